"""Plans for a running task: cached, in time, and from the next planner if one gives up."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace

from hrcplan.errors import HrcplanError, LimitError, UnsupportedError
from hrcplan.execution import events as ev
from hrcplan.execution.model import ExecutionModel
from hrcplan.pddl.model import Problem
from hrcplan.planners import registry
from hrcplan.planners.choice import fixed_order
from hrcplan.planners.contract import Planner, Status
from hrcplan.planners.result import is_better
from hrcplan.planners.solve import Result, solve
from hrcplan.task import Task
from hrcplan.task.regrounding import Groundings

DEFAULT_TIMEOUT_S = 20.0
COMPARISON = 0.1
"""The part of the time that each further planner gets for its first plan, once there is one."""
_Key = tuple[object, ...]


class Replanner:
    """Answers ``AskPlan``; equal questions are answered once.

    ``planners`` (names or objects; the built-in ones follow) are asked in turn, each for at most
    half of the time left. What one of them says counts if it is a checked plan or a proof that
    there is none. Unless a plan is proven, or of a planner that was named, the other planners are
    asked for their first one, and the best counts. Groundings are kept, so ``exact`` keeps what it
    knows of them. Interactions are priced with their retries.
    """

    def __init__(
        self, model: ExecutionModel, planners: Sequence[str | Planner] = (),
        timeout_s: float = DEFAULT_TIMEOUT_S,
    ) -> None:  # fmt: skip
        self.model = model
        self.timeout_s = timeout_s
        self.planners = list(with_successors(planners, model.problem))
        self._n_chosen = sum(planner != "auto" for planner in planners)
        self.wall_s: list[float] = []
        self._groundings = Groundings()
        self._answers: dict[_Key, ev.Planned] = {}

    @property
    def n_asked(self) -> int:
        """How often planners were asked, not counting questions that were known."""
        return len(self.wall_s)

    def answer(self, ask: ev.AskPlan) -> ev.Planned:
        """Return a checked plan for what was asked, or none with the reason."""
        values = tuple(sorted(ask.values.items()))
        coming = self.model.timed.coming(ask.n_happened, ask.t)
        key = (ask.facts, ask.absent, values, tuple(sorted(ask.numbers.items())), coming)
        answer = self._answers.get(key)
        if answer is None:
            begin = time.perf_counter()
            answer = self._ask(ask)
            answer = replace(answer, wall_s=round(time.perf_counter() - begin, 6))
            self.wall_s.append(answer.wall_s)
            if answer.plan is not None:
                self._answers[key] = answer
        return replace(answer, t=ask.t)

    def _ask(self, ask: ev.AskPlan) -> ev.Planned:
        deadline = time.monotonic() + self.timeout_s
        problem, task = self._from_now(ask)
        failures: list[str] = []
        best: Result | None = None
        note = ""
        for position in range(len(self.planners)):
            left_s = max(0.001, deadline - time.monotonic())
            share_s = left_s if position == len(self.planners) - 1 else left_s / 2
            if best is not None:
                share_s = min(share_s, COMPARISON * self.timeout_s)
            result = self._try(position, problem, task, share_s, best is not None, failures)
            if result is None or (result.plan is None and best is not None):
                continue
            if result.plan is None:
                return ev.Planned(ask.t, None, None, result.planner, "the goal is unsolvable")
            if best is None:
                note = "; ".join(failures)
            if best is None or is_better(problem, result.objective, best.objective):
                best = result
            if best.status is Status.OPTIMAL or position < self._n_chosen:
                break
        if best is None:
            return ev.Planned(ask.t, None, note="; ".join(failures))
        return ev.Planned(ask.t, best.plan, best.objective, best.planner, note)

    def _try(
        self, position: int, problem: Problem, task: Task | None, share_s: float,
        any_plan: bool, failures: list[str],
    ) -> Result | None:  # fmt: skip
        """Return a usable result, or None with one more failure noted."""
        planner = self.planners[position]
        name = planner if isinstance(planner, str) else planner.card.name
        try:
            if isinstance(planner, str):
                planner = self.planners[position] = registry.make(planner)
            result = solve(
                problem, planner, timeout_s=share_s, any_plan=any_plan, lanes=True, task=task
            )
        except HrcplanError as error:
            failures.append(f"{name}: {error.message}")
            return None
        except Exception as error:  # noqa: BLE001  a user's planner must not stop the robot
            failures.append(f"{name}: {type(error).__name__}: {error}")
            return None
        if result.status is Status.UNSOLVED:
            failures.append(f"{name}: no plan in time")
            return None
        return result

    def _from_now(self, ask: ev.AskPlan) -> tuple[Problem, Task | None]:
        """Return the problem from here on, and its grounding if bits can hold it."""
        state = self.model.actions.state(ask.facts, ask.numbers, ask.absent)
        values = {**ask.numbers, **ask.values}
        problem_with_prices = self.model.priced_problem.with_values(values)
        coming = self.model.timed.coming(ask.n_happened, ask.t)
        problem = replace(problem_with_prices, facts=frozenset(state.facts), timed=coming)
        try:
            return problem, self._groundings.task(problem)
        except (UnsupportedError, LimitError):
            return problem, None


def with_successors(
    planners: Sequence[str | Planner], problem: Problem
) -> tuple[str | Planner, ...]:
    """Return planners with the built-in ones after them, each once; ``auto`` means these alone.

    The order is fixed, whatever the clock says, so that runs can be repeated.
    """
    own = [p for p in planners if p != "auto"]
    return (*own, *(name for name in fixed_order(problem) if name not in own))
