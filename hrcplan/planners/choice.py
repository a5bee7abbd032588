"""Which planners can hold a task, and in which order they are asked."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from hrcplan.errors import MissingPlannerError, UnsupportedError, UsageError
from hrcplan.pddl.constructs import PREFERENCES
from hrcplan.pddl.inlining import remaining
from hrcplan.pddl.model import TOTAL_COST, Problem
from hrcplan.planners import registry
from hrcplan.planners.contract import Capabilities, Planner, Request

_SEQUENCES = ("fast-downward", "enhsp")
"""Planners that read a temporal task as a sequence of actions, and that search in two ways: for a
proof, and for plans without one."""

# Built-in jobs, the most promising first; True stands for the search without a proof.
_ANY = (
    ("kairos", True),
    ("fast-downward", True),
    ("enhsp", True),
    ("exact", True),
    ("uniform-cost", True),
)
_BEST = (
    ("exact", False),
    ("fast-downward", False),
    ("kairos", False),
    ("fast-downward", True),
    ("uniform-cost", False),
    ("enhsp", True),
    ("enhsp", False),
)


@dataclass(frozen=True)
class Job:
    """One planner to be asked: for its first plan, or for the best one; and why it is asked.

    ``finds_plans`` is False where only a bound, or a proof that there is no plan, can come of it.
    """

    planner: Planner
    any_plan: bool
    why: str
    finds_plans: bool = True

    @property
    def name(self) -> str:
        """The planner's name."""
        return self.planner.card.name


def jobs(request: Request) -> Iterator[Job]:
    """Yield what to ask for a request, the most promising jobs first.

    The first planner often solves the task, so the others are imported after it was taken.

    Raises:
        UnsupportedError: if no planner here can hold the task.
    """
    first = _first_jobs(request)
    yield from first
    yield from all_jobs(request)[len(first) :]


def _first_jobs(request: Request) -> list[Job]:
    """Return the jobs of the planner that stands first in the table, if it can hold a request."""
    name, any_plan = (_ANY if request.any_plan else _BEST)[0]
    jobs = [
        Job(variant, any_plan, _merit(planner.card, request, any_plan))
        for planner in _load(name)
        if unable(planner.card, request) is None and planner.missing() is None
        for variant in _variants(planner, request)
    ]
    return [job for job in jobs if _rank(job, request) == (False, 0)]


def all_jobs(request: Request) -> list[Job]:
    """Return all jobs for a request, the most promising first.

    Raises:
        UnsupportedError: if no planner here can hold the task.
    """
    from hrcplan.planners.relaxed_bound import RelaxedBound

    planners = [planner for name in registry.names() for planner in _load(name)]
    able = [p for p in planners if unable(p.card, request) is None and p.missing() is None]
    if not able:
        raise UnsupportedError("no planner here can hold this task")
    able = [variant for planner in able for variant in _variants(planner, request)]
    candidates = [Job(p, any_plan, _merit(p.card, request, any_plan))
             for p in able for any_plan in _modes(p.card, request)]  # fmt: skip
    candidates.sort(key=lambda job: _rank(job, request))
    bound = RelaxedBound()
    if unable(bound.card, request) is None:
        place = len(candidates) if request.any_plan else min(2, len(candidates))
        candidates.insert(place, Job(bound, False, "it bounds the metric", finds_plans=False))
    return candidates


def fixed_order(problem: Problem) -> tuple[str, ...]:
    """Return the built-in planners in the order in which they are asked one after the other.

    Planners that read a temporal task as a sequence of actions come last there.

    >>> from hrcplan.pddl.inputs import read
    >>> fixed_order(read("transport", "two-boxes"))[:2]
    ('exact', 'kairos')
    """
    names = dict.fromkeys(name for name, _ in _BEST)
    temporal = problem.domain.is_temporal
    return tuple(sorted(names, key=lambda name: temporal and name in _SEQUENCES))


def _variants(planner: Planner, request: Request) -> Sequence[Planner]:
    """Return a planner, or the forms of it that are good at different tasks."""
    if not (request.any_plan and request.problem.domain.is_temporal):
        return (planner,)
    from hrcplan.planners.kairos import LAST_PRESET, QUICK_PRESETS, Kairos

    if isinstance(planner, Kairos):
        return Kairos((LAST_PRESET,)), Kairos(QUICK_PRESETS)
    return (planner,)


def _modes(card: Capabilities, request: Request) -> tuple[bool, ...]:
    """Return in which ways to ask a planner: for any plan (True), for the best one (False)."""
    if request.any_plan:
        return (True,)
    return (False, True) if card.name in _SEQUENCES else (False,)


def _load(name: str) -> Iterator[Planner]:
    """Yield the planner of a name, unless its package is broken: ``auto`` goes on without it."""
    try:
        yield registry.make(name)
    except (MissingPlannerError, UsageError):
        return


def unable(card: Capabilities, request: Request) -> str | None:
    """Return why a planner cannot hold a request, by its card; None if it may."""
    domain = request.problem.domain
    if domain.is_temporal and not card.temporal and card.name not in _SEQUENCES:
        return "it plans without time"
    if not domain.is_temporal and not card.classical:
        return "it plans with time only"
    beyond = sorted(remaining(request.problem) - card.constructs)
    if beyond == [PREFERENCES]:
        from hrcplan.planners.soft_goals import without_preferences

        beyond = [] if without_preferences(request.problem) else beyond
    if beyond:
        return f"it does not know {' and '.join(beyond)}"
    if not card.numeric and _is_numeric(request):
        return "it holds no numbers that actions change"
    return None


def _is_numeric(request: Request) -> bool:
    """Return whether actions change numbers that bits do not hold, or not without a long wait."""
    if request.problem.domain.changed_functions <= {TOTAL_COST}:
        return False
    return not request.ground_quickly()


def _rank(job: Job, request: Request) -> tuple[bool, float]:
    """Return a sort key for jobs: built-in ones by the table, others by what they can prove."""
    card, order = job.planner.card, _ANY if request.any_plan else _BEST
    temporal = request.problem.domain.is_temporal
    sequences = temporal and not card.temporal and not request.any_plan
    late = card.own and card.numeric and _is_numeric(request)  # it has no heuristic
    key = (card.name, job.any_plan)
    if key in order:
        return (sequences or late, order.index(key))
    return (sequences or late, 0.5 if proves(card, request) else len(order))


def proves(card: Capabilities, request: Request) -> bool:
    """Return whether a planner can prove optimality for the metric of a request."""
    if request.problem.domain.is_temporal and not card.temporal:
        return False
    return card.proves and (card.metric == "cost+time" or not request.weighs_time)


def _merit(card: Capabilities, request: Request, any_plan: bool) -> str:
    if any_plan:
        return "any plan is enough" if request.any_plan else "it finds plans quickly"
    if proves(card, request):
        return f"it proves optimality for {card.metric}"
    return "it can hold this task but proves nothing"
