"""What the study compares, read from ``scenario.toml``: tasks are never named in Python."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import lru_cache
from itertools import permutations
from pathlib import Path
from typing import Any

from hrcplan.assistance import ASSISTANTS, Assistant
from hrcplan.assistance.assistant import needs_training
from hrcplan.assistance.expected_help import ExpectedHelp
from hrcplan.assistance.per_human import PerHuman
from hrcplan.assistance.waiting import may_wait
from hrcplan.bank import Bank, BuildOptions, Goals, build, read_goals
from hrcplan.bank.bank import OPTIMAL
from hrcplan.bank.cache import cache_path, cached_bank
from hrcplan.core.numbers import Number
from hrcplan.core.text import nearest
from hrcplan.episodes.courses import Habits, draw_course, draw_own_courses, own_goal_lengths
from hrcplan.episodes.episode import TurnWorld
from hrcplan.episodes.humans import HUMANS, Course, EpisodeHuman
from hrcplan.episodes.worlds import WORLDS
from hrcplan.errors import UsageError
from hrcplan.inference.belief import Belief
from hrcplan.inference.classifier.forest import ForestBelief, forest_path
from hrcplan.inference.classifier.training import training_time
from hrcplan.inference.recursive import LIKELIHOODS
from hrcplan.inference.registry import METHODS
from hrcplan.inference.run import GOALS_PER, HUMAN
from hrcplan.pddl.conventions import people, robots
from hrcplan.pddl.model import FluentKey
from hrcplan.studies.scenario import Scenario
from hrcplan.studies.study import Cell, Say, Seed, StudyOptions

HERE = Path(__file__).parent
MAIN = "rows"

MANY_TASKS, MANY_ROBOTS = 8, 128
"""How many tasks and robots are remembered: a process plays episodes of all of them in turn."""
ROW_FORMAT = 2
"""It changes when episodes get other columns or values: rows of two formats are not mixed."""

ADDED = ("methods", "humans")
"""Options that name more than one part, with commas between."""
RENAMED = {"paper": "rhp"}
"""Methods by their names in earlier versions."""

SCENARIO = Scenario(HERE, ADDED)
data, defaults, is_own_task = SCENARIO.data, SCENARIO.defaults, SCENARIO.is_own_task


# Cells.


def cells(table: str, options: StudyOptions) -> list[Cell]:
    """Return human and method of every cell of a table, human by human."""
    methods = selection(options["methods"], data()["tables"][table]["methods"])
    return [(human, method) for human in humans(table, options) for method in methods]


def humans(table: str, options: StudyOptions) -> list[str]:
    """Return the humans of a table; on another task, those that need no goals of their own."""
    names = data()["tables"][table]["humans"]
    if not is_own_task(options):
        names = [name for name in names if "goals" not in data()["humans"][name]]
    return selection(options["humans"], names) if table == MAIN else names


def selection(text: str, own: list[str]) -> list[str]:
    """Return the parts that are compared: those named, or the study's own and the user's.

    >>> selection("rhp,mine:Robot", ["rhp", "cdp"]), selection("mine:Robot", ["rhp", "cdp"])
    (['rhp', 'mine:Robot'], ['rhp', 'cdp', 'mine:Robot'])
    >>> selection("oracle", ["rhp", "cdp"])
    ['oracle']
    """
    names = split_names(text)
    is_all = not any(name in data()[key] for key in ADDED for name in names)
    return [n for n in own if is_all or n in names] + [n for n in names if n not in own]


def split_names(text: str) -> list[str]:
    """Return the names in a text with commas between; those of the study may have some themselves.

    >>> split_names("rhp, in order,mine:Robot"), split_names("rhp,oracle")
    (['rhp, in order', 'mine:Robot'], ['rhp', 'oracle'])
    """
    names: list[str] = []
    longest_first = sorted((name for key in ADDED for name in data()[key]), key=len, reverse=True)
    while text:
        name = next((n for n in longest_first if f"{text},".startswith(f"{n},")), None)
        name = text.partition(",")[0] if name is None else name
        names += [name] if name else []
        text = text[len(name) + 1 :]
    return names


def check(options: StudyOptions) -> None:
    """Check that every part that options name can be found.

    Raises:
        UsageError: if one cannot.
    """
    for key, parts in (("methods", ASSISTANTS), ("humans", HUMANS)):
        own = data()[key]
        for name in (name for name in split_names(options[key]) if name not in own):
            if ":" not in name and name not in parts.names():
                hint = nearest(name, own) or f"{'; '.join(own)}; or module:Class"
                message, code = f"there is no {parts.kind} '{name}'", f"unknown-{parts.kind}"
                raise UsageError(message, code=code, hint=hint)
            parts.find(name)
    if options["goals_per"] not in GOALS_PER:
        raise UsageError(f"goals are per {' or '.join(GOALS_PER)}, not '{options['goals_per']}'")
    HUMANS.find(options["chooser"])
    WORLDS.find(options["world"])


# Parts.


@lru_cache(maxsize=MANY_TASKS)
def goals_of(domain: str, goals: str) -> Goals:
    """Return the goals of a domain, from a folder or as shipped."""
    return read_goals(domain, goals or None)


@lru_cache(maxsize=MANY_TASKS)
def bank_of(domain: str, goals: str, quality: str = "", alternatives: str = "") -> Bank:
    """Return the bank of all optimal plans, or of those up to a multiple of the optimum.

    Raises:
        UsageError: if a multiple is no number, there are fewer than two goals, or one has no plan,
            or of human and robot one is missing.
    """
    recipe = BuildOptions(
        quality=_multiple(quality) or OPTIMAL, alternatives=_multiple(alternatives)
    )
    goal_set = goals_of(domain, goals)
    bank = cached_bank(goal_set) if recipe == BuildOptions() else build(goal_set, recipe)
    for kind, who in (("human", people(bank.goals.problem)), ("robot", robots(bank.goals.problem))):
        if bank.goals.problem.agents and not who:
            raise UsageError(f"there is no {kind} among the agents", code=f"no-{kind}")
    if len(bank.names) < 2:
        raise UsageError("a goal can only change where there are two", code="too-few-goals")
    for graph in bank.graphs:
        if not graph.n_steps:
            message = f"goal '{graph.goal}' has no plan, or holds from the start"
            raise UsageError(message, code="no-plan")
    return bank


def _multiple(text: str) -> Fraction | None:
    try:
        return Fraction(text) if text else None
    except (ValueError, ZeroDivisionError):
        raise UsageError(f"'{text}' is no multiple, such as 1.2 or 6/5") from None


def task_of(options: StudyOptions, human: str) -> tuple[str, str, str, str]:
    """Return domain and goals that a human is studied with, and the multiples of its bank."""
    goals = human_data(human).get("goals", options["goals"])
    return options["domain"], goals, options["quality"], options["alternatives"]


def human_data(name: str) -> Mapping[str, Any]:
    """Return what is said of a human; a user's own is one whose goal changes once."""
    table: Mapping[str, Any] = data()["humans"].get(name, {"changes": 1, "chooser": name})
    return table


def has_own_goals(options: StudyOptions, bank: Bank) -> bool:
    """Return whether there are several humans, each of whom has a goal of its own."""
    return options["goals_per"] == HUMAN and len(bank.humans) > 1


def human(name: str, bank: Bank, course: Course, options: StudyOptions) -> EpisodeHuman:
    """Return a human who follows a course."""
    chooser = HUMANS.find(human_data(name).get("chooser", options["chooser"]))
    follower: EpisodeHuman = chooser(bank, course)
    return follower


@lru_cache(maxsize=MANY_ROBOTS)
def robot(name: str, domain: str, goals: str, *multiples: str) -> Assistant[Any]:
    """Return an assistant: one of the study's methods, or a part of that name."""
    bank = bank_of(domain, goals, *multiples)
    return _robot(name, bank, lambda other: robot(other, domain, goals, *multiples))


@lru_cache(maxsize=32)
def robot_per_human(name: str, domain: str, goals: str, *multiples: str) -> PerHuman[Any]:
    """Return the helper of several humans with goals of their own, by the belief of a method."""
    bank = bank_of(domain, goals, *multiples)
    return PerHuman(bank, lambda view: _robot(name, view))


def robot_at_prices(
    name: str, bank: Bank, agent_state: Mapping[FluentKey, Number]
) -> Assistant[Any]:
    """Return an assistant that counts what steps cost agents in this state.

    Raises:
        UsageError: if the method chooses steps without prices.
    """
    return _robot(name, bank, agent_state=agent_state)


def _robot(
    name: str, bank: Bank, other: Callable[[str], Assistant[Any]] | None = None,
    agent_state: Mapping[FluentKey, Number] | None = None,
) -> Assistant[Any]:  # fmt: skip
    """Return an assistant; ``other`` returns the method whose belief it has."""
    options = dict(data()["methods"].get(name, {}))
    kind, waits = ASSISTANTS.find(options.pop("part", name)), options.pop("waits", False)
    belief = options.get("belief")
    if isinstance(belief, dict):
        options["belief"] = _belief(bank, **belief)
    elif isinstance(belief, str) and belief in METHODS.built_in:
        options["belief"] = METHODS.find(belief)(bank)
    elif isinstance(belief, str) and belief in data()["methods"]:
        options["belief"] = other(belief) if other else _robot(belief, bank)
    if agent_state and kind is not ExpectedHelp:
        message = f"'{name}' chooses steps without prices, so agent state changes nothing for it"
        raise UsageError(message, hint="leave --set and --profile out, or name hrcplan")
    if agent_state:
        options["agent_state"] = agent_state
    assistant = kind(bank, **options)
    return may_wait(assistant) if waits else assistant


def _belief(bank: Bank, kind: str, **options: Any) -> Belief[Any]:
    """Return a belief with options; a likelihood is given by its name and its number."""
    for name, value in options.get("likelihood", {}).items():
        options["likelihood"] = LIKELIHOODS[name](value)
    return METHODS.find(kind)(bank, **options)


def prepare(options: StudyOptions, jobs: int, say: Say) -> None:
    """Train the forests that methods need, so that no worker has to; they are kept in the cache."""
    for task in _tasks(options, needs_forest):
        bank = bank_of(*task)
        path = forest_path(bank)
        if path is None or not path.is_file():
            how_long = training_time(bank, jobs)
            say(f"a forest for {len(bank.names)} goals: trained once, {how_long}, then kept")
        ForestBelief(bank, n_jobs=jobs)


def files(options: StudyOptions) -> list[Path]:
    """Return the files of the cache folder that episodes read: banks, made here, and forests."""
    banks = [cache_path(bank_of(*task).goals) for task in _tasks(options)]
    forests = [forest_path(bank_of(*task)) for task in _tasks(options, needs_forest)]
    return [path for path in (*banks, *forests) if path is not None]


def _tasks(
    options: StudyOptions, has: Callable[[str], bool] = lambda method: True
) -> list[tuple[str, str, str, str]]:
    """Return the tasks of all cells, or of those whose method has a property."""
    tasks = dict.fromkeys(
        task_of(options, str(human))
        for table in data()["tables"]
        for human, method in cells(table, options)
        if has(str(method))
    )
    return list(tasks)


def needs_forest(method: str) -> bool:
    """Return whether a method has the forest as its belief."""
    changes = data()["methods"].get(method, {})
    if "belief" in changes:
        other = changes["belief"]
        return isinstance(other, str) and other in data()["methods"] and needs_forest(other)
    return needs_training(ASSISTANTS.find(changes.get("part", method)))


@lru_cache(maxsize=MANY_TASKS)
def world(name: str, domain: str, goals: str, *multiples: str) -> TurnWorld:
    """Return the world of the episodes; each episode resets it."""
    made_world: TurnWorld = WORLDS.find(name)(bank_of(domain, goals, *multiples))
    return made_world


def inputs(options: StudyOptions) -> str:
    """Return what rows depend on: tables of the file, the problems, and their goals.

    Raises:
        UsageError: if something that options name cannot be found, or is nothing to study.
    """
    check(options)
    tasks = dict.fromkeys(
        task_of(options, name) for table in data()["tables"] for name in humans(table, options)
    )
    # A user's goals are checked with their plans; those of the file are known to have some.
    goals = [
        bank_of(*task).goals if task[1] == options["goals"] else goals_of(*task[:2])
        for task in tasks
    ]
    for bank in (bank_of(*task) for task in tasks if options["goals_per"] == HUMAN):
        for who in bank.humans if has_own_goals(options, bank) else ():
            own_goal_lengths(bank, who)
    texts = [text for one in goals for text in (*one.names, *map(str, one.formulas))]
    texts.append(f"rows of format {ROW_FORMAT}")
    keys = ("study", "humans", "methods", "tables")
    return SCENARIO.inputs(keys, [one.problem for one in goals], texts)


# Courses.


def runs(options: StudyOptions) -> int:
    """Return how many runs a cell has: all ordered pairs of goals, as often as there are trials."""
    n = len(goals_of(options["domain"], options["goals"]))
    return n * (n - 1) * int(data()["study"]["trials"])


def course(name: str, bank: Bank, seed: Seed) -> Course:
    """Return what a human wants and when, which depends on the run alone; see ``draw_course``."""
    n = len(bank.names)
    pairs = _pairs(seed.study, seed.run // (n * (n - 1)), n)
    return draw_course(bank, str(seed), _habits(name), pairs[seed.run % len(pairs)])


def courses(name: str, bank: Bank, seed: Seed, options: StudyOptions) -> dict[str, Course]:
    """Return the course of each human who has goals of its own, or that of all humans."""
    if has_own_goals(options, bank):
        return draw_own_courses(bank, str(seed), _habits(name))
    return {"": course(name, bank, seed)}


def _habits(name: str) -> Habits:
    table = human_data(name)
    rates = table.get("mistake_rate", 0.0), table.get("wait_rate", 0.0)
    return Habits(table["changes"], *rates)


@lru_cache(maxsize=8)
def _pairs(study_seed: int, trial: int, n: int) -> list[tuple[int, int]]:
    """Return all ordered pairs of goals in the order in which a trial goes through them."""
    pairs = list(permutations(range(n), 2))
    random.Random(f"{study_seed}/{trial}/pairs").shuffle(pairs)
    return pairs
