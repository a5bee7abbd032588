"""Entry points of installed packages in a group of hrcplan's.

`importlib.metadata` reads the metadata of every installed package: 30 ms at each start, its own
import included. In most environments no package adds a part to hrcplan, and one look at each
``entry_points.txt`` says so.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from importlib.machinery import PathFinder
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

_SECTION = b"[hrcplan."
_METADATA = (".dist-info", ".egg-info", ".egg")
_INSIDE = "EGG-INFO"


def entry_points(group: str) -> Iterable[EntryPoint]:
    """Return the entry points of a group whose name begins with ``hrcplan.``."""
    if not _may_have_parts():
        return ()
    from importlib import metadata

    return metadata.entry_points(group=group)


def _may_have_parts() -> bool:
    """Return False if no installed package has an entry point for hrcplan."""
    finders = [finder for finder in sys.meta_path if "find_distributions" in dir(finder)]
    return finders != [PathFinder] or any(map(_holds_parts, sys.path))


def _holds_parts(folder: str) -> bool:
    """Return whether a package in a folder of ``sys.path`` names a part; an archive may."""
    try:
        names = os.listdir(folder or ".")
    except OSError:
        return os.path.isfile(folder)
    return any(
        _names_part(os.path.join(folder, name, _INSIDE if name.endswith(".egg") else ""))
        for name in names
        if name.endswith(_METADATA)
    )


def _names_part(folder: str) -> bool:
    try:
        with open(os.path.join(folder, "entry_points.txt"), "rb") as file:
            return _SECTION in file.read()
    except OSError:
        return False
