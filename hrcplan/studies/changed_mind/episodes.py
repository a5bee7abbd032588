"""The episodes of the study: one human, one robot, in turns."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, replace
from functools import lru_cache
from statistics import fmean
from typing import Any

from hrcplan.assistance import Assistant
from hrcplan.bank import Bank
from hrcplan.episodes.episode import REACHED, STUCK, UNFINISHED, EpisodeRecord, EpisodeTurn, play
from hrcplan.episodes.humans import Course
from hrcplan.episodes.measures import changes, guesses, mistakes, n_wasted, waits
from hrcplan.episodes.own_goals import play_own_goals
from hrcplan.episodes.traces import BeliefLog, Beliefs, trace_of_episode
from hrcplan.inference.belief import BeliefState
from hrcplan.inference.traces import ActionTrace
from hrcplan.studies.changed_mind import scenario
from hrcplan.studies.study import Cell, CellValue, Seed, StudyOptions, StudyRow

SUCCESS = ("reached_pct", "stuck_pct", "unfinished_pct")
UNREACHABLE = "unreachable"
"""The ending of an episode whose goal no agent can reach any more, however it ended."""
MEASURES = (
    *SUCCESS,
    "first_correct", "last_incorrect_pct", "last_incorrect_step", "correct_pct", "top3_pct",
    "wasted_robot_steps", "human_mistakes", "total_steps", "extra_steps", "extra_vs_oracle",
    "detection_delay", "false_changes", "decision_ms",
)  # fmt: skip
CLOCKED = ("decision_ms",)
DETAILS = ("n_detected", "false_before", "robot_waits", "unreachable_pct", "played_steps")
UNIT = ("first", "second")
DRAWN = (*UNIT, "goals", "turns", "ending")
ENDINGS = (REACHED, STUCK, UNFINISHED)


def _is(ending: str) -> Callable[[StudyRow], CellValue]:
    return lambda row: 100.0 * (row["ending"] == ending)


GROWN: Mapping[str, Callable[[StudyRow], CellValue]] = {
    **{f"{ending}_pct": _is(ending) for ending in ENDINGS},
    "unreachable_pct": lambda row: None,
    "played_steps": lambda row: row["total_steps"],
}
"""Columns that the rows of earlier versions lack, with their values there: how an episode ended was
noted, and its length was its cost."""
_OLD = (name for name in (*MEASURES, *DETAILS) if name not in (*CLOCKED, *GROWN))
COLUMNS = (*DRAWN, *_OLD, *GROWN)
ORACLE = "oracle"


def simulate(options: StudyOptions, cell: Cell, seed: Seed) -> StudyRow:
    """Return the row of one episode: what was drawn, and its measures."""
    name, method = map(str, cell)
    courses = _courses(options, name, seed)
    return _row(options, name, courses, _play(options, name, method, courses))


def simulate_with_trace(
    options: StudyOptions, cell: Cell, seed: Seed
) -> tuple[StudyRow, ActionTrace]:
    """Return the same, and what was done and believed."""
    name, method = map(str, cell)
    courses = _courses(options, name, seed)
    bank = scenario.bank_of(*scenario.task_of(options, name))
    beliefs: Beliefs = {}
    record = _play(options, name, method, courses, beliefs)
    return _row(options, name, courses, record), trace_of_episode(bank, record, beliefs)


def _courses(options: StudyOptions, name: str, seed: Seed) -> Mapping[str, Course]:
    bank = scenario.bank_of(*scenario.task_of(options, name))
    return scenario.courses(name, bank, seed, options)


def _row(
    options: StudyOptions, name: str, courses: Mapping[str, Course], record: EpisodeRecord
) -> StudyRow:
    bank = scenario.bank_of(*scenario.task_of(options, name))
    n_faultless, n_oracle = _oracles(tuple(options.items()), name, tuple(courses.items()))
    return {
        **columns_of_course(bank, courses, record),
        **measures_of(record),
        "extra_steps": record.cost - n_faultless,
        "extra_vs_oracle": record.cost - n_oracle,
        "decision_ms": fmean(record.decisions_ms) if record.decisions_ms else 0.0,
    }


def columns_of_course(bank: Bank, courses: Mapping[str, Course], record: EpisodeRecord) -> StudyRow:
    """Return the columns that say what humans wanted, and how the episode ended."""
    names = [bank.names[goal] for goal in record.course.goals]
    return {
        "first": names[0],
        "second": names[1] if len(names) > 1 else None,
        "goals": "; ".join(" ".join(bank.names[g] for g in c.goals) for c in courses.values()),
        "turns": "; ".join(" ".join(map(str, course.turns)) for course in courses.values()),
        "ending": ending_of(record),
    }


def ending_of(record: EpisodeRecord) -> str:
    """Return how an episode ended; `UNREACHABLE` if no agent can reach the goal any more."""
    return record.ending if record.is_reachable else UNREACHABLE


def measures_of(record: EpisodeRecord) -> StudyRow:
    """Return the measures of an episode that need no other episode."""
    ending = ending_of(record)
    return {
        **asdict(guesses(record)),
        **asdict(changes(record)),
        "wasted_robot_steps": n_wasted(record),
        "human_mistakes": mistakes(record),
        "robot_waits": waits(record),
        "total_steps": record.cost,
        **{f"{name}_pct": 100.0 * (ending == name) for name in (*ENDINGS, UNREACHABLE)},
        "played_steps": record.n_turns,
    }


def _play(
    options: StudyOptions, name: str, method: str, courses: Mapping[str, Course],
    beliefs: Beliefs | None = None,
) -> EpisodeRecord:  # fmt: skip
    """Return the record of an episode; what the robot believes is added to ``beliefs``."""
    task = scenario.task_of(options, name)
    bank, world = scenario.bank_of(*task), scenario.world(options["world"], *task)
    if scenario.has_own_goals(options, bank):
        humans = {
            who: scenario.human(name, bank.for_human(who), course, options)
            for who, course in courses.items()
        }
        helper = scenario.robot_per_human(method, *task)
        own_log: BeliefLog[Any] = BeliefLog(
            lambda state, turn: helper.posterior_of(state, turn.agent or ""), beliefs
        )
        return play_own_goals(bank, humans, helper, courses, world, own_log.watch)
    (course,) = courses.values()
    return play_shared(options, name, scenario.robot(method, *task), course, beliefs)


def play_shared(
    options: StudyOptions, name: str, robot: Assistant[Any], course: Course,
    beliefs: Beliefs | None = None, see: Callable[[EpisodeTurn], None] | None = None,
) -> EpisodeRecord:  # fmt: skip
    """Return the record of an episode of humans who share their goal, with any robot.

    Args:
        options: The options of the study.
        name: The human.
        robot: The robot.
        course: What is wanted and when.
        beliefs: What the robot believes is added to it; None to note nothing.
        see: Is called with every turn.
    """
    task = scenario.task_of(options, name)
    bank, world = scenario.bank_of(*task), scenario.world(options["world"], *task)
    human = scenario.human(name, bank, course, options)
    log: BeliefLog[Any] = BeliefLog(lambda state, turn: robot.posterior(state), beliefs)

    def watch(turn: EpisodeTurn, state: BeliefState) -> None:
        log.watch(turn, state)
        if see is not None:
            see(turn)

    return play(bank, human, robot, course, world, watch)


@lru_cache(maxsize=64)
def _oracles(
    options: tuple[tuple[str, str], ...], name: str, courses: tuple[tuple[str, Course], ...]
) -> tuple[int, int]:
    """Return what an oracle's episode costs with faultless humans, and with these."""
    faultless = {who: replace(c, mistake_rate=0.0, wait_rate=0.0) for who, c in courses}
    cost = _play(dict(options), name, ORACLE, faultless).cost
    if faultless == dict(courses):
        return cost, cost
    return cost, _play(dict(options), name, ORACLE, dict(courses)).cost
