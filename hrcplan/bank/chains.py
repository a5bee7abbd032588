"""Partial orders as chains and cliques (Hayes and Scassellati, ICRA 2016).

A set of steps whose parts have nothing to do with each other is a clique of these parts; one whose
parts follow on each other is a chain of them. What is neither contains an N (a before c, b before
c and d), and no chains and cliques have just its orders; then order constraints are added:

    The set is cut into two parts, of which the first holds whatever comes before its steps. All of
    the first part comes before all of the second. Of all such cuts the one is taken that orders the
    fewest pairs of steps which were free; among equals the one with the smallest first part, and
    then the one whose first part has the smaller step numbers.

Sets are bits of integers; which step a bit is, says a `Layout`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import comb

from hrcplan.core.bits import positions

NEVER_CUT = 1 << 30  # more than there are pairs of steps


@dataclass(frozen=True, slots=True)
class Leaf:
    """One step; ``mask`` is its bit."""

    step: int
    mask: int


@dataclass(frozen=True, slots=True)
class Chain:
    """Children in this order.

    ``mask`` holds the bits of all steps below; ``added`` are pairs of steps of different children
    that are in this order here, but not in all plans.
    """

    children: tuple[OrderNode, ...]
    mask: int
    added: tuple[tuple[int, int], ...] = ()


@dataclass(frozen=True, slots=True)
class Clique:
    """Children in any order, which may be interleaved; ``added`` is empty: it orders nothing."""

    children: tuple[OrderNode, ...]
    mask: int
    added: tuple[tuple[int, int], ...] = ()


OrderNode = Leaf | Chain | Clique


def n_orders(node: OrderNode) -> int:
    """Return in how many orders the steps below a node can be done.

    >>> a, b, c = (Leaf(i, 1 << i) for i in range(3))
    >>> n_orders(Clique((Chain((a, b), 3), c), 7))
    3
    """
    if isinstance(node, Leaf):
        return 1
    n, size = 1, 0
    for child in node.children:
        n *= n_orders(child)
        size += child.mask.bit_count()
        if isinstance(node, Clique):
            n *= comb(size, child.mask.bit_count())
    return n


def n_added(node: OrderNode) -> int:
    """Return how many order constraints were added at a node and below it."""
    if isinstance(node, Leaf):
        return 0
    return len(node.added) + sum(map(n_added, node.children))


def chains_and_cliques(mask: int, before: Mapping[int, int], steps: Sequence[int]) -> OrderNode:
    """Return a partial order as chains and cliques.

    Args:
        mask: The steps, as bits.
        before: For each position of a bit of ``mask``, the bits of all that comes before it.
        steps: The step of each position.

    >>> n = chains_and_cliques(0b1111, {0: 0, 1: 0, 2: 0b11, 3: 0b10}, "abcd")
    >>> n.added, [child.mask for child in n.children]
    ((('b', 'a'),), [2, 13])
    """
    return _Order(mask, before, steps).node(mask)


class _Order:
    def __init__(self, mask: int, before: Mapping[int, int], steps: Sequence[int]) -> None:
        self.before, self.steps = before, steps
        after = dict.fromkeys(before, 0)
        for position in before:
            for earlier in positions(before[position]):
                after[earlier] |= 1 << position
        self.neighbors = {i: before[i] | after[i] for i in before}
        self.free = {i: mask & ~self.neighbors[i] & ~(1 << i) for i in before}

    def node(self, mask: int) -> OrderNode:
        """Return the steps of a mask as chains and cliques."""
        if mask.bit_count() == 1:
            return Leaf(self.steps[mask.bit_length() - 1], mask)
        parts = _components_of(mask, self.neighbors)
        if len(parts) > 1:
            return Clique(tuple(map(self.node, parts)), mask)
        parts = _components_of(mask, self.free)
        if len(parts) != 1:
            parts.sort(key=lambda part: self._n_before(part, mask))
            return Chain(tuple(map(self.node, parts)), mask)
        first = self._first_part(mask)
        return self._chain(first, mask & ~first)

    def _n_before(self, part: int, mask: int) -> int:
        return (self.before[part.bit_length() - 1] & mask).bit_count()

    def _chain(self, first: int, rest: int) -> Chain:
        """Return a chain of two parts, with what this adds; chains within it become part of it."""
        extra = [
            (self.steps[i], self.steps[j])
            for i in positions(first)
            for j in positions(rest & self.free[i])
        ]
        children: list[OrderNode] = []
        for node in (self.node(first), self.node(rest)):
            children += node.children if isinstance(node, Chain) else [node]
            extra += node.added if isinstance(node, Chain) else []
        return Chain(tuple(children), first | rest, tuple(extra))

    def _first_part(self, mask: int) -> int:
        """Return the first part of the best cut.

        Every first part holds a step that nothing comes before and leaves out one that nothing
        comes after. For each such pair the smallest of the best cuts is a minimum cut.
        """
        lowest = [i for i in positions(mask) if not self.before[i] & mask]
        inner = 0
        for i in positions(mask):
            inner |= self.before[i]
        best = (NEVER_CUT, 0, [0], 0)
        for source in lowest:
            for sink in positions(mask & ~inner & ~(1 << source)):
                value, part = self._minimum_cut(mask, source, sink, best[0])
                if part:
                    best = min(best, (value, part.bit_count(), list(positions(part)), part))
        return best[3]

    def _minimum_cut(self, mask: int, source: int, sink: int, most: int) -> tuple[int, int]:
        """Return what the best cut between two steps adds, and its smallest first part.

        That part is 0 if more than ``most`` would have to be added. By augmenting paths: a free
        pair carries one unit either way, and no cut goes between a step and what is before it.
        """
        room = {
            i: dict.fromkeys(positions(self.free[i] & mask), 1)
            | dict.fromkeys(positions(self.before[i] & mask), NEVER_CUT)
            for i in positions(mask)
        }
        onward = {i: (self.free[i] | self.before[i]) & mask for i in room}
        for value in range(most + 1):
            side, came = _flood(source, sink, onward)
            if sink not in came:
                return value, side
            here = sink
            while here != source:
                back, here = here, came[here]
                room[here][back] -= 1
                if not room[here][back]:
                    onward[here] &= ~(1 << back)
                room[back][here] = room[back].get(here, 0) + 1
                onward[back] |= 1 << here
        return most, 0


def _flood(source: int, sink: int, onward: Mapping[int, int]) -> tuple[int, dict[int, int]]:
    """Return what is met on the way from source to sink, as bits, and where each was come from."""
    nodes, waiting = 1 << source, [source]
    came: dict[int, int] = {}
    for here in waiting:
        new = onward[here] & ~nodes
        nodes |= new
        for there in positions(new):
            came[there] = here
            waiting.append(there)
        if sink in came:
            break
    return nodes, came


def _components_of(mask: int, links: Mapping[int, int]) -> list[int]:
    """Return the connected parts of a set of bits, that with the lowest bit first."""
    parts = []
    while mask:
        part = waiting = mask & -mask
        while waiting:
            new = links[waiting.bit_length() - 1] & mask & ~part
            waiting = waiting & ~(1 << waiting.bit_length() - 1) | new
            part |= new
        parts.append(part)
        mask &= ~part
    return parts
