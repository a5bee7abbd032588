"""The price that planners see for actions that may have to be repeated.

Planning assumes that an interaction succeeds. What the planner is given for its price is what it
costs until it has succeeded, on average: price / success probability. A plan's own cost, as
``validate`` gives it, is that of the PDDL.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from hrcplan.core.numbers import Number
from hrcplan.errors import UsageError
from hrcplan.pddl.model import TOTAL_COST, Action, Arithmetic, Constant, Problem


def expected_retries(problem: Problem) -> Problem:
    """Return a problem in which every action costs its price divided by its success probability.

    Success probabilities are the domain's notes. An action that never succeeds is left out.

    >>> from hrcplan.pddl.inputs import read
    >>> priced = expected_retries(read("transport-coached", "two-boxes"))
    >>> next(a for a in priced.domain.actions if a.name == "remind").effects[-1].value
    Arithmetic(op='/', parts=(Function(name='help-price', args=()), Constant(value=Fraction(4, 5))))
    """
    domain = problem.domain
    if all(domain.success(action.name) == 1 for action in domain.actions):
        return problem
    actions = tuple(
        _with_expected_price(action, Fraction(p))
        for action in domain.actions
        if (p := domain.success(action.name)) > 0
    )
    return replace(problem, domain=replace(domain, actions=actions))


def with_success(problem: Problem, probability: float | Number) -> Problem:
    """Return a problem in which every action with a success note succeeds with this probability.

    Raises:
        UsageError: if it is no probability.
    """
    if not 0 <= probability <= 1:
        raise UsageError(f"{probability} is no probability", code="bad-probability")
    exact = Fraction(str(probability))
    notes = tuple(
        replace(note, numbers=(exact,)) if note.kind == "success" else note
        for note in problem.domain.notes
    )
    return replace(problem, domain=replace(problem.domain, notes=notes))


def _with_expected_price(action: Action, probability: Fraction) -> Action:
    if probability == 1:
        return action
    effects = tuple(
        replace(e, value=Arithmetic("/", (e.value, Constant(probability))))
        if e.target.name == TOTAL_COST and e.value is not None
        else e
        for e in action.effects
    )
    return replace(action, effects=effects)
