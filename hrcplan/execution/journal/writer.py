"""Journals are written: every line is on disk before a decision is acted on."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any, Protocol, TypeVar

from hrcplan import __version__
from hrcplan.errors import InputError, UsageError
from hrcplan.execution.codec import KINDS, Item, to_json
from hrcplan.execution.journal.file import JournalFile
from hrcplan.execution.journal.reader import FORMAT, Journal, event_in

E = TypeVar("E", bound=Item)


class HasJson(Protocol):
    """What a journal begins and ends with: a setup, and an outcome."""

    def to_json(self) -> dict[str, Any]:
        """Return it as a JSON object."""


class JournalWriter:
    """Appends to a journal; a run that is resumed first goes over the lines that are there.

    Lines are written at once, and on disk before a decision is acted on. ``kinds`` are the classes
    of events and commands.
    """

    def __init__(
        self, file: JournalFile, journal: Journal | None = None,
        kinds: Mapping[str, type] = KINDS,
    ) -> None:  # fmt: skip
        self.path = file.path
        self._kinds = kinds
        self._file = file
        self._past_lines = () if journal is None else journal.lines
        self._position = 1

    @property
    def is_repeating(self) -> bool:
        """Whether the run still goes over what was recorded before."""
        return self._position < len(self._past_lines)

    def record_event(self, event: E) -> E:
        """Write an event down and return it as it can be read again.

        Raises:
            InputError: if the journal has another event at this place.
        """
        line = self._line({"event": to_json(event)})
        return event_in(line, self._position, self.path, self._kinds)  # type: ignore[no-any-return]

    def record_decision(self, commands: Sequence[Item]) -> None:
        """Write down what the monitor decided.

        Raises:
            InputError: if the journal has another decision at this place.
        """
        self._line({"decided": [to_json(command) for command in commands]})
        if commands and not self.is_repeating:
            self._file.sync()  # what is acted on is on disk, with all that came before it

    def recorded_answer(self, kind: type[E]) -> E | None:
        """Return the event that was recorded at this place, if it is of a kind."""
        line = self._past_lines[self._position] if self.is_repeating else {}
        event = line.get("event")
        if not isinstance(event, dict) or event.get("kind") != kind.__name__.lower():
            return None
        return event_in(line, self._position + 1, self.path, self._kinds)  # type: ignore[no-any-return]

    def finish(self, outcome: HasJson) -> None:
        """Write the outcome, the last line."""
        self._line({"row": outcome.to_json()})
        self._file.sync()

    def _line(self, content: Mapping[str, Any]) -> Mapping[str, Any]:
        line = json.loads(json.dumps({"seq": self._position, **content}))
        if self.is_repeating:
            if self._past_lines[self._position] != line:
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
        self._file.append(text.encode("utf-8", "backslashreplace"))

    @classmethod
    def begin(
        cls, file: JournalFile, setup: HasJson, journal_format: int = FORMAT,
        kinds: Mapping[str, type] = KINDS,
    ) -> JournalWriter:  # fmt: skip
        """Return the writer of a new journal whose first line is the setup.

        Raises:
            UsageError: if the file holds anything, or cannot be written.
        """
        if file.n_bytes:
            hint = "--resume goes on with it; or name another file"
            raise UsageError("the journal exists already", path=str(file.path), hint=hint)
        writer = cls(file, kinds=kinds)
        head = {"seq": 0, "journal": journal_format, "hrcplan": __version__}
        writer._append({**head, **setup.to_json()})
        return writer

    @classmethod
    def resume(
        cls, file: JournalFile, journal: Journal, kinds: Mapping[str, type] = KINDS
    ) -> JournalWriter:
        """Return the writer that goes over a journal and then on; a torn last line is cut off."""
        file.cut(journal.n_bytes)
        return cls(file, journal, kinds)
