"""Names to values: the first calls a user makes."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from hrcplan import validation
from hrcplan.core.numbers import Number
from hrcplan.errors import InputError
from hrcplan.pddl import check, library
from hrcplan.pddl.model import Domain, FluentKey, Problem
from hrcplan.pddl.problem import named_domain
from hrcplan.pddl.reader import read
from hrcplan.pddl.source import read_source
from hrcplan.planners.contract import Planner
from hrcplan.planners.solve import AUTO, DEFAULT_TIMEOUT_S, Result, solve
from hrcplan.plans import parse_plan
from hrcplan.task import Task
from hrcplan.validation import Report


def load_problem(domain: str, problem: str) -> Problem:
    """Return a problem, given by paths or shipped names.

    Raises:
        PddlError: with every fault of the first file that has any.
        InputError: if a file is missing or unreadable.
    """
    path = library.find_domain(domain)
    return check.load_problem(check.load_domain(path), library.find_problem(domain, problem))


def load_file(path: str | Path) -> Problem:
    """Return the problem in a file; its domain is found beside it or among the shipped ones.

    Raises:
        PddlError: with every fault of the first file that has any.
        InputError: if a file is missing or unreadable, or no domain of the name is found.
    """
    root = read(read_source(path))
    name = None if root is None else named_domain(root)
    found = None if name is None else library.domain_file_for(str(name), Path(path))
    if name is not None and found is None:
        message = f"no domain '{name}' beside the problem or among the shipped ones"
        raise InputError(message, code="domain-mismatch", path=str(path))
    domain = Domain("") if found is None else check.load_domain(found)
    return check.load_problem(domain, path)


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


def plan(
    domain: str,
    problem: str,
    planner: str | Planner = AUTO,
    *,
    values: Mapping[FluentKey, Number] | None = None,
    timeout_s: float = DEFAULT_TIMEOUT_S,
    any_plan: bool = False,
    lanes: bool = False,
) -> Result:
    """Return a checked plan for a problem, given by paths or shipped names.

    Args:
        domain: A path or a shipped name.
        problem: A path or a shipped name.
        planner: A name (see ``hrcplan planners``), a planner object, or ``auto``.
        values: Function values to put into the initial state, as ``{("motivation", "human"): 8}``.
        timeout_s: Seconds for all planners together.
        any_plan: The first valid plan is enough.
        lanes: Lay a sequential plan out in lanes.

    Raises:
        InputError: if a file is missing or has faults.
        UsageError: if the planner is unknown or cannot hold the task.
        PlannerError: if it is missing, crashed, or gave a wrong answer.

    >>> plan("transport", "handover", values={("motivation", "human"): 3}).plan.is_schedule
    True
    """
    loaded = load_problem(domain, problem).with_values(values or {})
    return solve(loaded, planner, timeout_s=timeout_s, any_plan=any_plan, lanes=lanes)


def validate(domain: str, problem: str, plan: str) -> Report:
    """Return the replay of a plan, given as text in IPC format.

    Raises:
        InputError: if a file is missing or has faults, or the text is no plan.

    >>> validate("transport", "two-boxes", "(move human wp1 wp4)").reason
    'the goal (box-at green wp2) does not hold at the end'
    """
    return validation.validate(load_problem(domain, problem), parse_plan(plan))
