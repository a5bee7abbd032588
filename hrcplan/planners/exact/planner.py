"""``exact`` as a planner: from a request to a proven plan, or to the reason why there is none."""

from __future__ import annotations

import time

from hrcplan.errors import LimitError, UnsupportedError
from hrcplan.planners.contract import Answer, Capabilities, Request, Status
from hrcplan.planners.exact.memory import TaskMemories
from hrcplan.planners.exact.proof import Proof, Wish
from hrcplan.planners.exact.weights import metric
from hrcplan.task import Task


class ExactPlanner:
    """Proves weighted metrics of cost and time in tasks where no concurrency is required.

    It keeps what does not depend on costs of the last structures it saw: hold on to one object and
    give it ``task.with_values(...)`` to replan in milliseconds.

    >>> from hrcplan import ground
    >>> task, planner = ground("transport", "two-boxes"), ExactPlanner()
    >>> len(planner.replan(task).plan.actions)
    8
    >>> tired = task.with_values({("motivation", "human"): 10})
    >>> {action.args[0] for action in planner.replan(tired).plan.actions}
    {'robot'}
    """

    def __init__(self) -> None:
        self.card = Capabilities(
            "exact",
            "A* over schedules of any number of agents: proves weighted metrics of cost and time",
            classical=False,
            temporal=True,
            metric="cost+time",
            proves=True,
            limits=True,
            own=True,
        )
        self._memories = TaskMemories()

    def missing(self) -> str | None:
        """Return None: it is part of this package."""
        return None

    def solve(self, request: Request) -> Answer:
        """Return a proven plan, a proof that there is none, or what was not enough for one.

        Raises:
            UnsupportedError: if the task is outside the class that ``frame.py`` describes.
            LimitError: if the task cannot be grounded within the limits.
        """
        wish = Wish(
            request.deadline, request.any_plan, request.improves, request.on_plan,
            request.memory_bytes // 2,  # the process itself takes some
        )  # fmt: skip
        return self._answer(request.task, wish)

    def replan(
        self, task: Task, deadline: float | None = None, *, any_plan: bool = False
    ) -> Answer:
        """Return the answer for a task; quick if its grounding is that of the call before.

        Args:
            task: The task, with the costs and the initial state of now.
            deadline: When to give up, by ``time.monotonic()``; a minute from now by default.
            any_plan: A plan that is found sooner, without a proof, is enough.

        Raises:
            UnsupportedError: if the task is outside the class that ``frame.py`` describes.
        """
        until = time.monotonic() + 60 if deadline is None else deadline
        return self._answer(task, Wish(until, any_plan))

    def _answer(self, task: Task, wish: Wish) -> Answer:
        try:
            objective = metric(task.problem)
            memory = self._memories.of(task, wish.deadline)
            memory.admit(task, wish.deadline)
            return Proof(task, memory, objective, wish).answer()
        except UnsupportedError as error:
            raise UnsupportedError(f"exact declines: {error.message}", hint=error.hint) from None
        except LimitError as error:
            return Answer(Status.UNSOLVED, note=error.message)
