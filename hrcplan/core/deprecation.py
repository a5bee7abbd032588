"""Names of earlier versions: they still work, and a warning says how they are called now.

In Python it is a DeprecationWarning; commands print it on stderr (see ``cli/main.py``).
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any


class OldNameWarning(DeprecationWarning):
    """A name of an earlier version was used."""


def warn_old_name(kind: str, old: str, new: str, stacklevel: int = 2) -> None:
    """Warn that ``old`` is a name of an earlier version; ``stacklevel`` counts from the caller."""
    message = f"{kind} '{old}' is deprecated; its name is '{new}'"
    warnings.warn(message, OldNameWarning, stacklevel=stacklevel + 1)


def current_name(kind: str, name: str, aliases: Mapping[str, str]) -> str:
    """Return the name of today; one of an earlier version is replaced, with a warning.

    >>> current_name("profile", "hrcplan", {"paper": "replan-always"})
    'hrcplan'
    """
    if name not in aliases:
        return name
    warn_old_name(kind, name, aliases[name], stacklevel=3)
    return aliases[name]


class Renamed:
    """An attribute of an earlier version: it gives the value of the present one, with a warning.

    >>> class Box:
    ...     size = 3
    ...     extent = Renamed("size")
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("ignore")
    ...     Box().extent
    3
    """

    def __init__(self, present: str) -> None:
        self.present = present

    def __set_name__(self, owner: type, name: str) -> None:
        """Note the old name."""
        self.name = name

    def __get__(self, owner: object | None, kind: type) -> Any:
        """Return the value of the present attribute."""
        if owner is None:
            return self
        warn_old_name(f"attribute of {kind.__name__}", self.name, self.present)
        return getattr(owner, self.present)
