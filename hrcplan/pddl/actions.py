"""Trees of ``(:action …)`` and ``(:durative-action …)`` to actions."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Set

from hrcplan.core.text import nearest, nearest_name, quote
from hrcplan.pddl.durations import as_durative, is_durative, read_durations
from hrcplan.pddl.effects import read_effects
from hrcplan.pddl.foreign import FOREIGN
from hrcplan.pddl.formulas import read_conditions
from hrcplan.pddl.model import CONTINUOUS, DURATION, Action, Param, Preference
from hrcplan.pddl.parentheses import ACTIONS, PARTS
from hrcplan.pddl.preferences import read_preferences
from hrcplan.pddl.reader import GroupNode, ParseNode, WordNode
from hrcplan.pddl.scope import Scope
from hrcplan.pddl.source import SECTION_SIMILARITY, SourceText
from hrcplan.pddl.typed_lists import read_params

PROCESS = ":process"
PLUS = frozenset([PROCESS, ":event"])
_CLOSE = SECTION_SIMILARITY
_CLASSICAL = (":parameters", ":precondition", ":effect")
_DURATIVE = (":parameters", ":duration", ":condition", ":effect")

_OTHER_PARTS = {
    ":vars": ("PDDL 1.2", "add the variables to :parameters"),
    ":observe": ("contingent planning", None),
    ":agent": ("MA-PDDL", "make the agent the first of the :parameters"),
}
_INSTEAD = {
    (":condition", ":durative-action"): "write :precondition, or (:durative-action …)",
    (":precondition", ":action"): "write :condition with (at start …), or (:action …)",
}
"""Cures for a part of the other kind of action."""
_TYPED_PARTS = (":agent", ":vars")  # not supported, but what they bind is no further fault
_BINDING_PARTS = (":parameters", *_TYPED_PARTS)


def read_actions(
    root: GroupNode, scope: Scope, heads: Set[str] = ACTIONS
) -> Iterator[tuple[GroupNode, Action]]:
    """Yield the actions of a domain (or what has other heads) with their trees.

    Of two with one name the first.
    """
    actions: dict[str, Action] = {}
    for node in root[2:]:
        if not isinstance(node, GroupNode) or node.head not in heads:
            continue
        action = _action(node, scope)
        if action is None:
            continue
        if action.name in actions:
            message = f"{node.head[1:]} {quote(action.name)} is declared twice"
            if actions[action.name] == action:
                scope.source.warn(node[1].at, "duplicate-action", message)
            else:
                hint = "the two differ: give one of them another name"
                scope.source.error(node[1].at, "duplicate-action", message, hint)
        else:
            actions[action.name] = action
            yield node, action


def _action(node: GroupNode, scope: Scope) -> Action | None:
    source = scope.source
    if len(node) < 2 or not isinstance(node[1], WordNode) or node[1].startswith(":"):
        hint = f"write ({node.head} NAME …)"
        source.error(node.at, "no-name", "the action has no name", hint)
        return None
    name = str(node[1])
    is_mistaken = node.head == ":action" and is_durative(node)
    if is_mistaken:
        message = "this is a durative action: 'at start', 'over all' and 'at end' are for those"
        hint = f"write (:durative-action {name} …) with :duration, :condition and :effect"
        source.error(node.at, "unexpected-time", message, hint)
        node = as_durative(node)
    durative = node.head == ":durative-action"
    parts = _parts(node, source, durative)
    params: tuple[Param, ...] = ()
    for part in _BINDING_PARTS:
        if part in parts:
            params += read_params(parts[part], scope)
    inner = scope.binding(params)
    scope_at_end = inner.knowing(DURATION) if durative else inner
    moment = None if durative else "start"
    if node.head == PROCESS:
        scope_at_end, moment = inner.knowing(CONTINUOUS), "all"
    if node.head in PLUS:
        source.use(":time", node.at)
    if durative and not is_mistaken:
        source.use(":durative-actions", node.at)
    condition = parts.get(":condition" if durative else ":precondition")
    preferences: tuple[Preference, ...] = ()
    if condition is not None:
        condition, preferences = read_preferences(condition, inner, durative)
    effect = parts.get(":effect")
    if effect is None or _is_empty(effect, inner):
        source.warn(node.at, "no-effect", f"action {quote(name)} has no effect")
    return Action(
        name=name,
        params=params,
        conditions=() if condition is None else tuple(read_conditions(condition, inner, durative)),
        effects=() if effect is None else tuple(read_effects(effect, scope_at_end, moment)),
        durative=durative,
        durations=tuple(read_durations(parts.get(":duration"), inner, node)) if durative else (),
        preferences=preferences,
    )


def _is_empty(effect: ParseNode, scope: Scope) -> bool:
    """Whether an effect is ``()`` or ``(and)``."""
    if isinstance(effect, WordNode) or scope.plain_atom(effect) is not None:
        return False
    return len(effect) < 2 and effect.head in ("", "and")


def _parts(node: GroupNode, source: SourceText, durative: bool) -> dict[str, ParseNode]:
    part_names = _DURATIVE if durative else _CLASSICAL
    parts: dict[str, ParseNode] = {}
    rest = deque(node[2:])
    last = ""
    while rest:
        key = rest.popleft()
        if isinstance(key, GroupNode) and last in parts:
            _report_second(key, last, source)
            while rest and isinstance(rest[0], GroupNode):
                rest.popleft()
            continue
        if isinstance(key, GroupNode) or not (
            key[0] == ":" or nearest_name(key, part_names, _CLOSE)
        ):
            hint = None if isinstance(key, GroupNode) else FOREIGN.get(key)
            if isinstance(key, WordNode) and key in ("and", "or"):
                hint = f"the word stands first: ({key} …)"
            source.error(key.at, "stray-word", "a keyword such as :effect is expected here", hint)
            while rest and isinstance(rest[0], GroupNode):
                rest.popleft()
            continue
        name = _part_name(key, part_names, source)
        if key in _TYPED_PARTS:
            parts.setdefault(str(key), _typed_part(key, rest))
            continue
        if name == ":parameters" and rest and isinstance(rest[0], WordNode) and rest[0][0] == "?":
            message, hint = "parameters stand in parentheses", "write :parameters (?x - type …)"
            source.error(rest[0].at, "not-a-list", message, hint)
            parts[name] = _typed_part(key, rest)
            continue
        if not rest or (isinstance(rest[0], WordNode) and rest[0].startswith(":")):
            source.error(key.at, "missing-part", f"nothing follows {quote(key)}")
            continue
        value = rest.popleft()
        if name in parts:
            source.error(key.at, "repeated-section", f"a second {name} in one action")
        elif name is not None:
            parts[name] = value
            last = name
    return parts


def _typed_part(key: WordNode, rest: deque[ParseNode]) -> GroupNode:
    """Take the typed list that follows a keyword, with or without parentheses."""
    if rest and isinstance(first := rest[0], GroupNode):
        rest.popleft()
        return first
    part = GroupNode(key.at)
    while rest and not (isinstance(rest[0], WordNode) and rest[0].startswith(":")):
        part.append(rest.popleft())
    return part


def _report_second(node: GroupNode, part: str, source: SourceText) -> None:
    """Report a group that follows the one which a keyword takes."""
    kind = "effect" if part == ":effect" else "condition"
    hint = None if part in (":parameters", ":duration") else f"put the {kind}s in one (and …)"
    source.error(node.at, "stray-word", f"{part} takes one group, and a second one follows", hint)


def _part_name(key: WordNode, part_names: tuple[str, ...], source: SourceText) -> str | None:
    """Return the part that a keyword names; a misspelt one is reported, yet understood."""
    if key in part_names:
        return str(key)
    message = f"an action has no part {quote(key)}"
    if key in PARTS:
        right = ":action" if part_names is _DURATIVE else ":durative-action"
        cure = _INSTEAD.get((str(key), right), f"that belongs into a {right}")
        source.error(key.at, "unknown-section", message, cure)
        return None
    if key in _OTHER_PARTS:
        name, hint = _OTHER_PARTS[key]
        source.error(key.at, "unsupported", f"{key} ({name}) is not supported", hint)
        return None
    begun = next((part for part in part_names if len(key) > 2 and part.startswith(key)), None)
    hint = f"did you mean {quote(begun)}?" if begun else nearest(key, part_names)
    source.error(key.at, "unknown-section", message, hint)
    return begun or nearest_name(key, part_names, _CLOSE)
