"""The belief of the changed-mind paper: a random forest over the set of done steps.

Ghose et al. (RA-L 2025, IV-C). `hrcplan.inference.classifier.training` says how it is trained.
Training takes minutes, so the forest is cached in the user's cache folder.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain, islice
from pathlib import Path

import numpy as np

from hrcplan.bank import Bank
from hrcplan.core.arrays import Floats, Rows
from hrcplan.core.files import cache_folder
from hrcplan.errors import UsageError
from hrcplan.inference.belief import IMPOSSIBLE
from hrcplan.inference.classifier.cache import key_of, load_or_train, path_of
from hrcplan.inference.classifier.training import (
    N_SAMPLES,
    N_TREES,
    Classifier,
    TrainedClassifier,
    Training,
    forest,
    train,
)  # fmt: skip
from hrcplan.inference.probabilities import weights_to_posteriors

MAX_KNOWN = 4096  # rows whose posterior is remembered: look-ahead asks for them again


@dataclass(frozen=True, slots=True)
class ForestState:
    """The state of `ForestBelief`: the world, and which labels were done."""

    world: int
    row: Rows
    ignored: str | None = None


def forest_path(bank: Bank) -> Path | None:
    """Return the file of the forest of a bank, which may not be there; None without a cache."""
    folder = cache_folder()
    return None if folder is None else path_of(folder, key_of(bank, 0, N_SAMPLES, N_TREES))


class ForestBelief:
    """A classifier as a belief; both agents' steps are features, as in the changed-mind paper.

    Args:
        bank: The plans to sample from.
        seed: Of the samples and of the forest.
        n_samples: Sampled beginnings of plans, over all goals.
        n_trees: Trees of the forest.
        classifier: Any other scikit-learn classifier; it is not cached.
        n_jobs: Processes that train; the forest is the same.
        cache: The cache folder; True for the user's, False for none.

    Raises:
        UsageError: if no goal has a plan.
    """

    def __init__(
        self, bank: Bank, seed: int = 0, n_samples: int = N_SAMPLES, n_trees: int = N_TREES,
        classifier: Classifier | None = None, n_jobs: int = 1, cache: Path | bool = True,
    ) -> None:  # fmt: skip
        self.bank, self.steps = bank, bank.table
        self._column = np.array(bank.table.labels, dtype=np.int64)
        self.n_labels = bank.table.n_labels

        def make() -> TrainedClassifier:
            model = forest(seed, n_trees, n_jobs) if classifier is None else classifier
            return train(bank, seed, n_samples, model)

        folder = cache_folder() if cache is True else cache or None
        if folder is None or classifier is not None:
            self._training = make()
        else:
            self._training = load_or_train(folder, key_of(bank, seed, n_samples, n_trees), make)
        self._memo: dict[bytes, Floats] = {}

    @property
    def names(self) -> tuple[str, ...]:
        """The goals' names, in order."""
        return self.bank.names

    @property
    def training(self) -> Training:
        """Sample sizes, duration, and accuracy of the training."""
        return self._training.training

    @property
    def note(self) -> str:
        """The training in words."""
        t, origin = self.training, self._training
        text = (
            f"trained on {t.n_train} beginnings of plans in {t.train_s:.0f} s"
            f"{', and kept since' if origin.is_from_cache else ''}; "
            f"right on {100 * t.accuracy:.1f} % of {t.n_held_out} held out"
        )
        return text if origin.fault is None else f"{text}; trained again, since {origin.fault}"

    def start(self) -> ForestState:
        """Return the belief before any step."""
        return ForestState(self.bank.initial, np.zeros(self.n_labels, dtype=np.uint8))

    def observe(self, state: ForestState, step: int, *, robot: bool = False) -> ForestState:
        """Return the belief after one more step of either agent."""
        world = self.steps.successor(state.world, step)
        if world is None:
            return replace(state, ignored=IMPOSSIBLE)
        row = state.row.copy()
        row[self._column[step]] = 1
        return ForestState(world, row)

    def posterior(self, state: ForestState) -> Floats:
        """Return the probability of each goal, in order; uniform before any step."""
        posterior: Floats = self.posteriors(state.row[None])[0]
        return posterior

    def posteriors_after(self, state: ForestState, sequences: Sequence[Sequence[int]]) -> Floats:
        """Return (sequences, goals) probabilities: after each sequence of further steps.

        Whether the steps are applicable is not checked.
        """
        rows = np.repeat(state.row[None], len(sequences), axis=0)
        steps = np.fromiter(chain.from_iterable(sequences), dtype=np.int64)
        which = np.repeat(np.arange(len(sequences)), [len(more) for more in sequences])
        rows[which, self._column[steps]] = 1
        return self.posteriors(rows)

    def posteriors(self, rows: Rows) -> Floats:
        """Return (rows, goals) posteriors; equal rows and those of before cost nothing.

        Raises:
            UsageError: if the rows do not have a column for each label.
        """
        if rows.shape[1:] != (self.n_labels,):
            raise UsageError(f"a row has {self.n_labels} labels, not {rows.shape[1:]}")
        memo, keys = self._memo, [row.tobytes() for row in rows]
        new = {key: i for i, key in enumerate(keys) if key not in memo}
        if new:
            memo.update(zip(new, self._posteriors(rows[list(new.values())]), strict=True))
        posteriors = np.array([memo[key] for key in keys]).reshape(-1, len(self.names))
        for key in list(islice(memo, max(0, len(memo) - MAX_KNOWN))):
            del memo[key]
        return posteriors

    def _posteriors(self, rows: Rows) -> Floats:
        weights = np.zeros((len(rows), len(self.names)))
        weights[:, self._training.classes] = self._training.model.predict_proba(rows)
        weights[~rows.any(axis=1)] = 1
        return weights_to_posteriors(weights)
