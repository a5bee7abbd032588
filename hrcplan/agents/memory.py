"""What failures teach: which elements of an agent's state may have caused them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from hrcplan.pddl.model import FluentKey


@dataclass(frozen=True, slots=True)
class Memory:
    """Sets of suspects, one per failure not yet explained away.

    ``cleared`` are elements that an action went well with; they are suspected only where nothing
    else is left. The cause is one suspect of each set, all equally likely.
    """

    failures: tuple[frozenset[FluentKey], ...] = ()
    cleared: frozenset[FluentKey] = frozenset()

    def failed(self, suspects: Iterable[FluentKey]) -> Memory:
        """Return the memory after an action that ``suspects`` touch has failed."""
        blamed_keys = frozenset(suspects)
        if not blamed_keys:
            return self
        return Memory((*self.failures, blamed_keys), self.cleared)

    def went_well(self, touched: Iterable[FluentKey]) -> Memory:
        """Return the memory after an action that ``touched`` touch has succeeded."""
        return Memory(self.failures, self.cleared | frozenset(touched)) if self.failures else self

    def sensed(self, key: FluentKey) -> Memory:
        """Return the memory after a new value of ``key``: what was held against it is old."""
        rest = tuple(
            rest_of_suspects for suspects in self.failures if (rest_of_suspects := suspects - {key})
        )
        return Memory(rest, self.cleared - {key})

    def blame(self) -> dict[FluentKey, float]:
        """Return how likely each suspect makes an action fail again.

        One element that is in every set explains all failures, so suspects of later failures
        narrow down those of earlier ones.

        >>> Memory().failed([("a",), ("b",)]).failed([("b",), ("c",)]).blame()
        {('b',): 1.0}
        """
        shares: dict[FluentKey, float] = {}
        common: frozenset[FluentKey] = frozenset()
        for suspects in map(self._open, self.failures):
            common = common & suspects or suspects
            share = 1.0 / len(common)
            for key in sorted(common):
                shares[key] = max(shares.get(key, 0.0), share)
        return {key: share for key, share in shares.items() if key in common or share == 1.0}

    def _open(self, suspects: frozenset[FluentKey]) -> frozenset[FluentKey]:
        return suspects - self.cleared or suspects
