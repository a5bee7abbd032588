"""Who runs the episodes of a study: an interface, and the processes of this machine."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import TracebackType
from typing import Protocol, Self

from hrcplan.core.safe_path import safe_path
from hrcplan.inference.traces import ActionTrace
from hrcplan.studies.study import Episode, Seed, Study, StudyOptions, StudyRow, find
from hrcplan.studies.trace_files import EpisodeResult

_FEW = 16  # episodes that one process has done before others have prepared what they need
_CHUNK = 32  # episodes that are run before their rows are written: what a kill can lose


@dataclass(frozen=True, slots=True)
class StudyWork:
    """What the results of episodes depend on: the study by its name, its options, and the seed.

    ``is_traced`` says whether traces are wanted, too.
    """

    study: str
    options: tuple[tuple[str, str], ...]
    seed: int
    is_traced: bool = False

    @classmethod
    def of(
        cls, study: str, options: StudyOptions, seed: int, *, is_traced: bool = False
    ) -> StudyWork:
        """Return the work of a study with options."""
        return cls(study, tuple(options.items()), seed, is_traced)


class EpisodeRunner(Protocol):
    """Runs episodes; a context manager that ends its processes or its connection."""

    @property
    def failures(self) -> Mapping[Episode, str]:
        """Why there is no row, by episode, after the rest has been run."""
        ...

    def __enter__(self) -> Self:
        """Return the runner, ready to run."""
        ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:  # fmt: skip
        """End what the runner has started."""
        ...

    def run(self, episodes: Sequence[Episode]) -> Iterator[list[EpisodeResult]]:
        """Yield the results of episodes, some at a time, in any order."""
        ...


class LocalRunner:
    """Runs episodes in processes of this machine; an episode that raises ends the run.

    Args:
        work: What results depend on.
        jobs: Processes, if there are enough episodes for more than one.
    """

    failures: Mapping[Episode, str] = {}

    def __init__(self, work: StudyWork, jobs: int) -> None:
        self._work, self._jobs = work, jobs

    def __enter__(self) -> Self:
        """Return the runner itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:  # fmt: skip
        """Do nothing: joblib ends its processes."""

    def run(self, episodes: Sequence[Episode]) -> Iterator[list[EpisodeResult]]:
        """Yield results in the order of the episodes, not in that of their ends."""
        batches = in_batches(episodes)
        if self._jobs == 1 or len(episodes) < _FEW:
            yield from (results_of(self._work, batch) for batch in batches)
            return
        from joblib import Parallel, delayed

        workers = Parallel(n_jobs=self._jobs, return_as="generator", batch_size=1,
                           initializer=end_with, initargs=(os.getpid(),))  # fmt: skip
        with safe_path():
            yield from workers(delayed(results_of)(self._work, batch) for batch in batches)


def in_batches(episodes: Sequence[Episode]) -> list[Sequence[Episode]]:
    """Return episodes in batches that grow, so that progress shows after the first episode.

    >>> [len(batch) for batch in in_batches(range(100))]
    [1, 1, 2, 4, 8, 16, 32, 32, 4]
    """
    batches, at = [], 0
    while at < len(episodes):
        size = min(_CHUNK, max(1, at))
        batches.append(episodes[at : at + size])
        at += size
    return batches


def results_of(work: StudyWork, episodes: Sequence[Episode]) -> list[EpisodeResult]:
    """Return the results of episodes; what an episode raises has a note that names the episode."""
    study, options = find(work.study), dict(work.options)
    return [EpisodeResult(e, *_row(study, options, work, e)) for e in episodes]


def _row(
    study: Study, options: StudyOptions, work: StudyWork, episode: Episode
) -> tuple[StudyRow, ActionTrace | None]:
    table, seed = study.table(episode.table), Seed(work.seed, episode.run)
    try:
        if work.is_traced and table.traced is not None:
            return table.traced(options, episode.cell, seed)
        return table.episode(options, episode.cell, seed), None
    except Exception as error:
        error.add_note(f"in {episode.table}, cell {episode.cell}, run {episode.run}")
        raise


def end_with(parent: int) -> None:
    """End this worker soon after its parent was killed: it would wait for work for minutes."""

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(1)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
