"""A plan to begin with: greedy search in the sequential reading, its actions started early.

Every schedule has a sequential reading. So there is no plan at all if this search finds none, and
it looks at far fewer states than there are schedules.
"""

from __future__ import annotations

from heapq import heappop, heappush

from hrcplan.errors import LimitError
from hrcplan.planners.exact.clock import check_time
from hrcplan.planners.exact.estimates import Estimates
from hrcplan.planners.exact.frame import RunningActions, StaticMasks
from hrcplan.planners.exact.graph import FAR, MAX_STATES, Graph
from hrcplan.planners.exact.search import WAIT, pass_time
from hrcplan.planners.exact.weights import Weights
from hrcplan.task import Task
from hrcplan.task.conditions import meets

MAX_REFINED = 2000
"""States that are looked at closely; from then on, what they inherit has to do."""
_GREED = 5


def first_path(
    task: Task, frame: StaticMasks, graph: Graph, weights: Weights, ahead: Estimates,
    deadline: float,
) -> str | None:  # fmt: skip
    """Return the path of some plan, or None if there is none.

    Raises:
        LimitError: at the deadline, or if there are too many states.
    """
    sequence = _sequence(task, graph, weights, ahead, deadline)
    return None if sequence is None else _started_early(task, frame, sequence)


def _sequence(
    task: Task, graph: Graph, weights: Weights, ahead: Estimates, deadline: float
) -> list[int] | None:
    """Return actions that lead to a goal one after the other."""
    start = graph.state(task.initial)
    best: dict[int, tuple[int, int, int]] = {start: (0, -1, -1)}
    queue = [(0, start, 0)]
    n_refined = 0
    while queue:
        check_time(deadline, f"after {len(best):,} states in sequence")
        _, state, price = heappop(queue)
        if best[state][0] != price:
            continue
        if task.is_goal(graph.states[state]):
            return _steps(best, state)
        if n_refined < MAX_REFINED:
            n_refined += ahead.refine(state)
        if ahead[state].work >= FAR:
            continue
        if len(graph.states) > MAX_STATES:
            raise LimitError(f"no plan within {MAX_STATES:,} states in sequence")
        edges = iter(graph.edges(task, state))
        for action, target in zip(edges, edges, strict=True):
            total = price + weights.work[action]
            if target in best and best[target][0] <= total:
                continue
            ahead.inherit(state, action, target)
            if ahead[target].work < FAR:
                best[target] = (total, state, action)
                heappush(queue, (total + _GREED * ahead[target].work, target, total))
    return None


def _steps(best: dict[int, tuple[int, int, int]], state: int) -> list[int]:
    steps: list[int] = []
    while best[state][2] >= 0:
        _, state, action = best[state]
        steps.append(action)
    return steps[::-1]


def _started_early(task: Task, frame: StaticMasks, sequence: list[int]) -> str:
    """Return the path that starts actions in this order, each as soon as it can."""
    path: list[str] = []
    facts = task.initial
    running: RunningActions = ()
    for action in sequence:
        while not can_start(frame, facts, running, action):
            _, facts, running = pass_time(frame, facts, running)
            path.append(WAIT)
        path.append(chr(action))
        facts &= ~frame.deletes[action]
        running = tuple(sorted((*running, (frame.ticks[action], action))))
    return "".join(path)


def can_start(frame: StaticMasks, facts: int, running: RunningActions, action: int) -> bool:
    """Return whether an action can start now, and disturbs none that runs."""
    after = facts & ~frame.deletes[action]
    return meets(facts, frame.tests[action]) and all(
        meets(after, frame.over[other]) for _, other in running if frame.over[other]
    )
