"""The methods of the benchmark by name: robots that help, and beliefs that watch."""

from __future__ import annotations

from collections.abc import Hashable
from functools import lru_cache
from pathlib import Path
from typing import Any

from hrcplan.assistance import ASSISTANTS, Assistant
from hrcplan.assistance.assistant import KnowsGoal
from hrcplan.bank.cache import cache_path
from hrcplan.core.text import nearest
from hrcplan.errors import UsageError
from hrcplan.inference.belief import Belief
from hrcplan.inference.classifier.forest import ForestBelief, forest_path
from hrcplan.inference.classifier.training import training_time
from hrcplan.inference.registry import METHODS, takes_goals
from hrcplan.studies.changed_mind import scenario
from hrcplan.studies.study import Cell, Say, StudyOptions
from hrcplan.studies.switch.tasks import bank_of, definition, files_of, task_names
from hrcplan.studies.switch.watcher import Watcher

ASSISTANCE, INFERENCE = "assistance", "inference"


def cells(table: str, options: StudyOptions) -> list[Cell]:
    """Return task, human and method of every cell of a table.

    Methods that options name take the place of those of the benchmark, if they are of use there.
    """
    names = [n for n in scenario.split_names(options["methods"]) if _is_for(n, table)]
    if not options["methods"]:
        names = definition()["tables"][table]["methods"]
    return [
        (task, human, method)
        for task in task_names()
        for human in definition()["humans"]
        for method in names
    ]


def _is_for(name: str, table: str) -> bool:
    """Return whether a method can act, or infer without being informed of the goal."""
    is_method = name in scenario.data()["methods"] or _is_robot(name)
    if table == ASSISTANCE:
        return is_method
    return name in METHODS.names() or not (is_method and _knows_goal(name))


def _knows_goal(name: str) -> bool:
    kind: Hashable = ASSISTANTS.find(scenario.data()["methods"].get(name, {}).get("part", name))
    return isinstance(kind, type) and issubclass(kind, KnowsGoal)


def _is_robot(name: str) -> bool:
    if name in ASSISTANTS.names():
        return True
    if ":" not in name:
        return False
    if name.partition(":")[0] in ASSISTANTS.prefixes:
        return True
    return "choose" in dir(METHODS.find(name))


def check(options: StudyOptions) -> None:
    """Check that every method that options name can be found.

    Raises:
        UsageError: if one cannot.
    """
    known = [*ASSISTANTS.names(), *METHODS.names(), *scenario.data()["methods"]]
    for name in scenario.split_names(options["methods"]):
        if ":" in name:
            _is_robot(name)
        elif name not in known:
            short = dict.fromkeys([*ASSISTANTS.names(), *METHODS.names()])
            hint = nearest(name, known) or f"{', '.join(short)}; or module:Class, cmd:PROGRAM"
            raise UsageError(f"there is no method '{name}'", code="unknown-method", hint=hint)


def robot(task: str, method: str) -> Assistant[Any]:
    """Return a method as a robot that helps in a task."""
    return scenario.robot(method, *files_of(task))


def watcher(task: str, method: str) -> Assistant[Any]:
    """Return a robot that acts as the recorder does and believes what a method believes."""
    return Watcher(robot(task, definition()["recorder"]), _belief(task, method))


@lru_cache(maxsize=scenario.MANY_ROBOTS)
def _belief(task: str, method: str) -> Belief[Any]:
    """Return a belief; a name of both a belief and a robot is that of the belief."""
    is_robot = method in scenario.data()["methods"] or _is_robot(method)
    if is_robot and method not in METHODS.names():
        return robot(task, method)
    kind = METHODS.find(method)
    if takes_goals(kind):
        message = f"'{method}' is made from goals, not from a bank of plans, and watches no episode"
        raise UsageError(message, code="not-a-method")
    return METHODS.make(method, bank_of(task))


def needs_training(method: str) -> bool:
    """Return whether a method trains a classifier, which takes minutes."""
    is_known = method in scenario.data()["methods"] or method in ASSISTANTS.names()
    return method == "forest" or (is_known and scenario.needs_forest(method))


def prepare(options: StudyOptions, jobs: int, say: Say) -> None:
    """Train the forests that methods need, so that no worker has to; they stay in the cache."""
    for task in task_names() if _are_forests_needed(options) else ():
        bank = bank_of(task)
        how_long = training_time(bank, jobs)
        say(f"{task}: a forest for {len(bank.names)} goals: trained once, {how_long}, then kept")
        ForestBelief(bank, n_jobs=jobs)


def files(options: StudyOptions) -> list[Path]:
    """Return the files of the cache folder that episodes read: banks, made here, and forests."""
    banks = [bank_of(task) for task in task_names()]
    forests = map(forest_path, banks if _are_forests_needed(options) else [])
    paths = [*(cache_path(bank.goals) for bank in banks), *forests]
    return [path for path in paths if path is not None]


def _are_forests_needed(options: StudyOptions) -> bool:
    names = {str(cell[2]) for table in (ASSISTANCE, INFERENCE) for cell in cells(table, options)}
    return any(map(needs_training, names))
