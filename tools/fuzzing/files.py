"""Targets that take PDDL: shipped and public files, changed as texts or as trees."""

from __future__ import annotations

import random
import time
from functools import cache
from pathlib import Path

from fuzzing import mutate, trees
from hrcplan.errors import PddlError
from hrcplan.pddl import library
from hrcplan.pddl.check import check, domain_in, problem_in
from hrcplan.pddl.model import Problem
from hrcplan.pddl.reader import read
from hrcplan.pddl.source import SourceText
from hrcplan.pddl.write import domain_text, problem_text
from hrcplan.plans import Plan, PlannedAction
from hrcplan.task import Task
from hrcplan.validation import validate

PAIRS = (
    ("transport", "two-boxes"),
    ("transport", "handover"),
    ("transport-coached", "two-boxes"),
    ("kitchen", "parfait-nut"),
)
PUBLIC = Path(__file__).parents[2] / "tests" / "data" / "public"
GROUNDING_S = 2.0
"""Seconds that a mutant may be grounded for: one without types can have millions of actions."""
WALK = 20
"""Steps of a walk in a mutant that can be grounded."""
TOKENISED = {"yes": 0, "no": 0}


def pddl(rng: random.Random, folder: Path) -> None:
    """Check, read, ground and write a mutated domain or problem."""
    _read_mutant(rng, folder, texts(rng.choice(PAIRS)))


def public(rng: random.Random, folder: Path) -> None:
    """Do the same with public files: derived predicates, preferences, timed literals, numbers."""
    _read_mutant(rng, folder, _public_texts(rng))


def tree(rng: random.Random, folder: Path) -> None:
    """Change names and groups; what can be read is walked in, replayed, written and read again."""
    sources = texts(rng.choice(PAIRS)) if rng.random() < 0.3 else _public_texts(rng)
    changed = trees.mutant(rng, sources)
    _count_tokenised(changed[0])
    problem = _problem(changed)
    written = _written(problem)
    assert _written(_problem(written)) == written, "written differently"
    _walk(rng, Task(problem, time.monotonic() + GROUNDING_S))


@cache
def texts(pair: tuple[str, str]) -> list[str]:
    """Return the texts of a shipped domain and problem."""
    return [library.find_domain(pair[0]).read_text(), library.find_problem(*pair).read_text()]


def _public_texts(rng: random.Random) -> list[str]:
    return _texts_in(rng.choice(_public_folders()))


@cache
def _texts_in(folder: Path) -> list[str]:
    return [(folder / name).read_text() for name in ("domain.pddl", "problem.pddl")]


@cache
def _public_folders() -> list[Path]:
    return sorted(path.parent for path in PUBLIC.glob("*/*/problem.pddl"))


def _read_mutant(rng: random.Random, folder: Path, sources: list[str]) -> None:
    changed, which = list(sources), rng.randrange(2)
    changed[which] = mutate.text(rng, changed[which])
    paths = [str(folder / "d.pddl"), str(folder / "p.pddl")]
    _count_tokenised(changed[which])
    contents: dict[str, str] = dict(zip(paths, changed, strict=True))
    if rng.random() < 0.05:  # as files, of which some bytes are others
        for path, text in contents.items():
            Path(path).write_bytes(mutate.data(rng, text.encode("utf-8", "replace")))
        contents = {}
    report = check(paths, contents)
    faults = [d for d in report.diagnostics if d.severity == "error"]
    if faults and rng.random() < 0.9:  # else it is refused below
        raise PddlError(faults)
    problem = _problem(changed)
    assert not faults or not contents, f"check refuses what can be loaded: {faults[0]}"
    problem_text(problem)
    task = Task(problem, time.monotonic() + GROUNDING_S)
    for action in task.applicable(task.initial)[:WALK]:
        task.successor(task.initial, action)


def _count_tokenised(text: str) -> None:
    source = SourceText("x", text)
    root = read(source)
    TOKENISED["yes" if root is not None and not source.has_errors else "no"] += 1


def _problem(pair: list[str]) -> Problem:
    return problem_in(domain_in(SourceText("d", pair[0])), SourceText("p", pair[1]))


def _written(problem: Problem) -> list[str]:
    return [domain_text(problem.domain), problem_text(problem)]


def _walk(rng: random.Random, task: Task) -> None:
    """Walk in the ground task: the replay of the PDDL accepts every step, and the goal alike."""
    state, steps = task.initial, list[PlannedAction]()
    for _ in range(WALK):
        options = task.applicable(state)
        if not options:
            break
        step = task.actions[rng.choice(options)]
        if step.duration is None and task.problem.domain.is_temporal:
            return  # it is chosen
        state = task.successor(state, step.index)
        steps.append(PlannedAction(step.name, step.args))
    report = validate(task.problem, Plan(tuple(steps)))
    assert report.valid == task.is_goal(state), report.reason
