"""Which actions can run at the same time: reachable pairs of facts and "A is running".

This is the h^2 reading of a temporal task (Haslum and Geffner, AIPS 2000): a start makes its
action running, an end stops that and adds facts; an event can happen if every pair of its
conditions is reachable. It errs only towards more overlap.
"""

from __future__ import annotations

from hrcplan.core.bits import holders, positions, union
from hrcplan.errors import UnsupportedError
from hrcplan.pddl.model import fact_text
from hrcplan.planners.exact.frame import HINT, StaticMasks
from hrcplan.task import Task


class Overlap:
    """Reachable pairs over facts and running actions, from any number of initial states.

    Positions below ``n_facts`` are facts; action ``a`` running is at ``n_facts + a``.
    """

    def __init__(self, frame: StaticMasks) -> None:
        self.frame = frame
        self._shift = frame.n_facts
        n_actions = len(frame.ticks)
        self._with = [0] * (frame.n_facts + n_actions)
        self._reached = 0
        self._seen = [0] * (2 * n_actions)
        deleters = holders(frame.over_needs, frame.n_facts)
        self._stops = [union(deleters[p] for p in positions(d & ~late)) << self._shift
                       for d, late in zip(frame.deletes, frame.late, strict=True)]  # fmt: skip

    def admit(self, initial: int) -> None:
        """Take in an initial state and all that can follow it."""
        self._reached |= initial
        for position in positions(initial):
            self._with[position] |= initial
        while sum(self._start(a) + self._end(a) for a in range(len(self.frame.ticks))):
            pass

    def running_at_start(self, action: int) -> int:
        """Return, as bits, the actions that can run when ``action`` starts."""
        return self._seen[2 * action] >> self._shift

    def running_beside(self, action: int) -> int:
        """Return, as bits, the other actions that can ever run together with ``action``."""
        return self._with[self._shift + action] >> self._shift & ~(1 << action)

    def _start(self, action: int) -> bool:
        frame = self.frame
        context = self._reached
        needs = frame.needs[action]
        for position in positions(needs):
            context &= self._with[position]
        if needs & ~context:
            return False
        gone = frame.deletes[action] & ~frame.late[action]
        context &= ~(frame.avoids[action] | gone | self._stops[action])
        return self._happen(2 * action, context, 1 << self._shift + action)

    def _end(self, action: int) -> bool:
        running = 1 << self._shift + action
        context = self._with[self._shift + action] & ~running
        if not self._reached & running:
            return False
        return self._happen(2 * action + 1, context, self.frame.adds[action])

    def _happen(self, event: int, context: int, adds: int) -> bool:
        """Note that all of ``adds`` can hold with each other and with all of ``context``."""
        if adds & ~self._reached == 0 and context & ~self._seen[event] == 0:
            return False
        new = context & ~self._seen[event]
        self._seen[event] |= context
        self._reached |= adds
        for position in positions(adds):
            self._with[position] |= context | adds
        for position in positions(new):
            self._with[position] |= adds
        return True


def check_overlap(task: Task, overlap: Overlap) -> None:
    """Raise unless no overlap of two actions is required, or hidden from the sequential reading.

    Raises:
        UnsupportedError: naming two actions that can overlap, and what is wrong with that.
    """
    frame = overlap.frame
    adders = holders(frame.adds, frame.n_facts)
    shunners = holders(frame.over_shuns, frame.n_facts)
    lanes = lane_members(frame)
    _check_late(task, overlap)
    for late, agent in enumerate(frame.agents):
        running = overlap.running_at_start(late)
        touched = frame.deletes[late] | frame.shuns[late]
        hiding = union(adders[p] for p in positions(touched)) & running
        hidden = union(shunners[p] for p in positions(frame.adds[late])) & running
        for found, why in (
            (lanes[agent] & running, f"both need {agent} throughout"),
            (hiding, "{fact} depends on which of them ends first"),
            (hidden, "{fact} depends on which of them ends first"),
        ):
            if found:
                early = next(positions(found))
                mine = frame.adds[early] & touched or frame.adds[late] & frame.over_shuns[early]
                fact = next((fact_text(task.facts[p]) for p in positions(mine)), "")
                raise UnsupportedError(
                    f"{task.actions[late]} can start while {task.actions[early]} runs, but "
                    + why.format(fact=fact), hint=HINT,
                )  # fmt: skip


def _check_late(task: Task, overlap: Overlap) -> None:
    """Raise unless what is deleted at an end is looked at by nobody until then."""
    frame = overlap.frame
    users = holders([_mentioned(frame, a) for a in range(len(frame.ticks))], frame.n_facts)
    for action, late in enumerate(frame.late):
        for fact in positions(late):
            found = users[fact] & overlap.running_beside(action)
            if found:
                other = task.actions[next(positions(found))]
                raise UnsupportedError(
                    f"{task.actions[action]} deletes {fact_text(task.facts[fact])} at its end, and "
                    f"{other}, which looks at it, can overlap it", hint=HINT,
                )  # fmt: skip


def _mentioned(frame: StaticMasks, action: int) -> int:
    tests = union(mask for mask, _ in (*frame.tests[action], *frame.over[action]))
    return tests | frame.deletes[action] | frame.adds[action]


def lane_members(frame: StaticMasks) -> dict[str, int]:
    """Return for each agent the actions in its lane, as bits."""
    found: dict[str, int] = {}
    for i, agent in enumerate(frame.agents):
        found[agent] = found.get(agent, 0) | 1 << i
    return found


def held(task: Task, overlap: Overlap) -> tuple[tuple[str, ...], ...]:
    """Return which agents each action keeps busy: its own, and those it shares with nobody.

    Two actions that keep the same agent busy never overlap, so that the durations of all actions
    that keep an agent busy add up to the makespan at most.
    """
    agents = set(overlap.frame.agents)
    named = {agent: union(1 << a.index for a in task.actions if agent in a.args)
             for agent in agents}  # fmt: skip
    return tuple(
        tuple(
            agent for agent in dict.fromkeys(action.args)
            if agent == action.agent
            or (agent in agents and not overlap.running_beside(action.index) & named[agent])
        )
        for action in task.actions
    )  # fmt: skip
