"""Journals are written: every line is on disk before a decision is acted on."""

from __future__ import annotations

import fcntl
import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from hrcplan import __version__
from hrcplan.errors import InputError, UsageError
from hrcplan.execution import events as ev
from hrcplan.execution.codec import from_json, to_json
from hrcplan.execution.events import Command, Event
from hrcplan.execution.journal.reader import FORMAT, Journal
from hrcplan.execution.journal.setup import RunSetup
from hrcplan.execution.outcome import Outcome


class JournalWriter:
    """Appends to a journal; a run that is resumed first goes over the lines that are there.

    Lines are written at once, and on disk before a decision is acted on.
    """

    def __init__(self, path: Path, recorded: Sequence[Mapping[str, Any]], n_bytes: int) -> None:
        self.path = path
        self._recorded = recorded
        self._position = 1
        try:
            self._file = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            os.ftruncate(self._file, n_bytes)
            os.lseek(self._file, n_bytes, os.SEEK_SET)
        except BlockingIOError:
            message = "another process is writing this journal"
            raise UsageError(message, path=str(path)) from None
        except OSError as error:
            raise self._refused(error) from None

    def _refused(self, error: OSError) -> UsageError:
        message = f"cannot write the journal: {error.strerror}"
        return UsageError(message, path=str(self.path))

    @property
    def is_repeating(self) -> bool:
        """Whether the run still goes over what was recorded before."""
        return self._position < len(self._recorded)

    def record_event(self, event: Event) -> Event:
        """Write an event down and return it as it can be read again.

        Raises:
            InputError: if another event stands in the journal at this place.
        """
        line = self._line({"event": to_json(event)})
        return from_json(line["event"])  # type: ignore[no-any-return]

    def record_decision(self, commands: tuple[Command, ...]) -> None:
        """Write down what the monitor decided.

        Raises:
            InputError: if another decision stands in the journal at this place.
        """
        self._line({"decided": [to_json(command) for command in commands]})
        if commands and not self.is_repeating:
            os.fsync(self._file)  # what is acted on is on disk, with all that came before it

    def recorded_plan(self) -> ev.Planned | None:
        """Return the plan that was recorded at this place, if any."""
        event = self._recorded[self._position].get("event") if self.is_repeating else None
        if event is None or event.get("kind") != "planned":
            return None
        return from_json(event)  # type: ignore[no-any-return]

    def close(self, outcome: Outcome) -> None:
        """Write the outcome and close the file."""
        self._line({"row": outcome.to_json()})
        os.fsync(self._file)
        os.close(self._file)

    def _line(self, content: Mapping[str, Any]) -> Mapping[str, Any]:
        line = json.loads(json.dumps({"seq": self._position, **content}))
        if self.is_repeating:
            if self._recorded[self._position] != line:
                raise InputError(
                    "the journal goes another way than the run; was it made by this version?",
                    code="bad-journal", path=str(self.path), line=self._position + 1,
                    hint="hrcplan replay JOURNAL shows the first difference",
                )  # fmt: skip
        else:
            self._append(line)
        self._position += 1
        return line  # type: ignore[no-any-return]

    def _append(self, line: Mapping[str, Any]) -> None:
        text = json.dumps(line, ensure_ascii=False, separators=(",", ":")) + "\n"
        data = text.encode()
        try:
            while data:
                data = data[os.write(self._file, data) :]
        except OSError as error:  # no room left
            raise self._refused(error) from None

    @classmethod
    def begin(cls, path: Path, setup: RunSetup) -> JournalWriter:
        """Return the writer of a new journal whose first line is the setup.

        Raises:
            UsageError: if the file exists and holds anything, or cannot be written.
        """
        if path.exists() and (path.is_dir() or path.stat().st_size):
            hint = "--resume goes on with it; or name another file"
            raise UsageError("the journal exists already", path=str(path), hint=hint)
        writer = cls(path, (), 0)
        writer._append({"seq": 0, "journal": FORMAT, "hrcplan": __version__, **setup.to_json()})
        return writer

    @classmethod
    def resume(cls, journal: Journal) -> JournalWriter:
        """Return the writer that goes over a journal and then on; a torn last line is cut off."""
        return cls(journal.path, journal.lines, journal.n_bytes)
