"""Landmarks that are due again: what must come last is done once more after anything else."""

import numpy as np

from hrcplan.bank import build_bank
from hrcplan.bank.landmark_bound import LandmarkBound
from hrcplan.bank.search import BuildLimits, Explorer
from hrcplan.core.bit_rows import pack
from hrcplan.search.lm_cut import Landmark, landmarks
from hrcplan.search.packed_states import FactPacking, PackedRules
from hrcplan.search.relevance import relevant
from hrcplan.task import BitEffect
from hrcplan.task.conditions import ALWAYS
from hrcplan.task.steps import Operator

COOKED, SERVED, WARM = 0b001, 0b010, 0b100
COOK = Operator(ALWAYS, (BitEffect(COOKED, SERVED),), (), 0, 1)
SERVE = Operator(ALWAYS, (BitEffect(SERVED, 0),), (), 1, 1)
MARKS = (Landmark(frozenset([0]), 1), Landmark(frozenset([1]), 1))
GOAL = ((COOKED | SERVED, COOKED | SERVED),)


def bounds(*ops: Operator, goal: tuple[tuple[int, int], ...] = GOAL) -> list[int]:
    """Return the bounds where none was met, the first landmark, the second, and both."""
    return LandmarkBound(ops, MARKS, goal).of(pack([0b00, 0b01, 0b10, 0b11], 2)).tolist()


def test_what_is_spoiled_is_due_again() -> None:
    assert bounds(COOK, SERVE) == [2, 1, 2, 0]


def test_a_negative_goal() -> None:
    heat = Operator(ALWAYS, (BitEffect(COOKED | WARM, 0),), (), 0, 1)
    cool = Operator(ALWAYS, (BitEffect(0, WARM),), (), 1, 1)
    assert bounds(heat, cool, goal=((COOKED | WARM, COOKED),)) == [2, 1, 2, 0]


def test_what_may_not_be_spoiled_is_not_due() -> None:
    kind = Operator(ALWAYS, (BitEffect(COOKED, 0), BitEffect(0, SERVED, ((WARM, WARM),))), (), 0, 1)
    assert bounds(kind, SERVE) == [2, 1, 1, 0]
    both = Operator(ALWAYS, (BitEffect(0, SERVED),), (BitEffect(COOKED | SERVED, 0),), 0, 1)
    assert bounds(both, SERVE) == [2, 1, 1, 0]
    alternatives = ((COOKED | SERVED, COOKED | SERVED), (COOKED, COOKED))
    assert bounds(COOK, SERVE, goal=alternatives) == [2, 1, 1, 0]


def test_another_way_to_serve() -> None:
    other = Operator(ALWAYS, (BitEffect(SERVED, 0),), (), 2, 1)
    assert bounds(COOK, SERVE, other) == [2, 1, 1, 0]


def test_no_state_of_a_recipe_is_looked_at_in_vain() -> None:
    bank = build_bank("kitchen", only=["oatmeal-apple"])
    ops, literals = relevant(bank.table.ops, bank.goals.tests[0])
    packing = FactPacking.of_facts(literals.facts)
    marks = landmarks(ops, bank.initial, bank.goals.tests[0])
    assert marks is not None
    search = Explorer(
        PackedRules(ops, packing), bank.goals.tests[0], marks, sum(mark.cost for mark in marks),
        optimal=True, limits=BuildLimits(), name="oatmeal",
    )  # fmt: skip
    space = search.run(packing.row(bank.initial))
    assert len(space.states) == bank.graphs[0].n_nodes
    assert np.count_nonzero(space.is_goal) == 1
