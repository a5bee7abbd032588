"""The outcome of a run: how it ended, what was counted, and measures in percent.

The percentages are those of Table I of the failure-anticipation paper: means over runs of each
run's own percentage. "Assigned" counts all actions of all plans of a run, also of replans. With
this reading, rows 1a and 2a of that table come out to the last digit (see the tests).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from hrcplan.core.means import mean_and_error
from hrcplan.execution import events as ev
from hrcplan.execution.run import Run

MEASURES = (
    "success_pct", "replans", "failed_pct", "assigned_human_pct", "assigned_robot_pct",
    "successful_human_pct", "successful_robot_pct", "makespan_s", "interactions",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Outcome:
    """What one run came to.

    Humans are all agents that take no commands; actions without an agent count for the robot.
    ``executed`` counts actions that succeeded. ``makespan_s`` is the end of the last action.
    """

    success: bool
    ending: str
    replans_change: int = 0
    replans_failure: int = 0
    replans_deviation: int = 0
    plans_confirmed: int = 0
    assigned_human: int = 0
    assigned_robot: int = 0
    executed_human: int = 0
    executed_robot: int = 0
    failed_human: int = 0
    failed_robot: int = 0
    cancelled_human: int = 0
    cancelled_robot: int = 0
    interactions: int = 0
    makespan_s: float = 0.0

    @property
    def replans(self) -> int:
        """All replans, for whatever reason."""
        return self.replans_change + self.replans_failure + self.replans_deviation

    def measures(self) -> dict[str, float]:
        """Return the measures of this run, percentages in [0, 100]; 0 where nothing was done.

        >>> outcome = Outcome(True, "goal reached", executed_human=1, executed_robot=3)
        >>> outcome.measures()["failed_pct"]
        0.0
        """
        n_executed = self.executed_human + self.executed_robot
        n_failed = self.failed_human + self.failed_robot
        n_assigned = self.assigned_human + self.assigned_robot
        return dict(zip(MEASURES, (
            100.0 * self.success,
            float(self.replans),
            _percent(n_failed, n_failed + n_executed),
            _percent(self.assigned_human, n_assigned),
            _percent(self.assigned_robot, n_assigned),
            _percent(self.executed_human, n_executed),
            _percent(self.executed_robot, n_executed),
            self.makespan_s,
            float(self.interactions),
        ), strict=True))  # fmt: skip

    def __repr__(self) -> str:
        n_done = self.executed_human + self.executed_robot
        n_failed = self.failed_human + self.failed_robot
        actions = f"{n_done} actions done, {n_failed} failed"
        return f"Outcome({self.ending}, {self.makespan_s:g} s, {self.replans} replans, {actions})"

    def to_json(self) -> dict[str, Any]:
        """Return the outcome as a JSON object; its keys are the fields."""
        return asdict(self)


def outcome_of(run: Run, robots: frozenset[str]) -> Outcome:
    """Return the outcome of a run; of an unfinished one so far."""
    counts = run.counts

    def split(by_agent: Mapping[str, int]) -> tuple[int, int]:
        robot = sum(n for agent, n in by_agent.items() if agent in robots or not agent)
        return sum(by_agent.values()) - robot, robot

    n_assigned, n_done = split(counts.assigned), split(counts.done)
    n_failed, n_cancelled = split(counts.failed), split(counts.cancelled)
    return Outcome(
        success=run.ending == ev.GOAL,
        ending=run.ending or "unfinished",
        replans_change=counts.replans.get(ev.CHANGE, 0),
        replans_failure=counts.replans.get(ev.FAILURE, 0),
        replans_deviation=counts.replans.get(ev.DEVIATION, 0),
        plans_confirmed=counts.plans_confirmed,
        assigned_human=n_assigned[0], assigned_robot=n_assigned[1],
        executed_human=n_done[0], executed_robot=n_done[1],
        failed_human=n_failed[0], failed_robot=n_failed[1],
        cancelled_human=n_cancelled[0], cancelled_robot=n_cancelled[1],
        interactions=counts.interactions,
        makespan_s=round(counts.last_end_s, 6),
    )  # fmt: skip


def means(rows: Sequence[Outcome]) -> dict[str, tuple[float, float]]:
    """Return mean and standard error of every measure over runs; (0, 0) without runs."""
    tables = [row.measures() for row in rows]
    return {name: mean_and_error([table[name] for table in tables]) for name in MEASURES}


def _percent(part: int, whole: int) -> float:
    return 100.0 * part / whole if whole else 0.0
