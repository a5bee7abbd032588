"""All trees of a forest in three arrays that walk many rows down at once.

A row of a forest of 200 trees takes scikit-learn 10-25 ms, most of it for starting.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hrcplan.core.arrays import Floats, Ids, Rows, SmallIds

_LEVELS = 6  # that all trees are walked down before those that have ended are left out
_WALKS = 1 << 15  # of a tree by a row, at once; more no longer fit into the processor's cache
_NODE = 3  # numbers of a node: its feature, and where the nodes for 0 and for 1 begin


class SklearnNodes(Protocol):
    """The nodes of a scikit-learn tree: the children of leaves are negative."""

    node_count: int
    children_left: Ids
    children_right: Ids
    feature: Ids
    value: Floats


class SklearnTree(Protocol):
    """A tree of a scikit-learn forest."""

    tree_: SklearnNodes


class SklearnForest(Protocol):
    """A trained scikit-learn forest."""

    estimators_: Sequence[SklearnTree]


@dataclass(frozen=True, eq=False)
class FlatForest:
    """A forest over features that are 0 or 1.

    Equal leaves are one, whichever trees they are of; there are about seven times fewer. They come
    before the other nodes and lead to themselves.

    Attributes:
        nodes: Three numbers for each node, one node after the other.
        leaves: (leaves, classes): the shares of the classes.
        roots: Where the root of each tree begins in ``nodes``.
    """

    nodes: SmallIds
    leaves: NDArray[np.float32]
    roots: SmallIds

    @classmethod
    def from_sklearn(cls, forest: SklearnForest) -> FlatForest:
        """Return a scikit-learn forest, flattened."""
        trees = [tree.tree_ for tree in forest.estimators_]
        is_leaf = np.concatenate([tree.children_left < 0 for tree in trees])
        shares = np.concatenate([tree.value[tree.children_left < 0, 0, :] for tree in trees])
        shares = (shares / shares.sum(axis=1, keepdims=True)).astype(np.float32)
        whole = shares.view(f"V{shares[0].nbytes}").ravel()  # bytes sort much faster than rows
        rows, which = np.unique(whole, return_inverse=True)
        leaves = rows.view(np.float32).reshape(len(rows), -1)
        n_inner = int((~is_leaf).sum())
        begin = np.zeros(len(is_leaf), dtype=np.int64)
        begin[is_leaf] = _NODE * which
        begin[~is_leaf] = _NODE * (len(leaves) + np.arange(n_inner))
        first = np.cumsum([0, *(tree.node_count for tree in trees)])[:-1]
        nodes = np.zeros((len(leaves) + n_inner, _NODE), dtype=np.int32)
        nodes[: len(leaves), 1:] = _NODE * np.arange(len(leaves))[:, None]
        inner = nodes[len(leaves) :]
        inner[:, 0] = np.concatenate([tree.feature for tree in trees])[~is_leaf]
        left_child = [tree.children_left + root for tree, root in zip(trees, first, strict=True)]
        right = [tree.children_right + root for tree, root in zip(trees, first, strict=True)]
        inner[:, 1] = begin[np.concatenate(left_child)[~is_leaf]]
        inner[:, 2] = begin[np.concatenate(right)[~is_leaf]]
        return cls(nodes.ravel(), leaves, begin[first].astype(np.int32))

    def predict_proba(self, rows: Rows) -> Floats:
        """Return the probabilities by class for each row of features.

        The sums are exact: shares are float32 and not below 1 / samples, and double precision
        holds the sum of hundreds of these. So neither order nor company of a row matters.
        """
        n_rows = max(1, _WALKS // len(self.roots))
        parts = [self._some(rows[i : i + n_rows]) for i in range(0, len(rows), n_rows)]
        return np.concatenate([np.empty((0, self.leaves.shape[1])), *parts])

    def _some(self, rows: Rows) -> Floats:
        leaf_means = self.leaves.take(self._walk(rows), axis=0).astype(np.float64)
        ones = np.ones((1, len(self.roots)))
        mean: Floats = np.matmul(ones, leaf_means)[:, 0] / len(self.roots)
        return mean

    def _walk(self, rows: Rows) -> SmallIds:
        """Return the leaf that each row reaches in each tree."""
        shape = len(rows), len(self.roots)
        column = ((rows != 0) + np.int32(1)).ravel()  # which number of a node leads on
        row = np.repeat(np.arange(len(rows), dtype=np.int32) * rows.shape[1], shape[1])
        at = np.tile(self.roots, shape[0])
        ends, going = at.copy(), np.arange(len(at))
        nodes, n_leaves = self.nodes, _NODE * len(self.leaves)
        while len(going):
            for _ in range(_LEVELS):
                at = nodes.take(at + column.take(row + nodes.take(at)))
            ends[going] = at
            on = np.flatnonzero(at >= n_leaves)
            at, row, going = at.take(on), row.take(on), going.take(on)
        return (ends // _NODE).reshape(shape)
