"""Options that several commands share, and the syntax of their values, each defined once."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeVar

import click

from hrcplan.core.extras import require
from hrcplan.core.files import check_target
from hrcplan.errors import UsageError

F = TypeVar("F", bound=Callable[..., Any])

NAMES = (
    "DOMAIN PROBLEM: two paths, or the names of shipped files: 'transport two-boxes', or in one "
    "word 'transport/two-boxes'."
)
GOALS = (
    "GOALS: a folder of problem files with the same objects and initial state, or a folder with "
    "template.pddl and hyps.dat; by default ./problems/DOMAIN, or else the shipped problems."
)
PLANNER = (
    "PLANNER: auto, a name that 'hrcplan planners' lists, up:NAME (an engine of "
    "unified-planning), 'cmd:PROGRAM {domain} {problem}' (any program), or module:Class."
)
SETTING = (
    'SETTING: FUNCTION OBJECT ...=NUMBER, as in "motivation human=8": the function of these '
    "objects has this value in the initial state."
)
PROFILE = "PROFILE: hrcplan, replan-always, or another one that `execute` knows."
ROBOTS = (
    "METHOD: rhp (of the changed-mind paper), recursive, recursive-best, cdp, infogain, hrcplan, "
    "oracle, or your own robot: module:Class, or 'cmd:PROGRAM' (a program in any language)."
)
JOINT_ROBOTS = (
    "Robots that weigh goal and agent state: joint (it may ask you what you want), "
    "joint-without-asking, goal-only, state-only, joint-oracle."
)


def notes(*texts: str) -> str:
    """Return what stands below the options of a command: the syntax of its arguments."""
    return "\n\n".join(texts)


def goals_per(default: str | None) -> Callable[[F], F]:
    """Return the option that says whose goals are inferred."""
    return click.option(
        "--goals-per",
        type=click.Choice(["human", "team"]),
        default=default,
        show_default=default is not None,
        help="Whether each human has a goal of its own, or all humans share one.",
    )


_JOINED = {"--set": "=", "--change": "@"}


class SettingsCommand(click.Command):
    """A command whose ``--set`` and ``--change`` also work without quotes around their value."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse arguments in which the words of each setting are joined."""
        return super().parse_args(ctx, join_settings(args))


def join_settings(args: Sequence[str]) -> list[str]:
    """Return arguments with the words of each setting as one.

    A setting goes on to its first word with ``=`` (of a change: with ``@``). Words that never come
    to one stay as they are, and so do quoted settings.

    >>> join_settings(["a/b", "--set", "motivation", "human=10", "--json"])
    ['a/b', '--set', 'motivation human=10', '--json']
    """
    words_out: list[str] = []
    words = list(args)
    while words:
        words_out.append(words.pop(0))
        if (mark := _JOINED.get(words_out[-1])) is not None:
            n = _n_words(words, mark)
            words_out.append(" ".join(words[:n])) if n else None
            del words[:n]
    return words_out


def _n_words(words: Sequence[str], mark: str) -> int:
    """Return how many words are one setting: up to that with the mark, and the number after it."""
    for i, word in enumerate(words):
        if word.startswith("--") or word == "-o":
            break
        if mark in word:
            return min(len(words), i + (2 if word.endswith(mark) else 1))
    return min(1, len(words))


def planner(help_text: str) -> Callable[[F], F]:
    """Return the option ``--planner``."""
    return click.option(
        "--planner", default="auto", show_default=True, metavar="PLANNER", help=help_text
    )


class FiniteNumber(click.FloatRange):
    """A number in a range; ``nan`` and the infinities are none.

    Args:
        cap: Greater numbers, also infinity, stand for this one.
    """

    def __init__(
        self, least: float | None = None, *, min_open: bool = False, cap: float | None = None
    ) -> None:
        super().__init__(least, min_open=min_open)
        self.cap = cap

    def convert(
        self, value: float, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """Return the number."""
        number = float(super().convert(value, param, ctx))
        if self.cap is not None and number > self.cap:
            return self.cap
        if not math.isfinite(number):
            self.fail(f"'{value}' is no finite number", param, ctx)
        return number


MOST_SECONDS = 1e8  # about three years: clocks and planners can count more, but not all of them
SECONDS = FiniteNumber(0, min_open=True, cap=MOST_SECONDS)


def timeout(help_text: str, default: float | None) -> Callable[[F], F]:
    """Return the option ``--timeout``, in seconds."""
    return click.option(
        "--timeout", type=SECONDS, default=default,
        show_default=default is not None, metavar="SECONDS", help=help_text,
    )  # fmt: skip


def seed(
    help_text: str = "Random seed.", default: int = 0, least: int | None = 0
) -> Callable[[F], F]:
    """Return the option ``--seed``; the same seed gives the same result."""
    return click.option(
        "--seed", type=int if least is None else click.IntRange(min=least), default=default,
        show_default=True, metavar="N",
        help=help_text,
    )  # fmt: skip


def settings(function: F) -> F:
    """Add the option ``--set``."""
    return click.option(
        "--set", "settings", multiple=True, metavar="SETTING",
        help="Change a value of the initial state; repeatable.",
    )(function)  # fmt: skip


def ros_python(function: F) -> F:
    """Add the option ``--ros-python``."""
    return click.option(
        "--ros-python", metavar="PATH",
        help="The Python that has ROS 2, for robots of ROS; by default python3.",
    )(function)  # fmt: skip


def picture(option: str, help_text: str) -> Callable[[F], F]:
    """Return an option that takes the file of a picture."""
    return click.option(
        option, type=click.Path(path_type=Path), metavar="FILE",
        help=f"{help_text} A .png or .svg file.",
    )  # fmt: skip


def picture_form(path: Path) -> str:
    """Return the form of a picture, ``png`` or ``svg``, by the name of its file."""
    return path.suffix[1:].lower()


def check_picture(path: Path | None, option: str, *inputs: str) -> None:
    """Check that a picture can be written to a path, before any work is done.

    Raises:
        UsageError: if its form is unknown, it cannot be written, or it is one of ``inputs``.
    """
    if path is not None and picture_form(path) not in ("png", "svg"):
        raise UsageError(f"{option} writes .png or .svg, not '{path.suffix}'", path=str(path))
    if path is not None:
        require("matplotlib", option)
    check_target(path, *inputs)
