"""Folders of the goal recognition benchmarks of Ramírez and Geffner (IJCAI 2009).

``template.pddl`` is a problem with ``<HYPOTHESIS>`` for its goal, ``hyps.dat`` lists the goals, one
a line, ``real_hyp.dat`` repeats the true one, ``obs.dat`` lists the observed actions. The files
in circulation mix upper and lower case, end in blank lines, and declare actions more than once.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from hrcplan.bank.goals import Goals, SourceFile
from hrcplan.errors import InputError, PddlError, PlanFormatError
from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.generate import with_goal
from hrcplan.pddl.model import TRUE, And, Formula, Problem
from hrcplan.pddl.reader import GroupNode, WordNode, read
from hrcplan.pddl.source import SourceText, read_source, read_text
from hrcplan.plans import Plan, parse_plan, plans_of_log

KIND = "ramirez-geffner"
TEMPLATE, HYPOTHESES = "template.pddl", "hyps.dat"
OBSERVATIONS, TRUE_HYPOTHESIS, DOMAIN = "obs.dat", "real_hyp.dat", "domain.pddl"
_PLACE = re.compile(r"<hypothesis>", re.IGNORECASE)
_NO_WORD = re.compile(r"^\s*+(?:step\s++)?[\d.]++\s*+:|\[[^\[\]]*+\]|[()]", re.IGNORECASE)
_BETWEEN = re.compile(r"\)\s*,\s*")


@dataclass(frozen=True)
class RecognitionInstance:
    """A whole folder: goals, observed actions, and the index of the true goal.

    Actions are ``(name, *objects)`` in lower case; there are none, and the true goal is None, where
    the files are missing.
    """

    goals: Goals
    observations: tuple[tuple[str, ...], ...]
    true_goal: int | None


def is_folder(path: Path) -> bool:
    """Return whether a path is a folder of this kind."""
    return os.path.isfile(path / TEMPLATE) and os.path.isfile(path / HYPOTHESES)


def read_instance(folder: Path) -> RecognitionInstance:
    """Return all that a folder holds; its domain is ``domain.pddl`` in the folder.

    Raises:
        InputError: if a file is missing or has faults, or the true goal is not among the goals.
    """
    if not is_folder(folder):
        message = f"'{folder}' has no {TEMPLATE} and {HYPOTHESES}"
        raise InputError(message, code="no-goals", path=str(folder))
    goals = goals_of(*(SourceFile.read(folder / part) for part in (DOMAIN, TEMPLATE, HYPOTHESES)))
    path = folder / OBSERVATIONS
    actions = read_actions(read_text(path), goals.problem) if os.path.isfile(path) else ()
    return RecognitionInstance(goals, actions, _true_goal(folder / TRUE_HYPOTHESIS, goals))


def read_actions(text: str, problem: Problem | None = None) -> tuple[tuple[str, ...], ...]:
    r"""Return the actions of a text as ``(name, *objects)`` in lower case, in order of time.

    The text is a plan as `parse_plan` reads it, a planner's log with one plan (if a problem is
    given), or it has one action a line, with or without parentheses.

    >>> read_actions("(TAKE plate)\n\n(take bread)\n")
    (('take', 'plate'), ('take', 'bread'))
    >>> read_actions("0: (take plate) [1]\n1: (take bread) [1]")
    (('take', 'plate'), ('take', 'bread'))
    """
    try:
        return _words(parse_plan(text))
    except PlanFormatError:
        plans = [] if problem is None else plans_of_log(text, problem)
    if problem is not None and (len(plans) == 1 or (plans and problem.domain.is_temporal)):
        return _words(plans[-1])
    return tuple(action for line in text.splitlines() for action in _actions_of_line(line))


def _words(plan: Plan) -> tuple[tuple[str, ...], ...]:
    return tuple((action.name, *action.args) for action in plan.actions)


def _actions_of_line(line: str) -> tuple[tuple[str, ...], ...]:
    try:
        return _words(parse_plan(line))
    except PlanFormatError:
        words = _NO_WORD.sub(" ", line.split(";", 1)[0]).lower().split()
        return (tuple(words),) if words else ()


def goals_of(domain: SourceFile, template: SourceFile, hypotheses: SourceFile) -> Goals:
    """Return the goals of a folder in the order of ``hyps.dat``; each is called like its line.

    Raises:
        PddlError: if domain or template has faults.
        InputError: if a line of ``hyps.dat`` is no goal of the template.
    """
    source, aliases = _without_duplicates(domain.source())
    frame = template.source()
    if not _PLACE.search(frame.text):
        raise InputError(f"no <HYPOTHESIS> in {TEMPLATE}", code="no-goals", path=frame.path)
    text = _PLACE.sub(lambda match: " " * len(match[0]), frame.text)
    base = problem_in(domain_in(source), SourceText(frame.path, text))
    lines = list(_lines(hypotheses.source()))
    if not lines:
        raise InputError(f"{HYPOTHESES} lists no goal", code="no-goals", path=hypotheses.path)
    formulas = tuple(_goal(base, line, hypotheses.path, number) for number, line in lines)
    return Goals(replace(base, goal=formulas[0]), tuple(line for _, line in lines), formulas,
                 (domain, template, hypotheses), KIND, aliases)  # fmt: skip


def _lines(source: SourceText) -> Iterator[tuple[int, str]]:
    for number, line in enumerate(source.text.splitlines(), start=1):
        if line.strip():
            yield number, line.strip()


def _goal(base: Problem, line: str, path: str, number: int) -> Formula:
    try:
        goal = with_goal(base, f"(and {_BETWEEN.sub(') ', line).rstrip(',')})", "goal").goal
    except PddlError as error:
        raise InputError(error.message, code=error.code, path=path, line=number,
                         hint=error.hint) from None  # fmt: skip
    return goal if base.goal == TRUE else And((base.goal, goal))


def _true_goal(path: Path, goals: Goals) -> int | None:
    if not os.path.isfile(path):
        return None
    sets = [_parts(formula) for formula in goals.formulas]
    common = frozenset.intersection(*sets)  # what the template asks for besides the hypothesis
    world = replace(goals.problem, goal=TRUE)
    for number, line in _lines(read_source(path)):
        goal_parts = _parts(_goal(world, line, str(path), number))
        for index, parts in enumerate(sets):
            if parts == goal_parts | (parts & common):
                return index
    message = f"the true goal is not among those of {HYPOTHESES}"
    raise InputError(message, code="no-goals", path=str(path))


def _parts(formula: Formula) -> frozenset[Formula]:
    if isinstance(formula, And):
        return frozenset(leaf for part in formula.parts for leaf in _parts(part))
    return frozenset([formula])


def _without_duplicates(source: SourceText) -> tuple[SourceText, Mapping[str, tuple[str, ...]]]:
    """Return a domain's text in which actions have different names, and the new names of each."""
    root = read(SourceText(source.path, source.text))
    places: dict[str, list[WordNode]] = {}
    for node in root or ():
        if isinstance(node, GroupNode) and node.head == ":action" and len(node) > 1:
            word = node[1]
            if isinstance(word, WordNode):
                places.setdefault(str(word).lower(), []).append(word)
    names_in_use, text = set(places), source.text
    names: dict[str, list[str]] = {name: [name] for name, words in places.items() if len(words) > 1}
    edits: list[tuple[int, str, str]] = []
    for name, new_names in names.items():
        for word in places[name][1:]:
            count = len(new_names) + 1
            while f"{name}-{count}" in names_in_use:
                count += 1
            new_names.append(f"{name}-{count}")
            names_in_use.add(new_names[-1])
            edits.append((word.at, name, new_names[-1]))
    for at, name, new in sorted(edits, reverse=True):
        text = text[:at] + new + text[at + len(name) :]
    return SourceText(source.path, text), {
        name: tuple(new_names) for name, new_names in names.items()
    }
