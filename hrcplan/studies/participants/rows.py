"""From the journal of a trial to its row: the same episode, played again by `play`.

The robot is deterministic, so an episode with the person's moves is the one that the person had;
and what is measured of simulated humans is measured of people by the same code.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict

from hrcplan.assistance.registry import ASSISTANTS
from hrcplan.bank import Bank
from hrcplan.collaboration.history import BegunAction, EndedAction, History, PassedTurn
from hrcplan.episodes.episode import REACHED, STUCK, UNFINISHED, play
from hrcplan.episodes.humans import HUMANS, Course, HumanMove
from hrcplan.episodes.measures import changes, guesses, n_wasted, waits
from hrcplan.execution import events as ev
from hrcplan.studies.study import StudyRow

MEASURES = (
    "reached_pct", "stuck_pct", "unfinished_pct", "first_correct", "last_incorrect_pct",
    "last_incorrect_step", "correct_pct", "top3_pct", "wasted_robot_steps", "human_mistakes",
    "total_steps", "extra_steps", "detection_delay", "false_changes",
)  # fmt: skip
DETAILS = ("n_detected", "false_before", "robot_waits", "undone_steps")
DRAWN = ("participant", "trial", "goals", "turns", "ending")
COLUMNS = (*DRAWN, *MEASURES, *DETAILS)


class RecordedHuman:
    """A human who does in turn what a person did, and then waits.

    Args:
        bank: The plans.
        moves: The person's steps in words; None where they waited.
    """

    def __init__(self, bank: Bank, moves: Sequence[tuple[str, ...] | None]) -> None:
        self.bank, self.moves = bank, moves

    def move(self, turn: int, world: int, last: int | None) -> HumanMove:
        """Return what the person did in a turn."""
        words = self.moves[turn] if turn < len(self.moves) else None
        return HumanMove(None if words is None else self.bank.table.find(words))


def moves_in(history: History, robots: frozenset[str]) -> list[tuple[str, ...] | None]:
    """Return the steps of people in words, in order; None where they waited, or failed."""
    failed = {
        m.number for m in history if isinstance(m, EndedAction) and m.outcome != ev.DONE
    }  # fmt: skip
    moves: list[tuple[str, ...] | None] = []
    for mark in history:
        if isinstance(mark, BegunAction) and not mark.is_robot:
            moves.append(None if mark.number in failed else mark.words)
        elif isinstance(mark, PassedTurn) and mark.agent not in robots:
            moves.append(None)
    return moves


def row_of_trial(
    bank: Bank, course: Course, method: str, moves: Sequence[tuple[str, ...] | None],
    n_undone: int = 0,
) -> StudyRow:  # fmt: skip
    """Return the measures of a trial.

    Args:
        bank: The plans.
        course: What the person was asked to do, and when that changed.
        method: The robot.
        moves: What the person did, from `moves_in`.
        n_undone: How many steps they took back.
    """
    human = RecordedHuman(bank, moves)
    record = play(bank, human, ASSISTANTS.make(method, bank), course)
    faultless = HUMANS.make("frontier", bank, course)
    best = play(bank, faultless, ASSISTANTS.make("oracle", bank), course)
    return {
        "goals": " ".join(bank.names[goal] for goal in course.goals),
        "turns": " ".join(map(str, course.turns)),
        "ending": record.ending,
        **{f"{end}_pct": 100.0 * (record.ending == end) for end in (REACHED, STUCK, UNFINISHED)},
        **asdict(guesses(record)), **asdict(changes(record)),
        "wasted_robot_steps": n_wasted(record),
        "human_mistakes": sum(
            turn.is_human and turn.step is not None and not turn.is_needed for turn in record.turns
        ),
        "robot_waits": waits(record), "undone_steps": n_undone,
        "total_steps": record.cost, "extra_steps": record.cost - best.cost,
    }  # fmt: skip
