"""The text of one file: decoded strictly, with offsets turned into lines and columns."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Collection, Iterable, Sequence
from typing import TYPE_CHECKING

from hrcplan.core.files import UNPACK_HINT, archive_kind, read_bytes
from hrcplan.core.text import cut, nearest
from hrcplan.errors import Diagnostic, InputError

if TYPE_CHECKING:
    from pathlib import Path

MAX_BYTES = 64 << 20  # also ends the reading of what never ends
MAX_MESSAGE = 160  # a message and its hint are each cut here, whatever they repeat
MAX_FAULTS = 1000  # errors, and as many warnings: beyond that the file is something else
MAX_HINTS = 100  # a file of nonsense is not worth a search among its names for every word
SECTION_SIMILARITY = 0.75  # a misspelt section or keyword this close is read as what was meant

_NEWLINE = re.compile(r"\r\n?|\n")
_BOM = b"\xef\xbb\xbf"


class SourceText:
    """A file's text, the faults found in it so far, and the requirements that it uses."""

    def __init__(self, path: str, text: str) -> None:
        self.path = path
        self.text = text
        self.diagnostics: list[Diagnostic] = []
        self.uses: dict[str, int] = {}
        self.unknown_types: dict[str, int] = {}
        self.reported_types: Collection[str] = ()  # unknown ones that the domain has a fault for
        self._unknown: set[tuple[str, str]] = set()
        self._counts: dict[str, int] = {}
        self._lines: list[int] = []
        self._mentioned: dict[str, bool] = {}

    def position(self, at: int) -> tuple[int, int]:
        r"""Return the 1-based (line, column) of the character at offset ``at``.

        >>> SourceText("x", "ab\ncd").position(4)
        (2, 2)
        """
        line = self._line(at)
        return line, at - self._lines[line - 1] + 1

    def line_end(self, at: int) -> int:
        """Return the offset at which the line after the one of ``at`` begins, or the text ends."""
        line = self._line(at)
        return self._lines[line] if line < len(self._lines) else len(self.text)

    def _line(self, at: int) -> int:
        if not self._lines:
            self._lines = [0, *(match.end() for match in _NEWLINE.finditer(self.text))]
        return bisect_right(self._lines, at)

    def error(self, at: int, code: str, message: str, hint: str | None = None) -> None:
        """Note an error at offset ``at``."""
        self._note(at, "error", code, message, hint)

    def warn(self, at: int, code: str, message: str, hint: str | None = None) -> None:
        """Note a warning at offset ``at``."""
        self._note(at, "warning", code, message, hint)

    def unknown(
        self, at: int, code: str, message: str, word: str, names: Iterable[str],
        hint: str | None = None, cure: str | None = None,
    ) -> None:  # fmt: skip
        """Note once that ``word`` is none of ``names``.

        The hint is the nearest of them, unless there is a better one; or ``cure`` if none is near.
        """
        if self.is_reported(code, word) and code != "unbound":  # each action has its own variables
            return
        self._unknown.add((code, word))
        if hint is None and len(self.diagnostics) < MAX_HINTS:
            hint = nearest(word, names)
        self.error(at, code, message, hint or cure)

    def is_reported(self, code: str, word: str) -> bool:
        """Return whether ``unknown`` has noted an error about the word."""
        return (code, word) in self._unknown

    def mentions(self, word: str) -> bool:
        """Return whether the text holds a word anywhere, in small letters or capitals."""
        if word not in self._mentioned:
            self._mentioned[word] = word in self.text.lower()
        return self._mentioned[word]

    def once(self, at: int, code: str, message: str, hint: str | None = None) -> None:
        """Note an error where it occurs first."""
        if (code, message) not in self._unknown:
            self._unknown.add((code, message))
            self.error(at, code, message, hint)

    def use(self, requirement: str, at: int) -> None:
        """Remember where the file first needs a requirement flag."""
        self.uses.setdefault(requirement, at)

    def _note(self, at: int, severity: str, code: str, message: str, hint: str | None) -> None:
        count = self._counts[severity] = self._counts.get(severity, 0) + 1
        if count > MAX_FAULTS:
            return
        if count == MAX_FAULTS:
            code, message, hint = "too-many", f"there are more {severity}s than are shown", None
        line, column = self.position(at)
        hint = None if hint is None else cut(hint, MAX_MESSAGE)
        self.diagnostics.append(
            Diagnostic(self.path, line, column, severity, code, cut(message, MAX_MESSAGE), hint)
        )

    @property
    def has_errors(self) -> bool:
        """Whether any fault so far is an error."""
        return "error" in self._counts


def read_source(path: str | Path) -> SourceText:
    """Return the text of a file as a Source; see ``decode`` for what is not UTF-8 text.

    Raises:
        InputError: if there is no such file, it is a folder, or it may not be read.
    """
    return decode(str(path), read_bytes(path, MAX_BYTES))


def read_text(path: str | Path) -> str:
    """Return the text of a file that is not PDDL, such as a plan.

    Raises:
        InputError: if it is missing, a folder, or not UTF-8 text.
    """
    source = read_source(path)
    if source.has_errors:
        fault = source.diagnostics[0]
        raise InputError(fault.message, code=fault.code, path=fault.path, line=fault.line,
                         hint=fault.hint)  # fmt: skip
    return source.text


_HEAD = 4096
"""How many bytes are looked at to tell UTF-16 from what is no text."""


def decode(path: str, data: bytes) -> SourceText:
    """Return ``data`` as a Source.

    A few bytes that are not UTF-8 are one error, and the rest is read all the same; UTF-16, an
    archive, and binary content are one error and no text.
    """
    data = data.removeprefix(_BOM)
    kind = archive_kind(data)
    if kind is not None:
        source = SourceText(path, "")
        source.error(0, "archive", f"this is a file packed by {kind}, not text", UNPACK_HINT)
        return source
    if b"\0" in data or data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return _not_text(path, data)
    try:
        return SourceText(path, data.decode())
    except UnicodeDecodeError as error:
        source = SourceText(path, data.decode(errors="replace"))
        at = len(data[: error.start].decode())
        message = f"byte 0x{data[error.start]:02x} is not UTF-8"
        source.error(at, "not-utf-8", message, "save the file as UTF-8 text")
        if source.text.count("\ufffd") * 20 > len(source.text):
            source.text = ""  # not a stray accent but some other encoding, or no text at all
        return source


def _not_text(path: str, data: bytes) -> SourceText:
    if data[:2] in (b"\xff\xfe", b"\xfe\xff") or _is_wide(data[:_HEAD]):
        source = SourceText(path, "")
        source.error(0, "utf-16", "the file is UTF-16, not UTF-8", "save the file as UTF-8 text")
        return source
    before = data[: data.index(0)].decode(errors="replace")
    source = SourceText(path, before)
    source.error(len(before), "binary", "the file holds a NUL byte: it is not text")
    source.text = ""
    return source


def _is_wide(data: bytes) -> bool:
    """Return whether bytes look like ASCII as UTF-16: nearly every second one is zero."""
    fewest, most = sorted((data[::2].count(0), data[1::2].count(0)))
    return most * 2.5 > len(data) and fewest * 40 < len(data)


def in_order(diagnostics: Sequence[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return diagnostics sorted by place, without repetitions."""

    def place(fault: Diagnostic) -> tuple[str, int, int, str, str]:
        return fault.path, fault.line, fault.column, fault.code, fault.message

    return tuple(sorted(set(diagnostics), key=place))
