"""The text of one file: decoded strictly, with offsets turned into lines and columns."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from hrcplan.errors import Diagnostic, InputError

MAX_QUOTE = 60  # characters of a file that a message may repeat


@dataclass(slots=True)
class Source:
    """A file's text and the faults found in it so far."""

    path: str
    text: str
    diagnostics: list[Diagnostic] = field(default_factory=list)
    _lines: list[int] = field(default_factory=list)

    def position(self, at: int) -> tuple[int, int]:
        """Return the 1-based (line, column) of the character at offset ``at``.

        >>> Source("x", "ab\\ncd").position(4)
        (2, 2)
        """
        if not self._lines:
            self._lines = [0, *(i + 1 for i, c in enumerate(self.text) if c == "\n")]
        line = bisect_right(self._lines, at)
        return line, at - self._lines[line - 1] + 1

    def error(self, at: int, code: str, message: str, hint: str | None = None) -> None:
        """Note an error at offset ``at``."""
        self._note(at, "error", code, message, hint)

    def warn(self, at: int, code: str, message: str, hint: str | None = None) -> None:
        """Note a warning at offset ``at``."""
        self._note(at, "warning", code, message, hint)

    def _note(self, at: int, severity: str, code: str, message: str, hint: str | None) -> None:
        line, column = self.position(at)
        self.diagnostics.append(
            Diagnostic(self.path, line, column, severity, code, message, hint)
        )

    @property
    def has_errors(self) -> bool:
        """Whether any fault so far is an error."""
        return any(d.severity == "error" for d in self.diagnostics)


def quote(text: str) -> str:
    """Return ``text`` in quotes, shortened so that a message never repeats a long line."""
    return f"'{text}'" if len(text) <= MAX_QUOTE else f"'{text[:MAX_QUOTE]}…'"


def nearest(word: str, known: Iterable[str]) -> str | None:
    """Return a "did you mean" hint for ``word``, or None if nothing known is close.

    >>> nearest("motivaton", ["motivation", "capacity"])
    "did you mean 'motivation'?"
    """
    from rapidfuzz import distance, process

    choices = [k for k in known if k != word]
    found = process.extractOne(
        word[:MAX_QUOTE], choices, scorer=distance.OSA.normalized_similarity, score_cutoff=0.6
    )
    return f"did you mean '{found[0]}'?" if found else None


def read_source(path: str | Path) -> Source:
    """Return the text of a file as a Source.

    A file that is not UTF-8 text gives a Source with an error and no text.

    Raises:
        InputError: if there is no such file, it is a folder, or it may not be read.
    """
    try:
        data = Path(path).read_bytes()
    except IsADirectoryError:
        raise InputError(f"{path} is a folder, not a file", code="is-folder", path=str(path),
                         hint="name one file inside it") from None  # fmt: skip
    except FileNotFoundError:
        raise InputError(f"there is no file {path}", code="no-file", path=str(path)) from None
    except (OSError, ValueError) as error:
        raise InputError(f"cannot read {path}: {error}", path=str(path)) from None
    return decode(str(path), data)


def decode(path: str, data: bytes) -> Source:
    """Return ``data`` as a Source; text that is not UTF-8 becomes an error at its place."""
    fault = _encoding_fault(data)
    if fault is None:
        return Source(path, data.decode("utf-8-sig"))
    at, code, message = fault
    readable = data[:at].decode("utf-8", errors="replace")
    source = Source(path, readable)
    source.error(len(readable), code, message, "save the file as UTF-8 text")
    source.text = ""
    return source


def _encoding_fault(data: bytes) -> tuple[int, str, str] | None:
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return 0, "utf-16", "the file is UTF-16, not UTF-8"
    nul = data.find(b"\0")
    if nul >= 0:
        return nul, "binary", "the file holds a NUL byte; it is binary or UTF-16"
    try:
        data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        return error.start, "not-utf-8", f"byte 0x{data[error.start]:02x} is not UTF-8"
    return None


def in_order(diagnostics: Sequence[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return diagnostics sorted by place, without repetitions."""
    return tuple(sorted(set(diagnostics), key=lambda d: (d.path, d.line, d.column, d.code)))
