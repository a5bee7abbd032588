"""The tree of a domain file to a Domain; every fault is noted in the file's source."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from hrcplan.core.records import replace
from hrcplan.core.text import nearest, nearest_name, quote
from hrcplan.pddl import conventions
from hrcplan.pddl.actions import PLUS, PROCESS, read_actions
from hrcplan.pddl.annotations import read_notes
from hrcplan.pddl.axioms import DERIVED, read_axioms
from hrcplan.pddl.formulas import OBJECT_FLUENTS
from hrcplan.pddl.model import OBJECT, Domain, Signature
from hrcplan.pddl.parentheses import ACTIONS
from hrcplan.pddl.reader import FlatNode, GroupNode, ParseNode, WordNode
from hrcplan.pddl.requirements import check_requirements, read_requirements
from hrcplan.pddl.scope import Scope
from hrcplan.pddl.source import SECTION_SIMILARITY, SourceText
from hrcplan.pddl.trajectories import SECTION, read_constraints
from hrcplan.pddl.typed_lists import (
    NO_PRIVATE,
    Entry,
    params_of,
    plain_params,
    read_typed,
    report_types,
    with_dashes,
)

_HIERARCHICAL = "tasks and methods of HDDL (hierarchical planning)"
_UNSUPPORTED = {
    ":axiom": "axioms of PDDL 1.2",
    ":constraint": "global constraints of ENHSP",
    ":free_functions": "free functions of ENHSP",
    **dict.fromkeys((":task", ":method", ":htn"), _HIERARCHICAL),
}
_CURES = {
    ":axiom": "write (:derived (p ?x) CONDITION)",
    **dict.fromkeys((":task", ":method", ":htn"), "write (:action …) and a (:goal …)"),
    ":free_functions": "write the value as a parameter or as an action that changes it",
    ":constraint": "add its condition to the actions, or write (:constraints (always …))",
}
_KEYWORDS = frozenset([
    "and", "or", "not", "imply", "forall", "exists", "when", "preference", "increase",
    "decrease", "assign", "scale-up", "scale-down", "is-violated", "always", "sometime",
    "within",
])  # fmt: skip
_NO_TYPES = frozenset(["number", "either"])
_ELSEWHERE = {
    ":objects": "a domain's own objects stand in (:constants …)",
    ":constants": "a problem's objects stand in (:objects …)",
    **dict.fromkeys((":init", ":goal", ":metric"), "that belongs into a problem"),
    **dict.fromkeys(
        (":minimize", ":maximize"), "write (:metric minimize …) or (:metric maximize …)"
    ),
    **dict.fromkeys(
        (":precondition", ":effect", ":parameters"), "that belongs into an (:action …)"
    ),
    **dict.fromkeys(
        (":types", ":predicates", ":functions", ":action", ":durative-action", ":derived"),
        "that belongs into a domain",
    ),
}
_OPERATORS = frozenset(["=", "<", ">", "<=", ">=", "+", "*", "/"])
_REPEATED = ACTIONS | PLUS | {DERIVED}
_LISTS = frozenset([":requirements", ":types", ":constants", ":predicates", ":functions",
                    ":objects", ":init"])  # fmt: skip
_SECTIONS = (":requirements", ":types", ":constants", ":predicates", ":functions", SECTION,
             *_REPEATED)  # fmt: skip


def read_domain(root: GroupNode, source: SourceText) -> Domain:
    """Return the domain that a ``(define (domain …) …)`` tree describes."""
    name = declared_name(root, "domain", source)
    sections = sections_of(root, source, _SECTIONS)
    types = _types(sections.get(":types"), source)
    constants = read_objects(sections.get(":constants"), source, types, {})
    base = Domain(
        name=name,
        requirements=read_requirements(sections.get(":requirements"), source),
        types=types,
        constants=constants,
        predicates=_signatures(sections.get(":predicates"), source, types, "predicate"),
        functions=_signatures(sections.get(":functions"), source, types, "function"),
        path=source.path,
    )
    axioms = tuple(read_axioms(root, Scope(source, base, constants, {})))
    derived_names = frozenset(axiom.name for axiom in axioms)
    scope = Scope(source, base, constants, {}, derived=derived_names)
    actions = list(read_actions(root, scope))
    plus = list(read_actions(root, scope, PLUS))
    domain = replace(
        base,
        actions=tuple(action for _, action in actions),
        axioms=axioms,
        constraints=read_constraints(sections.get(SECTION), scope),
        processes=tuple(action for node, action in plus if node.head == PROCESS),
        events=tuple(action for node, action in plus if node.head != PROCESS),
    )
    domain = replace(domain, notes=read_notes(source, domain))
    report_types(source, types)
    check_requirements(domain.requirements, source)
    conventions.check_domain(domain, actions, source)
    return domain


def sections_of(
    root: GroupNode, source: SourceText, section_names: Sequence[str]
) -> dict[str, GroupNode]:
    """Return the sections of a file by name, reporting unknown, unsupported and repeated ones.

    A misspelt section is reported and then read as the one that was meant; a second list is read
    as a part of the first one.
    """
    sections: dict[str, GroupNode] = {}
    for node in root[2:]:
        word = node.head if isinstance(node, GroupNode) else ""
        name = _section_name(node, source, section_names)
        if name is None or isinstance(node, WordNode):
            continue
        if name in sections and name not in _REPEATED:
            if word == name:  # else it is misspelt, and reported for that
                hint = f"{'put all of it into' if name in _LISTS else 'write'} one section"
                source.error(node.at, "repeated-section", f"a second {name} section", hint)
            if name in _LISTS:
                sections[name].extend(node[1:])
        else:
            sections.setdefault(name, node)
    return sections


def _section_name(node: ParseNode, source: SourceText, section_names: Sequence[str]) -> str | None:
    name = node.head if isinstance(node, GroupNode) else ""
    if isinstance(node, WordNode) or not name:
        message = "a section such as (:predicates …) or (:init …) is expected here"
        is_keyword = isinstance(node, WordNode) and node.startswith(":")
        cure = f"the parenthesis stands first: ({node} …)" if is_keyword else "remove it"
        source.error(node.at, "stray-word", message, cure)
    elif name in section_names:
        return name
    elif name in _UNSUPPORTED:
        message = f"{_UNSUPPORTED[name]} are not supported"
        source.once(node.at, "unsupported", message, _CURES.get(name))
    elif name == ":length":
        source.warn(node.at, "ignored-section", "hrcplan takes no notice of :length", "remove it")
    else:
        message = f"there is no section {quote(name)} here"
        hint = _ELSEWHERE.get(name) or nearest(name, section_names)
        hint = hint or f"sections are: {', '.join(section_names)}"
        source.error(node.at, "unknown-section", message, hint)
        right = nearest_name(name, section_names, SECTION_SIMILARITY)
        if right is not None:
            node[0] = _rename(node[0], right)
        return right
    return None


def _rename(word: ParseNode, name: str) -> WordNode:
    copy = WordNode(name)
    copy.at = word.at
    return copy


def declared_name(root: GroupNode, kind: str, source: SourceText) -> str:
    """Return the NAME of ``(domain NAME)`` or ``(problem NAME)``."""
    node = root[1] if len(root) > 1 else root
    name = node[1] if isinstance(node, GroupNode) and len(node) == 2 and node.head == kind else None
    if isinstance(name, WordNode):
        return str(name)
    source.error(node.at, "no-name", f"({kind} NAME) is expected here", _name_cure(node, kind))
    return ""


def _name_cure(node: ParseNode, kind: str) -> str:
    if isinstance(node, GroupNode) and node.head == kind and len(node) > 2:
        return "a name has no spaces: write - or _ instead"
    return f"a file begins with (define ({kind} NAME)"


def read_objects(
    section: GroupNode | None,
    source: SourceText,
    types: Collection[str],
    constants: Mapping[str, str],
) -> dict[str, str]:
    """Return the objects of an ``:objects`` or ``:constants`` section with their types."""
    objects: dict[str, str] = {}
    for name, kinds in read_typed(section[1:] if section else (), source, types):
        if len(kinds) > 1:
            hint = "declare a type below all of these, and give the object that type"
            source.error(name.at, "unsupported", "an object needs one type, not (either …)", hint)
        before = objects.get(str(name), constants.get(str(name)))
        if before not in (None, kinds[0]):
            message = f"object {quote(name)} is declared twice, as {before} and as {kinds[0]}"
            hint = "declare a type below both, and give the object that type"
            source.error(name.at, "duplicate-object", message, hint)
        elif name in objects:
            message = f"object {quote(name)} is declared twice"
            source.warn(name.at, "duplicate-object", message, "remove one of the two")
        elif name.startswith("?"):
            message = f"an object's name cannot be {quote(name)}"
            source.error(name.at, "not-a-name", message, f"write {name.lstrip('?') or 'a name'}")
        else:
            objects[str(name)] = kinds[0]
    return objects


def _types(section: GroupNode | None, source: SourceText) -> dict[str, tuple[str, ...]]:
    """Return the types with those directly above them.

    A type that is listed twice is below both; one that is only named as above others is declared
    by that. Both are warnings.
    """
    types: dict[str, tuple[str, ...]] = {}
    entries = list(read_typed(section[1:] if section else [], source))
    for name, parents in entries:
        if name == OBJECT:
            continue
        if name in types and name not in (*parents, *types[name]):
            above = dict.fromkeys(p for p in (*types[name], *parents) if p != OBJECT)
            all_above = " ".join(above) if len(above) == 1 else f"(either {' '.join(above)})"
            cure = f"write '{name} - {all_above}' once" if above else "remove one of the two"
            message = f"type {quote(name)} is declared twice"
            source.warn(name.at, "duplicate-type", message, cure)
        both = [*types.get(str(name), ()), *parents]
        types[str(name)] = tuple(dict.fromkeys(p for p in both if p != OBJECT)) or (OBJECT,)
        if name in _NO_TYPES:
            message = f"many readers refuse a type called {quote(name)}"
            source.warn(name.at, "keyword-name", message, "give it another name")
    declared = [str(name) for name, _ in entries]
    for name, parents in entries:
        for parent in parents:
            if parent != OBJECT and parent not in types:
                types[parent] = (OBJECT,)
                message = f"type {quote(parent)} is only named as a supertype"
                close = nearest_name(parent, [n for n in declared if n != name], 0.8)
                cure = f"add '{parent} - object' to (:types …)"
                hint = f"did you mean {quote(close)}? else {cure}" if close else cure
                source.warn(name.at, "undeclared-supertype", message, hint)
    _report_cycles(types, entries, source)
    return types


def _report_cycles(
    types: dict[str, tuple[str, ...]], entries: Sequence[Entry], source: SourceText
) -> None:
    """Report the types that are left when those with only settled types above are taken away."""
    acyclic: set[str] = set()
    below: dict[str, list[str]] = {}
    for name, parents in types.items():
        for parent in parents:
            below.setdefault(parent, []).append(name)
    open_parents = {n: sum(p in types for p in above) for n, above in types.items()}
    ready = [name for name, n_open in open_parents.items() if not n_open]
    while ready:
        name = ready.pop()
        acyclic.add(name)
        for child in below.get(name, ()):
            open_parents[child] -= 1
            if not open_parents[child]:
                ready.append(child)
    reported: set[str] = set()
    for name, _ in entries:
        if name not in types or name in acyclic or name in reported:
            continue
        ancestors = _ancestors(name, types)
        if name in ancestors:
            reported |= ancestors  # the other types of the cycle
            message = f"type {quote(name)} is below itself"
            source.error(name.at, "cyclic-types", message, f"write '{name} - object' apart")


def _ancestors(name: str, types: dict[str, tuple[str, ...]]) -> set[str]:
    """Return the types above a type; itself only if it is below itself."""
    ancestors: set[str] = set()
    waiting = list(types[name])
    while waiting:
        above = waiting.pop()
        if above not in ancestors:
            ancestors.add(above)
            waiting.extend(types.get(above, ()))
    return ancestors


def _signatures(
    section: GroupNode | None, source: SourceText, types: Collection[str], kind: str
) -> dict[str, Signature]:
    signatures: dict[str, Signature] = {}
    for node in _without_result_types(section, source):
        if isinstance(node, FlatNode):
            word, *words = node.words()
            plain = plain_params(words, source, types)
            if plain is not None and not _is_odd(word) and word not in signatures:
                signatures[word] = Signature(word, plain)
                continue
        if isinstance(node, GroupNode) and node.head == ":private":
            hint = "declare its predicates with the others: hrcplan has no private facts"
            source.error(node.at, "unsupported", NO_PRIVATE, hint)
            inner = [part for part in node if isinstance(part, GroupNode)]
            private = GroupNode(node.at)
            private.extend([node[0], *inner])
            signatures |= _signatures(private, source, types, kind)
            continue
        if not isinstance(node, GroupNode) or not node.head:
            message = f"a {kind} such as (name ?x - type) is expected"
            hint = f"write ({node})" if isinstance(node, WordNode) else "the name stands first"
            source.error(node.at, f"bad-{kind}", message, hint)
            continue
        name = node[0]
        assert isinstance(name, WordNode)
        params = params_of(node[1:], source, types, declaration=True)
        if _is_odd(name):
            _report_odd_name(name, kind, source)
        if name == "=" and kind == "predicate":
            continue
        if name in signatures:
            same = [p.types for p in params] == [p.types for p in signatures[name].params]
            report = source.warn if same else source.error
            hint = "remove one of the two" if same else "give one of them another name"
            report(name.at, f"duplicate-{kind}", f"{kind} {quote(name)} is declared twice", hint)
        else:
            signatures[str(name)] = Signature(str(name), params)
    return signatures


def _is_odd(word: str) -> bool:
    """Whether a word is a keyword or no name."""
    return word in _KEYWORDS or word in _OPERATORS or word[0] in "?-"


def _report_odd_name(name: WordNode, kind: str, source: SourceText) -> None:
    """Report a declaration of what is no name; a keyword, and ``=``, is only a warning."""
    if name == "=" and kind == "predicate":
        source.warn(name.at, "keyword-name", "'=' needs no declaration", "remove it")
    elif name in _KEYWORDS:
        message = f"many readers refuse a {kind} called {quote(name)}"
        source.warn(name.at, "keyword-name", message, "give it another name")
    else:
        message = f"a {kind} cannot be called {quote(name)}"
        source.error(name.at, "not-a-name", message, "a name begins with a letter")


def _without_result_types(section: GroupNode | None, source: SourceText) -> Iterator[ParseNode]:
    """Yield declarations, skipping the ``- number`` that may follow functions."""
    nodes = iter(with_dashes(section[1:] if section else (), source))
    for node in nodes:
        if isinstance(node, GroupNode) or node != "-":
            yield node
        elif next(nodes, None) != "number":
            source.error(node.at, "unsupported", "functions have numbers as values", OBJECT_FLUENTS)
