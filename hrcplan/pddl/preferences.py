"""Preferences (PDDL 3) in goals and conditions: taken out of the tree, then read by themselves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hrcplan.core.records import replace
from hrcplan.pddl.formulas import read_conditions, read_formula
from hrcplan.pddl.model import Constraint, Formula, Param, Preference
from hrcplan.pddl.reader import GroupNode, ParseNode, WordNode
from hrcplan.pddl.scope import Scope
from hrcplan.pddl.typed_lists import read_params

UNNAMED = "unnamed"


def read_preferences(
    node: ParseNode, scope: Scope, durative: bool | None = None
) -> tuple[ParseNode, tuple[Preference, ...]]:
    """Return a tree without its preferences, and these.

    ``durative`` is None for a goal, else it says whether the tree is a durative action's condition.
    """
    if not scope.source.mentions("preference") or not _mentions(node, scope):
        return node, ()
    scope.source.use(":preferences", node.at)
    preferences: list[Preference] = []
    return _without(node, scope, (), durative, preferences), tuple(preferences)


def _mentions(node: ParseNode, scope: Scope) -> bool:
    if not isinstance(node, GroupNode) or scope.is_atom(node):
        return False
    inner = node[1:] if node.head in ("and", "forall") else []
    return node.head == "preference" or any(_mentions(part, scope) for part in inner)


def _without(
    node: ParseNode,
    scope: Scope,
    params: tuple[Param, ...],
    durative: bool | None,
    preferences: list[Preference],
) -> ParseNode:
    if not isinstance(node, GroupNode) or not _mentions(node, scope):
        return node
    if node.head == "preference":
        preferences.extend(_preference(node, scope, params, durative))
        return GroupNode(node.at)
    rest = GroupNode(node.at)
    if node.head == "forall" and len(node) == 3:
        inner, inside = scope.quantifying(read_params(node[1], scope), node.at)
        body = _without(node[2], inside, (*params, *inner), durative, preferences)
        rest.extend([node[0], node[1], body])
    else:
        rest.append(node[0])
        parts = [_without(part, scope, params, durative, preferences) for part in node[1:]]
        rest.extend(part for part in parts if part != [])
    return rest


def _preference(
    node: GroupNode, scope: Scope, params: tuple[Param, ...], durative: bool | None
) -> Iterator[Preference]:
    has_name = len(node) == 3 and isinstance(node[1], WordNode)
    if not has_name and len(node) != 2:
        message = "(preference NAME CONDITION) is expected here"
        scope.source.error(node.at, "bad-preference", message)
        return
    name = str(node[1]) if has_name else UNNAMED
    for when, formula in _conditions(node[-1], scope, durative):
        yield Preference(name, formula, params, when)


def _conditions(
    node: ParseNode, scope: Scope, durative: bool | None
) -> Iterator[tuple[str, Formula]]:
    if durative is None:
        yield "", read_formula(node, scope)
    else:
        for condition in read_conditions(node, scope, durative):
            if condition.when == "all":
                message = "a preference over the whole duration of an action is not supported"
                scope.source.error(node.at, "unsupported", message, "prefer it (at start …)")
            yield condition.when, condition.formula


def with_names(
    scope: Scope, preferences: Sequence[Preference], constraints: Sequence[Constraint]
) -> Scope:
    """Return the scope of a metric: it knows all preferences, those of actions too."""
    names = {p.name for action in scope.domain.actions for p in action.preferences}
    names.update(preference.name for preference in preferences)
    names.update(c.preference for c in (*scope.domain.constraints, *constraints) if c.preference)
    return replace(scope, preferences=names)
