"""Tools for language models, called as a client calls them: a real server over real pipes."""

import asyncio
import json
import re
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from mcp import ClientSession, StdioServerParameters, stdio_client

from hrcplan.errors import UsageError
from hrcplan.mcp.commands import FolderCommands

DOMAIN = """(define (domain lamp) (:predicates (on))
  (:action press :parameters () :precondition (not (on)) :effect (on)))"""
PROBLEM = "(define (problem p) (:domain lamp) (:init) (:goal (on)))"


def call(folder: Path, *calls: tuple[str, Mapping[str, Any]]) -> list[tuple[bool, Any]]:
    """Return for each call whether it failed, and its document (or the message)."""

    async def talk() -> list[tuple[bool, Any]]:
        server = StdioServerParameters(
            command=sys.executable, args=["-m", "hrcplan", "mcp", str(folder)], cwd=str(folder)
        )
        answers = []
        async with stdio_client(server) as (read, write), ClientSession(read, write) as session:
            await session.initialize()
            for name, arguments in calls:
                result = await session.call_tool(name, dict(arguments))
                text = result.content[0].text
                answers.append((result.is_error, text if result.is_error else json.loads(text)))
        return answers

    return asyncio.run(talk())


def test_texts_are_checked_planned_and_validated(tmp_path: Path) -> None:
    answers = call(
        tmp_path,
        ("check", {"files": [DOMAIN.replace("(not (on))", "(of)"), PROBLEM]}),
        ("plan", {"domain": DOMAIN, "problem": PROBLEM}),
        ("validate", {"domain": DOMAIN, "problem": PROBLEM, "plan": "(press)\n(press)"}),
    )
    assert [failed for failed, _ in answers] == [False] * 3
    (_, faults), (_, plan), (_, verdict) = answers
    assert (faults["exit_code"], faults["diagnostics"][0]["code"]) == (3, "unknown-predicate")
    assert (plan["exit_code"], plan["status"], plan["cost"]) == (0, "solved-optimally", 1)
    assert (verdict["exit_code"], verdict["failed_step"]) == (1, 1)


def test_shipped_names_agent_state_and_goals(tmp_path: Path) -> None:
    words = {"domain": "transport", "problem": "two-boxes"}
    answers = call(
        tmp_path,
        ("plan", {**words, "settings": ["motivation human=10"]}),
        ("infer", {"domain": "kitchen", "actions": ["(get human yogurt)"]}),
    )
    (_, plan), (_, inference) = answers
    assert plan["exit_code"] == inference["exit_code"] == 0
    assert {step["agent"] for step in plan["steps"]} == {"robot"}


@pytest.mark.parametrize("kind", ["above", "absolute", "link", "program", "option"])
def test_nothing_outside_of_the_folder_is_read_or_run(tmp_path: Path, kind: str) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    secret = tmp_path / "secret.pddl"
    secret.write_text(DOMAIN)
    (folder / "link.pddl").symlink_to(secret)
    names = {"above": "../secret.pddl", "absolute": str(secret), "link": "link.pddl"}
    if kind == "program":
        calls = ("plan", {"domain": DOMAIN, "problem": PROBLEM, "planner": "cmd:touch x"})
    elif kind == "option":
        calls = ("check", {"files": ["--help"]})
    else:
        calls = ("check", {"files": [names[kind]]})
    ((failed, message),) = call(folder, calls)
    assert failed
    assert "lamp" not in message
    assert not (folder / "x").exists()


@pytest.mark.parametrize("text", ["--help", "-o", "a\0b", "x" * 300, "../x", "a/-o", "\ud800"])
def test_a_word_is_a_file_a_name_or_refused(tmp_path: Path, text: str) -> None:
    commands = FolderCommands([tmp_path])
    if re.fullmatch(r"x+", text):  # a name that no file can have is for the command to refuse
        with commands.files(text) as names:
            assert names == [text]
        return
    with pytest.raises(UsageError, match="no file of the folders"), commands.files(text):
        pass


def test_a_command_that_cannot_be_called_is_named(tmp_path: Path) -> None:
    commands = FolderCommands([tmp_path])
    for word in ("a\0", "x" * (1 << 22)):
        with pytest.raises(UsageError, match="cannot be called"):
            commands.run("check", word)
