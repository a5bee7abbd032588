"""Timed initial literals during a run: which are to come, and which conditions look at them."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import replace

from hrcplan.core.numbers import exact
from hrcplan.execution.action_model import ActionModel, BoundAction
from hrcplan.pddl.interference import Access
from hrcplan.pddl.model import Action, Formula, Problem, TimedChange
from hrcplan.pddl.semantics import LiftedState
from hrcplan.pddl.walks import functions_in, lifted_names
from hrcplan.plans import EPSILON_S


class TimedEvents:
    """The timed initial literals of a problem, in order of time; ``problem`` is that of the run."""

    def __init__(self, problem: Problem) -> None:
        self.literals = problem.timed
        self._times = [float(change.time) for change in problem.timed]
        names = {change.key[0] for change in problem.timed}
        sources = problem.domain.sources.items()
        self._names = names.union(name for name, below in sources if not names.isdisjoint(below))

    def n_past(self, t: float) -> int:
        """Return how many of them are past at a time."""
        return bisect_right(self._times, t)

    def coming(self, n_happened: int, t: float) -> tuple[TimedChange, ...]:
        """Return those that have not happened, with the time that is left until they do."""
        now = exact(repr(t))
        return tuple(
            replace(change, time=max(EPSILON_S, change.time - now))
            for change in self.literals[n_happened:]
        )

    def touch(self, formula: Formula) -> bool:
        """Return whether a condition looks at what they change, or at what follows from it."""
        return not self._names.isdisjoint(lifted_names(formula))

    def obstacle_at_end(
        self, actions: ActionModel, state: LiftedState, step: BoundAction
    ) -> str | None:
        """Return the condition at an action's end that they have made false, as ground PDDL."""
        exposed = any(c.when == "end" and self.touch(c.formula) for c in step.schema.conditions)
        return actions.unmet_phase(state, step, "end") if exposed else None

    def touch_duration(self, action: Action) -> bool:
        """Return whether the duration of an action depends on something that they change."""
        functions = (f for _, expression in action.durations for f in functions_in(expression))
        return any(function.name in self._names for function in functions)


def change_access(change: TimedChange) -> Access:
    """Return what a timed initial literal writes."""
    key, none = frozenset({change.key}), frozenset[tuple[str, ...]]()
    if change.value is not None:
        return Access(none, none, none, none, none, key)
    return Access(none, key if change.positive else none, none if change.positive else key,
                  none, none, none)  # fmt: skip
