"""The cache of trained forests: one file for each, in the user's cache folder.

A file is named after a hash of everything that the forest depends on, such as bank and seed. If
several processes need the same missing forest, one trains it and the others wait. The arrays are
memory-mapped, so that processes share them.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, replace
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from hrcplan.bank import Bank
from hrcplan.bank.store import digest
from hrcplan.core.array_file import Arrays, Format, array, map_file
from hrcplan.core.files import write_atomically
from hrcplan.core.json_values import DOCUMENT_FAULTS
from hrcplan.errors import InputError, UsageError
from hrcplan.inference.classifier.flat_forest import FlatForest
from hrcplan.inference.classifier.training import (
    HELD_OUT,
    MIN_LEAF,
    MIN_SPLIT,
    TrainedClassifier,
    Training,
)

VERSION = 1  # to be raised whenever the same bank and seed give another forest than before
_FORMAT = Format(b"HRCPTREE", VERSION, "forest", "trained forest", "it may be deleted")
_ARRAYS = {"nodes": "<i4", "leaves": "<f4", "roots": "<i4"}
_PACKAGES = ("numpy", "scikit-learn")  # whose version decides which samples and trees a seed gives

Key = Mapping[str, Any]

_unsaved: dict[Path, TrainedClassifier] = {}
"""Forests that could not be written to a file; this process does not train them twice."""


def key_of(bank: Bank, seed: int, n_samples: int, n_trees: int) -> Key:
    """Return everything that a forest depends on."""
    return {
        "bank": digest(bank), "seed": int(seed),
        "n_samples": int(n_samples), "n_trees": int(n_trees),
        "held_out": HELD_OUT, "min_leaf": MIN_LEAF, "min_split": MIN_SPLIT,
        **{name: metadata.version(name) for name in _PACKAGES},
    }  # fmt: skip


def load_or_train(
    folder: Path, key: Key, make: Callable[[], TrainedClassifier]
) -> TrainedClassifier:
    """Return the forest of a key from its file; if there is none, train it and write the file.

    A file that is damaged, or of another key, is replaced. If the file cannot be written, the
    forest is returned all the same.

    Args:
        folder: The cache folder; it is created if it is missing.
        key: The result of ``key_of``.
        make: Trains the forest.
    """
    path = path_of(folder, key)
    forest, fault = _look(path, key)
    forest = forest or _unsaved.get(path)
    if forest is not None:
        return forest
    with _alone(path.with_suffix(".lock")) as alone:
        if alone:  # while this process waited, another may have made it
            forest, fault = _look(path, key)
            if forest is not None:
                return forest
        new = make()
        if alone and _try_save(path, key, new):
            new = _look(path, key)[0] or new
        else:
            _unsaved[path] = new
        return replace(new, is_from_cache=False, fault=fault)


def path_of(folder: Path, key: Key) -> Path:
    """Return the path of the file of a key."""
    text = json.dumps([VERSION, key], sort_keys=True)
    return folder / f"{hashlib.sha256(text.encode()).hexdigest()[:32]}.forest"


def load(path: Path, key: Key) -> TrainedClassifier:
    """Return the forest in a file.

    Raises:
        OSError: if there is no such file, or it may not be read.
        InputError: if it is damaged, or no forest, or that of another key.
    """
    header, body = _FORMAT.decode(map_file(path), str(path))
    try:
        if header["key"] != key:
            raise InputError(f"'{path}' is the forest of something else", code="not-a-forest")
        model = FlatForest(
            **{name: array(body, header[name], kind) for name, kind in _ARRAYS.items()}
        )
        classes = np.array(header["classes"], dtype=np.int64)
        return TrainedClassifier(model, classes, Training(**header["training"]), is_from_cache=True)
    except DOCUMENT_FAULTS as error:
        message = f"'{path}' has a header that makes no sense: {error!r}"
        raise InputError(message, code="not-a-forest", path=str(path)) from None


def _look(path: Path, key: Key) -> tuple[TrainedClassifier | None, str | None]:
    """Return the forest, or the fault of its file; both are None if there is no file."""
    try:
        return load(path, key), None
    except FileNotFoundError:
        return None, None
    except OSError as error:
        return None, f"cannot read '{path}': {error.strerror or error}"
    except InputError as error:
        return None, error.message


def _try_save(path: Path, key: Key, forest: TrainedClassifier) -> bool:
    """Return whether a forest could be written to its file."""
    model = forest.model
    assert isinstance(model, FlatForest), "only forests have a file format"
    data = {"nodes": model.nodes, "leaves": model.leaves, "roots": model.roots}
    arrays = Arrays()
    header = {
        "key": key, "classes": forest.classes.tolist(), "training": asdict(forest.training),
        **{name: arrays.add(data[name], kind) for name, kind in _ARRAYS.items()},
    }  # fmt: skip
    try:
        write_atomically(path, _FORMAT.encode(header, arrays))
    except UsageError:
        return False
    return True


@contextmanager
def _alone(path: Path) -> Iterator[bool]:
    """Lock out other processes; the value is False where locks are impossible."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        lock = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    except OSError:
        yield False
        return
    try:
        yield _try_lock(lock)
    finally:
        os.close(lock)


def _try_lock(lock: int) -> bool:
    try:
        fcntl.flock(lock, fcntl.LOCK_EX)
    except OSError:
        return False  # some network drives have no locks
    return True
