"""Batches of episodes that wait for a worker, and what becomes of those that fail.

A batch that fails is run again, up to ``RETRIES`` times; then its episodes are run one by one, and
those that fail once more are in quarantine: they get no row in this run.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from hrcplan.studies.study import Episode

RETRIES = 3


@dataclass(frozen=True, slots=True)
class EpisodeBatch:
    """Episodes that one worker runs, and how often they have failed."""

    episodes: Sequence[Episode]
    n_failures: int = 0


class Backlog:
    """The batches of a part of a study; it belongs to the event loop that it is made in.

    Attributes:
        quarantine: The episodes that get no row, and why.
        done: Set when every episode has a row or is in quarantine.
    """

    def __init__(self, batches: Iterable[Sequence[Episode]]) -> None:
        self.quarantine: dict[Episode, str] = {}
        self.done = asyncio.Event()
        self._waiting: asyncio.Queue[EpisodeBatch] = asyncio.Queue()
        self._n_open = 0
        for episodes in batches:
            self._open(EpisodeBatch(episodes))
        if not self._n_open:
            self.done.set()

    async def take(self) -> EpisodeBatch:
        """Return the next batch; wait for one, since batches that others have may come back."""
        return await self._waiting.get()

    def close(self, batch: EpisodeBatch) -> None:
        """Note that nothing more will come of a batch: its rows are there."""
        self._n_open -= 1
        if not self._n_open:
            self.done.set()

    def put_back(self, batch: EpisodeBatch) -> None:
        """Let another worker take a batch whose worker may not or cannot run it."""
        self._waiting.put_nowait(batch)

    def fail(self, batch: EpisodeBatch, why: str) -> None:
        """Let a batch that has failed be run again, as a whole or one by one, or not at all."""
        if batch.n_failures < RETRIES:
            self.put_back(replace(batch, n_failures=batch.n_failures + 1))
            return
        if len(batch.episodes) == 1:
            self.quarantine[batch.episodes[0]] = why
        else:
            for episode in batch.episodes:
                self._open(EpisodeBatch((episode,), RETRIES))
        self.close(batch)

    def _open(self, batch: EpisodeBatch) -> None:
        self._n_open += 1
        self.put_back(batch)
