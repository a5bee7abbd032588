"""What goes to stdout (the result, or one JSON document) and to stderr (all the rest)."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import rich_click as click

from hrcplan.core.files import write_atomically as write_atomically
from hrcplan.core.numbers import Number
from hrcplan.errors import PddlError

FILE_WIDTH = 160  # characters of a table that goes to a file or a program

DEBUG = False
JSON = False
VERBOSE = False

F = TypeVar("F", bound=Callable[..., Any])


def common_options(function: F) -> F:
    """Add ``--json`` and ``-v`` to a command; both take effect at once."""

    def set_json(ctx: click.Context, param: click.Parameter, value: bool) -> None:
        global JSON
        JSON = value

    def set_verbose(ctx: click.Context, param: click.Parameter, value: bool) -> None:
        global VERBOSE
        VERBOSE = value

    function = click.option("-v", "--verbose", is_flag=True, expose_value=False,
                            callback=set_verbose, help="Say more on stderr.")(function)  # fmt: skip
    return click.option("--json", is_flag=True, is_eager=True, expose_value=False,
                        callback=set_json, help="Print one JSON document.")(function)  # fmt: skip


def document(value: Mapping[str, Any]) -> None:
    """Print one JSON document on stdout."""
    click.echo(json.dumps(value, indent=2, ensure_ascii=False))


def result(text: str) -> None:
    """Print a result in words on stdout."""
    click.echo(text)


def table(made: Any) -> None:
    """Print a table of rich on stdout; in colour only where that is shown."""
    from rich.console import Console

    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = FILE_WIDTH
    with console.capture() as text:
        console.print(made)
    click.echo("\n".join(line.rstrip() for line in text.get().splitlines()))


def say(text: str) -> None:
    """Print progress on stderr if it was asked for."""
    if VERBOSE:
        click.echo(text, err=True)


def note(text: str) -> None:
    """Print on stderr what takes long, in dim letters."""
    click.secho(text, err=True, dim=True)


def warn(text: str) -> None:
    """Print a warning on stderr."""
    click.echo(f"warning: {text}", err=True)


def fail(
    code: str, message: str, path: str | None = None, line: int | None = None,
    hint: str | None = None,
) -> None:  # fmt: skip
    """Print an error: JSON on stdout if asked for, else words on stderr."""
    if JSON:
        fault = {"code": code, "message": message, "path": path, "line": line, "hint": hint}
        document({"error": fault})
        return
    place = "" if path is None or path in message else f"{path}:{line}: " if line else f"{path}: "
    click.echo(f"error: {place}{message}", err=True)
    if hint:
        click.echo(f"  hint: {hint}", err=True)


def fail_pddl(error: PddlError) -> None:
    """Print every fault of PDDL files."""
    if JSON:
        fail(error.code, error.message, error.path, error.line, error.hint)
        return
    for diagnostic in error.diagnostics:
        click.echo(diagnostic, err=True)


def number(value: Number | None) -> int | float | None:
    """Return a number as JSON holds it: an int where it is whole."""
    if value is None or isinstance(value, int):
        return value
    return int(value) if value.denominator == 1 else float(value)
