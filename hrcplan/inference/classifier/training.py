"""Training of the forest of the changed-mind paper, from sampled beginnings of plans.

Ghose et al. (RA-L 2025, IV-C): 200 trees, at least 2 samples in a leaf and 10 to split, 300,000
sampled sequences of which a fifth is held out. A sequence is read as the beginning of a plan, of
uniform length: on whole plans any classifier is right, and useless early on.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import Protocol, cast, runtime_checkable

import numpy as np

from hrcplan.bank import Bank
from hrcplan.core.arrays import Floats, Ids, Rows
from hrcplan.core.extras import require
from hrcplan.errors import UsageError
from hrcplan.inference.classifier.flat_forest import FlatForest, SklearnForest

N_SAMPLES = 300_000
N_TREES = 200
MIN_LEAF, MIN_SPLIT = 2, 10
MINUTE = 60.0
TRIAL_SAMPLES, TRIAL_TREES = 6_000, 4  # of the forest that tells how long the whole takes
HELD_OUT = 0.2


class Predictor(Protocol):
    """A trained classifier."""

    def predict_proba(self, rows: Rows) -> Floats:
        """Return a row of probabilities for each row of features, by class."""
        ...


class Classifier(Predictor, Protocol):
    """A classifier with probabilities, as in scikit-learn."""

    def fit(self, rows: Rows, goals: Ids) -> Predictor:
        """Learn goals from rows of features."""
        ...


@runtime_checkable
class HasClasses(Protocol):
    """A trained classifier that says which goals it has seen; otherwise these are all goals."""

    classes_: Ids


@dataclass(frozen=True, slots=True)
class Training:
    """The training of a classifier: sample sizes, duration, and accuracy on held-out samples."""

    n_train: int
    n_held_out: int
    train_s: float
    accuracy: float


@dataclass(frozen=True, slots=True)
class TrainedClassifier:
    """A trained classifier.

    ``classes[c]`` is the goal of class ``c``. ``fault`` says why the file of the cache could not be
    used; None if it could, or there was none.
    """

    model: Predictor
    classes: Ids
    training: Training
    is_from_cache: bool = False
    fault: str | None = None


def prefixes(bank: Bank, n: int, rng: np.random.Generator) -> tuple[Rows, Ids]:
    """Return about ``n`` sampled beginnings of plans, shuffled: done labels, and goals.

    The length of each is uniform from 1 to that of its plan.

    Raises:
        UsageError: if no goal has a plan.
    """
    reachable = [g for g, graph in enumerate(bank.graphs) if graph.n_steps]
    if not reachable:
        raise UsageError("no goal has a plan to learn from", code="no-plan")
    column, each = np.array(bank.table.labels), -(-n // len(reachable))
    rows = np.zeros((each * len(reachable), bank.table.n_labels), dtype=np.uint8)
    for i, goal in enumerate(reachable):
        plans = bank.sampler(goal).draw(each, rng)
        lengths = (plans >= 0).sum(axis=1)
        cut = rng.integers(1, lengths + 1)
        is_in_prefix = np.arange(plans.shape[1]) < cut[:, None]
        where, place = np.nonzero(is_in_prefix)
        rows[i * each + where, column[plans[where, place]]] = 1
    goals = np.repeat(np.array(reachable), each)
    order = rng.permutation(len(rows))
    return rows[order], goals[order]


def forest(seed: int, n_trees: int, n_jobs: int) -> Classifier:
    """Return the classifier of the changed-mind paper, untrained."""
    require("sklearn", "the classifier of the changed-mind paper")
    from sklearn.ensemble import RandomForestClassifier

    classifier: Classifier = RandomForestClassifier(
        n_trees, min_samples_leaf=MIN_LEAF, min_samples_split=MIN_SPLIT, random_state=seed,
        n_jobs=n_jobs,
    )  # fmt: skip
    return classifier


def training_time(bank: Bank, n_jobs: int) -> str:
    """Return in words how long a forest takes to train, by the time that a small one takes."""
    rng, small = np.random.default_rng(0), forest(0, TRIAL_TREES, 1)
    prefixes(bank, 1, rng)  # what is counted once is not timed
    began = time.monotonic()
    rows, goals = prefixes(bank, TRIAL_SAMPLES, rng)
    sampling_s = time.monotonic() - began
    began = time.monotonic()
    small.fit(rows, goals)
    trees_s = (time.monotonic() - began) * N_TREES / TRIAL_TREES / max(1, n_jobs)
    seconds = (sampling_s + trees_s) * N_SAMPLES / TRIAL_SAMPLES
    return f"in about {math.ceil(seconds / 60)} min" if seconds > MINUTE else "in a minute"


def train(bank: Bank, seed: int, n_samples: int, classifier: Classifier) -> TrainedClassifier:
    """Return a classifier, trained on a bank and tested on held-out samples; forests are flattened.

    Raises:
        UsageError: if no goal has a plan.
    """
    from sklearn.ensemble import RandomForestClassifier

    rows, goals = prefixes(bank, n_samples, np.random.default_rng(seed))
    n_test = int(HELD_OUT * len(rows))
    began = time.monotonic()
    classifier.fit(rows[n_test:], goals[n_test:])
    train_s = time.monotonic() - began
    is_forest = isinstance(classifier, RandomForestClassifier)
    model: Predictor = (
        FlatForest.from_sklearn(cast(SklearnForest, classifier)) if is_forest else classifier
    )
    all_goals = np.arange(len(bank.names))
    classes = np.asarray(classifier.classes_ if isinstance(classifier, HasClasses) else all_goals)
    right = classes[model.predict_proba(rows[:n_test]).argmax(axis=1)] == goals[:n_test]
    return TrainedClassifier(
        model, classes, Training(len(rows) - n_test, n_test, train_s, float(right.mean()))
    )
