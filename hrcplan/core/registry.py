"""Parts by name: ours, those that other packages register, or anybody's as ``module:Class``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from importlib.metadata import entry_points
from typing import Any

from hrcplan.core.text import nearest
from hrcplan.errors import UsageError


@dataclass(frozen=True, slots=True)
class Registry:
    """The parts of one kind: what it is called, where our own are, and its entry-point group."""

    kind: str
    own: Mapping[str, str]
    group: str

    def names(self) -> list[str]:
        """Return the names of all parts, ours first."""
        registered = (entry.name for entry in entry_points(group=self.group))
        return [*self.own, *sorted(name for name in registered if name not in self.own)]

    def find(self, name: str) -> Any:
        """Return the class of a part.

        Raises:
            UsageError: if there is none of this name, or it cannot be loaded.
        """
        place = self.own.get(name, name if ":" in name else None)
        if place is None:
            found = next(iter(entry_points(group=self.group, name=name)), None)
            if found is None:
                known = f"{self.kind}s: {', '.join(self.names())}, or module:Class"
                message = f"there is no {self.kind} '{name}'"
                hint = nearest(name, self.names()) or known
                raise UsageError(message, code=f"unknown-{self.kind}", hint=hint)
            place = found.value
        module, _, attribute = place.partition(":")
        try:
            return getattr(import_module(module), attribute)
        except (ImportError, AttributeError, ValueError) as error:
            message = f"cannot load '{name}': {error}"
            raise UsageError(message, code=f"unknown-{self.kind}") from None
