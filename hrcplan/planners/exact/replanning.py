"""``exact`` for a task that goes on: what one plan took to find is kept for the next."""

from __future__ import annotations

from hrcplan.planners.answer import Answer, Request
from hrcplan.planners.exact.planner import Exact
from hrcplan.task import Task
from hrcplan.task.regrounding import regrounded

MAX_KEPT = 32


class Replanning:
    """``exact`` with groundings and state graphs kept between the requests of one running task.

    There is one for each choice of agent states that interactions could better: which they are
    decides what is possible; how bad they are decides costs only.
    """

    def __init__(self) -> None:
        self.card = Exact().card
        self._kept: list[tuple[Task, Exact]] = []

    def missing(self) -> str | None:
        """Return None: it is part of this package."""
        return None

    def solve(self, request: Request) -> Answer:
        """Return the answer of ``exact``.

        Raises:
            UnsupportedError: if the task is outside its class.
            LimitError: if there are too many ground actions.
        """
        task, planner = self._find(request)
        return planner.replan(task, request.deadline, any_plan=request.any_plan)

    def _find(self, request: Request) -> tuple[Task, Exact]:
        for kept, planner in self._kept:
            task = regrounded(kept, request.problem)
            if task is not None:
                return task, planner
        found = request.task, Exact()
        # The smallest that holds the problem is the quickest.
        self._kept = sorted([*self._kept[-MAX_KEPT:], found], key=lambda k: len(k[0].actions))
        return found
