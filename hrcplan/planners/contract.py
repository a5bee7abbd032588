"""What planners are asked and what they answer; every planner speaks these types."""

from __future__ import annotations

import enum
import time
from collections.abc import Callable
from functools import cached_property
from typing import Protocol, runtime_checkable

from hrcplan.core.numbers import Number
from hrcplan.core.records import field, record, replace
from hrcplan.errors import LimitError, UnsupportedError
from hrcplan.pddl.model import TOTAL_TIME, Problem
from hrcplan.pddl.walks import functions_in
from hrcplan.plans import Plan
from hrcplan.task import Task
from hrcplan.validation import Report, validate

MEMORY_BYTES = 4 << 30
MOST_REPLAYS = 8
GROUNDING_S = 1.0
"""What grounding once for all planners may take, but never more than a tenth of the time."""


class Status(enum.Enum):
    """How a planner ended; the values are those of the JSON output."""

    OPTIMAL = "solved-optimally"
    SOLVED = "solved"
    UNSOLVABLE = "unsolvable"
    UNSOLVED = "unsolved"


@record
class Capabilities:
    """What a planner can do; ``auto`` chooses by it and ``hrcplan planners`` prints it.

    ``temporal``: plans with durations and concurrency. ``numeric``: numbers that actions change.
    ``metric``: which metrics its plans are good for: ``none``, ``cost``, ``cost+time``.
    ``proves``: it can prove optimality for that metric. ``limits``: it keeps the time limit by
    itself (hrcplan enforces it anyway). ``own``: it is a search of hrcplan's own, with exact
    numbers, so "unsolvable" is believed from it alone. ``constructs``: what it knows of
    `hrcplan.pddl.constructs`. ``needs``: what to install, in words.
    """

    name: str
    summary: str
    classical: bool = True
    temporal: bool = False
    numeric: bool = False
    metric: str = "cost"
    proves: bool = False
    limits: bool = False
    own: bool = False
    constructs: frozenset[str] = frozenset()
    needs: str = "nothing"
    licence: str = "Apache-2.0"


class LazyTask:
    """The task of a problem, grounded once for all planners that ask.

    Args:
        task: The task, if the problem is grounded already.
    """

    def __init__(self, task: Task | None = None) -> None:
        self._task = task
        self._has_begun = False
        self._failure: UnsupportedError | LimitError | None = None

    def begin(self, problem: Problem, deadline: float) -> bool:
        """Ground a problem if that can be done in time; else who needs it does it later.

        Return whether it is grounded. It is tried once.
        """
        if self._task is None and not self._has_begun:
            self._has_begun = True
            try:
                self._task = Task(problem, deadline)
            except UnsupportedError as error:
                self._failure = error
            except LimitError:
                return False
        return self._task is not None

    @property
    def is_ready(self) -> bool:
        """Whether the task is grounded already."""
        return self._task is not None

    def ground(self, problem: Problem, deadline: float) -> Task:
        """Return the task; what failed once is not tried again for the next planner.

        Raises:
            UnsupportedError: if bits cannot hold it.
            LimitError: if there are too many ground actions, or too little time.
        """
        if self._failure is not None:
            raise self._failure
        if self._task is None:
            try:
                self._task = Task(problem, deadline)
            except (UnsupportedError, LimitError) as error:
                self._failure = error
                raise
        return self._task


class Replays:
    """Replays of plans; the last ones are kept, since a planner and its check ask for the same."""

    def __init__(self) -> None:
        self._reports: dict[Plan, Report] = {}

    def __call__(self, problem: Problem, plan: Plan) -> Report:
        """Return the replay of a plan; the problem is always the same one."""
        if plan not in self._reports:
            while len(self._reports) >= MOST_REPLAYS:
                del self._reports[next(iter(self._reports))]
            self._reports[plan] = validate(problem, plan)
        return self._reports[plan]


def ignore_plan(plan: Plan) -> None:
    """Do nothing with a plan."""


@record
class Request:
    """One problem for one planner: until when, and whether the first plan is enough.

    ``improves`` asks for plans that get better until the deadline, where any plan is enough at
    first. ``on_plan`` is called with plans that a planner will improve, so that they are not lost
    if it is stopped. ``replays`` replays plans of the problem. ``n_threads`` is how many threads a
    planner may search with: with more than one, the clock decides which plan it has first.
    """

    problem: Problem
    deadline: float = field(default_factory=lambda: time.monotonic() + 60)
    any_plan: bool = False
    memory_bytes: int = MEMORY_BYTES
    lazy_task: LazyTask = field(default_factory=LazyTask, repr=False, compare=False)
    improves: bool = False
    n_threads: int = 1
    replays: Replays = field(default_factory=Replays, repr=False, compare=False)
    on_plan: Callable[[Plan], None] = field(default=ignore_plan, repr=False, compare=False)

    @property
    def time_left_s(self) -> float:
        """Seconds until the deadline; never below zero."""
        return max(0.0, self.deadline - time.monotonic())

    @property
    def task(self) -> Task:
        """The grounded task, made when it is first needed, in at most half of the time left.

        Raises:
            UnsupportedError: if bits cannot hold it.
            LimitError: if there are too many ground actions, or too little time.
        """
        return self.lazy_task.ground(self.problem, time.monotonic() + self.time_left_s / 2)

    def ground_quickly(self) -> bool:
        """Ground the task unless that takes long; return whether it is grounded."""
        time_s = min(GROUNDING_S, self.time_left_s / 10)
        return self.lazy_task.begin(self.problem, time.monotonic() + time_s)

    def until(self, deadline: float) -> Request:
        """Return the same request until another time; both share the grounded task."""
        return replace(self, deadline=deadline)

    @cached_property
    def weighs_time(self) -> bool:
        """Whether the metric looks at the makespan of a temporal plan.

        In a classical metric, ``total-time`` is the number of actions.
        """
        return self.problem.domain.is_temporal and any(
            f.name == TOTAL_TIME for f in functions_in(self.problem.metric)
        )


@record
class Answer:
    """What a planner said, unchecked: its claim, its plan, and the cost it reported, if any.

    ``objective`` is the planner's own figure for the plan, in units of the problem's metric (number
    of steps, or makespan of a temporal plan, where there is none); the cost guard compares it with
    hrcplan's. None if the planner reports none. ``bound`` is what no plan can be better than, in
    the same units, by a proof with exact numbers.
    """

    status: Status
    plan: Plan | None = None
    objective: Number | None = None
    note: str = ""
    bound: Number | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        """Hold status and plan together.

        Raises:
            ValueError: if there is a plan without a solved status, or the other way round.
        """
        has_plan = self.status in (Status.OPTIMAL, Status.SOLVED)
        if has_plan != (self.plan is not None):
            raise ValueError(f"{self.status} with plan {self.plan!r}")


@runtime_checkable
class Planner(Protocol):
    """Anything that solves a request.

    ``solve`` returns an Answer for whatever can happen to a search (solved, unsolvable, out of
    time). It raises UnsupportedError for a task outside its card, MissingPlannerError if a program
    or package is not there, PlannerError if the program crashes.
    """

    @property
    def card(self) -> Capabilities:
        """What this planner can do."""

    def missing(self) -> str | None:
        """Return why the planner cannot run here and what to install; None if it can."""

    def solve(self, request: Request) -> Answer:
        """Return the planner's answer, at the latest shortly after the deadline."""


class OwnPlanner:
    """A planner that is part of this package: nothing has to be installed for it."""

    def missing(self) -> str | None:
        """Return None: it can run everywhere."""
        return None
