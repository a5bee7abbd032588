"""The episodes of the benchmark, and their measures."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

from hrcplan.assistance import Assistant
from hrcplan.episodes.episode import EpisodeRecord
from hrcplan.episodes.traces import Beliefs, trace_of_episode
from hrcplan.inference.traces import ActionTrace
from hrcplan.studies.changed_mind import episodes as changed_mind
from hrcplan.studies.study import Cell, Seed, StudyOptions, StudyRow
from hrcplan.studies.switch.instances import SwitchInstance, listed
from hrcplan.studies.switch.methods import ASSISTANCE, robot, watcher
from hrcplan.studies.switch.tasks import bank_of, options_of

KEYS = ("task", "human", "method")
GUESSES = ("first_correct", "last_incorrect_pct", "correct_pct", "top3_pct", "detection_delay",
           "false_changes", "brier")  # fmt: skip
HELP = ("reached_pct", "stuck_pct", "unfinished_pct", "unreachable_pct", "total_steps",
        "extra_vs_oracle", "wasted_robot_steps", "robot_waits")  # fmt: skip
DRAWN = ("first", "second", "goals", "turns", "ending")
COUNTS = ("n_detected", "human_mistakes", "played_steps")
COLUMNS = {
    ASSISTANCE: (*DRAWN, *HELP, *GUESSES, *COUNTS),
    "inference": (*DRAWN, *GUESSES, *COUNTS),
}


def simulate(table: str, options: StudyOptions, cell: Cell, seed: Seed) -> StudyRow:
    """Return the row of one episode: what was drawn, and its measures."""
    return simulate_with_trace(table, options, cell, seed)[0]


def simulate_with_trace(
    table: str, options: StudyOptions, cell: Cell, seed: Seed
) -> tuple[StudyRow, ActionTrace]:
    """Return the row of one episode, and its trace."""
    task, human, method = map(str, cell)
    instance = SwitchInstance(task, human, seed.run, seed.study)
    helper = robot(task, method) if table == ASSISTANCE else watcher(task, method)
    record, beliefs = play(instance, helper)
    trace = trace_of_episode(bank_of(task), record, beliefs)
    return row_of(table, instance, record, beliefs), trace


def play(instance: SwitchInstance, helper: Assistant[Any]) -> tuple[EpisodeRecord, Beliefs]:
    """Return the episode of an instance with a robot, and what the robot believed."""
    beliefs: Beliefs = {}
    options = options_of(instance.task)
    record = changed_mind.play_shared(options, instance.human, helper, instance.course, beliefs)
    return record, beliefs


def row_of(
    table: str, instance: SwitchInstance, record: EpisodeRecord, beliefs: Beliefs
) -> StudyRow:
    """Return the row of an episode; the same for an episode and its trace that is replayed.

    Where the human did nothing, so that there was no guess, measures of guesses have no value.
    """
    row: StudyRow = {
        **changed_mind.columns_of_course(bank_of(instance.task), {"": record.course}, record),
        **changed_mind.measures_of(record),
        "brier": _brier(record, beliefs),
        "extra_vs_oracle": record.cost - oracle_steps(instance),
    }
    if row["brier"] is None:
        row |= dict.fromkeys(GUESSES)
    return {name: row[name] for name in COLUMNS[table]}


def _brier(record: EpisodeRecord, beliefs: Beliefs) -> float | None:
    """Return the mean Brier score of the posteriors: 0 if always sure and right, 2 at the most."""
    scores = [
        _squared_error(beliefs[turn.t][0], turn.goal)
        for turn in record.turns
        if turn.guess is not None
    ]
    return sum(scores) / len(scores) if scores else None


def _squared_error(posterior: Sequence[float], goal: int) -> float:
    return sum((p - (place == goal)) ** 2 for place, p in enumerate(posterior))


@lru_cache(maxsize=256)
def oracle_steps(instance: SwitchInstance) -> int:
    """Return what the episode of an instance costs with a robot that knows the goal."""
    known = listed(instance)
    return played_oracle_steps(instance) if known is None else known.oracle_steps


def played_oracle_steps(instance: SwitchInstance) -> int:
    """Return the same, without a look at the list of instances."""
    return play(instance, robot(instance.task, changed_mind.ORACLE))[0].cost
