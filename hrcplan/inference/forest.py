"""The paper's belief: a random forest over which steps were done, in no order.

Ghose et al. (RA-L 2025, IV-C): 200 trees, at least 2 samples in a leaf and 10 to split, 300,000
sampled sequences of which a fifth is held out. A sequence is read as the beginning of a plan, of
uniform length: on whole plans any classifier is right, and useless early on.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from hrcplan.bank import Bank
from hrcplan.errors import UsageError
from hrcplan.inference.belief import Floats, weights_to_posterior
from hrcplan.inference.exact import IMPOSSIBLE

N_SAMPLES = 300_000
N_TREES = 200
MIN_LEAF, MIN_SPLIT = 2, 10
HELD_OUT = 0.2
_LEVELS = 8  # of all trees that are walked down before looking whether any goes on

Rows = NDArray[np.uint8]
Ids = NDArray[np.int64]


class Classifier(Protocol):
    """What scikit-learn calls a classifier with probabilities."""

    def fit(self, rows: Any, goals: Any) -> Any:
        """Learn goals from rows of features."""
        ...

    def predict_proba(self, rows: Any) -> Any:
        """Return a row of probabilities for each row of features, by class."""
        ...


@dataclass(frozen=True, slots=True)
class Training:
    """What a classifier was trained on, how long it took, and how often it is right."""

    n_train: int
    n_held_out: int
    train_s: float
    accuracy: float


@dataclass(frozen=True, slots=True)
class Done:
    """The state of `Forest`: the world, and which labels were done."""

    world: int
    row: Rows
    ignored: str | None = None


class Forest:
    """A classifier as a belief; both agents' steps are features, as in the paper.

    Args:
        bank: The plans to sample from.
        seed: Of the samples and of the forest.
        n_samples: Sampled beginnings of plans, over all goals.
        n_trees: Trees of the forest.
        classifier: Any other scikit-learn classifier.
        n_jobs: Processes that train; the forest is the same.
    """

    def __init__(
        self, bank: Bank, seed: int = 0, n_samples: int = N_SAMPLES, n_trees: int = N_TREES,
        classifier: Classifier | None = None, n_jobs: int = 1,
    ) -> None:  # fmt: skip
        self.bank, self.table = bank, bank.table
        labels: dict[tuple[str, ...], int] = {}
        self._label = np.array(
            [labels.setdefault(bank.table[i].name, len(labels)) for i in range(len(bank.table))]
        )
        self.n_labels = len(labels)
        rng = np.random.default_rng(seed)
        rows, goals = self.prefixes(n_samples, rng)
        n_test = int(HELD_OUT * len(rows))
        model = _forest(seed, n_trees, n_jobs) if classifier is None else classifier
        began = time.monotonic()
        model.fit(rows[n_test:], goals[n_test:])
        train_s = time.monotonic() - began
        self._classes = np.asarray(getattr(model, "classes_", np.arange(len(bank.names))))
        self._model = model
        self._flat = Flat(model) if hasattr(model, "estimators_") else None
        right = self._classes[self.predict(rows[:n_test]).argmax(axis=1)] == goals[:n_test]
        self.training = Training(len(rows) - n_test, n_test, train_s, float(right.mean()))

    @property
    def names(self) -> tuple[str, ...]:
        """The goals' names, in order."""
        return self.bank.names

    @property
    def note(self) -> str:
        """What training took and reached, in words."""
        t = self.training
        return (
            f"trained on {t.n_train} beginnings of plans in {t.train_s:.0f} s; "
            f"right on {100 * t.accuracy:.1f} % of {t.n_held_out} held out"
        )

    def prefixes(self, n: int, rng: np.random.Generator) -> tuple[Rows, Ids]:
        """Return about ``n`` sampled beginnings of plans, shuffled: done labels, and goals.

        The length of each is uniform from 1 to that of its plan.

        Raises:
            UsageError: if no goal has a plan.
        """
        reachable = [g for g, graph in enumerate(self.bank.graphs) if graph.n_steps]
        if not reachable:
            raise UsageError("no goal has a plan to learn from", code="no-plan")
        each = -(-n // len(reachable))
        rows = np.zeros((each * len(reachable), self.n_labels), dtype=np.uint8)
        for i, goal in enumerate(reachable):
            plans = self.bank.sampler(goal).draw(each, rng)
            lengths = (plans >= 0).sum(axis=1)
            cut = rng.integers(1, lengths + 1)
            kept = np.arange(plans.shape[1]) < cut[:, None]
            where, column = np.nonzero(kept)
            rows[i * each + where, self._label[plans[where, column]]] = 1
        goals = np.repeat(np.array(reachable), each)
        order = rng.permutation(len(rows))
        return rows[order], goals[order]

    def predict(self, rows: Rows) -> Floats:
        """Return probabilities by class for many rows."""
        found: Floats = self._model.predict_proba(rows)
        return found

    def start(self) -> Done:
        """Return the belief before any step."""
        return Done(self.bank.initial, np.zeros(self.n_labels, dtype=np.uint8))

    def observe(self, state: Done, step: int, *, robot: bool = False) -> Done:
        """Return the belief after one more step, whoever did it."""
        world = self.table.successor(state.world, step)
        if world is None:
            return replace(state, ignored=IMPOSSIBLE)
        row = state.row.copy()
        row[self._label[step]] = 1
        return Done(world, row)

    def posterior(self, state: Done) -> Floats:
        """Return the probability of each goal, in order; uniform before any step."""
        found = np.zeros(len(self.names))
        if not state.row.any():
            return np.full(len(found), 1 / len(found))
        flat = self._flat
        by_class = self.predict(state.row[None])[0] if flat is None else flat.predict(state.row)
        found[self._classes] = by_class
        return weights_to_posterior(found)


def _forest(seed: int, n_trees: int, n_jobs: int) -> Classifier:
    from sklearn.ensemble import RandomForestClassifier

    found: Classifier = RandomForestClassifier(
        n_trees, min_samples_leaf=MIN_LEAF, min_samples_split=MIN_SPLIT, random_state=seed,
        n_jobs=n_jobs,
    )  # fmt: skip
    return found


class Flat:
    """All trees of a scikit-learn forest in a few arrays, for one row at a time.

    A row of a forest of 200 trees takes scikit-learn 10-25 ms, most of it for starting.
    """

    def __init__(self, forest: Any) -> None:
        trees = [tree.tree_ for tree in forest.estimators_]
        sizes = [tree.node_count for tree in trees]
        self._roots = np.concatenate([[0], np.cumsum(sizes)[:-1]]).astype(np.int64)
        self._depth = max(tree.max_depth for tree in trees)
        self._feature = np.concatenate([np.maximum(tree.feature, 0) for tree in trees])
        children, values, n_leaves = [], [], 0
        leaf_of = np.zeros(sum(sizes), dtype=np.int64)
        for root, tree in zip(self._roots.tolist(), trees, strict=True):
            own = np.arange(tree.node_count)
            is_leaf = tree.children_left < 0
            pair = np.stack([tree.children_left, tree.children_right], axis=1)
            children.append(np.where(is_leaf[:, None], own[:, None], pair) + root)
            value = tree.value[is_leaf, 0, :]
            values.append((value / value.sum(axis=1, keepdims=True)).astype(np.float32))
            leaf_of[root + own[is_leaf]] = n_leaves + np.arange(is_leaf.sum())
            n_leaves += int(is_leaf.sum())
        # Interleaved, so that the child is found with one look: 2 node + (1 if it was done).
        self._child = np.concatenate(children).reshape(-1)
        self._leaf, self._values = leaf_of, np.concatenate(values)

    def predict(self, row: Rows) -> Floats:
        """Return the probabilities by class for one row."""
        nodes = self._roots
        for _ in range(0, self._depth, _LEVELS):
            before = nodes
            for _ in range(_LEVELS):
                side = row.take(self._feature.take(nodes))
                nodes = self._child.take(2 * nodes + side)
            if (nodes == before).all():
                break
        found: Floats = self._values[self._leaf[nodes]].mean(axis=0, dtype=np.float64)
        return found
