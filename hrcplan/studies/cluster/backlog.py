"""Episodes that wait for a worker, and what becomes of batches that fail.

A batch that fails is run again, up to ``RETRIES`` times; then its episodes are run one by one, and
those that fail once more are in quarantine: they get no row in this run.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from hrcplan.studies.study import Episode

RETRIES = 3
BATCH_S, PER_SLOT_S = 1.0, 0.02
"""How long a batch should take: at least the first, and the second for each slot. One scheduler
carries some hundred batches a second at most, however many workers there are."""
MAX_SIZE = 4096  # episodes of a batch


@dataclass(frozen=True, slots=True)
class EpisodeBatch:
    """Episodes that one worker runs, and how often they have failed."""

    episodes: Sequence[Episode]
    n_failures: int = 0


class Backlog:
    """The episodes of a part of a study; it belongs to the event loop that it is made in.

    Batches grow while they take less time than they should, and shrink towards the end, so that all
    workers end at about the same time.

    Attributes:
        quarantine: The episodes that get no row, and why.
        done: Set when every episode has a row or is in quarantine.
        n_slots: How many batches are run at a time.
    """

    def __init__(self, episodes: Iterable[Episode]) -> None:
        self.quarantine: dict[Episode, str] = {}
        self.done = asyncio.Event()
        self.n_slots = 1
        self._new = deque(episodes)
        self._again: asyncio.Queue[EpisodeBatch] = asyncio.Queue()
        self._size, self._n_open = 1, len(self._new)
        if not self._n_open:
            self.done.set()

    async def take(self) -> EpisodeBatch:
        """Return the next batch; wait for one, since batches that others have may come back."""
        if self._again.empty() and self._new:
            n_fair = -(-len(self._new) // (2 * self.n_slots))
            n = min(self._size, n_fair)
            return EpisodeBatch([self._new.popleft() for _ in range(n)])
        return await self._again.get()

    def close(self, batch: EpisodeBatch, seconds: float) -> None:
        """Note that the rows of a batch have come, and how long it took."""
        wanted_s = max(BATCH_S, PER_SLOT_S * self.n_slots)
        if len(batch.episodes) == self._size and seconds < wanted_s / 2:
            self._size = min(MAX_SIZE, 2 * self._size)
        elif len(batch.episodes) >= self._size and seconds > 2 * wanted_s:
            self._size = max(1, self._size // 2)
        self._remove(batch)

    def put_back(self, batch: EpisodeBatch) -> None:
        """Let another worker take a batch whose worker may not or cannot run it."""
        self._again.put_nowait(batch)

    def fail(self, batch: EpisodeBatch, why: str) -> None:
        """Let a batch that has failed be run again, as a whole or one by one, or not at all."""
        if batch.n_failures < RETRIES:
            self.put_back(replace(batch, n_failures=batch.n_failures + 1))
        elif len(batch.episodes) > 1:
            for episode in batch.episodes:
                self.put_back(EpisodeBatch((episode,), RETRIES))
        else:
            self.quarantine[batch.episodes[0]] = why
            self._remove(batch)

    def _remove(self, batch: EpisodeBatch) -> None:
        self._n_open -= len(batch.episodes)
        if not self._n_open:
            self.done.set()
