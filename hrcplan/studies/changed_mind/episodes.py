"""The episodes of the study: one human, one robot, in turns."""

from __future__ import annotations

from dataclasses import asdict, replace
from functools import lru_cache
from statistics import fmean

from hrcplan.episodes.episode import EpisodeRecord, play
from hrcplan.episodes.humans import Course
from hrcplan.episodes.measures import changes, guesses, mistakes, waits, wasted
from hrcplan.studies.changed_mind import scenario
from hrcplan.studies.study import Cell, Seed, StudyOptions, StudyRow

MEASURES = (
    "first_correct", "last_incorrect_pct", "last_incorrect_step", "correct_pct", "top3_pct",
    "wasted_robot_steps", "human_mistakes", "total_steps", "extra_steps", "extra_vs_oracle",
    "detection_delay", "false_changes", "decision_ms",
)  # fmt: skip
CLOCKED = ("decision_ms",)
DETAILS = ("n_detected", "false_before", "robot_waits")
UNIT = ("first", "second")
DRAWN = (*UNIT, "goals", "turns", "ending")
COLUMNS = (*DRAWN, *(name for name in MEASURES if name not in CLOCKED), *DETAILS)
ORACLE = "oracle"


def simulated(options: StudyOptions, cell: Cell, seed: Seed) -> StudyRow:
    """Return the row of one episode: what was drawn, and its measures."""
    name, method = map(str, cell)
    task = scenario.task_of(options, name)
    bank = scenario.bank_of(*task)
    course = scenario.course(name, bank, seed)
    record = _play(options, name, method, course)
    n_faultless, n_oracle = _oracles(tuple(options.items()), name, course)
    names = [bank.names[goal] for goal in course.goals]
    return {
        "first": names[0],
        "second": names[1] if len(names) > 1 else None,
        "goals": " ".join(names),
        "turns": " ".join(map(str, course.turns)),
        "ending": record.ending,
        **asdict(guesses(record)),
        **asdict(changes(record)),
        "wasted_robot_steps": wasted(record),
        "human_mistakes": mistakes(record),
        "robot_waits": waits(record),
        "total_steps": record.n_turns,
        "extra_steps": record.n_turns - n_faultless,
        "extra_vs_oracle": record.n_turns - n_oracle,
        "decision_ms": fmean(record.decisions_ms) if record.decisions_ms else 0.0,
    }


def _play(options: StudyOptions, name: str, method: str, course: Course) -> EpisodeRecord:
    task = scenario.task_of(options, name)
    bank, robot = scenario.bank_of(*task), scenario.robot(method, *task)
    human = scenario.human(name, bank, course, options)
    return play(bank, human, robot, course, scenario.world(options["world"], *task))


@lru_cache(maxsize=64)
def _oracles(options: tuple[tuple[str, str], ...], name: str, course: Course) -> tuple[int, int]:
    """Return how long an oracle's episode lasts with a faultless human, and with this one."""
    faultless = replace(course, mistake_rate=0.0, wait_rate=0.0)
    lengths = {
        wanted: _play(dict(options), name, ORACLE, wanted).n_turns for wanted in (faultless, course)
    }
    return lengths[faultless], lengths[course]
