"""Goals that share a world: problems with the same objects and initial state."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from hrcplan.errors import InputError, UsageError
from hrcplan.pddl import check, library
from hrcplan.pddl.model import Formula, Problem, fact_text, number_text
from hrcplan.pddl.source import nearest
from hrcplan.task import Task
from hrcplan.task.conditions import Test

MAX_DIFFERENCES = 5  # named in one message


@dataclass(frozen=True, slots=True)
class SourceFile:
    """A file that goals were read from: its name as the user gave it, its path, its bytes."""

    name: str
    path: str
    data: bytes

    @property
    def sha256(self) -> str:
        """The hash of its bytes, in hexadecimal."""
        return hashlib.sha256(self.data).hexdigest()


@dataclass(frozen=True)
class Goals:
    """Goals in order, all for one task.

    ``problem`` is one of the problems; the others differ in name and goal only. ``aliases`` maps
    the name of an action that the domain declares more than once to the names it was given.
    """

    problem: Problem
    names: tuple[str, ...]
    formulas: tuple[Formula, ...]
    files: tuple[SourceFile, ...] = ()
    aliases: Mapping[str, tuple[str, ...]] | None = None

    def __len__(self) -> int:
        return len(self.names)

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
        return any(state & mask == value for mask, value in self.tests[goal])

    def only(self, names: Sequence[str]) -> Goals:
        """Return the goals of these names, in this order; the task stays the same.

        Raises:
            UsageError: if a name is not among the goals.
        """
        unknown = [name for name in names if name not in self.names]
        if unknown:
            raise UsageError(f"there is no goal '{unknown[0]}'", hint=nearest(unknown[0], self.names))
        chosen = tuple(self.formulas[self.names.index(name)] for name in names)
        return replace(self, names=tuple(names), formulas=chosen)


def read_goals(domain: str, goals: str | None = None) -> Goals:
    """Return the goals of a folder: problem files in the order of their names, or a
    Ramírez–Geffner folder; by default the shipped problems of the domain.

    Args:
        domain: A path or a shipped name.
        goals: A folder, or None.

    Raises:
        InputError: if a file is missing or has faults, there is no problem, two goals have one
            name, or objects or initial states differ; the message names the differences.
    """
    from hrcplan.bank import ramirez_geffner

    path = library.find_domain(domain)
    if goals is not None and ramirez_geffner.is_folder(Path(goals)):
        return ramirez_geffner.read_goals(Path(goals), path, domain)
    loaded = check.load_domain(path)
    files = [SourceFile(domain, str(path), path.read_bytes())]
    problems: list[Problem] = []
    for name, place in _problem_files(domain, path, goals):
        problems.append(check.load_problem(loaded, place))
        files.append(SourceFile(name, str(place), place.read_bytes()))
    return from_problems(problems, tuple(files))


def _problem_files(domain: str, path: Path, goals: str | None) -> Iterator[tuple[str, Path]]:
    if goals is None:
        shipped = library.problem_names(Path(domain).stem)
        if not shipped:
            message = f"no problems are shipped for domain '{Path(domain).stem}'"
            raise InputError(message, code="no-goals", hint="name a folder of problem files")
        for name in shipped:
            yield name, library.find_problem(domain, name)
        return
    folder = Path(goals)
    if not folder.is_dir():
        message = f"there is no folder '{goals}'"
        raise InputError(message, code="no-folder", path=goals, hint="GOALS is a folder")
    found = [p for p in sorted(folder.glob("*.pddl")) if p.resolve() != path.resolve()]
    found = [p for p in found if not _is_domain(p)]
    if not found:
        hint = "a folder of problem files, or one with template.pddl and hyps.dat"
        raise InputError(f"no problem file in '{goals}'", code="no-goals", path=goals, hint=hint)
    for place in found:
        yield str(place), place


def _is_domain(path: Path) -> bool:
    from hrcplan.pddl.reader import read
    from hrcplan.pddl.source import read_source

    root = read(read_source(path))
    heading = root[1] if root is not None and len(root) > 1 else None
    return getattr(heading, "head", "") == "domain"


def from_problems(problems: Sequence[Problem], files: tuple[SourceFile, ...] = ()) -> Goals:
    """Return the goals of problems that are alike in all but name and goal.

    Raises:
        InputError: if there are none, two have one name, or they differ in objects or init.
    """
    if not problems:
        raise InputError("no goals", code="no-goals")
    first = problems[0]
    seen: dict[str, Problem] = {}
    for problem in problems:
        if problem.name in seen:
            message = f"two goals are called '{problem.name}'"
            hint = f"the other is {seen[problem.name].path}" if seen[problem.name].path else None
            raise InputError(message, code="same-name", path=problem.path or None, hint=hint)
        seen[problem.name] = problem
        _check_alike(first, problem)
    return Goals(first, tuple(seen), tuple(p.goal for p in problems), files)


def _check_alike(first: Problem, other: Problem) -> None:
    found = list(_differences(first, other))
    if found:
        shown = "; ".join(found[:MAX_DIFFERENCES])
        more = f"; and {len(found) - MAX_DIFFERENCES} more" if len(found) > MAX_DIFFERENCES else ""
        message = f"'{other.name}' is not in the same world as '{first.name}': {shown}{more}"
        hint = "the goals of a bank share objects and init"
        raise InputError(message, code="goals-differ", path=other.path or None, hint=hint)


def _differences(first: Problem, other: Problem) -> Iterator[str]:
    if first.domain.name != other.domain.name:
        yield f"domain {other.domain.name} instead of {first.domain.name}"
    mine, theirs = first.all_objects, other.all_objects
    for name in sorted(mine.keys() | theirs.keys()):
        if mine.get(name) != theirs.get(name):
            yield f"object {name} is {theirs.get(name, 'missing')}, there {mine.get(name, 'missing')}"
    for fact in sorted(first.facts ^ other.facts):
        yield f"{fact_text(fact)} holds only in {(first if fact in first.facts else other).name}"
    for key in sorted(first.values.keys() | other.values.keys()):
        one, two = first.values.get(key), other.values.get(key)
        if one != two:
            texts = ("missing" if v is None else number_text(v) for v in (two, one))
            yield f"{fact_text(key)} is {next(texts)}, there {next(texts)}"
