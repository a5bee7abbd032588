"""The episodes of the study: one human, one robot, in turns."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, replace
from functools import lru_cache
from statistics import fmean

from hrcplan.episodes.episode import REACHED, STUCK, UNFINISHED, EpisodeRecord, play
from hrcplan.episodes.humans import Course
from hrcplan.episodes.measures import changes, guesses, mistakes, n_wasted, waits
from hrcplan.episodes.own_goals import play_own_goals
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
    task = scenario.task_of(options, name)
    bank = scenario.bank_of(*task)
    courses = scenario.courses(name, bank, seed, options)
    record = _play(options, name, method, courses)
    n_faultless, n_oracle = _oracles(tuple(options.items()), name, tuple(courses.items()))
    names = [bank.names[goal] for goal in record.course.goals]
    ending = record.ending if record.is_reachable else UNREACHABLE
    return {
        "first": names[0],
        "second": names[1] if len(names) > 1 else None,
        "goals": "; ".join(" ".join(bank.names[g] for g in c.goals) for c in courses.values()),
        "turns": "; ".join(" ".join(map(str, course.turns)) for course in courses.values()),
        "ending": ending,
        **asdict(guesses(record)),
        **asdict(changes(record)),
        "wasted_robot_steps": n_wasted(record),
        "human_mistakes": mistakes(record),
        "robot_waits": waits(record),
        "total_steps": record.cost,
        "extra_steps": record.cost - n_faultless,
        "extra_vs_oracle": record.cost - n_oracle,
        **{f"{name}_pct": 100.0 * (ending == name) for name in (*ENDINGS, UNREACHABLE)},
        "played_steps": record.n_turns,
        "decision_ms": fmean(record.decisions_ms) if record.decisions_ms else 0.0,
    }


def _play(
    options: StudyOptions, name: str, method: str, courses: Mapping[str, Course]
) -> EpisodeRecord:
    task = scenario.task_of(options, name)
    bank, world = scenario.bank_of(*task), scenario.world(options["world"], *task)
    if scenario.has_own_goals(options, bank):
        humans = {
            who: scenario.human(name, bank.for_human(who), course, options)
            for who, course in courses.items()
        }
        helper = scenario.robot_per_human(method, *task)
        return play_own_goals(bank, humans, helper, courses, world)
    (course,) = courses.values()
    human = scenario.human(name, bank, course, options)
    return play(bank, human, scenario.robot(method, *task), course, world)


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
