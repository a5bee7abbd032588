"""Plans out of a graph: in order of cost, at random, and whether steps fit any of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from hrcplan.bank.graph import PlanGraph
from hrcplan.core.arrays import Bools, Floats, Ids, SmallIds
from hrcplan.errors import LimitError

MAX_TRIES = 1_000  # samples thrown away for each one that is kept

CHUNK = 8192  # plans that are drawn together: their arrays stay in the processor's cache
ABOVE_ALL = 2.0  # no random number is

PlanFilter = Callable[[Sequence[int]], bool]
"""Says of a plan, as step ids, whether it is wanted."""


def plans(graph: PlanGraph, keep: PlanFilter | None = None) -> Iterator[tuple[int, ...]]:
    """Yield plans, the cheapest first, those of one cost in order of their step ids.

    Args:
        graph: The graph.
        keep: Which plans are wanted; all by default.
    """
    for layer in graph.final_layers:
        alive = _reaching(graph, layer)
        for plan in _depth_first(graph, alive):
            if keep is None or keep(plan):
                yield plan


def _reaching(graph: PlanGraph, layer: int) -> Bools:
    """Return which nodes lead to a goal node of a layer."""
    alive: Bools = graph.is_goal & (graph.layer_of == layer)
    for edges, sources in reversed(list(graph.edges_by_layer())):
        np.logical_or.at(alive, sources, alive[graph.targets[edges]])
    return alive


def _depth_first(graph: PlanGraph, alive: Bools) -> Iterator[tuple[int, ...]]:
    path: list[int] = []
    stack = [iter([(-1, 0)])]
    while stack:
        step, node = next(stack[-1], (-1, -1))
        if node < 0:
            stack.pop()
            if path:
                path.pop()
            continue
        if step >= 0:
            path.append(step)
        if graph.is_goal[node]:
            yield tuple(path)
        stack.append(iter([(s, n) for s, n in graph.next(node).items() if alive[n]]))


class Sampler:
    """Draws plans uniformly, many at a time, without listing any.

    >>> from hrcplan.bank import build_bank
    >>> import numpy as np
    >>> bank = build_bank("kitchen", only=["parfait-nut"])
    >>> Sampler(bank.graphs[0]).draw(3, np.random.default_rng(1)).shape
    (3, 17)
    """

    def __init__(self, graph: PlanGraph) -> None:
        self.graph = graph
        degrees = np.diff(graph.first)
        sources = np.repeat(np.arange(graph.n_nodes), degrees)
        # Of Python integers, which may be too large for a float, the quotient is one.
        shares = graph.n_paths_to_goal[graph.targets] / graph.n_paths_to_goal[sources]
        total = np.cumsum(shares.astype(np.float64))
        before = np.concatenate([[0.0], total])[graph.first[:-1]]
        self._last = graph.first[1:] - 1
        # An edge is passed over if the random number is not below its share and those before it.
        self._shares = total - before[sources]
        self._shares[self._last[degrees > 0]] = ABOVE_ALL
        widest = int(degrees.max(initial=1))
        self._strides = [1 << i for i in reversed(range((widest - 1).bit_length()))]

    def draw(self, n: int, rng: np.random.Generator) -> SmallIds:
        """Return ``n`` plans as rows of step ids, shorter ones filled up with -1.

        Every plan has the same chance, up to the rounding of floats (about 1e-12).
        """
        parts = [self._draw(min(CHUNK, n - n_so_far), rng) for n_so_far in range(0, n, CHUNK)]
        width = max((part.shape[1] for part in parts), default=0)
        plans = np.full((n, width), -1, dtype=np.int32)
        for i, part in enumerate(parts):
            plans[i * CHUNK : i * CHUNK + len(part), : part.shape[1]] = part
        return plans

    def _draw(self, n: int, rng: np.random.Generator) -> SmallIds:
        graph = self.graph
        nodes = np.zeros(n, dtype=np.int32)
        columns: list[SmallIds] = []
        is_end = graph.is_goal[nodes]
        while not is_end.all():
            edges = self._choose(nodes, rng.random(n))
            if is_end.any():
                edges[is_end] = 0
                columns.append(np.where(is_end, np.int32(-1), graph.steps[edges]))
                nodes = np.where(is_end, nodes, graph.targets[edges])
            else:
                columns.append(graph.steps[edges])
                nodes = graph.targets[edges]
            is_end = graph.is_goal[nodes]
        return np.stack(columns, axis=1) if columns else np.zeros((n, 0), dtype=np.int32)

    def _choose(self, nodes: NDArray[np.integer], chance: Floats) -> Ids:
        """Return an edge for each node, by halving the range of its edges."""
        edges: Ids = self.graph.first[nodes]
        last = self._last[nodes]
        for stride in self._strides:
            ahead = np.minimum(edges + (stride - 1), last)
            edges = edges + stride * (self._shares[ahead] <= chance)
        return edges

    def draw_kept(
        self, n: int, rng: np.random.Generator, keep: PlanFilter
    ) -> list[tuple[int, ...]]:
        """Return ``n`` plans drawn uniformly from those that a filter keeps.

        Raises:
            LimitError: if fewer than one in ``MAX_TRIES`` is kept.
        """
        plans: list[tuple[int, ...]] = []
        tries = 0
        while len(plans) < n:
            for row in self.draw(max(16, n), rng).tolist():
                plan = tuple(step for step in row if step >= 0)
                tries += 1
                if len(plans) < n and keep(plan):
                    plans.append(plan)
            if tries > MAX_TRIES * (len(plans) + 1):
                message = f"hardly any plan of '{self.graph.goal}' passes the filter"
                raise LimitError(message, hint="lower --quality, or build with --alternatives")
        return plans


def is_prefix(graph: PlanGraph, steps: Sequence[int]) -> bool:
    """Return whether some plan begins with these steps."""
    return graph.after(steps) is not None


def is_subsequence(graph: PlanGraph, steps: Sequence[int]) -> bool:
    """Return whether some plan holds these steps in this order, with others between them."""
    if not graph.n_nodes:
        return False
    keys = np.array([*steps, -1], dtype=np.int32)
    n_matches = np.full(graph.n_nodes, -1, dtype=np.int64)
    n_matches[0] = 0
    for edges, sources in graph.edges_by_layer():
        n = n_matches[sources]
        np.maximum.at(n_matches, graph.targets[edges], n + (graph.steps[edges] == keys[n]))
    return bool(n_matches[graph.is_goal].max() == len(steps))


def shortest(graph: PlanGraph, node: int = 0) -> Iterator[tuple[int, int]]:
    """Yield the steps of the shortest plan that is left at a node, and the nodes they lead to.

    Of several it is the one whose first steps have the smallest ids.
    """
    while graph.n_nodes and not graph.is_goal[node]:
        step, node = min(graph.next(node).items(), key=lambda edge: graph.steps_left[edge[1]])
        yield step, node
