"""Help texts: with rich-click's frames and colours at a terminal, else as plain text.

Rich-click takes longer to import than all else that ``hrcplan --help`` does, so it is imported only
where its help is seen.
"""

from __future__ import annotations

import re
import sys
import textwrap
from collections.abc import Iterable

import click

NO_BREAK_HYPHEN = "\u2011"


def set_help(command: click.Command) -> None:
    """Give a command, and those below it, the help of `HelpContext`."""
    command.context_class = HelpContext
    if isinstance(command, click.Group):
        for below in command.commands.values():
            set_help(below)


class _WholeWords(click.HelpFormatter):
    """Breaks no line at a hyphen: a name such as ``two-boxes`` stays in one piece."""

    def write_text(self, text: str) -> None:
        """Write a paragraph."""
        super().write_text(text.replace("-", NO_BREAK_HYPHEN))

    def write_dl(
        self, rows: Iterable[tuple[str, str]], col_max: int = 30, col_spacing: int = 2
    ) -> None:
        """Write words with their definitions."""
        whole = [(word, text.replace("-", NO_BREAK_HYPHEN)) for word, text in rows]
        super().write_dl(whole, col_max, col_spacing)

    def getvalue(self) -> str:
        """Return all that was written, also texts that are lines already, within the width."""
        lines = super().getvalue().splitlines()
        text = "\n".join(_fold(line, self.width) for line in lines)
        return f"{text}\n".replace(NO_BREAK_HYPHEN, "-")


def _fold(line: str, width: int) -> str:
    """Return a line folded below its second column, or below its first if it has one only."""
    match = re.match(r"( *\S+(?: \S+)*  +)\S", line) or re.match("( *)", line)
    indent = " " * len(match[1]) if match else ""
    return textwrap.fill(line, width, subsequent_indent=indent, break_long_words=False)


class HelpContext(click.Context):
    """The call of a command whose help has the form that suits standard output."""

    formatter_class = _WholeWords

    def get_help(self) -> str:
        """Return the help text."""
        return _rich_help(self) if sys.stdout.isatty() else super().get_help()


class Group(click.Group):
    """Commands below a command, listed with the first sentences of their help in full."""

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the name and the first paragraph of the help of each command."""
        names = self.list_commands(ctx)
        with formatter.section("Commands"):
            formatter.write_dl([(name, summary(self.commands[name])) for name in names])


def summary(command: click.Command) -> str:
    """Return the first paragraph of a command's help, as one line."""
    return " ".join((command.help or "").partition("\n\n")[0].split())


def _rich_help(call: click.Context) -> str:
    """Return the help of a command in frames and colours."""
    from rich_click import RichCommand, RichCommandPanel, RichContext, RichGroup

    command = call.command
    same: RichCommand = RichCommand(name=command.name)
    if isinstance(command, click.Group):
        panel = RichCommandPanel("Commands", commands=command.list_commands(call))
        same = RichGroup(name=command.name, commands=command.commands, panels=[panel])
    same.params, same.help, same.epilog = command.params, command.help, command.epilog
    context = RichContext(
        same,
        call.parent,
        call.info_name,
        terminal_width=call.terminal_width,
        help_option_names=call.help_option_names,
    )
    return same.get_help(context)
