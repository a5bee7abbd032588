"""In which partial order the plans of a graph do their steps: found over its nodes, not its plans.

Plans that do the same steps, each as often, are of one kind. A step comes before another in the
order of a kind if it does in all plans of that kind.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate, islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hrcplan.bank.graph import PlanGraph
from hrcplan.bank.multisets import Multiset, step_multisets
from hrcplan.bank.walk import plans
from hrcplan.core.arrays import Bools, Ids
from hrcplan.core.bits import positions
from hrcplan.core.numbers import Number
from hrcplan.errors import LimitError

MAX_KINDS = 64
MAX_LISTED = 10_000  # plans that are looked at for kinds where there are too many of these
MAX_PLACES = 2_000_000  # nodes, each as often as there are different steps left to do at it
WORD_BITS = 62  # above it masks are Python integers

Masks = NDArray[Any]


def kinds_of(graph: PlanGraph) -> tuple[tuple[Multiset, ...], bool]:
    """Return up to ``MAX_KINDS`` kinds of plans, the cheapest first, and whether these are all.

    Equally cheap ones come in order of how many steps they have, then of their step ids. Where
    ``step_multisets`` gives up, they are those of the first ``MAX_LISTED`` plans.
    """
    multisets = step_multisets(graph)
    if multisets is None:
        kinds = (frozenset(Counter(p).items()) for p in islice(plans(graph), MAX_LISTED))
        return tuple(islice(dict.fromkeys(kinds), MAX_KINDS)), False
    costs = _costs(graph) if len(multisets) > 1 else dict.fromkeys(graph.used_steps, 1)

    def rank(kind: Multiset) -> tuple[Number, int, list[tuple[int, int]]]:
        return sum(costs[s] * n for s, n in kind), sum(n for _, n in kind), sorted(kind)

    return tuple(sorted(multisets, key=rank)[:MAX_KINDS]), len(multisets) <= MAX_KINDS


def _costs(graph: PlanGraph) -> dict[int, Number]:
    """Return what each step costs where it costs least."""
    sources = np.repeat(np.arange(graph.n_nodes), np.diff(graph.first))
    layers = graph.layer_of
    edges = np.stack([graph.steps, layers[sources], layers[graph.targets]], axis=1)
    least: dict[int, Number] = {}
    for step, begin, end in np.unique(edges, axis=0).tolist():
        cost = graph.layers[end][0] - graph.layers[begin][0]
        least[step] = min(least.get(step, cost), cost)
    return least


@dataclass(frozen=True)
class Layout:
    """A bit for every step of some kinds, in step order.

    A step that is done several times has a bit for each; the lowest is the last time. So as long
    as it has to be done ``n`` times more, its ``n`` lowest bits are left.

    Attributes:
        times: How often a step is done at most.

    >>> layout = Layout({7: 1, 9: 2})
    >>> layout.steps, layout.mask([9]), layout.mask([9, 7, 9]), layout.mask([8])
    ((7, 9, 9), 2, 7, None)
    """

    times: Mapping[int, int]

    @staticmethod
    def of(kinds: Iterable[Multiset]) -> Layout:
        """Return the layout that holds all of these kinds."""
        times: dict[int, int] = {}
        for kind in kinds:
            for step, n in kind:
                times[step] = max(n, times.get(step, 0))
        return Layout(dict(sorted(times.items())))

    @cached_property
    def steps(self) -> tuple[int, ...]:
        """The step of each bit."""
        return tuple(Counter(dict(self.times)).elements())

    @cached_property
    def starts(self) -> dict[int, int]:
        """The position of the lowest bit of each step."""
        return dict(zip(self.times, accumulate(self.times.values(), initial=0), strict=False))

    @cached_property
    def places(self) -> dict[int, int]:
        """All bits of each step."""
        return {s: (1 << n) - 1 << self.starts[s] for s, n in self.times.items()}

    @property
    def dtype(self) -> type[np.generic]:
        """What arrays of masks are made of."""
        return np.int64 if len(self.steps) <= WORD_BITS else np.object_

    def mask(self, steps: Iterable[int]) -> int | None:
        """Return the bits of steps still to do; None if no plan does them, or not as often."""
        bits, places = 0, self.places
        for step in steps:
            free = places.get(step, 0) & ~bits
            if not free:
                return None
            bits |= free & -free
        return bits


@dataclass(frozen=True)
class KindOrder:
    """The partial order of the steps of one kind of plans.

    Attributes:
        mask: The bits of its steps.
        before: For the position of each bit, the bits of all steps that come before it.
        plans: How many plans are of this kind.
        exact: Whether every order of the steps that ``before`` permits is a plan.
    """

    mask: int
    before: Mapping[int, int]
    plans: int
    exact: bool


def order_of(graph: PlanGraph, layout: Layout, kind: Multiset) -> KindOrder:
    """Return the partial order of one kind of plans.

    Raises:
        LimitError: if more than ``MAX_PLACES`` would have to be looked at.
    """
    mask = layout.mask(Counter(dict(kind)).elements()) or 0
    ways = _by_node(graph, layout, mask) or _by_remaining(graph, layout, mask)
    alive = ways.alive()
    edges = [(ways.remaining[s], bits, alive[t]) for s, t, bits in ways.layers]
    here = np.concatenate([ways.remaining[:0], *(remaining[used] for remaining, _, used in edges)])
    bits = np.concatenate([ways.remaining[:0], *(bits[used] for _, bits, used in edges)])
    remaining = ways.remaining[alive]
    before = {
        i: mask & ~int(np.bitwise_or.reduce(here[bits == 1 << i], initial=0))
        for i in positions(mask)
    }
    # What comes next in the graph can do so in the order. If no more can, they are the same.
    possible = sum(
        np.count_nonzero((remaining & (b | 1 << i)) == 1 << i) for i, b in before.items()
    )
    n_plans = ways.n_plans(graph.n_paths_to_goal.dtype.type)
    return KindOrder(mask, before, n_plans, bool(possible == len(bits)))


@dataclass(frozen=True)
class _Ways:
    """The ways through a graph that do steps of one kind only, layer by layer.

    A place is a node with what is left to do there; the first is 0. A layer holds, of each edge,
    the places that it leads from and to, and the bit that it takes away.
    """

    remaining: Masks
    ends: Bools
    layers: Sequence[tuple[Ids, Ids, Masks]]

    def alive(self) -> Bools:
        """Return which places lead to an end."""
        lives = self.ends.copy()
        for sources, targets, _ in reversed(self.layers):
            np.logical_or.at(lives, sources, lives[targets])
        return lives

    def n_plans(self, dtype: type[np.generic]) -> int:
        """Return how many ways lead from the first place to ends."""
        counts = np.zeros(len(self.remaining), dtype=dtype)
        counts[0] = 1
        for sources, targets, _ in self.layers:
            np.add.at(counts, targets, counts[sources])
        return int(counts[self.ends].sum())


def _by_node(graph: PlanGraph, layout: Layout, mask: int) -> _Ways | None:
    """Return the ways where each node has one place only; None if some has more."""
    dtype = layout.dtype
    remaining, has_place = (
        np.zeros(graph.n_nodes, dtype=dtype),
        np.zeros(graph.n_nodes, dtype=np.bool_),
    )
    remaining[0], has_place[0] = mask, True
    starts = np.zeros(int(graph.steps.max(initial=0)) + 1, dtype=dtype)
    full = starts.copy()
    for step, start in layout.starts.items():
        starts[step], full[step] = start, layout.places[step] >> start
    layers: list[tuple[Ids, Ids, Masks]] = []
    for edges, sources in graph.edges_by_layer():
        steps, targets = graph.steps[edges], graph.targets[edges].astype(np.int64)
        times = remaining[sources] >> starts[steps] & full[steps]  # n low bits for n times left
        bit = ((times + 1) >> 1) << starts[steps]
        used = has_place[sources] & (bit != 0)
        sources, targets, bit = sources[used], targets[used], bit[used]
        after = remaining[sources] ^ bit
        clash = has_place[targets] & (remaining[targets] != after)
        remaining[targets], has_place[targets] = after, True
        if clash.any() or (remaining[targets] != after).any():
            return None
        layers.append((sources, targets, bit))
    return _Ways(remaining, graph.is_goal & has_place & (remaining == 0), layers)


def _by_remaining(graph: PlanGraph, layout: Layout, mask: int) -> _Ways:
    """Return the ways with a place for whatever can be left to do at a node."""
    places: list[dict[int, int]] = [{} for _ in range(graph.n_nodes)]
    places[0][mask] = 0
    remaining, ends = [mask], [False]
    layers: list[list[tuple[int, int, int]]] = [[] for _ in graph.layers]
    for node, layer in enumerate(graph.layer_of.tolist()):
        for rest, place in places[node].items():
            ends[place] = bool(graph.is_goal[node]) and not rest
            for step, target in graph.next(node).items():
                highest = (rest & layout.places.get(step, 0)).bit_length()
                if not highest:
                    continue
                bit = 1 << highest - 1
                at = places[target].setdefault(rest ^ bit, len(remaining))
                if at == len(remaining):
                    remaining.append(rest ^ bit)
                    ends.append(False)
                layers[layer].append((place, at, bit))
        if len(remaining) > MAX_PLACES:
            raise LimitError(f"too many ways through the plans of '{graph.goal}'")
    dtype = layout.dtype
    return _Ways(np.array(remaining, dtype=dtype), np.array(ends, dtype=np.bool_), [
        (np.array([e[0] for e in edges], dtype=np.int64),
         np.array([e[1] for e in edges], dtype=np.int64),
         np.array([e[2] for e in edges], dtype=dtype))
        for edges in layers
    ])  # fmt: skip
