"""Rows on disk: one SQLite file, one row per episode, keyed by its cell.

Rows are only ever added, and an episode that is there already stays as it is. So a study that was
killed at any moment goes on where it stopped. What a clock has measured is no part of that: it has
a file of its own, so that equal runs give equal bytes.
"""

from __future__ import annotations

import fcntl
import json
import os
import sqlite3
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any

from hrcplan.core.files import make_folder
from hrcplan.core.json_values import DOCUMENT_FAULTS, JsonValue
from hrcplan.core.text import cut, harmless
from hrcplan.errors import InputError, UsageError
from hrcplan.studies.study import Episode, StudyRow, StudyTable

FILE, CLOCK = "rows.sqlite", "clock.sqlite"
MAX_VALUE = 1e15  # of a number in a row
MAX_REASON = 160  # characters of a fault that a message repeats
_ABOUT = "about"
_GROWN, _COMPACT = 0, 1  # the file's user_version


class Store:
    """The rows of one study in a folder; a context manager."""

    def __init__(self, folder: Path, connection: sqlite3.Connection) -> None:
        self.folder = folder
        self._connection = connection
        self._lock: int | None = None
        self._has_clock = False

    @classmethod
    def to_write(cls, folder: Path, about: dict[str, Any], tables: Iterable[StudyTable]) -> Store:
        """Return the store of a folder, made if there is none, for one writer at a time.

        ``about`` is everything that the rows depend on.

        Raises:
            UsageError: if the folder cannot be made or written to, another process writes to it,
                or it holds rows that depend on something else.
            InputError: if its files are damaged.
        """
        make_folder(folder)
        lock = _lock(folder)
        with _explain_errors(folder):
            store = cls(folder, sqlite3.connect(folder / FILE))
        store._lock = lock
        try:
            with _explain_errors(folder):
                store._prepare(about, tables)
        except BaseException:
            store.close()
            raise
        return store

    @classmethod
    def to_read(cls, folder: Path) -> Store:
        """Return the store of a folder.

        Raises:
            UsageError: if its files cannot be opened.
            InputError: if there is none, or its files are damaged.
        """
        path = folder / FILE
        if not os.path.isfile(path):
            hint = "hrcplan study run NAME -o DIR makes one"
            raise InputError(f"no {FILE} in {folder}", code="no-file", path=str(path), hint=hint)
        with _explain_errors(folder):
            store = cls(folder, sqlite3.connect(path))
            if os.path.isfile(folder / CLOCK):
                store._open_clock()
        return store

    def __enter__(self) -> Store:
        """Return the store itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:  # fmt: skip
        """Close the file and let other writers in; an error of SQLite becomes one of hrcplan."""
        self.close()
        with _explain_errors(self.folder):
            if isinstance(error, sqlite3.Error | UnicodeDecodeError):
                raise error

    def close(self) -> None:
        """Close the file and let other writers in."""
        self._connection.close()
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None

    def _prepare(self, about: dict[str, Any], tables: Iterable[StudyTable]) -> None:
        with self._connection as connection:
            columns = "(key text primary key, value) without rowid"
            connection.execute(f"create table if not exists {_ABOUT} {columns}")
            tables = list(tables)
            for table in tables:
                connection.execute(_create(table))
            before = self.about()
            if not before:
                pairs = [(key, json.dumps(value)) for key, value in about.items()]
                connection.executemany(f"insert into {_ABOUT} values (?, ?)", pairs)
        if any(table.clocked for table in tables):
            self._open_clock()
            for table in (table for table in tables if table.clocked):
                self._connection.execute(_create(table, "clock."))
        for key, value in about.items():
            if before and before.get(key) != value:
                message = f"{self.folder} holds rows of {key} {before.get(key)}, not {value}"
                raise UsageError(message, code="other-rows", hint="take a new folder")

    def _open_clock(self) -> None:
        self._connection.execute("attach ? as clock", [str(self.folder / CLOCK)])
        self._has_clock = True

    def about(self) -> dict[str, Any]:
        """Return what the rows depend on.

        Raises:
            InputError: if the file is no store of rows.
        """
        try:
            pairs = self._connection.execute(f"select key, value from {_ABOUT}").fetchall()
        except (sqlite3.DatabaseError, UnicodeDecodeError) as error:
            path = str(self.folder / FILE)
            raise InputError(f"not a file of rows: {error}", code="bad-rows", path=path) from None
        try:
            about = {key: json.loads(value) for key, value in pairs}
        except DOCUMENT_FAULTS as error:
            raise self._damage(f"what they depend on is no JSON: {error}") from None
        if fault := _about_fault(about):
            raise self._damage(fault)
        return about

    def _damage(self, reason: str) -> InputError:
        path = harmless(str(self.folder / FILE))
        message = f"the rows in {path} are damaged: {cut(harmless(reason), MAX_REASON)}"
        return InputError(message, code="bad-rows", path=path)

    def missing(self, tables: Iterable[StudyTable], episodes: Iterable[Episode]) -> list[Episode]:
        """Return the episodes that have no row yet, in their order."""
        present = {
            Episode(table.name, tuple(cell), run)
            for table in tables
            for *cell, run in self._connection.execute(
                f"select {_names((*table.keys, 'run'))} from {table.name}"
            )
        }
        return [episode for episode in episodes if episode not in present]

    def add(self, table: StudyTable, rows: Sequence[tuple[Episode, StudyRow]]) -> None:
        """Add rows in one transaction; those that are there already stay."""
        with self._connection as connection:
            if table.clocked:
                into = f"insert or replace into clock.{table.name}"
                connection.executemany(*_insert(into, rows, table.clocked))
            into = f"insert or ignore into main.{table.name}"
            connection.executemany(*_insert(into, rows, table.columns))
            connection.execute(f"pragma main.user_version = {_GROWN}")

    def rows(self, table: StudyTable) -> list[StudyRow]:
        """Return all rows of a table, keys and run included, in the order of cells and runs."""
        more = ""
        if table.clocked and self._has_clock:
            more = f" left join clock.{table.name} using ({_names((*table.keys, 'run'))})"
        tables = self._connection.execute("select name from main.sqlite_master").fetchall()
        if (table.name,) not in tables:
            return []  # written before the study had this table
        cursor = self._connection.execute(f"select * from main.{table.name}{more}")
        names = [column[0] for column in cursor.description]
        if missing := {*table.keys, "run", *table.columns} - {*names, *table.grown}:
            raise self._damage(f"{table.name} has no column {min(missing)}")
        records = [dict(zip(names, row, strict=True)) for row in cursor]
        for row in records:
            if wrong := next((n for n, value in row.items() if not _is_value(value)), None):
                raise self._damage(f"{table.name} holds {wrong} = {row[wrong]!r}")
            row |= {name: of(row) for name, of in table.grown.items() if name not in names}
        return records

    @property
    def is_compact(self) -> bool:
        """Whether no row was added since the file was rewritten."""
        (version,) = self._connection.execute("pragma main.user_version").fetchone()
        return bool(version == _COMPACT)

    def compact(self) -> None:
        """Rewrite the file, so that its bytes depend on its rows and not on how they came."""
        path, fresh = self.folder / FILE, self.folder / f".{FILE}.new"
        fresh.unlink(missing_ok=True)
        tables = self._connection.execute("select name, sql from sqlite_master").fetchall()
        self._connection.close()
        copy = sqlite3.connect(fresh)
        copy.execute("attach ? as old", [str(path)])
        with copy:
            for name, statement in sorted(tables):
                if statement is not None:  # an index that SQLite makes by itself
                    copy.execute(statement)
                    copy.execute(f"insert into main.{name} select * from old.{name} order by 1, 2")
        copy.execute(f"pragma main.user_version = {_COMPACT}")
        copy.close()
        fresh.replace(path)
        self._connection = sqlite3.connect(path)
        if self._has_clock:
            self._open_clock()
        for stray in self.folder.glob(f"{FILE}-mj*"):  # what a kill left of a commit to two files
            stray.unlink()


def _about_fault(about: dict[str, Any]) -> str | None:
    """Return what is wrong with the entries that every study has, if they are there."""
    options = about.get("options", {})
    values = options.values() if isinstance(options, dict) else [0]
    if any(type(value) not in (str, type(None)) for value in values):
        return "options are texts by name"
    kinds = {"study": str, "version": str, "seed": int, "inputs_sha256": str}
    wrong = (k for k, kind in kinds.items() if k in about and type(about[k]) is not kind)
    return next((f"{key} is {about[key]!r}" for key in wrong), None)


def _is_value(value: JsonValue) -> bool:
    """Whether a value is one that rows hold: text, nothing, or a number of sensible size."""
    if isinstance(value, (int, float)):
        return abs(value) < MAX_VALUE  # not so of nan
    return value is None or isinstance(value, str)


@contextmanager
def _explain_errors(folder: Path) -> Iterator[None]:
    """Say of errors of SQLite what the caller can do about them."""
    try:
        yield
    except sqlite3.OperationalError as error:  # it may not be opened or written, or is locked
        message = f"cannot use the rows in {folder}: {error}"
        raise UsageError(message, code="no-access", path=str(folder)) from None
    # A message of SQLite quotes the file, so it may be no UTF-8 either.
    except (sqlite3.DatabaseError, UnicodeDecodeError) as error:
        message = f"the rows in {folder} are damaged: {error}"
        raise InputError(message, code="bad-rows", path=str(folder)) from None


def _insert(
    into: str, rows: Sequence[tuple[Episode, StudyRow]], columns: Sequence[str]
) -> tuple[str, list[tuple[Any, ...]]]:
    """Return a statement that adds the named columns of rows, and its values."""
    values = [(*e.cell, e.run, *(row[name] for name in columns)) for e, row in rows]
    width = len(values[0]) if values else 0
    return f"{into} values ({', '.join('?' * width)})", values


def _create(table: StudyTable, file: str = "") -> str:
    """Return the statement that makes a table; without rowid, so it is sorted by its key."""
    keys = (*table.keys, "run")
    fields = table.clocked if file else table.columns
    columns = ", ".join(_quote(name) for name in (*keys, *fields))
    return (
        f"create table if not exists {file}{table.name} "
        f"({columns}, primary key ({_names(keys)})) without rowid"
    )


def _quote(name: str) -> str:
    return f'"{name}"'  # "case" is a word of SQL


def _names(names: Iterable[str]) -> str:
    return ", ".join(map(_quote, names))


def _lock(folder: Path) -> int:
    """Return a handle that keeps other writers out of a folder until it is closed."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(handle)
        message = f"another process writes to {folder}"
        raise UsageError(message, code="busy", path=str(folder)) from None
    return handle
