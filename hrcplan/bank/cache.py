"""Banks that were built before, in the user's cache folder: one file for each.

A file is named after a hash of the goals' files, so that a bank of PDDL that has changed is not
found. Nothing is lost with the folder: what is missing or damaged is built again. The banks that
were used last stay, up to a size of all together.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
from pathlib import Path

from hrcplan import __version__
from hrcplan.bank import Bank, build
from hrcplan.bank.goals import Goals
from hrcplan.bank.store import TEAM_VERSION, load, save
from hrcplan.core.files import cache_folder
from hrcplan.errors import InputError, UsageError

MAX_BYTES = 1 << 30


def cached_bank(goals: Goals, *, timeout_s: float = float("inf")) -> Bank:
    """Return the bank of goals, from the cache if it was built before.

    Args:
        goals: The goals.
        timeout_s: Seconds for all graphs together, if they are built.

    Raises:
        UnsupportedError: if bits cannot hold the task.
        LimitError: if time or memory runs out.
    """
    path = cache_path(goals)
    if path is not None and path.is_file():
        with contextlib.suppress(InputError):
            bank = load(path)
            with contextlib.suppress(OSError):
                os.utime(path)  # it is in use: others go first
            return bank
    bank = build(goals, timeout_s=timeout_s)
    if path is not None:
        with contextlib.suppress(OSError, UsageError):
            path.parent.mkdir(parents=True, exist_ok=True)
            save(bank, path)
            drop_oldest(path.parent, MAX_BYTES)
    return bank


def drop_oldest(folder: Path, most: int) -> None:
    """Remove the banks of a folder that were used least lately, until the rest is small enough.

    The last one stays, however large it is.

    Args:
        folder: The folder of banks.
        most: Bytes of all banks together.

    Raises:
        OSError: if a file cannot be looked at or removed.
    """
    by_age = sorted(folder.glob("*.bank"), key=lambda path: path.stat().st_mtime_ns, reverse=True)
    n_bytes = 0
    for place, path in enumerate(by_age):
        n_bytes += path.stat().st_size
        if place and n_bytes > most:
            path.unlink(missing_ok=True)


def cache_path(goals: Goals) -> Path | None:
    """Return the file of the bank of goals; None if it is not read from files, or has no place."""
    folder = cache_folder()
    if folder is None or not goals.files:
        return None
    words = [__version__, str(TEAM_VERSION), *goals.names]
    for file in goals.files:
        words += [os.path.realpath(file.path), file.sha256]
    digest = hashlib.sha256("\n".join(words).encode()).hexdigest()
    return folder / "banks" / f"{digest[:32]}.bank"
