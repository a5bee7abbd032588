"""Plans for a running task: cached, in time, and from the next planner if one gives up."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from hrcplan.errors import HrcplanError
from hrcplan.execution import events as ev
from hrcplan.execution.acting import Acting
from hrcplan.pddl.model import Problem
from hrcplan.planners import registry
from hrcplan.planners.answer import Planner, Status
from hrcplan.planners.solve import Result, objective, solve
from hrcplan.task import Task

DEFAULT_TIMEOUT_S = 20.0
_Key = tuple[object, ...]


@dataclass
class Replanner:
    """Answers ``AskPlan``; equal questions are answered once.

    ``planners`` are asked in turn, each for at most half of the time left. What one of them says
    counts if it is a checked plan or a proof that there is none.
    """

    problem: Problem
    planners: Sequence[str | Planner] = ()
    timeout_s: float = DEFAULT_TIMEOUT_S
    n_asked: int = 0
    wall_s: list[float] = field(default_factory=list)
    _known: dict[_Key, ev.Planned] = field(default_factory=dict, repr=False)
    _task: Task | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        """Take the built-in planners where none is given."""
        self.planners = with_successors(self.planners)
        self._acting = Acting(self.problem)

    def answer(self, ask: ev.AskPlan) -> ev.Planned:
        """Return a checked plan for what was asked, or none with the reason."""
        values = tuple(sorted(ask.values.items()))
        key = (ask.facts, values, tuple(sorted(ask.numbers.items())))
        found = self._known.get(key)
        if found is None:
            begun = time.perf_counter()
            found = self._ask(ask)
            found = replace(found, wall_s=round(time.perf_counter() - begun, 6))
            self.n_asked += 1
            self.wall_s.append(found.wall_s)
            if found.plan is not None:
                self._known[key] = found
        return replace(found, t=ask.t)

    def _ask(self, ask: ev.AskPlan) -> ev.Planned:
        problem = self._from_now(ask)
        deadline = time.monotonic() + self.timeout_s
        failures: list[str] = []
        for position, planner in enumerate(self.planners):
            left_s = max(0.001, deadline - time.monotonic())
            share_s = left_s if position == len(self.planners) - 1 else left_s / 2
            result = self._try(planner, problem, share_s, failures)
            if result is None:
                continue
            note = "; ".join(failures)
            if result.plan is None:
                return ev.Planned(ask.t, None, None, result.planner, "the goal is unsolvable")
            assert result.report is not None
            return ev.Planned(ask.t, result.plan, objective(result.report), result.planner, note)
        return ev.Planned(ask.t, None, note="; ".join(failures))

    def _try(
        self, planner: str | Planner, problem: Problem, share_s: float, failures: list[str]
    ) -> Result | None:
        """Return a usable result, or None with one more failure noted."""
        name = planner if isinstance(planner, str) else planner.card.name
        try:
            result = solve(problem, planner, timeout_s=share_s, lanes=True)
        except HrcplanError as error:
            failures.append(f"{name}: {error.message}")
            return None
        except Exception as error:  # noqa: BLE001  a stranger's planner must not stop the robot
            failures.append(f"{name}: {type(error).__name__}: {error}")
            return None
        if result.status is Status.UNSOLVED:
            failures.append(f"{name}: no plan in time")
            return None
        return result

    def _from_now(self, ask: ev.AskPlan) -> Problem:
        state = self._acting.state(ask.facts, ask.numbers)
        values = {**self.problem.values, **ask.numbers, **ask.values}
        return replace(self.problem, facts=frozenset(state.facts), values=values)


def with_successors(planners: Sequence[str | Planner]) -> tuple[str | Planner, ...]:
    """Return planners with the built-in ones after them, each once; ``auto`` means ours first."""
    named = [p for p in planners if p != "auto"]
    return (*named, *(name for name in PREFERRED if name not in named))


PREFERRED = ("exact", *(name for name in registry.BUILT_IN if name != "exact"))
