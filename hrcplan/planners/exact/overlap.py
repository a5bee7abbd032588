"""No overlap of two actions may be required, or hidden from the sequential reading."""

from __future__ import annotations

from math import inf

from hrcplan.core.bits import holders, positions, union
from hrcplan.core.clock import check_time
from hrcplan.errors import UnsupportedError
from hrcplan.pddl.model import fact_text
from hrcplan.planners.exact.frame import HINT, StaticMasks
from hrcplan.search.reachable_pairs import ReachablePairs
from hrcplan.task import Task


def check_overlap(
    task: Task, pairs: ReachablePairs, frame: StaticMasks, deadline: float = inf
) -> None:
    """Raise unless no overlap of two actions is required, or hidden from the sequential reading.

    Raises:
        UnsupportedError: naming two actions that can overlap, and what is wrong with that.
        LimitError: at the deadline.
    """
    adders = holders(frame.adds, frame.n_facts)
    shunners = holders(frame.over_shuns, frame.n_facts)
    lanes = lane_members(frame)
    _check_late(task, pairs, frame)
    for late, agent in enumerate(frame.agents):
        check_time(deadline, "while comparing actions in pairs")
        running = pairs.running_at_start(late)
        change = frame.deletes[late] | frame.shuns[late]
        hiding = union(adders[p] for p in positions(change)) & running
        blocked_by_end = union(shunners[p] for p in positions(frame.adds[late])) & running
        for pairs_of_actions, why in (
            (lanes[agent] & running, f"both need {agent} throughout"),
            (hiding, "{fact} depends on which of them ends first"),
            (blocked_by_end, "{fact} depends on which of them ends first"),
        ):
            if pairs_of_actions:
                early = next(positions(pairs_of_actions))
                mine = frame.adds[early] & change or frame.adds[late] & frame.over_shuns[early]
                fact = next((fact_text(task.facts[p]) for p in positions(mine)), "")
                raise UnsupportedError(
                    f"{task.actions[late]} can start while {task.actions[early]} runs, but "
                    + why.format(fact=fact), hint=HINT,
                )  # fmt: skip


def _check_late(task: Task, pairs: ReachablePairs, frame: StaticMasks) -> None:
    """Raise unless no action reads until then what is deleted at an end."""
    users = holders([_facts_of(frame, a) for a in range(len(frame.ticks))], frame.n_facts)
    for action, late in enumerate(frame.late):
        for fact in positions(late):
            readers = users[fact] & pairs.running_beside(action)
            if readers:
                other = task.actions[next(positions(readers))]
                raise UnsupportedError(
                    f"{task.actions[action]} deletes {fact_text(task.facts[fact])} at its end, and "
                    f"{other}, which looks at it, can overlap it", hint=HINT,
                )  # fmt: skip


def _facts_of(frame: StaticMasks, action: int) -> int:
    tests = union(mask for mask, _ in (*frame.tests[action], *frame.over[action]))
    return tests | frame.deletes[action] | frame.adds[action]


def lane_members(frame: StaticMasks) -> dict[str, int]:
    """Return for each agent the actions in its lane, as bits."""
    members: dict[str, int] = {}
    for i, agent in enumerate(frame.agents):
        members[agent] = members.get(agent, 0) | 1 << i
    return members


def lanes_of(task: Task, pairs: ReachablePairs, frame: StaticMasks) -> tuple[tuple[str, ...], ...]:
    """Return which agents each action keeps busy: its own, and those it shares with no other.

    Two actions that keep the same agent busy never overlap, so that the durations of all actions
    that keep an agent busy add up to the makespan at most.
    """
    agents = set(frame.agents)
    users = {agent: union(1 << a.index for a in task.actions if agent in a.args)
             for agent in agents}  # fmt: skip
    return tuple(
        tuple(
            agent for agent in dict.fromkeys(action.args)
            if agent == action.agent
            or (agent in agents and not pairs.running_beside(action.index) & users[agent])
        )
        for action in task.actions
    )  # fmt: skip
