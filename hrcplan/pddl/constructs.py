"""Constructs beyond facts, actions and numbers: which of them a problem has, by name."""

from __future__ import annotations

from collections.abc import Iterator

from hrcplan.pddl.model import TRUE, Problem

AXIOMS = "derived predicates"
TIMED = "timed initial literals"
PREFERENCES = "preferences"
START_CONDITIONS = "effects at the end with a condition at the start"
TRAJECTORIES = "trajectory constraints"
CONTINUOUS = "processes, events or continuous effects"
ALL = frozenset([AXIOMS, TIMED, PREFERENCES, START_CONDITIONS, TRAJECTORIES, CONTINUOUS])

EXECUTED = frozenset([AXIOMS, TIMED, PREFERENCES, START_CONDITIONS])
"""Those that an execution can hold."""


def constructs(problem: Problem) -> Iterator[str]:
    """Yield the names of the constructs that a ground task cannot hold."""
    domain = problem.domain
    if domain.axioms:
        yield AXIOMS
    if problem.timed:
        yield TIMED
    if problem.preferences or any(action.preferences for action in domain.actions):
        yield PREFERENCES
    if domain.constraints or problem.constraints:
        yield TRAJECTORIES
    if any(e.start_condition != TRUE for action in domain.actions for e in action.effects):
        yield START_CONDITIONS
    if domain.is_continuous:
        yield CONTINUOUS
