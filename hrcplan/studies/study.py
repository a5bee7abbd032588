"""The definition of a study: tables of episodes, and a report that depends on their rows alone.

A study names its cells and says how one episode is run; it knows nothing of files or processes.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path

from hrcplan.core.deprecation import warn_old_name
from hrcplan.core.registry import ObjectRegistry
from hrcplan.errors import UsageError
from hrcplan.inference.traces import ActionTrace
from hrcplan.studies.verdict import verdict_of

CellValue = int | float | str | None
StudyRow = dict[str, CellValue]
Cell = tuple[str | int | float, ...]
StudyOptions = Mapping[str, str]
Say = Callable[[str], None]


class Seed(str):
    """The seed of one run, as text: study seed and number of the run."""

    study: int
    run: int
    __slots__ = ("run", "study")

    def __new__(cls, study: int, run: int) -> Seed:
        """Return the seed of a run.

        >>> Seed(0, 17), Seed(0, 17).run
        ('0/17', 17)
        """
        seed = super().__new__(cls, f"{study}/{run}")
        seed.study, seed.run = study, run
        return seed


@dataclass(frozen=True, slots=True)
class StudyTable:
    """Episodes of one kind: each is a cell and the number of a run.

    ``cells`` lists the cells; ``episode`` returns the row of one episode from options, cell and
    seed, and nothing else decides about it, but for the ``clocked`` columns: they are measured by
    the clock and kept in a file of their own. The seed depends on study seed and run only, so that
    cells are paired. ``at_most`` is the largest number of runs per cell. ``grown`` are the columns
    that rows of earlier versions lack, with what their value is there. ``traced`` returns the same
    row as ``episode`` with a trace of the episode; None if a table has no traces.
    """

    name: str
    keys: tuple[str, ...]
    columns: tuple[str, ...]
    cells: Callable[[StudyOptions], Sequence[Cell]]
    episode: Callable[[StudyOptions, Cell, Seed], StudyRow]
    at_most: int | None = None
    clocked: tuple[str, ...] = ()
    grown: Mapping[str, Callable[[StudyRow], CellValue]] = field(default_factory=dict)
    traced: Callable[[StudyOptions, Cell, Seed], tuple[StudyRow, ActionTrace]] | None = None


@dataclass(frozen=True, slots=True)
class Claim:
    """A statement that the rows support or not; the page shows claims group by group.

    ``holds`` is None where there are too few runs to tell.
    """

    claim: str
    holds: bool | None
    evidence: str
    group: str = "Claims"

    @property
    def verdict(self) -> str:
        """``holds``, ``fails`` or ``too-few``."""
        return verdict_of(self.holds)


@dataclass(frozen=True, slots=True)
class Section:
    """A part of the page: a title, and its content as HTML."""

    title: str
    html: str


@dataclass(frozen=True, slots=True)
class Findings:
    """The content of a study's page; ``lead`` is the text at its top, as HTML."""

    lead: str
    claims: Sequence[Claim]
    sections: Sequence[Section]


StudyRows = Mapping[str, Sequence[StudyRow]]
"""The rows of every table, by its name, in the order of cells and runs."""


@dataclass(frozen=True, slots=True)
class Study:
    """A study; the first table holds what is reported by cell, the others what explains it.

    ``inputs`` returns the text of the files that rows depend on; where it has changed, rows made
    before are not added to. ``prepare`` makes what episodes need, with a number of processes, and
    is given a function that tells the user; cells that are ``is_ready`` without it begin before.
    ``files`` lists the files of the cache folder that episodes read, if they are there: a cluster
    sends them to workers that lack them.
    ``runs`` is how many runs a cell has by default. ``unit`` names the columns of which each
    combination counts once in a standard error: means over its rows are taken first, and those that
    share a value of a column are not taken as independent; without it every row counts. ``renamed``
    holds, by key column or option, the names of earlier versions with the present ones: they still
    work in options, and in rows that were written before. ``version`` is that of a benchmark.
    ``pddl`` returns the PDDL files of the study's tasks, by path: they are written with traces.
    """

    name: str
    title: str
    tables: tuple[StudyTable, ...]
    measures: tuple[str, ...]
    findings: Callable[[StudyOptions, StudyRows], Findings]
    inputs: Callable[[StudyOptions], str]
    details: tuple[str, ...] = ()
    options: StudyOptions = field(default_factory=dict)
    runs: Callable[[StudyOptions], int] = lambda options: 1000
    prepare: Callable[[StudyOptions, int, Say], None] = lambda options, jobs, say: None
    files: Callable[[StudyOptions], Sequence[Path]] = lambda options: ()
    is_ready: Callable[[Cell], bool] = lambda cell: True
    unit: tuple[str, ...] = ()
    renamed: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    version: str = ""
    pddl: Callable[[StudyOptions], Mapping[str, str]] = lambda options: {}

    def present_name(self, key: str, value: str) -> str:
        """Return a value of a key column or an option by the names of this version."""
        return present_name(value, self.renamed.get(key, {}))

    def present_rows(self, table: StudyTable, rows: Sequence[StudyRow]) -> list[StudyRow]:
        """Return rows of a table, their keys by the names of this version."""
        keys = [key for key in table.keys if key in self.renamed]
        return [
            {**row, **{key: self.present_name(key, str(row[key])) for key in keys}} for row in rows
        ]

    def table(self, name: str) -> StudyTable:
        """Return a table by its name."""
        return next(table for table in self.tables if table.name == name)

    def with_defaults(self, options: Mapping[str, str | None]) -> dict[str, str]:
        """Return all options, the given ones over the study's own.

        A name of an earlier version is replaced, with a DeprecationWarning.

        Raises:
            UsageError: if the study has no such option.
        """
        choice: dict[str, str] = {}
        for key, value in options.items():
            if value is not None:
                choice[key] = self.present_name(key, value)
                if choice[key] != value:
                    warn_old_name(f"option {key}", value, choice[key])
        for key in choice:
            if key not in self.options:
                names = ", ".join(self.options) or "none"
                raise UsageError(f"{self.name} has no option '{key}'", hint=f"options: {names}")
        return {**self.options, **choice}


def present_name(text: str, new_names: Mapping[str, str]) -> str:
    """Return a name, or names with commas between, by the names of this version.

    Args:
        text: The names.
        new_names: Names of earlier versions with the present ones.

    >>> present_name("old, in order", {"old": "new"}), present_name("x,old", {"old": "new"})
    ('new, in order', 'x,new')
    """
    for old, new in new_names.items():
        text = re.sub(rf"(^|,\s*){re.escape(old)}(?=,|$)", rf"\g<1>{new}", text)
    return text


@dataclass(frozen=True, slots=True)
class Episode:
    """The place of one row: a table, one of its cells, and the number of a run from 0."""

    table: str
    cell: Cell
    run: int


STUDIES: ObjectRegistry[Study] = ObjectRegistry(
    "study",
    {
        "failure-anticipation": "hrcplan.studies.failure_anticipation:STUDY",
        "changed-mind": "hrcplan.studies.changed_mind:STUDY",
        "participants": "hrcplan.studies.participants:STUDY",
        "collaboration": "hrcplan.studies.collaboration:STUDY",
        "switch": "hrcplan.studies.switch:STUDY",
    },
    "hrcplan.studies",
    Study,
)


def find(name: str) -> Study:
    """Return a study that a user has named, also their own as ``module:NAME``.

    Raises:
        UsageError: if there is none.
    """
    return STUDIES.find(name)


def episodes(
    study: Study, options: StudyOptions, runs: int, limit: int | None = None,
    tables: Sequence[str] = (),
) -> Iterator[Episode]:  # fmt: skip
    """Yield the episodes of a study in their fixed order.

    Those of the first table come run by run, each over all cells; those of the other tables follow,
    also run by run. ``limit`` bounds the episodes of all tables together; a larger one extends a
    smaller one. ``tables`` names the only tables that are run; then the first of them comes first.

    Raises:
        UsageError: if the study has no table of that name.
    """
    first, *others = _named(study, tables)
    main: Iterable[Episode] = _by_run([first], options, runs)
    rest: Iterable[Episode] = _by_run(others, options, runs)
    if limit is not None:
        main, rest = _shares(list(islice(main, limit)), list(islice(rest, limit)), limit)
    yield from main
    yield from rest


def _shares(
    main: Sequence[Episode], rest: Sequence[Episode], limit: int
) -> tuple[Sequence[Episode], Sequence[Episode]]:
    """Return the first episodes of the main table and of all others, ``limit`` of them together.

    The first run of the main table comes first. After it both get one in turn, but the others never
    begin a run that the main table has not completed.
    """
    n_cells = sum(episode.run == 0 for episode in main)
    n_main = n_rest = 0
    while n_main + n_rest < min(limit, len(main) + len(rest)):
        has_turn = n_rest < len(rest) and n_rest <= n_main - n_cells
        if n_main == len(main) or (has_turn and (rest[n_rest].run + 1) * n_cells <= n_main):
            n_rest += 1
        else:
            n_main += 1
    return main[:n_main], rest[:n_rest]


def _named(study: Study, names: Sequence[str]) -> list[StudyTable]:
    """Return the tables that are named, in the order of the study; all by default."""
    known = [table.name for table in study.tables]
    for name in names:
        if name not in known:
            message = f"{study.name} has no table '{name}'"
            raise UsageError(message, code="unknown-table", hint=f"tables: {', '.join(known)}")
    return [table for table in study.tables if not names or table.name in names]


def _by_run(tables: Sequence[StudyTable], options: StudyOptions, runs: int) -> Iterator[Episode]:
    """Yield the episodes of tables: the first run of every cell, then the second, and so on."""
    cells = [(table, cell) for table in tables for cell in table.cells(options)]
    for run in range(runs):
        for table, cell in cells:
            if table.at_most is None or run < table.at_most:
                yield Episode(table.name, cell, run)
