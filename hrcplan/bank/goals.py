"""Goals that share a world: problems with the same objects and initial state."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from hrcplan.core.files import read_bytes
from hrcplan.core.numbers import number_text
from hrcplan.core.text import cut, nearest, plural
from hrcplan.errors import InputError, UsageError
from hrcplan.pddl.constructs import constructs
from hrcplan.pddl.model import Formula, Problem, fact_text
from hrcplan.pddl.source import SourceText, decode
from hrcplan.task import Task
from hrcplan.task.conditions import Test, meets

MAX_DIFFERENCES = 5  # named in one message


@dataclass(frozen=True, slots=True)
class SourceFile:
    """A file that goals are read from: its path and its bytes."""

    path: str
    data: bytes

    @classmethod
    def read(cls, path: Path) -> SourceFile:
        """Return a file's bytes.

        Raises:
            InputError: if it is missing or may not be read.
        """
        return cls(str(path), read_bytes(path))

    def source(self) -> SourceText:
        """Return its text, to be read as PDDL."""
        return decode(self.path, self.data)

    @property
    def sha256(self) -> str:
        """The hash of its bytes, in hexadecimal."""
        return hashlib.sha256(self.data).hexdigest()


@dataclass(frozen=True, repr=False)
class Goals:
    """Goals in order, all for one task.

    ``problem`` is one of the problems; the others differ in name and goal only. ``files`` are the
    domain's and then the rest, ``kind`` how they are to be read. ``aliases`` maps the name of an
    action that the domain declares more than once to the names it was given.
    """

    problem: Problem
    names: tuple[str, ...]
    formulas: tuple[Formula, ...]
    files: tuple[SourceFile, ...] = ()
    kind: str = "problems"
    aliases: Mapping[str, tuple[str, ...]] | None = None

    def __len__(self) -> int:
        return len(self.names)

    def __repr__(self) -> str:
        return f"<Goals {self.title}>"

    @property
    def title(self) -> str:
        """The domain and how many goals there are, on one short line."""
        return f"{cut(self.problem.domain.name, 80)}: {plural(len(self), 'goal')}"

    @cached_property
    def task(self) -> Task:
        """The grounded task; its own goal is that of the first problem."""
        return Task(self.problem)

    @cached_property
    def tests(self) -> tuple[tuple[Test, ...], ...]:
        """For each goal its alternatives as ``(mask, value)`` over the facts of ``task``."""
        return tuple(self.task.with_goal(formula).goal for formula in self.formulas)

    def is_reached(self, goal: int, state: int) -> bool:
        """Return whether a goal holds in a state of ``task``."""
        return meets(state, self.tests[goal])

    def only(self, names: Sequence[str]) -> Goals:
        """Return the goals of these names, in this order; the task stays the same.

        Raises:
            UsageError: if a name is not among the goals.
        """
        unknown = [name for name in names if name not in self.names]
        if unknown:
            raise UsageError(
                f"there is no goal '{unknown[0]}'", hint=nearest(unknown[0], self.names)
            )
        formulas = tuple(self.formulas[self.names.index(name)] for name in names)
        return replace(self, names=tuple(names), formulas=formulas)

    def plus(self, names: Sequence[str], formulas: Sequence[Formula]) -> Goals:
        """Return these goals and further ones of the same task, which is not grounded again."""
        all_names, all_formulas = (*self.names, *names), (*self.formulas, *formulas)
        more = replace(self, names=all_names, formulas=all_formulas, files=())
        vars(more)["task"] = self.task
        return more


def from_problems(problems: Sequence[Problem], files: tuple[SourceFile, ...] = ()) -> Goals:
    """Return the goals of problems that are alike in all but name and goal.

    Raises:
        InputError: if there are none, two have one name, or they differ in objects or init.
    """
    if not problems:
        raise InputError("no goals", code="no-goals")
    first = problems[0]
    by_name: dict[str, Problem] = {}
    for problem in problems:
        if problem.name in by_name:
            message = f"two goals are called '{problem.name}'"
            hint = (
                f"the other is {by_name[problem.name].path}" if by_name[problem.name].path else None
            )
            raise InputError(message, code="same-name", path=problem.path or None, hint=hint)
        by_name[problem.name] = problem
        _check_alike(first, problem)
    return Goals(first, tuple(by_name), tuple(p.goal for p in problems), files)


def _check_alike(first: Problem, other: Problem) -> None:
    lines = list(_differences(first, other))
    if lines:
        differences = "; ".join(lines[:MAX_DIFFERENCES])
        more = f"; and {len(lines) - MAX_DIFFERENCES} more" if len(lines) > MAX_DIFFERENCES else ""
        message = f"'{other.name}' is not in the same world as '{first.name}': {differences}{more}"
        hint = "the goals of a bank share objects and init"
        raise InputError(message, code="goals-differ", path=other.path or None, hint=hint)


def _differences(first: Problem, other: Problem) -> Iterator[str]:
    if first.domain.name != other.domain.name:
        yield f"domain {other.domain.name} instead of {first.domain.name}"
    elif replace(other.domain, path="") != replace(first.domain, path=""):
        yield f"another domain that is called {other.domain.name}, too"
    mine, theirs = first.all_objects, other.all_objects
    for name in sorted(mine.keys() | theirs.keys()):
        here, there = theirs.get(name, "missing"), mine.get(name, "missing")
        if here != there:
            yield f"object {name} is {here}, there {there}"
    for fact in sorted(first.facts ^ other.facts):
        yield f"{fact_text(fact)} holds only in {(first if fact in first.facts else other).name}"
    for key in sorted(first.values.keys() | other.values.keys()):
        one, two = first.values.get(key), other.values.get(key)
        if one != two:
            texts = ("missing" if v is None else number_text(v) for v in (two, one))
            yield f"{fact_text(key)} is {next(texts)}, there {next(texts)}"
    theirs_only = set(constructs(other))
    for construct in sorted(theirs_only.symmetric_difference(constructs(first))):
        owner = other if construct in theirs_only else first
        yield f"only {owner.name} has {construct}"
