"""How well phrases are read that were written down before the reader was."""

from collections.abc import Iterable

import pytest

from hrcplan.reading import read_words
from tests.phrases import (
    KITCHEN,
    LATER,
    N_WALKS,
    OTHERS,
    TEST,
    Trial,
    moments,
    names_only,
    problems_of,
    sayings,
    trials,
)


def share(values: Iterable[bool]) -> float:
    every = list(values)
    return sum(every) / len(every)


@pytest.fixture(scope="module")
def kitchen() -> list[Trial]:
    scenes = [moment for problem in problems_of("kitchen") for moment in moments(problem, 1)]
    said = [saying for name in KITCHEN for saying in sayings(name, TEST)]
    return list(trials(said, scenes, read_words))


@pytest.mark.parametrize("name", ["kitchen-opposites", "kitchen-recipes-later"])
def test_later_phrases_are_read_right_or_asked_about(name: str) -> None:
    scenes = [moment for problem in problems_of("kitchen") for moment in moments(problem, 1)]
    said = list(trials(sayings(name, LATER), scenes, read_words))
    assert share(trial.is_right for trial in said if trial.can_be_meant) >= 0.92
    assert share(trial.is_wrong for trial in said) <= 0.01


def test_phrases_of_the_kitchen_are_read_right(kitchen: list[Trial]) -> None:
    sensible = [trial for trial in kitchen if trial.can_be_meant]
    assert len({trial.saying for trial in sensible}) >= 120
    assert share(trial.is_right for trial in sensible) >= 0.92


def test_a_wrong_step_is_almost_never_done_unasked(kitchen: list[Trial]) -> None:
    assert share(trial.is_wrong for trial in kitchen) <= 0.01


def test_most_clear_phrases_need_no_question(kitchen: list[Trial]) -> None:
    clear = [trial for trial in kitchen if len(trial.meant) == 1]
    assert share(trial.is_acted for trial in clear) >= 0.7


def test_most_phrases_that_mean_nothing_are_not_even_asked_about(kitchen: list[Trial]) -> None:
    idle = [trial for trial in kitchen if not trial.saying.meanings]
    assert share(not trial.reading.options for trial in idle) >= 0.6


@pytest.mark.parametrize("name", OTHERS)
def test_domains_without_notes_are_read_right_or_asked_about(name: str) -> None:
    problems = map(names_only, problems_of(name))
    n_walks = N_WALKS.get(name, 6)
    scenes = [moment for problem in problems for moment in moments(problem, n_walks)]
    said = list(trials(sayings(name, TEST), scenes, read_words))
    sensible = [trial for trial in said if trial.can_be_meant]
    good = [t.is_offered or (t.is_right and not t.is_wrong) for t in sensible]
    assert share(good) >= 0.8
    assert share(trial.is_wrong for trial in said) <= 0.01
