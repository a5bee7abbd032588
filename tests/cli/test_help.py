"""Help texts: complete for every command at any width, with the syntax of every kind of value."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from types import SimpleNamespace

import click
import pytest
from click.testing import CliRunner

from hrcplan.cli import main, options
from hrcplan.cli.help import summary


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


def test_the_list_of_commands_says_what_each_command_says() -> None:
    context = click.Context(main)
    for name, placeholder in main.commands.items():
        command = main.get_command(context, name)
        assert command is not None
        assert summary(command) == placeholder.help, name


def test_the_list_of_commands_imports_none() -> None:
    code = """if True:
        import sys
        from hrcplan.cli import main
        sys.argv[1:] = ["--help"]
        try:
            main()
        finally:
            known = [name for name in sys.modules if name.startswith("hrcplan.cli.")]
            assert not set(known) & {f"hrcplan.cli.{name}" for name in main.commands}, known
            assert not {"rich_click", "importlib.metadata", "hrcplan.pddl"} & set(sys.modules)
    """
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert (run.returncode, run.stderr) == (0, "")
    assert "  bank  " in run.stdout


@pytest.mark.parametrize("words", [[], ["bank"], ["plan", "--help"]])
def test_help_is_in_frames_at_a_terminal(words: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    plain = CliRunner().invoke(main, words, prog_name="hrcplan").output
    monkeypatch.setattr("hrcplan.cli.help.sys", SimpleNamespace(stdout=_Terminal()))
    framed = CliRunner().invoke(main, words, prog_name="hrcplan", terminal_width=80).output
    assert "╭─ Options ─" in framed
    assert "╭─" not in plain
    letters = re.compile(r"[a-z]{3,}")
    assert set(letters.findall(plain)) - {"multiple"} <= set(letters.findall(framed))


class _Terminal:
    def isatty(self) -> bool:
        return True
