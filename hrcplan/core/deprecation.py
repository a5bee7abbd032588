"""Names of earlier versions: they still work, and a warning says how they are called now.

In Python it is a DeprecationWarning; commands print it on stderr (see ``cli/main.py``).
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping


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
