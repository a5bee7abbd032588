"""The traces of a study's episodes: one file each, below the table and the cell that it is of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from urllib.parse import quote

from hrcplan.core.files import make_folder, write_atomically
from hrcplan.errors import UsageError
from hrcplan.inference.traces import ActionTrace
from hrcplan.studies.study import Episode, Study, StudyOptions, StudyRow

SUFFIX = ".jsonl"
_PLAIN = " ,=+@-._"  # characters of a cell's name that are the same in that of its folder
PDDL = "pddl"
SELECTIONS = ("methods", "humans")
"""Options that only select cells, which the cell says already."""
_LONGEST = 120  # characters of a cell's name that its folder has


def trace_path(folder: Path, episode: Episode) -> Path:
    """Return the file of an episode's trace.

    >>> str(trace_path(Path("t"), Episode("rows", ("optimal", "my:Robot"), 7)))
    't/rows/optimal/my%3ARobot/00007.jsonl'
    """
    parts = [quote(str(part), safe=_PLAIN)[:_LONGEST].strip(".") or "-" for part in episode.cell]
    return folder.joinpath(episode.table, *parts, f"{episode.run:05}{SUFFIX}")


@dataclass(frozen=True, slots=True)
class EpisodeResult:
    """An episode with its row, and its trace if that was wanted."""

    episode: Episode
    row: StudyRow
    trace: ActionTrace | None


class TraceFiles:
    """The traces of a study in a folder.

    Args:
        folder: The folder; it need not exist.
        study: The study.
        episodes: The episodes that will be traced.

    Raises:
        UsageError: if one is of a table that has no traces.
    """

    def __init__(self, folder: Path, study: Study, episodes: Sequence[Episode]) -> None:
        self.folder, self.study = folder, study
        for name in dict.fromkeys(episode.table for episode in episodes):
            if study.table(name).traced is None:
                message = f"{study.name} has no traces of its table '{name}'"
                raise UsageError(message, code="no-traces")

    def missing(self, episodes: Sequence[Episode], without_row: Sequence[Episode]) -> list[Episode]:
        """Return the episodes that lack a row or a trace, in their order."""
        rowless = set(without_row)
        return [
            episode for episode in episodes
            if episode in rowless or not trace_path(self.folder, episode).is_file()
        ]  # fmt: skip

    def write_pddl(self, options: StudyOptions) -> None:
        """Write the PDDL of the study's tasks to the folder ``pddl``, if the study has some.

        Raises:
            UsageError: if that is not possible.
        """
        for name, text in self.study.pddl(options).items():
            _write(self.folder / PDDL / name, text)

    def write(self, options: StudyOptions, seed: int, results: Sequence[EpisodeResult]) -> None:
        """Write the traces of episodes.

        Raises:
            UsageError: if that is not possible.
        """
        for result in results:
            if result.trace is not None:
                text = self._text(options, seed, result.episode, result.trace)
                _write(trace_path(self.folder, result.episode), text)

    def _text(self, options: StudyOptions, seed: int, episode: Episode, trace: ActionTrace) -> str:
        """Return the text of a trace that says which episode it is of."""
        assert trace.episode is not None
        own = {
            key: value for key, value in options.items()
            if value != self.study.options.get(key) and key not in SELECTIONS
        }  # fmt: skip
        named = replace(
            trace.episode, study=self.study.name, version=self.study.version, table=episode.table,
            cell=tuple(map(str, episode.cell)), run=episode.run, seed=seed, options=own,
        )  # fmt: skip
        return replace(trace, episode=named).text()


def _write(path: Path, text: str) -> None:
    make_folder(path.parent)
    write_atomically(path, text)
