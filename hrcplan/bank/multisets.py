"""The steps of plans as multisets, and whether some plan has given steps in any order."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from weakref import WeakKeyDictionary

import numpy as np

from hrcplan.bank.graph import PlanGraph

MAX_MULTISETS = 10_000
MAX_OBSERVED = 20  # steps that the subset test can look at where there are too many multisets
MAX_WORK = 2_000_000  # steps of a search before its answer is "unknown"


def is_subset(graph: PlanGraph, steps: Sequence[int]) -> bool | None:
    """Return whether some plan holds these steps in any order, as often as they stand here.

    None means unknown: there are more than ``MAX_MULTISETS`` kinds of plans, and either more than
    ``MAX_OBSERVED`` steps or too much to look at.
    """
    counts = Counter(steps)
    if not counts.keys() <= graph.used_steps:
        return not counts
    kinds = step_multisets(graph)
    if kinds is not None:
        return any(counts <= Counter(dict(kind)) for kind in kinds)
    return _has_subset(graph, counts) if len(steps) <= MAX_OBSERVED else None


Multiset = frozenset[tuple[int, int]]
"""Steps and how often each occurs."""

_MULTISETS: WeakKeyDictionary[PlanGraph, frozenset[Multiset] | None] = WeakKeyDictionary()


def step_multisets(graph: PlanGraph) -> frozenset[Multiset] | None:
    """Return the distinct multisets of steps of plans, as (step, times) pairs.

    None means that there are more than ``MAX_MULTISETS``.
    """
    if graph not in _MULTISETS:
        _MULTISETS[graph] = _one_multiset(graph) or _all_multisets(graph)
    return _MULTISETS[graph]


def _one_multiset(graph: PlanGraph) -> frozenset[Multiset] | None:
    """Return the multisets where all ways to a node hold the same steps; None if they do not."""
    used = sorted(graph.used_steps)
    if not graph.n_nodes or graph.n_nodes * len(used) > MAX_WORK * 100:
        return None
    column = np.full(max(used, default=0) + 1, 0, dtype=np.int64)
    column[used] = np.arange(len(used))
    # No path is longer than there are layers.
    dtype = np.uint8 if len(graph.layers) <= np.iinfo(np.uint8).max else np.int32
    times = np.zeros((graph.n_nodes, len(used)), dtype=dtype)
    for edges, sources in graph.edges_by_layer():
        after = times[sources]
        after[np.arange(len(sources)), column[graph.steps[edges]]] += 1
        times[graph.targets[edges]] = after
        if (times[graph.targets[edges]] != after).any():
            return None
    sources = np.repeat(np.arange(graph.n_nodes), np.diff(graph.first))
    difference = times[graph.targets].astype(np.int32) - times[sources]
    difference[np.arange(len(sources)), column[graph.steps]] -= 1
    if difference.any():  # ways from different layers meet in one node
        return None
    ends = np.unique(times[graph.is_goal], axis=0)
    return frozenset(
        frozenset((step, int(n)) for step, n in zip(used, row, strict=True) if n) for row in ends
    )


def _all_multisets(graph: PlanGraph) -> frozenset[Multiset] | None:
    """Return the multisets by collecting them from the goal backwards, up to the limit."""
    behind: list[frozenset[tuple[int, ...]]] = [frozenset()] * graph.n_nodes
    work = 0
    for node in reversed(range(graph.n_nodes)):
        if graph.is_goal[node]:
            behind[node] = frozenset([()])
            continue
        behind[node] = frozenset(
            tuple(sorted((step, *rest)))
            for step, target in _following(graph, node)
            for rest in behind[target]
        )
        work += len(behind[node])
        if len(behind[node]) > MAX_MULTISETS or work > MAX_WORK:
            return None
    ends = behind[0] if graph.n_nodes else frozenset[tuple[int, ...]]()
    return frozenset(frozenset(Counter(steps).items()) for steps in ends)


def _has_subset(graph: PlanGraph, counts: Counter[int]) -> bool | None:
    """Return whether one plan holds all of ``counts``: which of them a way has met, as bits."""
    places: dict[int, list[int]] = {}
    for position, step in enumerate(counts.elements()):
        places.setdefault(step, []).append(1 << position)
    everything = (1 << counts.total()) - 1
    masks: list[set[int]] = [set() for _ in range(graph.n_nodes)]
    masks[0].add(0)
    work = 0
    for node in range(graph.n_nodes):
        if graph.is_goal[node] and everything in masks[node]:
            return True
        for step, target in _following(graph, node):
            masks[target].update(_meet(mask, places.get(step, ())) for mask in masks[node])
        work += len(masks[node])
        masks[node] = set()
        if work > MAX_WORK:
            return None
    return False


def _following(graph: PlanGraph, node: int) -> Iterator[tuple[int, int]]:
    """Return the edges of a node; unlike ``next``, also those that read alike."""
    edges = slice(graph.first[node], graph.first[node + 1])
    return zip(graph.steps[edges].tolist(), graph.targets[edges].tolist(), strict=True)


def _meet(mask: int, places: Sequence[int]) -> int:
    """Return the mask with the first free place of a step taken."""
    return next((mask | place for place in places if not mask & place), mask)
