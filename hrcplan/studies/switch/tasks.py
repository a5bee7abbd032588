"""The worlds of the benchmark, and what makes those that are not shipped."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from hrcplan.bank import Bank, Goals, read_goals
from hrcplan.bank.team_moves import TeamMoves
from hrcplan.bank.turn_moves import team_moves
from hrcplan.bank.variants import vary
from hrcplan.bank.walked_goals import GoalRules, walked_goals
from hrcplan.core.files import cache_folder, make_folder, write_atomically
from hrcplan.core.toml import read_toml
from hrcplan.inference.traces import text_sha256, world_sha256
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import TRUE
from hrcplan.pddl.write import domain_text, problem_text
from hrcplan.studies.changed_mind import scenario
from hrcplan.studies.study import StudyOptions

HERE = Path(__file__).parent
BENCHMARK = HERE / "benchmark.toml"
NAME = "hrcplan-switch"


@cache
def definition() -> Mapping[str, Any]:
    """Return the definition of the benchmark."""
    return read_toml(BENCHMARK, "bad-benchmark")


def task_names() -> list[str]:
    """Return the names of the tasks, in order."""
    return list(definition()["tasks"])


@cache
def goals_of(task: str) -> Goals:
    """Return the goals of a task: shipped ones, or made from the task's seed."""
    table = definition()["tasks"][task]
    if "domain" in table:
        return scenario.goals_of(table["domain"], table.get("goals", ""))
    n, seed = table["n_goals"], table["seed"]
    if "variants" in table:
        return vary(read_goals(table["variants"], None), n, seed)
    folder = HERE / table["walks"]
    world = read(str(folder / "domain.pddl"), str(folder / "world.pddl"))
    rules = GoalRules(frozenset(table["predicates"]), table["n_facts"], table["least_steps"])
    return walked_goals(world, rules, n, seed)


def pddl_files(task: str) -> dict[str, str]:
    """Return a task as PDDL files: the domain, and a problem for each goal.

    They are written by this package, so that they are the same on every machine.
    """
    goals = goals_of(task)
    files = {"domain.pddl": domain_text(goals.problem.domain)}
    for name, formula in zip(goals.names, goals.formulas, strict=True):
        files[f"{name}.pddl"] = problem_text(replace(goals.problem, name=name, goal=formula))
    return files


def all_pddl_files() -> dict[str, str]:
    """Return the PDDL files of all tasks, below a folder for each.

    >>> [name for name in all_pddl_files() if name.startswith("yard/")][:2]
    ['yard/domain.pddl', 'yard/goal-01.pddl']
    """
    return {
        f"{task}/{name}": text for task in task_names() for name, text in pddl_files(task).items()
    }


def hashes_of(task: str) -> dict[str, str]:
    """Return the hash of a task's world, as in traces, and that of all its files."""
    text = "".join(f"{name}\n{text}" for name, text in pddl_files(task).items())
    world = world_sha256(replace(goals_of(task).problem, goal=TRUE))
    return {"pddl_sha256": world, "files_sha256": text_sha256(text)}


@cache
def options_of(task: str) -> StudyOptions:
    """Return the options of the changed-mind study by which the episodes of a task are played."""
    table = definition()["tasks"][task]
    names = {"domain": table.get("domain", ""), "goals": table.get("goals", "")}
    if not names["domain"]:
        folder = _written(task)
        names = {"domain": str(folder / "domain.pddl"), "goals": str(folder)}
    return {**scenario.defaults(), **names, "chooser": table["chooser"]}


def _written(task: str) -> Path:
    """Return a folder with the PDDL files of a task, in the cache."""
    cache_root = cache_folder() or Path(tempfile.mkdtemp(prefix="hrcplan-"))
    folder = cache_root / "switch" / f"{task}-{hashes_of(task)['files_sha256'][:16]}"
    write_pddl(task, folder)
    return folder


def write_pddl(task: str, folder: Path) -> None:
    """Write the PDDL files of a task that are not there yet.

    Raises:
        UsageError: if that is not possible.
    """
    make_folder(folder)
    for name, text in pddl_files(task).items():
        path = folder / name
        if not path.is_file() or path.read_text("utf-8") != text:
            write_atomically(path, text)


def files_of(task: str) -> tuple[str, str, str, str]:
    """Return domain, goals and multiples of a task, as the changed-mind study knows its bank by."""
    return scenario.task_of(options_of(task), definition()["humans"][0])


@cache
def bank_of(task: str) -> Bank:
    """Return the bank of a task, from the cache if it was built before."""
    bank = scenario.bank_of(*files_of(task))
    _held_moves.append(team_moves(bank))
    return bank


_held_moves: list[TeamMoves | None] = []
"""The costs to go of a team are shared as long as one holds them: they serve all episodes."""
