"""Hierarchical task networks of chains and cliques, out of the plans of a goal.

Plans that do the same steps are of one kind, and each kind has a tree: chains are done in order,
the children of a clique in any order. The tree holds the partial order of the kind's plans, with
more order constraints where chains and cliques cannot do without (see `hrcplan.bank.chains`). On
top stands a choice between the kinds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from hrcplan.bank.chains import (
    Chain,
    Clique,
    Leaf,
    OrderNode,
    chains_and_cliques,
    n_added,
    n_orders,
)
from hrcplan.bank.graph import PlanGraph
from hrcplan.bank.orders import Layout, kinds_of, order_of
from hrcplan.core.bits import positions

__all__ = ["Chain", "Clique", "Htn", "Kind", "Leaf", "OrderNode", "decompose"]

Pick = Callable[[int], int]
"""Chooses one of ``n`` things: returns an index in ``range(n)``."""


@dataclass(frozen=True)
class Kind:
    """Plans that do the same steps, as a tree.

    Attributes:
        steps: The steps, in order of their ids, each as often as plans do it.
        root: The tree.
        plans: Number of plans of this kind, exactly.
        exact: Whether the plans are just the orders of a partial order. Then all orders that the
            tree allows are plans; else some may be none.
    """

    steps: tuple[int, ...]
    root: OrderNode
    plans: int
    exact: bool

    @property
    def orders(self) -> int:
        """In how many orders the tree allows the steps."""
        return n_orders(self.root)

    @property
    def added(self) -> int:
        """Number of order constraints that not all plans of this kind meet."""
        return n_added(self.root)


@dataclass(frozen=True)
class Htn:
    """The chains and cliques of a goal.

    Attributes:
        goal: The goal's name.
        kinds: A tree for each kind of plans, the cheapest first; none if there is no plan.
        plans: Number of plans of the goal, exactly.
        complete: False if there are more kinds than are kept (``orders.MAX_KINDS``).
        layout: The bits of the steps.
    """

    goal: str
    kinds: tuple[Kind, ...]
    plans: int
    complete: bool
    layout: Layout

    @property
    def exact(self) -> bool:
        """Whether every order that a tree allows is known to be a plan."""
        return all(kind.exact for kind in self.kinds)

    @property
    def orders(self) -> int:
        """In how many orders steps can be done."""
        return sum(kind.orders for kind in self.kinds)

    @property
    def added(self) -> int:
        """Number of order constraints that not all plans meet."""
        return sum(kind.added for kind in self.kinds)

    def available(self, remaining: Iterable[int]) -> tuple[int, ...]:
        """Return the steps that can come next, in order of their ids.

        A chain goes on with its first child that has something left to do, a clique with any. A
        kind takes part if it holds all that remains, and may so bring in its own order: who is
        bound to one kind has to begin with just its steps.

        Args:
            remaining: The steps still to do, whatever the order of the others; a step
                as often as it has still to be done.
        """
        mask = self.layout.mask(remaining)
        if not mask:
            return ()
        bits = 0
        for kind in self.kinds:
            if not mask & ~kind.root.mask:
                bits |= _available(kind.root, mask)
        steps = self.layout.steps
        return tuple(dict.fromkeys(steps[i] for i in positions(bits)))

    def choose(self, remaining: Iterable[int], last: int | None, pick: Pick) -> int | None:
        """Return the next step of a human who finishes what was begun.

        From the top down: a chain goes on with its first child that has something left to do; a
        clique, and the choice between kinds, with one that holds the last step; else with
        one that is picked. None if no kind holds all that remains, or nothing does.

        Args:
            remaining: The steps still to do, as for ``available``.
            last: The step that was done last; None at the beginning.
            pick: Chooses among two or more.

        >>> a, b, c = (Leaf(i, 1 << i) for i in range(3))
        >>> root = Clique((Chain((a, b), 3), c), 7)
        >>> kind = Kind((0, 1, 2), root, 3, True)
        >>> htn = Htn("g", (kind,), 3, True, Layout({0: 1, 1: 1, 2: 1}))
        >>> htn.available([0, 1, 2]), htn.choose([1, 2], 0, lambda n: n - 1)
        ((0, 2), 1)
        """
        mask = self.layout.mask(remaining)
        if not mask:
            return None
        roots = [kind.root for kind in self.kinds if not mask & ~kind.root.mask]
        if not roots:
            return None
        last_mask = 0 if last is None else self.layout.places.get(last, 0)
        node = _one_of(roots, last_mask, pick)
        while not isinstance(node, Leaf):
            open_children = [child for child in node.children if child.mask & mask]
            node = (
                open_children[0]
                if isinstance(node, Chain)
                else _one_of(open_children, last_mask, pick)
            )
        return node.step


def _available(node: OrderNode, mask: int) -> int:
    """Return the bits of what can come next below a node that has something left to do."""
    if isinstance(node, Leaf):
        return node.mask
    bits = 0
    for child in node.children:
        if child.mask & mask:
            bits |= _available(child, mask)
            if isinstance(node, Chain):
                break
    return bits


def _one_of(nodes: list[OrderNode], last_mask: int, pick: Pick) -> OrderNode:
    if len(nodes) == 1:
        return nodes[0]
    current = next((node for node in nodes if node.mask & last_mask), None)
    return nodes[pick(len(nodes))] if current is None else current


def decompose(graph: PlanGraph) -> Htn:
    """Return the chains and cliques of all plans of a goal.

    Raises:
        LimitError: if the graph has too many ways to find out what comes before what.

    >>> from hrcplan.bank import build_bank
    >>> htn = decompose(build_bank("kitchen", only=["parfait-nut"]).graphs[0])
    >>> htn.exact, len(htn.kinds), htn.plans, htn.orders, htn.added
    (True, 1, 6647155200, 1729728000, 5)
    """
    if not graph.n_nodes:
        return Htn(graph.goal, (), 0, True, Layout({}))
    multisets, complete = kinds_of(graph)
    layout = Layout.of(multisets)
    kinds = []
    for multiset in multisets:
        order = order_of(graph, layout, multiset)
        root = chains_and_cliques(order.mask, order.before, layout.steps)
        steps = tuple(step for step, n in sorted(multiset) for _ in range(n))
        kinds.append(Kind(steps, root, order.plans, order.exact))
    return Htn(graph.goal, tuple(kinds), graph.plans, complete, layout)
