"""Help texts: complete for every command at any width, with the syntax of every kind of value."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
import rich_click as click
from click.testing import CliRunner

from hrcplan.cli import main, options


def commands(
    group: click.Group = main, path: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], click.Command]]:
    """Yield every command with the words that call it."""
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        if isinstance(command, click.Group):
            yield from commands(command, (*path, name))
        else:
            yield (*path, name), command


COMMANDS = list(commands())


@pytest.mark.parametrize(("path", "command"), COMMANDS, ids=[" ".join(p) for p, _ in COMMANDS])
def test_every_option_has_a_sentence(path: tuple[str, ...], command: click.Command) -> None:
    assert re.match(r"[A-Z].*\.", command.help or "", re.DOTALL)
    for param in command.params:
        if isinstance(param, click.Option):
            assert re.fullmatch(r"[A-Z][^.].{8,}\.", param.help or ""), (path, param.name)


# Words in capitals that stand for a value whose syntax is not plain from the word itself.
EXPLAINED = {"PLANNER", "SETTING", "CHANGE", "HUMAN", "METHOD", "GOALS", "PROFILE", "ELEMENT",
             "SOURCE", "SCRIPT", "Q"}  # fmt: skip


@pytest.mark.parametrize(("path", "command"), COMMANDS, ids=[" ".join(p) for p, _ in COMMANDS])
def test_the_syntax_of_values_is_explained(path: tuple[str, ...], command: click.Command) -> None:
    for param in command.params:
        for word in EXPLAINED & set(re.findall(r"[A-Z]+", param.metavar or "")):
            is_in_text = f"\n{param.opts[0]} " in (command.help or "")
            assert is_in_text or re.search(rf"\b{word}:", command.epilog or ""), (path, word)


@pytest.mark.parametrize("width", [60, 80, 120])
def test_help_keeps_to_the_width_and_loses_no_word(width: int) -> None:
    for path, command in COMMANDS:
        run = CliRunner(env={"COLUMNS": str(width), "NO_COLOR": "1"})
        text = run.invoke(main, [*path, "--help"], prog_name="hrcplan", terminal_width=width).output
        assert max(map(len, text.splitlines())) <= width, path
        shown = " ".join(re.sub(r"[│╭╮╰╯─]", " ", text).split())
        for word in (command.epilog or "").split():
            assert word in shown, (path, word)


@pytest.mark.parametrize(
    ("args", "joined"),
    [
        ("a/b --set x y=3 --set z=4", ["a/b", "--set", "x y=3", "--set", "z=4"]),
        ("--set x y = 3 a/b", ["--set", "x y = 3", "a/b"]),
        ("--change not at a b@60 --json", ["--change", "not at a b@60", "--json"]),
        ("--change m h=9@0 a b", ["--change", "m h=9@0", "a", "b"]),
        ("--set x --json", ["--set", "x", "--json"]),
        ("a b --set", ["a", "b", "--set"]),
    ],
)
def test_words_of_a_setting_are_joined(args: str, joined: list[str]) -> None:
    assert options.join_settings(args.split()) == joined
