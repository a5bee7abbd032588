"""A plan to begin with: greedy search in the sequential reading, its actions started early.

Every schedule has a sequential reading. So there is no plan at all if this search finds none, and
it looks at far fewer states than there are schedules.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from typing import NamedTuple

from hrcplan.core.clock import check_time
from hrcplan.errors import LimitError
from hrcplan.planners.exact.estimates import Estimates
from hrcplan.planners.exact.frame import RunningActions, StaticMasks
from hrcplan.planners.exact.graph import FAR, MAX_STATES, Graph
from hrcplan.planners.exact.search import WAIT, pass_time
from hrcplan.planners.exact.symmetry import Swap, representative
from hrcplan.planners.exact.weights import Weights
from hrcplan.task import Task
from hrcplan.task.conditions import meets

MAX_REFINED = 500
"""States that are looked at closely; from then on, what they inherit has to do."""
_GREED = 5


def first_path(
    task: Task, frame: StaticMasks, graph: Graph, weights: Weights, ahead: Estimates,
    swaps: Sequence[Swap], deadline: float,
) -> str | None:  # fmt: skip
    """Return the path of some plan, or None if there is none.

    Raises:
        LimitError: at the deadline, or if there are too many states.
    """
    search = _SequenceSearch(task, graph, weights, ahead, swaps, deadline)
    sequence = search.run()
    return None if sequence is None else _started_early(task, frame, sequence)


class _Step(NamedTuple):
    """The work up to a state, the action that leads to it, and the step before."""

    work: int
    action: int
    before: _Step | None


@dataclass
class _SequenceSearch:
    """Weighted A* over the states of the sequential reading.

    No state is expanded twice, nor an image of one.
    """

    task: Task
    graph: Graph
    weights: Weights
    ahead: Estimates
    swaps: Sequence[Swap]
    deadline: float

    def __post_init__(self) -> None:
        self._states: set[int] = set()
        self._images: set[int] = set()
        self._queue: list[tuple[int, int, int, _Step]] = []
        self._n_refined = 0

    def run(self) -> list[int] | None:
        """Return actions that lead to a goal one after the other; None if there are none."""
        self._push(self.graph.state(self.task.initial), _Step(0, -1, None))
        while self._queue:
            check_time(self.deadline, f"after {len(self._states):,} states in sequence")
            _, _, state, step = heappop(self._queue)
            if self.task.is_goal(self.graph.states[state]):
                return _actions(step)
            if len(self.graph.states) > MAX_STATES:
                raise LimitError(f"no plan within {MAX_STATES:,} states in sequence")
            self._expand(state, step)
        return None

    def _expand(self, state: int, step: _Step) -> None:
        if self._n_refined < MAX_REFINED:
            self._n_refined += self.ahead.refine(state)
        if self.ahead[state].work >= FAR:
            return
        edges = iter(self.graph.edges(self.task, state))
        for action, target in zip(edges, edges, strict=True):
            if target not in self._states:
                self.ahead.inherit(state, action, target)
                self._push(target, _Step(step.work + self.weights.work[action], action, step))

    def _push(self, state: int, step: _Step) -> None:
        """Put a state on the heap, unless it or an image of it was there before."""
        self._states.add(state)
        image, _ = representative(self.graph.states[state], (), self.swaps)
        ahead = self.ahead[state].work
        if ahead < FAR and image not in self._images:
            self._images.add(image)
            heappush(self._queue, (step.work + _GREED * ahead, -len(self._images), state, step))


def _actions(step: _Step) -> list[int]:
    actions: list[int] = []
    while step.before is not None:
        actions.append(step.action)
        step = step.before
    return actions[::-1]


def _started_early(task: Task, frame: StaticMasks, sequence: list[int]) -> str:
    """Return the path that starts actions in this order, each as soon as it can."""
    path: list[str] = []
    facts = task.initial
    running: RunningActions = ()
    for action in sequence:
        while not _can_start(frame, facts, running, action):
            _, facts, running = pass_time(frame, facts, running)
            path.append(WAIT)
        path.append(chr(action))
        facts &= ~frame.deletes[action]
        running = tuple(sorted((*running, (frame.ticks[action], action))))
    return "".join(path)


def _can_start(frame: StaticMasks, facts: int, running: RunningActions, action: int) -> bool:
    """Return whether an action can start now, and disturbs none that runs."""
    after = facts & ~frame.deletes[action]
    return meets(facts, frame.tests[action]) and all(
        meets(after, frame.over[other]) for _, other in running if frame.over[other]
    )
