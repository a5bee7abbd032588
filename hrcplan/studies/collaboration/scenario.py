"""What the study compares, read from ``scenario.toml``: tasks are never named in Python."""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from itertools import permutations
from pathlib import Path
from typing import Any

from hrcplan.agents import Profile
from hrcplan.assistance.assistant import Assistant
from hrcplan.bank import Bank, Goals, read_goals
from hrcplan.bank.cache import cache_path, cached_bank
from hrcplan.bank.turn_moves import team_moves
from hrcplan.collaboration.collaborate import assistant_of, make_setup
from hrcplan.collaboration.robots import check_robot
from hrcplan.collaboration.setup import CollaborationSetup
from hrcplan.core.numbers import Number
from hrcplan.core.text import nearest
from hrcplan.episodes.humans import HUMANS, Course
from hrcplan.errors import UsageError
from hrcplan.execution.worlds.simulated import Nature, StateChange
from hrcplan.pddl.conventions import people
from hrcplan.pddl.model import FluentKey
from hrcplan.studies.collaboration.prices import TaskPrices
from hrcplan.studies.scenario import Scenario
from hrcplan.studies.study import Cell, Seed, StudyOptions

MAIN, OTHERS = "rows", "others"
KEYS = ("task", "method")
ROW_FORMAT = 1
"""It changes when episodes get other columns or values: rows of two formats are not mixed."""

SCENARIO = Scenario(Path(__file__).parent, ("methods", "humans"))
data, defaults = SCENARIO.data, SCENARIO.defaults


# Cells.


def cells(table: str, options: StudyOptions) -> list[Cell]:
    """Return task and method of every cell of a table; a task's name also says who the human is."""
    methods = _chosen(options["methods"], data()["tables"][table]["methods"])
    names = _chosen(options["humans"], data()["tables"][table]["humans"], table == MAIN)
    tasks = [f"{task}{human_suffix(name)}" for name in names for task in tasks_of(options)]
    return [(task, method) for task in tasks for method in methods]


def _chosen(text: str, own: list[str], adds: bool = True) -> list[str]:
    """Return the names in a text with commas, or the study's own ones.

    Those that the table has not are added to it, if it takes more.
    """
    names = [name.strip() for name in text.split(",") if name.strip()]
    if not names:
        return own
    return [n for n in own if n in names] + [n for n in names if n not in own and adds]


def tasks_of(options: StudyOptions) -> list[str]:
    """Return the tasks: the study's own, or the one that options name."""
    return [options["domain"]] if options["domain"] else list(data()["tasks"])


def human_suffix(human: str) -> str:
    """Return what follows the name of a task, of a human who is not that of the main table."""
    return "" if human == data()["tables"][MAIN]["humans"][0] else f", {human}"


def split_case(case: str) -> tuple[str, str]:
    """Return task and human of a cell.

    >>> split_case("kitchen"), split_case("kitchen, steady")
    (('kitchen', 'changing'), ('kitchen', 'steady'))
    """
    task, comma, human = case.rpartition(", ")
    return (task, human) if comma else (case, data()["tables"][MAIN]["humans"][0])


def check(options: StudyOptions) -> None:
    """Check that every part that options name can be found.

    Raises:
        UsageError: if one cannot.
    """
    for name in _chosen(options["methods"], []):
        check_robot(name)
    for name in _chosen(options["humans"], []):
        if name not in data()["humans"]:
            hint = nearest(name, data()["humans"]) or f"humans: {', '.join(data()['humans'])}"
            raise UsageError(f"there is no human '{name}'", code="unknown-human", hint=hint)
    HUMANS.find(options["chooser"])


# Parts.


@lru_cache(maxsize=8)
def goals_of(domain: str, goals: str) -> Goals:
    """Return the goals of a domain, from a folder or as shipped."""
    return read_goals(domain, goals or None)


def files_of(options: StudyOptions, task: str) -> tuple[str, str]:
    """Return domain and goals of a task: one of the study's, or the user's."""
    if options["domain"]:
        return options["domain"], options["goals"]
    table = data()["tasks"][task]
    return table["domain"], table.get("goals", "")


class StudyTask:
    """The bank of a task, with what its episodes share.

    Args:
        domain: The domain.
        goals: A folder of goals of it; "" for the shipped ones.

    Raises:
        UsageError: if there are fewer than two goals, or one has no plan.
    """

    def __init__(self, domain: str, goals: str) -> None:
        self.bank: Bank = cached_bank(goals_of(domain, goals))
        if len(self.bank.names) < 2:
            raise UsageError("a goal can only change where there are two", code="too-few-goals")
        for graph in self.bank.graphs:
            if not graph.n_steps:
                message = f"goal '{graph.goal}' has no plan, or holds from the start"
                raise UsageError(message, code="no-plan")
        self.moves = team_moves(self.bank)  # held: it is shared as long as one needs it
        self.prices = TaskPrices(self.bank)
        self._assistants: dict[str, Assistant[Any]] = {}

    def assistant(self, setup: CollaborationSetup) -> Assistant[Any]:
        """Return the assistant of a robot; its states are immutable, so episodes share it."""
        if setup.method not in self._assistants:
            self._assistants[setup.method] = assistant_of(setup)(self.bank)
        return self._assistants[setup.method]

    def setup(self, options: StudyOptions, method: str, seed: Seed) -> CollaborationSetup:
        """Return what the collaboration of a run depends on."""
        human = {"name": options["chooser"]}
        setup = make_setup(
            self.bank, pace=options["pace"], method=method, seed=seed.run, human=human
        )
        return replace(setup, profile=Profile(**data()["profile"]))


@lru_cache(maxsize=4)
def task_of(domain: str, goals: str) -> StudyTask:
    """Return a task, with its bank from the cache."""
    return StudyTask(domain, goals)


def inputs(options: StudyOptions) -> str:
    """Return what rows depend on: tables of the file, the problems, and their goals.

    Raises:
        UsageError: if something that options name cannot be found, or is nothing to study.
    """
    check(options)
    goals = [goals_of(*files_of(options, task)) for task in tasks_of(options)]
    texts = [text for one in goals for text in (*one.names, *map(str, one.formulas))]
    texts.append(f"rows of format {ROW_FORMAT}")
    keys = ("study", "profile", "humans", "tables")
    return SCENARIO.inputs(keys, [one.problem for one in goals], texts)


def files(options: StudyOptions) -> list[Path]:
    """Return the files of the cache folder that episodes read: the banks of tasks, made here."""
    goals = [goals_of(*files_of(options, task)) for task in tasks_of(options)]
    return [path for one in goals if (path := cache_path(cached_bank(one).goals)) is not None]


# What is drawn; it depends on the run alone.


def course(bank: Bank, human: str, seed: Seed) -> Course:
    """Return what a human wants and when.

    The pairs of goals come in turn; the change comes before an action of the human that is uniform
    among those before the first goal could be finished by both.
    """
    table, chance = data()["humans"][human], random.Random(f"{seed}/course")
    n = len(bank.names)
    pairs = _pairs(seed.study, seed.run // (n * (n - 1)), n)
    goals = pairs[seed.run % len(pairs)][: 1 + table["changes"]]
    most = max(1, (bank.graphs[goals[0]].n_steps - 1) // 2)
    turns = tuple(chance.randint(1, most) for _ in goals[1:])
    return Course(goals, turns, table.get("mistake_rate", 0.0), seed=str(seed))


@lru_cache(maxsize=8)
def _pairs(study_seed: int, trial: int, n: int) -> list[tuple[int, int]]:
    """Return all ordered pairs of goals in the order in which a trial goes through them."""
    pairs = list(permutations(range(n), 2))
    random.Random(f"{study_seed}/{trial}/pairs").shuffle(pairs)
    return pairs


def nature(setup: CollaborationSetup, human: str, seed: Seed, lasts_s: float) -> Nature:
    """Return how the agent state of people drifts.

    Args:
        setup: The collaboration.
        human: Whose it is.
        seed: Of the run.
        lasts_s: How long the goals take about; drifts begin at a time that is uniform in it.
    """
    study, chance = data()["study"], random.Random(f"{seed}/drift")
    times = sorted(chance.uniform(0, lasts_s) for _ in range(data()["humans"][human]["drifts"]))
    low = setup.model.agents.low
    before: Mapping[FluentKey, Number] = {}
    changes = []
    for t in times:
        drifted = _drifted(setup, chance, study["levels"])
        changes.append(StateChange(t, {**{key: low[key] for key in before}, **drifted}))
        before = drifted
    return Nature(str(seed), tuple(changes), sensed=study["sensed"], draws=study["draws"])


def _drifted(
    setup: CollaborationSetup, chance: random.Random, levels: list[int]
) -> dict[FluentKey, Number]:
    """Return the elements of one person's agent state that take another value."""
    agents = setup.model.agents
    persons = [a for a in setup.people if a in people(setup.problem) and agents.elements(a)]
    if not persons:
        return {}
    elements = agents.elements(chance.choice(persons))
    name = chance.choice(sorted({key[0] for key in elements}))
    of_function = [key for key in elements if key[0] == name]
    half = (len(of_function) + 1) // 2
    some = chance.choice([of_function[:half], of_function[-half:]])
    value = agents.clamp(some[0], chance.randint(*levels))
    return dict.fromkeys(some, value)


def runs(options: StudyOptions) -> int:
    """Return how many runs a cell has."""
    return int(data()["study"]["runs"])
