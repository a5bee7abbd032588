"""Journals are read: complete lines only, each checked."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hrcplan.core.files import read_bytes
from hrcplan.errors import InputError
from hrcplan.execution.codec import from_json
from hrcplan.execution.journal.setup import RunSetup, setup_from_json

FORMAT = 1


@dataclass(frozen=True)
class Journal:
    """What a journal file holds: complete lines only, and how many bytes they take."""

    path: Path
    lines: tuple[dict[str, Any], ...]
    n_bytes: int

    @property
    def is_empty(self) -> bool:
        """Whether not even the first line was written."""
        return not self.lines

    def setup(self) -> RunSetup:
        """Return what the run depends on.

        Raises:
            InputError: if the first line does not say so.
        """
        head = self.lines[0] if self.lines else {}
        if head.get("journal") != FORMAT:
            message = f"this is no journal of format {FORMAT}"
            if isinstance(head.get("journal"), int):
                message = (
                    f"a journal of format {head['journal']}; that of a run has format {FORMAT}"
                )
            raise InputError(message, code="bad-journal", path=str(self.path), line=1)
        return setup_from_json(head, str(self.path))


def read_journal(path: Path) -> Journal:
    """Return a journal without its torn last line, if there is one.

    Raises:
        InputError: if the file is missing, a line before the last is damaged, or a number is
            missing or out of order.
    """
    return journal_in(path, read_bytes(path, limit=None))


def journal_in(path: Path, raw: bytes) -> Journal:
    """Return the journal that the content of a file holds; see ``read_journal``."""
    lines: list[dict[str, Any]] = []
    whole = raw[: raw.rfind(b"\n") + 1]
    for number, text in enumerate(whole.splitlines(), start=1):
        lines.append(_line(text, number, path))
    return Journal(path, tuple(lines), len(whole))


def event_in(line: Mapping[str, Any], number: int, path: Path, kinds: Mapping[str, type]) -> Any:
    """Return the event that a line of a journal holds; ``kinds`` as for ``codec.from_json``.

    Raises:
        InputError: if it holds none.
    """
    try:
        return from_json(line["event"], kinds)
    except (KeyError, ValueError) as error:
        message = f"line {number} of the journal holds no event: {error}"
        raise InputError(message, code="bad-journal", path=str(path), line=number) from None


def _line(text: bytes, number: int, path: Path) -> dict[str, Any]:
    try:
        line = json.loads(text)
        if isinstance(line, dict) and line["seq"] == number - 1:
            return line
        reason = f"its number is not {number - 1}"
    except (ValueError, KeyError, RecursionError):
        reason = "it is damaged"
    message = f"line {number} of the journal cannot be used: {reason}"
    raise InputError(message, code="bad-journal", path=str(path), line=number)
