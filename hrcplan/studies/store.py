"""Rows on disk: one SQLite file, one row per episode, keyed by its cell.

Rows are only ever added, and an episode that is there already stays as it is. So a study that was
killed at any moment goes on where it stopped.
"""

from __future__ import annotations

import fcntl
import json
import os
import sqlite3
from collections.abc import Iterable, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

from hrcplan.errors import InputError, UsageError
from hrcplan.studies.study import Episode, Row, Table

FILE = "rows.sqlite"
_ABOUT = "about"


class Store:
    """The rows of one study in a folder; a context manager."""

    def __init__(self, folder: Path, connection: sqlite3.Connection) -> None:
        self.folder = folder
        self._connection = connection
        self._lock: int | None = None

    @classmethod
    def to_write(cls, folder: Path, about: dict[str, Any], tables: Iterable[Table]) -> Store:
        """Return the store of a folder, made if there is none, for one writer at a time.

        ``about`` is everything that the rows depend on.

        Raises:
            UsageError: if the folder cannot be made, another process writes to it, or it holds
                rows that depend on something else.
        """
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise UsageError(f"cannot make {folder}: {error.strerror}", path=str(folder)) from None
        lock = _locked(folder)
        store = cls(folder, sqlite3.connect(folder / FILE))
        store._lock = lock
        try:
            store._prepare(about, tables)
        except BaseException:
            store.close()
            raise
        return store

    @classmethod
    def to_read(cls, folder: Path) -> Store:
        """Return the store of a folder.

        Raises:
            InputError: if there is none.
        """
        path = folder / FILE
        if not path.is_file():
            hint = "hrcplan study run NAME -o DIR makes one"
            raise InputError(f"no {FILE} in {folder}", code="no-file", path=str(path), hint=hint)
        return cls(folder, sqlite3.connect(path))

    def __enter__(self) -> Store:
        """Return the store itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:  # fmt: skip
        """Close the file and let other writers in."""
        self.close()

    def close(self) -> None:
        """Close the file and let other writers in."""
        self._connection.close()
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None

    def _prepare(self, about: dict[str, Any], tables: Iterable[Table]) -> None:
        with self._connection as connection:
            columns = "(key text primary key, value) without rowid"
            connection.execute(f"create table if not exists {_ABOUT} {columns}")
            for table in tables:
                connection.execute(_create(table))
            found = self.about()
            if not found:
                pairs = [(key, json.dumps(value)) for key, value in about.items()]
                connection.executemany(f"insert into {_ABOUT} values (?, ?)", pairs)
        for key, value in about.items():
            if found and found.get(key) != value:
                message = f"{self.folder} holds rows of {key} {found.get(key)}, not {value}"
                raise UsageError(message, code="other-rows", hint="take a new folder")

    def about(self) -> dict[str, Any]:
        """Return what the rows depend on.

        Raises:
            InputError: if the file is no store of rows.
        """
        try:
            pairs = self._connection.execute(f"select key, value from {_ABOUT}").fetchall()
        except sqlite3.DatabaseError as error:
            path = str(self.folder / FILE)
            raise InputError(f"not a file of rows: {error}", code="bad-rows", path=path) from None
        return {key: json.loads(value) for key, value in pairs}

    def missing(self, tables: Iterable[Table], wanted: Iterable[Episode]) -> list[Episode]:
        """Return the episodes that have no row yet, in their order."""
        known = {
            Episode(table.name, tuple(cell), run)
            for table in tables
            for *cell, run in self._connection.execute(
                f"select {_names((*table.keys, 'run'))} from {table.name}"
            )
        }
        return [episode for episode in wanted if episode not in known]

    def add(self, table: Table, rows: Sequence[tuple[Episode, Row]]) -> None:
        """Add rows in one transaction; those that are there already stay."""
        marks = ", ".join("?" * (len(table.keys) + 1 + len(table.columns)))
        values = [(*e.cell, e.run, *(row[name] for name in table.columns)) for e, row in rows]
        with self._connection as connection:
            connection.executemany(f"insert or ignore into {table.name} values ({marks})", values)

    def rows(self, table: Table) -> list[Row]:
        """Return all rows of a table, keys and run included, in the order of cells and runs."""
        try:
            cursor = self._connection.execute(f"select * from {table.name}")
        except sqlite3.DatabaseError:
            return []  # written before the study had this table
        names = [column[0] for column in cursor.description]
        return [dict(zip(names, row, strict=True)) for row in cursor]

    def compact(self) -> None:
        """Write the file anew, so that its bytes depend on its rows and not on how they came."""
        path, fresh = self.folder / FILE, self.folder / f".{FILE}.new"
        fresh.unlink(missing_ok=True)
        tables = self._connection.execute("select name, sql from sqlite_master").fetchall()
        self._connection.close()
        made = sqlite3.connect(fresh)
        made.execute("attach ? as old", [str(path)])
        with made:
            for name, statement in sorted(tables):
                if statement is not None:  # an index that SQLite makes by itself
                    made.execute(statement)
                    made.execute(f"insert into main.{name} select * from old.{name} order by 1, 2")
        made.close()
        fresh.replace(path)
        self._connection = sqlite3.connect(path)


def _create(table: Table) -> str:
    """Return the statement that makes a table; without rowid, so it is sorted by its key."""
    keys = (*table.keys, "run")
    columns = ", ".join(_quoted(name) for name in (*keys, *table.columns))
    return (
        f"create table if not exists {table.name} "
        f"({columns}, primary key ({_names(keys)})) without rowid"
    )


def _quoted(name: str) -> str:
    return f'"{name}"'  # "case" is a word of SQL


def _names(names: Iterable[str]) -> str:
    return ", ".join(map(_quoted, names))


def _locked(folder: Path) -> int:
    """Return a handle that keeps other writers out of a folder until it is closed."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(handle)
        message = f"another process writes to {folder}"
        raise UsageError(message, code="busy", path=str(folder)) from None
    return handle
