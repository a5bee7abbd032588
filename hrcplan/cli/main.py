"""The command group: every way out of a command passes through here."""

from __future__ import annotations

import importlib
import signal
import sys
import threading
import traceback
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NoReturn, TextIO

import rich_click as click
from click.exceptions import Abort, ClickException, Exit

from hrcplan import __version__
from hrcplan.cli import output
from hrcplan.core.deprecation import OldNameWarning
from hrcplan.errors import HrcplanError, LimitError, PddlError, UsageError

COMMANDS = {
    "plan": "hrcplan.cli.plan",
    "allocation": "hrcplan.cli.allocation",
    "validate": "hrcplan.cli.validate",
    "execute": "hrcplan.cli.execute",
    "replay": "hrcplan.cli.replay",
    "check": "hrcplan.cli.check",
    "new-problem": "hrcplan.cli.new_problem",
    "bank": "hrcplan.cli.bank",
    "infer": "hrcplan.cli.infer",
    "study": "hrcplan.cli.study",
    "planners": "hrcplan.cli.planners",
    "doctor": "hrcplan.cli.doctor",
}
INTERNAL_ERROR = 5
INTERRUPTED = 130
TERMINATED = 143


class _Commands(click.RichGroup):
    """Commands that are imported when they are called, so that ``--help`` answers at once."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names in the order of a first walk through the tool."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return a command, or None if there is none of this name."""
        if cmd_name not in COMMANDS:
            return None
        module = importlib.import_module(COMMANDS[cmd_name])
        command: click.Command = module.command
        return command

    def main(self, *args: Any, **kwargs: Any) -> NoReturn:
        """Run a command and exit; errors become messages and exit codes."""
        run = super().main
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGTERM, lambda *_: sys.exit(TERMINATED))
        kwargs["standalone_mode"] = False
        with _old_names_on_stderr():
            status = _guarded(lambda: run(*args, **kwargs))
        sys.exit(status)


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
            if issubclass(category, OldNameWarning):
                output.warn(str(message))
            else:
                show(message, category, filename, lineno, file, line)

        warnings.showwarning = show_in_words
        yield


def _guarded(run: Callable[[], Any]) -> int:
    try:
        result = run()
    except Exit as stop:
        return int(stop.exit_code)
    except ClickException as error:
        error.show()
        return error.exit_code
    except (KeyboardInterrupt, Abort):
        output.fail("interrupted", "interrupted")
        return INTERRUPTED
    except PddlError as error:
        output.fail_pddl(error)
        return error.exit_code
    except HrcplanError as error:
        message = f"{error.message}{_notes(error)}"
        output.fail(error.code, message, error.path, error.line, error.hint)
        return error.exit_code
    except MemoryError:
        output.fail("memory", "out of memory", hint="try a smaller problem")
        return LimitError.exit_code
    except BrokenPipeError:
        sys.stderr.close()
        return 1
    except OSError as error:  # files are read and written elsewhere: this is stdout
        click.echo(f"error: cannot print the result: {error.strerror}", err=True)
        return UsageError.exit_code
    except Exception as error:  # noqa: BLE001  a bug of ours: no traceback unless asked for
        if output.DEBUG:
            traceback.print_exc()
        what = f"{type(error).__name__}: {error}{_notes(error)}"
        output.fail(
            "internal", f"internal error: {what}", hint="run again with --debug, and tell us"
        )
        return INTERNAL_ERROR
    return result if isinstance(result, int) else 0


def _notes(error: Exception) -> str:
    """Return what was noted about where an error came up, such as the episode of a study."""
    return "".join(f" ({note})" for note in getattr(error, "__notes__", ()))


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="hrcplan")
@click.option("--debug", is_flag=True, help="Show tracebacks.")
def main(debug: bool) -> None:
    """Plan for humans and robots from PDDL: agent states are costs, plans are checked."""
    output.DEBUG = debug
