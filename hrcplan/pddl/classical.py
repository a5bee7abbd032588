"""Purely classical PDDL for simulators that know little more: no numbers, no durations.

The writer's text is then made plainer still, since pddlgym reads one type per variable only.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

from hrcplan.errors import UnsupportedError
from hrcplan.pddl.dialect import without_numbers
from hrcplan.pddl.model import (
    OBJECT,
    TRUE,
    Action,
    And,
    Atom,
    Condition,
    Effect,
    Equal,
    Formula,
    Not,
    Problem,
)
from hrcplan.pddl.write import domain_text, problem_text

_TEMPORAL = ":durative-actions"
_SHARED_TYPE = re.compile(r"((?:\?[^\s()]+ )+)- ([^\s()]+)")


def classical(problem: Problem) -> Problem:
    """Return a problem in which actions are instants, with literals as conditions and effects.

    What an action does one after the other in the sequential reading, it does here at once.

    Raises:
        UnsupportedError: if numbers decide something, a condition is no conjunction of literals,
            an effect is conditional, or start and end of an action do not fit in one instant.

    >>> from hrcplan.pddl.inputs import read
    >>> actions = classical(read("transport", "two-boxes")).domain.actions
    >>> [str(effect) for effect in actions[0].effects]
    ['(not (at ?a ?from))', '(at ?a ?to)', '(idle ?a)']
    """
    plain = without_numbers(problem)
    flags = tuple(flag for flag in plain.domain.requirements if flag != _TEMPORAL)
    actions = tuple(map(_at_once, plain.domain.actions))
    return replace(plain, domain=replace(plain.domain, requirements=flags, actions=actions))


def classical_texts(problem: Problem) -> tuple[str, str]:
    """Return domain and problem as plain PDDL text, each variable with a type of its own.

    Raises:
        UnsupportedError: if ``classical`` does.
    """
    plain = classical(problem)
    domain, text = domain_text(plain.domain), problem_text(plain)
    if not plain.domain.types:
        return domain.replace(f" - {OBJECT}", ""), text.replace(f" - {OBJECT}", "")
    return _SHARED_TYPE.sub(_spread, domain), text


def _spread(match: re.Match[str]) -> str:
    return " ".join(f"{variable} - {match[2]}" for variable in match[1].split())


def _at_once(action: Action) -> Action:
    if any(effect.params or effect.condition != TRUE for effect in action.effects):
        raise UnsupportedError(f"an effect of '{action.name}' is conditional")
    _check_one_instant(action)
    literals = And(tuple(part for c in action.conditions for part in _literals(c.formula, action)))
    add_targets = {effect.target for effect in action.effects if effect.kind == "add"}
    effects = tuple(
        replace(effect, when="start")
        for effect in sorted(action.effects, key=_is_late)
        if effect.kind == "add" or effect.target not in add_targets
    )
    return replace(
        action, conditions=(Condition("start", literals),), effects=effects,
        durative=False, durations=(),
    )  # fmt: skip


def _check_one_instant(action: Action) -> None:
    """Refuse an action whose end sees, or takes back, what its start did."""
    early = [effect for effect in action.effects if not _is_late(effect)]
    start_names = {effect.target.name for effect in early}
    add_names = {effect.target.name for effect in early if effect.kind == "add"}
    late = [c.formula for c in action.conditions if c.when != "start"]
    end_names = {
        part.name
        for formula in late
        for part in map(_positive, _literals(formula, action))
        if isinstance(part, Atom)
    }
    undone = {e.target.name for e in action.effects if _is_late(e) and e.kind == "delete"}
    if start_names & end_names or add_names & undone:
        name = min(start_names & end_names or add_names & undone)
        raise UnsupportedError(f"the end of '{action.name}' depends on '{name}' at its start")


def _is_late(effect: Effect) -> bool:
    return effect.when == "end"


def _positive(literal: Formula) -> Formula:
    return literal.body if isinstance(literal, Not) else literal


def _literals(formula: Formula, action: Action) -> Iterator[Formula]:
    match formula:
        case And(parts):
            for part in parts:
                yield from _literals(part, action)
        case Atom() | Equal() | Not(Atom() | Equal()):
            yield formula
        case _:
            raise UnsupportedError(f"'{action.name}' needs more than a conjunction of literals")
