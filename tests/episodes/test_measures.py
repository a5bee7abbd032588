"""Measures of records that are written by hand: H is a human's turn, R the robot's."""

import pytest

from hrcplan.episodes.episode import REACHED, EpisodeRecord, EpisodeTurn
from hrcplan.episodes.humans import Course
from hrcplan.episodes.measures import changes, guesses, mistakes, n_wasted, waits


def record(course, *turns):
    """Return a record of turns ``(guess, n_declared, rank)`` of the human, or None for a wait.

    After each, the robot does a step that is needed.
    """
    made = []
    for human, turn in enumerate(turns):
        guess, declared, rank = (*(turn or (None, 0)), None)[:3]
        goal, t = course.goal(human), 2 * human
        if turn is not None and rank is None:
            rank = 0 if guess == goal else 1
        step = None if turn is None else 0
        made.append(
            EpisodeTurn(t, True, step, goal, turn is not None, False, guess, rank, declared, human)
        )
        made.append(EpisodeTurn(t + 1, False, 0, goal, True, round=human))
    return EpisodeRecord(course, tuple(made), REACHED)


A, B, C = 4, 7, 2
FIXED, ONCE, TWICE = Course((A,)), Course((A, B), (2,)), Course((A, B, C), (1, 3))


def right(*guessed, course):
    """Return a record in which nothing is declared."""
    return record(course, *((guess, 0) for guess in guessed))


@pytest.mark.parametrize(
    ("found", "first_correct"),
    [
        (right(A, B, A, course=FIXED), 0),
        (right(B, B, A, course=FIXED), 4),
        (right(B, B, B, course=FIXED), 6),  # never: all that is left
        (right(B, B, B, A, A, course=ONCE), 0),  # what was before the change does not count
        (right(A, A, A, A, B, course=ONCE), 4),
        (right(A, A, A, A, A, course=ONCE), 6),
        (right(A, A, B, C, C, course=TWICE), (2 + 0) / 2),
        (right(A, B, A, B, C, course=TWICE), (0 + 2) / 2),
        (right(A, A, B, A, B, course=TWICE), (2 + 4) / 2),
    ],
)
def test_first_correct(found, first_correct):
    assert guesses(found).first_correct == first_correct


def test_first_correct_begins_with_the_first_action_after_a_change():
    waiting = record(ONCE, (A, 0), (A, 0), None, (A, 0), (B, 0))
    assert guesses(waiting).first_correct == 2
    late = record(FIXED, None, (B, 0), (A, 0))
    assert guesses(late).first_correct == 2


def test_a_change_after_which_the_human_never_acts_does_not_count():
    assert guesses(record(ONCE, (A, 0), (A, 0), None)).first_correct is None
    assert guesses(record(TWICE, (A, 0), (A, 0), (B, 0), None)).first_correct == 2


@pytest.mark.parametrize(
    ("found", "step", "correct_pct"),
    [
        (right(A, A, A, A, course=FIXED), 0, 100),
        (right(B, A, A, A, course=FIXED), 1, 75),
        (right(A, A, A, B, course=FIXED), 7, 75),
        (right(A, B, A, B, course=ONCE), 5, 50),
        (right(B, B, A, A, course=ONCE), 7, 0),
        (record(FIXED, (B, 0), None, None, (A, 0)), 1, 50),
    ],
)
def test_last_incorrect(found, step, correct_pct):
    made = guesses(found)
    assert made.last_incorrect_step == step
    assert made.last_incorrect_pct == 100 * step / 8
    assert made.correct_pct == correct_pct


def test_top_three():
    found = record(FIXED, (B, 0, 3), (B, 0, 2), (B, 0, 1), (A, 0, 0), None)
    assert guesses(found).top3_pct == 75


def test_nothing_happened():
    made = guesses(EpisodeRecord(FIXED, (), REACHED))
    assert made.first_correct is None
    assert (made.last_incorrect_step, made.last_incorrect_pct) == (0, 0)
    assert (made.correct_pct, made.top3_pct) == (0, 0)
    none = changes(EpisodeRecord(ONCE, (), REACHED))
    assert (none.detection_delay, none.n_detected, none.false_changes) == (0, 0, 0)


def declared(course, *numbers):
    """Return a record with how much is declared after each action; None for a wait."""
    return record(course, *(None if n is None else (A, n) for n in numbers))


@pytest.mark.parametrize(
    ("found", "delay", "n_detected", "false", "before"),
    [
        (declared(FIXED, 0, 0, 0), 0, 0, 0, 0),
        (declared(FIXED, 0, 1, 1, 2), 0, 0, 2, 2),
        (declared(ONCE, 0, 0, 0, 0), 4, 0, 0, 0),  # never: all that is left
        (declared(ONCE, 0, 0, 1, 1), 0, 1, 0, 0),
        (declared(ONCE, 0, 0, 0, 0, 1), 4, 1, 0, 0),
        (declared(ONCE, 0, 1, 1, 2), 2, 1, 1, 1),
        (declared(ONCE, 0, 1, 1, 1), 4, 0, 1, 1),  # too early, and then never
        (declared(ONCE, 0, 0, 1, 2, 3), 0, 1, 2, 0),
        (declared(ONCE, 1, 1, 1, 3), 2, 1, 2, 1),  # two at once: one of them is for nothing
        (declared(TWICE, 0, 1, 1, 1, 2), (0 + 2) / 2, 2, 0, 0),
        (declared(TWICE, 0, 0, 0, 0, 1), (8 + 2) / 2, 1, 0, 0),  # the first was missed
        (declared(TWICE, 1, 1, 2, 2, 2), (2 + 4) / 2, 1, 1, 1),
        (declared(ONCE, 0, 0, None, 0, 1), 2, 1, 0, 0),  # from the first action, not the wait
        (declared(ONCE, 0, 0, None, 1), 0, 1, 0, 0),
        (declared(ONCE, 0, 1, None, 1), 2, 0, 1, 1),  # what was declared stays so in a wait
        (declared(TWICE, 0, 0, 0, None, 1), (8 + 0) / 2, 1, 0, 0),
    ],
)
def test_declared_changes(found, delay, n_detected, false, before):
    made = changes(found)
    assert made.detection_delay == delay
    assert (made.n_detected, made.false_changes, made.false_before) == (n_detected, false, before)


def test_sums():
    course = Course((A,))
    turns = (
        EpisodeTurn(0, True, 3, A, False, is_mistake=True, guess=A, rank=0),
        EpisodeTurn(1, False, 5, A, False),
        EpisodeTurn(2, True, None, A, False),
        EpisodeTurn(3, False, None, A, False),
        EpisodeTurn(4, True, 3, A, False, guess=A, rank=0),
        EpisodeTurn(5, False, 0, A, True),
        EpisodeTurn(6, True, 3, A, False, is_mistake=True, guess=A, rank=0),
        EpisodeTurn(7, False, 6, A, False),
    )
    found = EpisodeRecord(course, turns, REACHED)
    assert (n_wasted(found), mistakes(found), waits(found), found.n_turns) == (2, 2, 1, 8)
