"""Which actions can run at the same time: reachable pairs of facts and "A is running".

This is the h^2 reading of a temporal task (Haslum and Geffner, AIPS 2000): a start makes its
action running, an end stops that and adds facts; an event can happen if every pair of its
conditions is reachable. It errs only towards more overlap.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from hrcplan.core.bits import holders, positions, union
from hrcplan.core.clock import check_time


@dataclass(frozen=True)
class DurativeMasks:
    """Facts as bits, one entry per durative action.

    ``needs`` are facts that must hold in every alternative of an action's conditions, ``avoids``
    facts that must be false in all, ``over_needs`` those that must hold throughout. ``deletes`` are
    deleted at either end, ``late`` of them at the end; ``adds`` are added at the end.
    """

    n_facts: int
    needs: tuple[int, ...]
    avoids: tuple[int, ...]
    over_needs: tuple[int, ...]
    deletes: tuple[int, ...]
    late: tuple[int, ...]
    adds: tuple[int, ...]


class ReachablePairs:
    """Reachable pairs over facts and running actions, from any number of initial states.

    Positions below ``n_facts`` are facts; action ``a`` running is at ``n_facts + a``.

    Args:
        masks: The conditions and effects of the actions.
    """

    def __init__(self, masks: DurativeMasks) -> None:
        self.masks = masks
        self._shift = masks.n_facts
        n_actions = len(masks.adds)
        self._with = [0] * (masks.n_facts + n_actions)
        self._possible_facts = 0
        self._contexts = [0] * (2 * n_actions)
        deleters = holders(masks.over_needs, masks.n_facts)
        self._stops = [union(deleters[p] for p in positions(d & ~late)) << self._shift
                       for d, late in zip(masks.deletes, masks.late, strict=True)]  # fmt: skip

    def admit(self, initial: int, deadline: float = inf) -> None:
        """Take in an initial state and all that can follow it.

        Raises:
            LimitError: at the deadline, by ``time.monotonic()``; the next call goes on from there.
        """
        self._possible_facts |= initial
        for position in positions(initial):
            self._with[position] |= initial
        grows = True
        while grows:
            grows = False
            for action in range(len(self.masks.adds)):
                check_time(deadline, "while looking for actions that can overlap")
                grows |= self._start(action) | self._end(action)

    def running_at_start(self, action: int) -> int:
        """Return, as bits, the actions that can run when ``action`` starts."""
        return self._contexts[2 * action] >> self._shift

    def running_beside(self, action: int) -> int:
        """Return, as bits, the other actions that can ever run together with ``action``."""
        return self._with[self._shift + action] >> self._shift & ~(1 << action)

    def _start(self, action: int) -> bool:
        masks = self.masks
        context = self._possible_facts
        needs = masks.needs[action]
        for position in positions(needs):
            context &= self._with[position]
        if needs & ~context:
            return False
        start_deletes = masks.deletes[action] & ~masks.late[action]
        context &= ~(masks.avoids[action] | start_deletes | self._stops[action])
        return self._happen(2 * action, context, 1 << self._shift + action)

    def _end(self, action: int) -> bool:
        running = 1 << self._shift + action
        context = self._with[self._shift + action] & ~running
        if not self._possible_facts & running:
            return False
        return self._happen(2 * action + 1, context, self.masks.adds[action])

    def _happen(self, event: int, context: int, adds: int) -> bool:
        """Note that all of ``adds`` can hold with each other and with all of ``context``."""
        if adds & ~self._possible_facts == 0 and context & ~self._contexts[event] == 0:
            return False
        new = context & ~self._contexts[event]
        self._contexts[event] |= context
        self._possible_facts |= adds
        for position in positions(adds):
            self._with[position] |= context | adds
        for position in positions(new):
            self._with[position] |= adds
        return True
