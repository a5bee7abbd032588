"""Names to values: the first calls a user makes."""

from __future__ import annotations

from hrcplan.pddl import check, library
from hrcplan.pddl.model import Problem
from hrcplan.task import Task


def load_problem(domain: str, problem: str) -> Problem:
    """Return a problem, given by paths or shipped names.

    Raises:
        PddlError: with every fault of the first file that has any.
        InputError: if a file is missing or unreadable.
    """
    path = library.find_domain(domain)
    return check.load_problem(check.load_domain(path), library.find_problem(domain, problem))


def load(domain: str, problem: str) -> Task:
    """Return the grounded task of a problem, given by paths or shipped names.

    Raises:
        PddlError: with every fault of the first file that has any.
        InputError: if a file is missing or unreadable.
        UnsupportedError: if bits cannot hold the task.

    >>> load("transport", "two-boxes").problem.name
    'two-boxes'
    """
    return Task(load_problem(domain, problem))
