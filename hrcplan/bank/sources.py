"""Where goals are read from: folders of problem files, goal recognition folders, stored texts."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from hrcplan.bank import ramirez_geffner
from hrcplan.bank.goals import Goals, SourceFile, from_problems
from hrcplan.core.text import quote
from hrcplan.errors import InputError
from hrcplan.pddl import inputs, library
from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.reader import GroupNode, read

KINDS = ("problems", ramirez_geffner.KIND)


def read_goals(domain: str, goals: str | None = None) -> Goals:
    """Return the goals of a folder, or of ``problems/DOMAIN`` here, or else the shipped ones.

    Problem files stand in the order of their names; a folder may also be one of Ramírez and
    Geffner's, with ``template.pddl`` and ``hyps.dat``.

    Args:
        domain: A path or a shipped name.
        goals: A folder, the name of a folder of shipped problems, or None.

    Raises:
        PddlError: with every fault of the first file that has any.
        InputError: if a file is missing, there is no problem, two goals have one name, or objects
            or initial states differ; the message names the differences.
    """
    first = SourceFile.read(library.find_domain(domain))
    stem = Path(domain).stem
    folder = library.own_goals(stem) if goals is None else library.find_goals(goals)
    if folder is not None and ramirez_geffner.is_folder(folder):
        parts = (ramirez_geffner.TEMPLATE, ramirez_geffner.HYPOTHESES)
        files = (SourceFile.read(folder / part) for part in parts)
        return goals_in((first, *files), ramirez_geffner.KIND)
    return goals_in((first, *_problem_files(domain, first, folder)))


def goals_named(domain: str, goals: str | None = None) -> Goals:
    """Return the goals that words name: those of `read_goals`, or that of one problem.

    Args:
        domain: As for `read_goals`, or domain and problem in one word (``transport/two-boxes``).
        goals: As for `read_goals`, or the path of a problem.

    Raises:
        PddlError: with every fault of the first file that has any.
        InputError: as `read_goals` does.
    """
    is_pair = goals is None and domain.count("/") == 1 and not domain.endswith(".pddl")
    if is_pair and not os.path.exists(domain):
        return from_problems([inputs.read(*domain.split("/"))])
    if goals is not None and goals.endswith(".pddl") and not os.path.isdir(goals):
        return from_problems([inputs.read(domain, goals)])
    return read_goals(domain, goals)


def goals_in(files: tuple[SourceFile, ...], kind: str = "problems") -> Goals:
    """Return the goals that files hold: a domain, then problems, or a template and its goals.

    Raises:
        InputError: if the kind is unknown, or a file has faults.
    """
    if kind not in KINDS:
        raise InputError(f"goals of an unknown kind: {quote(str(kind))}", code="bad-goals")
    if kind == ramirez_geffner.KIND:
        return ramirez_geffner.goals_of(*files)
    domain = domain_in(files[0].source())
    return from_problems([problem_in(domain, file.source()) for file in files[1:]], files)


def _problem_files(domain: str, first: SourceFile, folder: Path | None) -> Iterator[SourceFile]:
    if folder is None:
        yield from _library_files(domain)
        return
    if not os.path.isdir(folder):
        hint = "GOALS is a folder of problem files, or one with template.pddl and hyps.dat"
        raise InputError(
            f"there is no folder '{folder}'", code="no-folder", path=str(folder), hint=hint
        )
    files = [SourceFile.read(p) for p in sorted(folder.glob("*.pddl")) if p.is_file()]
    problems = [file for file in files if not _is_domain(file)]
    if not problems:
        hint = "it needs problem files, or template.pddl and hyps.dat"
        raise InputError(f"no problem in '{folder}'", code="no-goals", path=str(folder), hint=hint)
    yield from problems


def _library_files(domain: str) -> Iterator[SourceFile]:
    name = Path(domain).stem
    names = library.problem_names(name)
    if not names:
        message = f"no problems are shipped for domain '{name}'"
        raise InputError(message, code="no-goals", hint="name a folder of problem files")
    for problem in names:
        yield SourceFile.read(library.find_problem(name, problem))


def _is_domain(file: SourceFile) -> bool:
    root = read(file.source())
    heading = root[1] if root is not None and len(root) > 1 else None
    return isinstance(heading, GroupNode) and heading.head == "domain"
