"""The tree of a domain file to a Domain; every fault is noted in the file's source."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from hrcplan.pddl.formulas import read_conditions, read_effects, read_expression
from hrcplan.pddl.model import DURATION, OBJECT, Action, Domain, Expr, Signature
from hrcplan.pddl.reader import Group, Node, Word, notes
from hrcplan.pddl.scope import Scope
from hrcplan.pddl.source import Source, nearest, quote
from hrcplan.pddl.typed_lists import Entry, check_types, params_of, read_params, read_typed

REQUIREMENTS = frozenset(
    ":strips :typing :negative-preconditions :disjunctive-preconditions :equality "
    ":existential-preconditions :universal-preconditions :quantified-preconditions "
    ":conditional-effects :fluents :numeric-fluents :object-fluents :adl :durative-actions "
    ":duration-inequalities :continuous-effects :derived-predicates :timed-initial-literals "
    ":preferences :constraints :action-costs :goal-utilities :time".split()
)
UNSUPPORTED = {
    ":derived": "derived predicates",
    ":process": "processes",
    ":event": "events",
    ":constraints": "constraints",
}
_ONCE = (":requirements", ":types", ":constants", ":predicates", ":functions")
_SECTIONS = (*_ONCE, ":action", ":durative-action", *UNSUPPORTED)


def read_domain(root: Group, source: Source) -> Domain:
    """Return the domain that a ``(define (domain …) …)`` tree describes."""
    sections = dict(sections_of(root, source, _SECTIONS, _ONCE))
    types = _types(sections.get(":types"), source)
    constants = read_objects(sections.get(":constants"), source, list(types), {})
    base = Domain(
        name=declared_name(root, "domain", source),
        requirements=_requirements(sections.get(":requirements"), source),
        types=types,
        constants=constants,
        predicates=_signatures(sections.get(":predicates"), source, list(types), "predicate"),
        functions=_signatures(sections.get(":functions"), source, list(types), "function"),
        notes=tuple(text for _, text in notes(source)),
        path=source.path,
    )
    actions = tuple(_actions(root, Scope(source, base, constants, {})))
    return replace(base, actions=actions)


def sections_of(
    root: Group, source: Source, known: Sequence[str], once: Sequence[str]
) -> Iterator[tuple[str, Group]]:
    """Yield the sections of a file by name, reporting unknown, unsupported and repeated ones."""
    seen: set[str] = set()
    for node in root[2:]:
        name = node.head if isinstance(node, Group) else ""
        if isinstance(node, Word) or not name:
            source.error(node.at, "stray-word", "a section such as (:action …) is expected here")
        elif name in UNSUPPORTED:
            source.error(node.at, "unsupported", f"{UNSUPPORTED[name]} are not supported")
        elif name not in known:
            message = f"there is no section {quote(name)} here"
            source.error(node.at, "unknown-section", message, nearest(name, known))
        elif name in once and name in seen:
            source.error(node.at, "repeated-section", f"a second {name} section")
        else:
            seen.add(name)
            yield name, node


def declared_name(root: Group, kind: str, source: Source) -> str:
    """Return the NAME of ``(domain NAME)`` or ``(problem NAME)``."""
    node = root[1] if len(root) > 1 else root
    if isinstance(node, Group) and len(node) == 2 and node.head == kind:
        if isinstance(node[1], Word):
            return str(node[1])
    source.error(node.at, "no-name", f"({kind} NAME) is expected here")
    return ""


def read_objects(
    section: Group | None, source: Source, types: Sequence[str], known: dict[str, str]
) -> dict[str, str]:
    """Return the objects of an ``:objects`` or ``:constants`` section with their types."""
    found: dict[str, str] = {}
    for name, kinds, words in read_typed(section[1:] if section else (), source):
        check_types(words, types, source)
        if len(kinds) > 1:
            source.error(name.at, "unsupported", "an object needs one type, not (either …)")
        if name in found or (name in known and known[name] != kinds[0]):
            source.error(name.at, "duplicate-object", f"object {quote(name)} is declared twice")
        elif name.startswith("?"):
            source.error(name.at, "not-a-name", f"an object's name cannot be {quote(name)}")
        else:
            found[str(name)] = kinds[0]
    return found


def _requirements(section: Group | None, source: Source) -> tuple[str, ...]:
    flags = [word for word in (section or ())[1:] if isinstance(word, Word)]
    for word in flags:
        if word not in REQUIREMENTS:
            message = f"requirement {quote(word)} is unknown"
            source.warn(word.at, "unknown-requirement", message, nearest(word, REQUIREMENTS))
    return tuple(map(str, flags))


def _types(section: Group | None, source: Source) -> dict[str, tuple[str, ...]]:
    entries = list(read_typed(section[1:] if section else (), source))
    found: dict[str, tuple[str, ...]] = {}
    for name, parents, _ in entries:
        if name in found and found[name] != parents:
            source.error(name.at, "duplicate-type", f"type {quote(name)} is declared twice")
        elif name != OBJECT:
            found[str(name)] = parents
    for _, parents, words in entries:
        check_types(words, list(found), source)
    _report_cycles(found, entries, source)
    return found


def _report_cycles(
    types: dict[str, tuple[str, ...]], entries: Sequence[Entry], source: Source
) -> None:
    settled: set[str] = {OBJECT}
    waiting = dict(types)
    while ready := [n for n, above in waiting.items() if not set(above) & set(waiting) - {n}]:
        for name in ready:
            if name not in types[name]:
                settled.add(name)
            del waiting[name]
    for name, _, _ in entries:
        if name in types and name not in settled and _is_own_ancestor(name, types):
            source.error(name.at, "cyclic-types", f"type {quote(name)} is below itself")


def _is_own_ancestor(name: str, types: dict[str, tuple[str, ...]]) -> bool:
    seen: set[str] = set()
    waiting = list(types[name])
    while waiting:
        above = waiting.pop()
        if above == name:
            return True
        if above not in seen:
            seen.add(above)
            waiting.extend(types.get(above, ()))
    return False


def _signatures(
    section: Group | None, source: Source, types: Sequence[str], kind: str
) -> dict[str, Signature]:
    found: dict[str, Signature] = {}
    for node in _without_result_types(section, source):
        if not isinstance(node, Group) or not node.head:
            source.error(node.at, f"bad-{kind}", f"a {kind} such as (name ?x - type) is expected")
            continue
        name = node[0]
        assert isinstance(name, Word)
        if name in found:
            source.error(name.at, f"duplicate-{kind}", f"{kind} {quote(name)} is declared twice")
        else:
            found[str(name)] = Signature(str(name), params_of(node[1:], source, types))
    return found


def _without_result_types(section: Group | None, source: Source) -> Iterator[Node]:
    """Yield declarations, skipping the ``- number`` that may follow functions."""
    nodes = list(section[1:] if section else ())
    index = 0
    while index < len(nodes):
        if nodes[index] == "-":
            following = nodes[index + 1] if index + 1 < len(nodes) else None
            if following != "number":
                source.error(nodes[index].at, "unsupported", "functions have numbers as values")
            index += 2
        else:
            yield nodes[index]
            index += 1


def _actions(root: Group, scope: Scope) -> Iterator[Action]:
    seen: set[str] = set()
    for node in root[2:]:
        if isinstance(node, Group) and node.head in (":action", ":durative-action"):
            action = _action(node, scope)
            if action is None:
                continue
            if action.name in seen:
                message = f"action {quote(action.name)} is declared twice"
                scope.source.error(node[1].at, "duplicate-action", message)
            seen.add(action.name)
            yield action


def _action(node: Group, scope: Scope) -> Action | None:
    source = scope.source
    if len(node) < 2 or not isinstance(node[1], Word) or node[1].startswith(":"):
        source.error(node.at, "no-name", "the action has no name")
        return None
    durative = node.head == ":durative-action"
    parts = _parts(node, source, durative)
    params = read_params(parts[":parameters"], scope) if ":parameters" in parts else ()
    inner = scope.binding(params)
    condition = parts.get(":condition" if durative else ":precondition")
    effect = parts.get(":effect")
    timed = Scope(source, inner.domain, inner.objects, {**inner.variables, DURATION: ("number",)})
    action = Action(
        name=str(node[1]),
        params=params,
        conditions=() if condition is None else tuple(read_conditions(condition, inner, durative)),
        effects=() if effect is None else tuple(
            read_effects(effect, timed if durative else inner, None if durative else "start")
        ),
        durative=durative,
        durations=_durations(parts.get(":duration"), timed, node) if durative else (),
    )  # fmt: skip
    if not action.effects and not source.has_errors:
        source.warn(node.at, "no-effect", f"action {quote(action.name)} has no effect")
    return action


def _parts(node: Group, source: Source, durative: bool) -> dict[str, Node]:
    known = [":parameters", ":effect"]
    known += [":duration", ":condition"] if durative else [":precondition"]
    found: dict[str, Node] = {}
    index = 2
    while index < len(node):
        key = node[index]
        value = node[index + 1] if index + 1 < len(node) else None
        if isinstance(key, Group) or not key.startswith(":"):
            source.error(key.at, "stray-word", "a keyword such as :effect is expected here")
            index += 1
            continue
        if key not in known:
            message = f"an action has no part {quote(key)}"
            source.error(key.at, "unknown-section", message, nearest(key, known))
        elif key in found:
            source.error(key.at, "repeated-section", f"a second {key} in one action")
        elif value is None or (isinstance(value, Word) and value.startswith(":")):
            source.error(key.at, "missing-part", f"nothing follows {key}")
            index += 1
            continue
        else:
            found[str(key)] = value
        index += 2
    return found


def _durations(node: Node | None, scope: Scope, action: Group) -> tuple[tuple[str, Expr], ...]:
    if node is None:
        scope.source.error(action.at, "no-duration", "a durative action needs a :duration")
        return ()
    found: list[tuple[str, Expr]] = []
    constraints = node[1:] if isinstance(node, Group) and node.head == "and" else [node]
    for part in constraints:
        inner = part[2] if isinstance(part, Group) and part.head == "at" and len(part) == 3 else part
        if not _is_duration(inner):
            scope.source.error(part.at, "bad-duration", "(= ?duration …) is expected here")
            continue
        assert isinstance(inner, Group)
        value = read_expression(inner[2], scope)
        found.append((inner.head, value))
    return tuple(found)


def _is_duration(node: Node) -> bool:
    return (
        isinstance(node, Group)
        and len(node) == 3
        and node.head in ("=", "<=", ">=")
        and node[1] == DURATION
    )


