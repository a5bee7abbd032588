"""What a replay of a plan finds, and the number that planners minimize."""

from __future__ import annotations

from hrcplan.core.numbers import Number, number_text
from hrcplan.core.records import record
from hrcplan.core.text import cut
from hrcplan.pddl.model import Fact, Problem


@record
class Report:
    """What a replay found.

    ``failed_step`` counts actions from 0 in order of start time, ties in file order; it is None
    if the plan is valid or only the goal is missed. ``cost``, ``metric`` (None if the problem
    has none) and ``makespan_s`` are None unless the plan is valid. ``state`` is the state at the
    end, or where the replay broke off. ``gap_s`` is the gap that was too small, above zero, if that
    was the only fault until then.
    """

    valid: bool
    cost: Number | None = None
    makespan_s: Number | None = None
    metric: Number | None = None
    failed_step: int | None = None
    reason: str | None = None
    state: frozenset[Fact] = frozenset()
    step_costs: tuple[Number, ...] = ()
    gap_s: Number | None = None

    def __repr__(self) -> str:
        if not self.valid:
            step = "" if self.failed_step is None else f" at step {self.failed_step}"
            return cut(f"<Report: invalid{step}: {self.reason}", 190) + ">"
        figures = {"cost": self.cost, "metric": self.metric, "makespan_s": self.makespan_s}
        words = [f"{name} {number_text(n)}" for name, n in figures.items() if n is not None]
        return cut(f"<Report: {', '.join(['valid', *words])}", 190) + ">"


def objective(problem: Problem, report: Report) -> Number | None:
    """Return what planners minimize: the metric, else the makespan if temporal, else the cost."""
    if problem.metric is not None:
        return report.metric
    return report.makespan_s if problem.domain.is_temporal else report.cost
