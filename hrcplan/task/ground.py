"""From a problem to its grounded task, in one call."""

from __future__ import annotations

from hrcplan.pddl.inputs import Readable, as_problem
from hrcplan.pddl.model import Domain, Problem
from hrcplan.task.task import Task


def ground(domain: Readable | Domain | Problem, problem: Readable | None = None) -> Task:
    """Return the grounded task of a problem: facts and ground actions as bit positions.

    Args:
        domain: A `Problem`, or whatever `hrcplan.read` takes.
        problem: The problem, if ``domain`` is only its domain.

    Raises:
        InputError: if a file is missing or has faults.
        UnsupportedError: if bits cannot hold the task.
        LimitError: if there are too many ground actions.

    >>> ground("transport/two-boxes").problem.name
    'two-boxes'
    """
    return Task(as_problem(domain, problem))
