"""The ``:duration`` of durative actions, and those that are written as ``(:action …)``."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from hrcplan.pddl.formulas import read_expression, time_of
from hrcplan.pddl.model import DURATION, Constant, Expr
from hrcplan.pddl.reader import FlatNode, GroupNode, ParseNode, WordNode
from hrcplan.pddl.scope import Scope
from hrcplan.pddl.semantics import Undefined, evaluate
from hrcplan.pddl.source import SourceText

_DURATION_FORMS = "write (= ?duration …), (<= ?duration …) or (>= ?duration …)"
_OPERATORS = {":=": "=", "==": "=", "assign": "=", "<": "<=", ">": ">="}
_OTHER_WORDS = frozenset(["?d", "?time", "?t", "time"])


def read_durations(
    node: ParseNode | None, scope: Scope, action: GroupNode
) -> Iterator[tuple[str, Expr]]:
    """Yield the comparisons of ``:duration`` with their values; what is none is an error."""
    constraints = node[1:] if isinstance(node, GroupNode) and node.head == "and" else [node]
    if node is None or not constraints:
        at = action.at if node is None else node.at
        message, hint = "a durative action needs a :duration", "write :duration (= ?duration 1)"
        scope.source.error(at, "no-duration", message, hint)
        return
    for part in constraints:
        assert part is not None
        inner = part[2] if _has_time(part) and isinstance(part, GroupNode) else part
        if not _is_constraint(inner) or not isinstance(inner, GroupNode):
            message, hint = "a duration is compared by =, <= or >=", _duration_cure(inner)
            scope.source.error(part.at, "bad-duration", message, hint)
            continue
        if any(word == DURATION for word in _words(inner[2])):
            message = "the duration is compared with itself"
            hint = "the right side has numbers and functions only, such as (= ?duration (f ?x))"
            scope.source.error(inner.at, "bad-duration", message, hint)
            continue
        if inner.head != "=":
            scope.source.use(":duration-inequalities", inner.at)
        value = read_expression(inner[2], scope)
        _check_constant(inner, value, scope.source)
        yield str(inner.head), value


def _duration_cure(node: ParseNode) -> str:
    if isinstance(node, WordNode):
        is_value = node[0] not in ":?=<>"
        return f"write (= ?duration {node})" if is_value else _DURATION_FORMS
    if not node:
        return "for any duration write (>= ?duration 0)"
    operator = _OPERATORS.get(node.head, node.head)
    if node.head == "or":
        return "write (and (>= ?duration LEAST) (<= ?duration MOST)), or one action for each"
    if operator in ("=", "<=", ">=") and len(node) == 3:
        if node[2] == DURATION:
            return f"?duration stands first: ({operator} ?duration …)"
        value = node[2] if isinstance(node[2], WordNode) else "…"
        if node[1] == DURATION or _is_duration_name(node[1]):
            return f"write ({operator} ?duration {value})"
    return _DURATION_FORMS


def _is_duration_name(node: ParseNode) -> bool:
    """Whether a word, perhaps in parentheses, is an attempt at ``?duration``."""
    if isinstance(node, GroupNode):
        return len(node) == 1 and _is_duration_name(node[0])
    return node in _OTHER_WORDS or node.startswith(("?dur", "dur"))


def _words(node: ParseNode) -> Iterator[WordNode]:
    waiting = [node]
    while waiting:
        part = waiting.pop()
        if isinstance(part, WordNode):
            yield part
        else:
            waiting += part


def _has_time(node: ParseNode) -> bool:
    return isinstance(node, GroupNode) and len(node) == 3 and node.head == "at"


def _is_constraint(node: ParseNode) -> bool:
    return (
        isinstance(node, GroupNode)
        and len(node) == 3
        and node.head in ("=", "<=", ">=")
        and node[1] == DURATION
    )


def _check_constant(node: GroupNode, duration: Expr, source: SourceText) -> None:
    """Report a duration that is below zero whatever the problem says."""
    try:
        value = evaluate(duration, {}, {})
    except Undefined:
        return
    if node.head != ">=" and value < 0:
        message = f"the action lasts {Constant(value)}: less than nothing"
        source.error(node.at, "negative-duration", message)


def is_durative(node: GroupNode) -> bool:
    """Whether an ``(:action …)`` says times as durative actions do, in all of its effects."""
    if ":effect" not in node or not _has_times(node):
        return False
    if ":duration" in node or ":condition" in node:
        return True
    effect = next((after for key, after in pairwise(node) if key == ":effect"), None)
    parts: list[ParseNode | None] = [effect]
    if isinstance(effect, GroupNode) and effect.head == "and":
        parts = list(effect[1:])
    return all(isinstance(part, GroupNode) and _has_times(part) for part in parts)


def _has_times(node: GroupNode) -> bool:
    """Whether an action or a part of it has a group such as ``(at start (p))``."""
    waiting = [node]
    while waiting:
        group = waiting.pop()
        if isinstance(group, FlatNode):
            continue  # words only
        if time_of(group) is not None and isinstance(group[2], GroupNode):
            return True
        waiting += [part for part in group if isinstance(part, GroupNode)]
    return False


def as_durative(node: GroupNode) -> GroupNode:
    """Return an ``(:action …)`` as the durative action that it is meant to be."""
    action = GroupNode(node.at)
    words = {":action": ":durative-action", ":precondition": ":condition"}
    for part in node:
        word = words.get(part) if isinstance(part, WordNode) else None
        action.append(part if word is None else _word(word, part.at))
    if ":duration" not in action:
        anything = GroupNode(node.at)
        anything += [_word("=", node.at), _word(DURATION, node.at), _word("0", node.at)]
        action += [_word(":duration", node.at), anything]
    return action


def _word(text: str, at: int) -> WordNode:
    word = WordNode(text)
    word.at = at
    return word
