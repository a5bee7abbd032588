"""What goes to stdout (the result, or one JSON document) and to stderr (all the rest)."""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Callable, Container, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import click

from hrcplan.core.files import reason_of
from hrcplan.core.files import write_atomically as write_atomically
from hrcplan.core.numbers import Number, nearest_float
from hrcplan.core.text import harmless
from hrcplan.errors import PddlError

if TYPE_CHECKING:
    from rich.console import RenderableType

NO_BREAK = "\u00a0"
FILE_WIDTH = 160  # characters of a table that goes to a file or a program

DEBUG = False
JSON = False
LINES = False
VERBOSE = False

F = TypeVar("F", bound=Callable[..., Any])


class PrintError(Exception):
    """A standard stream takes nothing more: its disk is full, or its reader is gone."""

    def __init__(self, cause: OSError) -> None:
        super().__init__(reason_of(cause))
        self.is_closed = isinstance(cause, BrokenPipeError)


def _echo(text: str, err: bool = False, end: str = "\n") -> None:
    """Print a line; only of a result it matters that it cannot be printed."""
    try:
        click.echo(text + end, nl=False, err=err)
    except OSError as error:
        if not err:
            raise PrintError(error) from None


def common_options(function: F) -> F:
    """Add ``--json`` and ``-v`` to a command; both take effect at once."""

    def set_json(ctx: click.Context, param: click.Parameter, value: bool) -> None:
        global JSON, LINES
        JSON, LINES = value, False

    def set_verbose(ctx: click.Context, param: click.Parameter, value: bool) -> None:
        global VERBOSE
        VERBOSE = value

    verbose = click.option(
        "-v", "--verbose", is_flag=True, expose_value=False, callback=set_verbose,
        help="Print more details on stderr.",
    )  # fmt: skip
    as_json = click.option(
        "--json", is_flag=True, is_eager=True, expose_value=False, callback=set_json,
        help="Print the result as one JSON document.",
    )  # fmt: skip
    return as_json(verbose(function))


def document(value: Mapping[str, Any]) -> None:
    """Print one JSON document on stdout, in UTF-8 and harmless to a terminal.

    It is one line if the command prints one for every event (``LINES``).
    """
    import json  # 2 ms that results in words do without

    limit = sys.get_int_max_str_digits()
    sys.set_int_max_str_digits(0)  # numbers are bounded where they are computed
    try:
        text = json.dumps(value, indent=None if LINES else 2, ensure_ascii=False)
    finally:
        sys.set_int_max_str_digits(limit)
    _echo(text if text.isascii() else "".join(map(_json_character, text)))


def _json_character(character: str) -> str:
    import json

    is_plain = character.isprintable() or character == "\n"
    return character if is_plain else json.dumps(character)[1:-1]


def result(text: str) -> None:
    """Print a result in words on stdout."""
    _echo(harmless(text))


def text(content: str) -> None:
    """Print a text on stdout as it is, with its own ends of lines."""
    _echo(content, end="")


def prompt(text: str) -> None:
    """Print what asks for a line of input, at once."""
    try:
        click.echo(harmless(text), nl=False)
        sys.stdout.flush()
    except OSError as error:
        raise PrintError(error) from None


def table(grid: RenderableType) -> None:
    """Print a table of rich on stdout; in colour only where that is shown."""
    from rich.console import Console
    from rich.segment import Segment, Segments

    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = FILE_WIDTH
    # Only rich writes control characters to the terminal: the text of a cell has none.
    pieces = [Segment(harmless(s.text), s.style, s.control) for s in console.render(grid)]
    with console.capture() as text:
        console.print(Segments(pieces))
    _echo("\n".join(line.rstrip() for line in text.get().splitlines()))


def table_width() -> int:
    """Return how many characters a line of a table may have."""
    return _terminal_width() if sys.stdout.isatty() else FILE_WIDTH


def _terminal_width() -> int:
    import shutil

    return shutil.get_terminal_size().columns


def fold(line: str, indent: int = 2) -> str:
    """Return a line folded between its words at a terminal; for files and programs as it is.

    A no-break space joins words that belong together; it is printed as a space. ``indent`` is the
    number of spaces before the second line and all that follow.
    """
    if sys.stdout.isatty():
        width = _terminal_width()
        line = "\n".join(
            textwrap.wrap(line.replace(" %", f"{NO_BREAK}%"), width,
                          subsequent_indent=" " * indent, break_long_words=False,
                          break_on_hyphens=False)
        )  # fmt: skip
    return line.replace(NO_BREAK, " ")


def columns(rows: Sequence[Sequence[str]], right: Container[int] = ()) -> list[str]:
    """Return rows of cells as lines with aligned columns; ``right`` are those of numbers.

    >>> columns([["a", "n"], ["bc", "10"]], right=[1])
    ['a    n', 'bc  10']
    """
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = (
        [c.rjust(w) if i in right else c.ljust(w)
         for i, (c, w) in enumerate(zip(row, widths, strict=True))]
        for row in rows
    )  # fmt: skip
    return ["  ".join(line).rstrip() for line in lines]


def rule(rows: Sequence[Sequence[str]]) -> list[str]:
    """Return a row of lines as long as the widest cell of each column."""
    return ["─" * max(map(len, column)) for column in zip(*rows, strict=True)]


def say(text: str) -> None:
    """Print progress on stderr if it was asked for."""
    if VERBOSE:
        _echo(harmless(text), err=True)


def note(text: str) -> None:
    """Print on stderr what takes long, in dim letters."""
    _echo(click.style(harmless(text), dim=True), err=True)


def warn(text: str) -> None:
    """Print a warning on stderr."""
    _echo(f"warning: {harmless(text)}", err=True)


def complain(text: str) -> None:
    """Print an error that is not one of input or use on stderr."""
    _echo(f"error: {harmless(text)}", err=True)


def fail(
    code: str, message: str, path: str | None = None, line: int | None = None,
    hint: str | None = None, column: int | None = None,
) -> None:  # fmt: skip
    """Print an error: JSON on stdout if asked for, else words on stderr."""
    if JSON:
        fault = {"code": code, "message": message, "path": path, "line": line, "hint": hint}
        if column is not None:
            fault["column"] = column
        document({"error": fault})
        return
    place = _place(path, line, column, message)
    _echo(f"error: {harmless(place + message)}", err=True)
    if hint:
        _echo(f"  hint: {harmless(hint)}", err=True)


def _place(path: str | None, line: int | None, column: int | None, message: str) -> str:
    """Return ``path:line:column: ``, as far as known; nothing if the message names the path."""
    if path is None or (line is None and path in message):
        return ""
    return ":".join([path, *(str(n) for n in (line, column) if n)]) + ": "


def fail_pddl(error: PddlError) -> None:
    """Print every fault of PDDL files."""
    if JSON:
        fail(error.code, error.message, error.path, error.line, error.hint, error.column)
        return
    for diagnostic in error.diagnostics:
        _echo(harmless(str(diagnostic)), err=True)


def number(value: Number | None) -> int | float | None:
    """Return a number as JSON holds it: an int where it is whole."""
    if value is None or isinstance(value, int):
        return value
    return int(value) if value.denominator == 1 else nearest_float(value)
