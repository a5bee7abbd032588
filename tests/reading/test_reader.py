"""Reading one phrase at a time: what decides, and what never happens."""

import pickle

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.source import SourceText
from hrcplan.reading import Lexicon, Reading, ReadingOutcome, make_lexicon, read_words

GARDEN = """
;; hrcplan: say water sprinkle
;; hrcplan: say dig_up pull, pull out
;; hrcplan: call bed-1 rose bed
(define (domain garden) (:requirements :strips :typing) (:types agent bed plant - object)
  (:predicates (controllable ?a - agent) (wet ?b - bed) (in ?p - plant ?b - bed)
    (swapped ?p ?q - plant))
  (:action water :parameters (?a - agent ?b - bed) :effect (wet ?b))
  (:action dig_up :parameters (?a - agent ?p - plant ?b - bed)
    :precondition (in ?p ?b) :effect (not (in ?p ?b)))
  (:action swap :parameters (?a - agent ?p ?q - plant) :effect (swapped ?p ?q)))
"""
PLOT = """
;; hrcplan: call tulip tulipan
(define (problem plot) (:domain garden)
  (:objects robo ann - agent bed-1 bed-2 - bed tulip olive olive-tree - plant)
  (:init (controllable robo)) (:goal (wet bed-2)))
"""
STEPS = [
    ("water", "ann", "bed-1"),
    ("water", "ann", "bed-2"),
    ("dig_up", "ann", "tulip", "bed-1"),
    ("dig_up", "ann", "olive", "bed-2"),
    ("dig_up", "ann", "olive-tree", "bed-2"),
    ("swap", "ann", "tulip", "olive"),
    ("swap", "ann", "olive", "tulip"),
]


@pytest.fixture(scope="module")
def lexicon() -> Lexicon:
    domain = domain_in(SourceText("garden.pddl", GARDEN))
    return make_lexicon(problem_in(domain, SourceText("plot.pddl", PLOT)))


def step_of(reading: Reading) -> tuple[str, ...] | None:
    return None if reading.step is None else STEPS[reading.step]


@pytest.mark.parametrize(
    ("text", "step"),
    [
        ("watering the rose bed", ("water", "ann", "bed-1")),
        ("WATER BED 2!", ("water", "ann", "bed-2")),
        ("I sprinkled bed-2", ("water", "ann", "bed-2")),
        ("dig the tulip up", ("dig_up", "ann", "tulip", "bed-1")),
        ("I pulled the tulipans out", ("dig_up", "ann", "tulip", "bed-1")),
        ("dig up the olive tree", ("dig_up", "ann", "olive-tree", "bed-2")),
        ("swap tulip and olive", ("swap", "ann", "tulip", "olive")),
        ("no, water bed 2", ("water", "ann", "bed-2")),
    ],
)
def test_words_name_a_step(lexicon: Lexicon, text: str, step: tuple[str, ...]) -> None:
    assert step_of(read_words(lexicon, text, STEPS)) == step


@pytest.mark.parametrize("text", ["water a bed", "water it", "dig up tulip and olive"])
def test_what_means_several_steps_is_asked_about(lexicon: Lexicon, text: str) -> None:
    reading = read_words(lexicon, text, STEPS)
    assert reading.outcome is ReadingOutcome.ASK
    assert reading.step is None
    assert 0 < len(reading.options) <= 4


@pytest.mark.parametrize("text", ["", "???", "good morning", "don't water bed 2", "hello robo"])
def test_what_means_no_step_is_refused(lexicon: Lexicon, text: str) -> None:
    assert read_words(lexicon, text, STEPS).outcome is ReadingOutcome.REFUSE


def test_a_step_that_is_not_possible_is_not_replaced_by_another(lexicon: Lexicon) -> None:
    steps = [step for step in STEPS if step != ("water", "ann", "bed-2")]
    assert read_words(lexicon, "water bed 2", steps).step is None
    swaps = [("swap", "ann", "olive", "tulip")]
    assert read_words(lexicon, "swap tulip and olive", swaps).step is None


@pytest.mark.parametrize("word", ["ivy", "fig"])
def test_a_short_word_that_is_no_grammar_may_be_an_object(lexicon: Lexicon, word: str) -> None:
    beds = [("water", "ann", "bed-2")]
    assert read_words(lexicon, "I'll water it now", beds).outcome is ReadingOutcome.ACT
    assert read_words(lexicon, f"water the {word}", beds).outcome is ReadingOutcome.ASK


def test_the_prior_decides_between_equals_and_overrules_no_word(lexicon: Lexicon) -> None:
    likely = [0.9 if step[1:] == ("ann", "bed-1") else 0.01 for step in STEPS]
    assert step_of(read_words(lexicon, "water it", STEPS, likely)) == ("water", "ann", "bed-1")
    reading = read_words(lexicon, "water bed 2", STEPS, likely)
    assert step_of(reading) == ("water", "ann", "bed-2")
    with pytest.raises(ValueError, match="7 steps with a prior of 1"):
        read_words(lexicon, "water it", STEPS, [1.0])


def test_a_lexicon_can_be_sent_to_another_process(lexicon: Lexicon) -> None:
    copy = pickle.loads(pickle.dumps(lexicon))
    assert read_words(copy, "water bed 2", STEPS) == read_words(lexicon, "water bed 2", STEPS)


@given(st.text(max_size=60) | st.just("water bed 2 " * 2_000) | st.just("\x00\x1b[2J\ud800"))
@settings(max_examples=60, deadline=None)
def test_any_text_has_a_reading(lexicon: Lexicon, text: str) -> None:
    reading = read_words(lexicon, text, STEPS)
    assert (reading.step is not None) == (reading.outcome is ReadingOutcome.ACT)
    assert sum(p for _, p in reading.options) + reading.none <= 1 + 1e-9
    assert len(reading.options) <= 4
    assert read_words(lexicon, text, []).outcome is ReadingOutcome.REFUSE


def test_other_scripts_are_read() -> None:
    domain = GARDEN.replace("say water sprinkle", "say water 浇水, полить")
    problem = PLOT.replace("call tulip tulipan", "call bed-2 花坛, клумба")
    model = domain_in(SourceText("garden.pddl", domain))
    lexicon = make_lexicon(problem_in(model, SourceText("plot.pddl", problem)))
    for text in ("给花坛浇水", "полить клумбу"):
        assert step_of(read_words(lexicon, text, STEPS)) == ("water", "ann", "bed-2")
