"""The measures of an episode in turns (section IV-E of the changed-mind paper)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from hrcplan.episodes.episode import EpisodeRecord, EpisodeTurn
from hrcplan.episodes.humans import Course

TOP = 3  # goals that count as a right guess in ``top3_pct``


@dataclass(frozen=True, slots=True)
class GuessMeasures:
    """How well the goal was guessed: one guess after each action of the human.

    Attributes:
        first_correct: Timesteps from the first human action after a change to the first right
            guess, the mean over changes; of a human who never changes, from its first action.
            None if the human did nothing after a change.
        last_incorrect_step: The timestep after the last wrong guess; 0 without one.
        last_incorrect_pct: The same as a percentage of all timesteps.
        correct_pct: The share of guesses that are right.
        top3_pct: The share of guesses with the right goal among the first three.
    """

    first_correct: float | None
    last_incorrect_step: int
    last_incorrect_pct: float
    correct_pct: float
    top3_pct: float


@dataclass(frozen=True, slots=True)
class ChangeMeasures:
    """Declared changes of goal compared with the true ones.

    Attributes:
        detection_delay: Timesteps from the first human action after a change to the declaration, or
            to the end if it is never declared, as for ``first_correct``; the mean over changes, 0
            without any.
        n_detected: Changes that were declared before the next one, or the end.
        false_changes: Declarations with no true change before them that was still undeclared.
        false_before: Those of them before the first true change.
    """

    detection_delay: float
    n_detected: int
    false_changes: int
    false_before: int


def guesses(record: EpisodeRecord) -> GuessMeasures:
    """Return how well the goal was guessed."""
    with_guess = [turn for turn in record.turns if turn.guess is not None]
    wrong = [turn.t for turn in with_guess if turn.guess != turn.goal]
    last = max(wrong, default=-1) + 1
    spans = _spans(record)
    firsts = [_first_right(span, record.n_turns) for span in spans]
    return GuessMeasures(
        sum(firsts) / len(firsts) if firsts else None,
        last,
        100 * last / max(1, record.n_turns),
        100 * (len(with_guess) - len(wrong)) / max(1, len(with_guess)),
        100 * sum((turn.rank or 0) < TOP for turn in with_guess) / max(1, len(with_guess)),
    )


def _spans(record: EpisodeRecord) -> list[list[EpisodeTurn]]:
    """Return the guesses made under each goal that was changed to; of the only goal if none was."""
    spans: list[list[EpisodeTurn]] = []
    for course, turns in _by_course(record):
        own: list[list[EpisodeTurn]] = [[] for _ in course.goals]
        for turn in turns:
            if turn.guess is not None:
                own[record.n_changes(turn)].append(turn)
        spans += own[1:] or own
    return [span for span in spans if span]


def _by_course(record: EpisodeRecord) -> list[tuple[Course, list[EpisodeTurn]]]:
    """Return the turns of the humans by what they wanted: together, or each for itself."""
    humans = [turn for turn in record.turns if turn.is_human]
    if not record.courses:
        return [(record.course, humans)]
    return [
        (course, [turn for turn in humans if turn.agent == agent])
        for agent, course in record.courses.items()
    ]


def _first_right(span: Sequence[EpisodeTurn], n_turns: int) -> int:
    right = next((turn.t for turn in span if turn.guess == turn.goal), n_turns)
    return right - span[0].t


def changes(record: EpisodeRecord) -> ChangeMeasures:
    """Return declared changes compared with the true ones."""
    delays: list[int] = []
    n_found = n_false = n_before = 0
    for _, turns in _by_course(record):
        open_since: int | None = None  # the timestep of the true change that awaits declaration
        n_noticed = n_known = 0
        for turn in turns:
            if turn.step is None:
                continue  # a wait shows nothing, so no change can be declared after it
            if record.n_changes(turn) > n_noticed:
                if open_since is not None:
                    delays.append(record.n_turns - open_since)
                open_since, n_noticed = turn.t, record.n_changes(turn)
            for _ in range(turn.n_declared - n_known):
                if open_since is None:
                    n_false += 1
                    n_before += not record.n_changes(turn)
                else:
                    delays.append(turn.t - open_since)
                    n_found, open_since = n_found + 1, None
            n_known = max(n_known, turn.n_declared)
        if open_since is not None:
            delays.append(record.n_turns - open_since)
    return ChangeMeasures(sum(delays) / max(1, len(delays)), n_found, n_false, n_before)


def n_wasted(record: EpisodeRecord) -> int:
    """Return how many robot actions the human's goal did not need when they were done."""
    return sum(
        not turn.is_human and turn.step is not None and not turn.is_needed for turn in record.turns
    )


def mistakes(record: EpisodeRecord) -> int:
    """Return how many actions of the human were mistakes."""
    return sum(turn.is_mistake for turn in record.turns)


def waits(record: EpisodeRecord) -> int:
    """Return how often the robot waited."""
    return sum(not turn.is_human and turn.step is None for turn in record.turns)
