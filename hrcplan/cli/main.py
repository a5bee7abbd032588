"""The command group: every way out of a command passes through here."""

from __future__ import annotations

import contextlib
import importlib
import signal
import sys
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from typing import Any, NoReturn, TextIO

import click
from click.exceptions import Abort, ClickException, Exit

from hrcplan import __version__
from hrcplan.cli import output, streams
from hrcplan.cli.help import Group, HelpContext, set_help
from hrcplan.cli.progress_line import show_progress
from hrcplan.core.deprecation import OldNameWarning
from hrcplan.core.files import reason_of
from hrcplan.core.text import harmless
from hrcplan.errors import HrcplanError, InputError, LimitError, PddlError, UsageError

COMMANDS = {
    "plan": "Find a plan for the PROBLEM of a DOMAIN.",
    "allocation": "Show which agent does how much in the best plan, for every value of ELEMENT.",
    "validate": "Replay PLAN step by step, and print whether it is valid or where it fails.",
    "execute": "Carry out DOMAIN PROBLEM with a simulated human, and replan before actions fail.",
    "collaborate": "Work together with a robot that does not know your goal.",
    "serve": "Serve a page in which you work together with a robot. Ctrl-C ends it.",
    "robot": "Simulate a robot, to try robot links with.",
    "replay": "Check that every decision in JOURNAL follows from what was written before it.",
    "check": "Report every fault of domain and problem FILEs, with line and column.",
    "format": "Write domain and problem FILEs again in one layout; words and comments stay.",
    "lsp": "Serve an editor over standard input and output, as the Language Server Protocol says.",
    "mcp": "Serve check, plan, validate, allocation and infer to a language model.",
    "new-problem": "Write a copy of PROBLEM with another goal and other values.",
    "bank": "Policy banks: every valid plan of every goal, counted exactly.",
    "infer": "Infer the human's goal, and where it changed, from the observed ACTIONS.",
    "study": "Run a study, and report on its rows.",
    "score": "Check the traces of a method, play each of them again, and print what it reaches.",
    "planners": "List the planners: the problems each can solve, and whether it can run here.",
    "doctor": "Show versions, Java and planners, and what to install.",
}
"""By name: the first sentence of a command's help, so that a list of them imports none."""
INTERNAL_ERROR = 5
INTERRUPTED = 130
TERMINATED = 143
HUNG_UP = 129


class _Commands(Group):
    """Commands that are imported when they are called, so that ``--help`` answers at once.

    ``commands`` holds their names and summaries only.
    """

    context_class = HelpContext

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names in the order of a first walk through the tool."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return a command, or None if there is none of this name."""
        if cmd_name not in COMMANDS:
            return None
        module = importlib.import_module(f"hrcplan.cli.{cmd_name.replace('-', '_')}")
        command: click.Command = module.command
        set_help(command)
        return command

    def main(
        self, args: Sequence[str] | None = None, prog_name: str | None = None,
        complete_var: str | None = None, standalone_mode: bool = True, **more: str | bool | None,
    ) -> NoReturn:  # fmt: skip
        """Run a command and exit; errors become messages and exit codes."""
        streams.prepare()
        show_progress(sys.stderr)
        words = list(sys.argv[1:] if args is None else args)
        output.JSON = "--json" in words  # an error before options are read is a document, too
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGTERM, lambda *_: sys.exit(TERMINATED))
            if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:  # as nohup sets it
                signal.signal(signal.SIGHUP, lambda *_: sys.exit(HUNG_UP))
        run = partial(super().main, words, prog_name, complete_var, standalone_mode=False, **more)
        with _old_names_on_stderr():
            code = _exit_code(words, run)
        sys.exit(code)


@contextmanager
def _old_names_on_stderr() -> Iterator[None]:
    """Print warnings about names of earlier versions; Python alone would not show them."""
    with warnings.catch_warnings():
        warnings.simplefilter("once", OldNameWarning)
        show = warnings.showwarning

        def show_in_words(
            message: Warning | str, category: type[Warning], filename: str, lineno: int,
            file: TextIO | None = None, line: str | None = None,
        ) -> None:  # fmt: skip
            if category.__name__ == "OwnFileWarning":  # its module is not imported for --help
                output.note(f"note: {message}")
            elif issubclass(category, OldNameWarning):
                output.warn(str(message))
            else:
                show(message, category, filename, lineno, file, line)

        warnings.showwarning = show_in_words
        yield


def _exit_code(words: list[str], run: Callable[[], Any]) -> int:
    """Return the exit code of a command, after its errors were printed as far as that can be."""
    try:
        code = _guard(words, run)
    except output.PrintError as error:
        code = _print_fault(error)
    fault = streams.flush()
    return code if fault is None or code else _print_fault(output.PrintError(fault))


def _print_fault(error: output.PrintError) -> int:
    """Say that the result could not be printed; a closed pipe is not reported."""
    if not error.is_closed:
        with contextlib.suppress(output.PrintError):
            output.complain(f"cannot print the result: {error}")
    return UsageError.exit_code


def _guard(words: list[str], run: Callable[[], Any]) -> int:
    """Return the exit code of a command; what it raises is printed first."""
    try:
        if "\0" in "".join(words):
            raise UsageError("an argument holds a NUL character")
        result = run()
    except Exit as stop:
        return int(stop.exit_code)
    except (Exception, KeyboardInterrupt) as error:
        if isinstance(error, output.PrintError):
            raise
        code, show = _fault(error)
        with contextlib.suppress(OSError, output.PrintError):
            show()
        return code
    return result if isinstance(result, int) else 0


def _fault(error: BaseException) -> tuple[int, Callable[[], None]]:
    """Return the exit code of an error, and what prints it."""
    match error:
        case ClickException():
            return error.exit_code, lambda: _show_usage(error)
        case KeyboardInterrupt() | Abort():
            return INTERRUPTED, lambda: output.fail("interrupted", "interrupted")
        case PddlError():
            return error.exit_code, lambda: output.fail_pddl(error)
        case HrcplanError():
            text = f"{error.message}{_notes(error)}"
            return error.exit_code, lambda: output.fail(
                error.code, text, error.path, error.line, error.hint, error.column
            )
        case MemoryError():
            hint = "try a smaller problem"
            return LimitError.exit_code, lambda: output.fail("memory", "out of memory", hint=hint)
        case OSError():
            path = None if error.filename is None else harmless(str(error.filename))
            return InputError.exit_code, lambda: output.fail("no-access", reason_of(error), path)
    return INTERNAL_ERROR, lambda: _show_internal(error)


def _show_usage(error: ClickException) -> None:
    if output.JSON:
        output.fail("usage", error.format_message())
    else:
        error.show()


def _show_internal(error: BaseException) -> None:
    """Print an error that is a bug of hrcplan."""
    if output.DEBUG:
        import traceback

        traceback.print_exception(error)
    what = f"{type(error).__name__}: {error}{_notes(error)}"
    output.fail("internal", f"internal error: {what}", hint="run again with --debug, and tell us")


def _notes(error: BaseException) -> str:
    """Return what was noted about where an error came up, such as the episode of a study."""
    return "".join(f" ({note})" for note in getattr(error, "__notes__", ()))


@click.group(
    cls=_Commands,
    commands={name: click.Command(name, help=text) for name, text in COMMANDS.items()},
    context_settings={"help_option_names": ["-h", "--help"]},
)
@click.version_option(__version__, prog_name="hrcplan")
@click.option("--debug", is_flag=True, help="Show tracebacks.")
def main(debug: bool) -> None:
    """Plan for humans and robots from PDDL: agent states are costs, plans are checked."""
    output.DEBUG = debug
