"""The allocation diagram: held against a fine sweep, and against what a hand computes."""

from fractions import Fraction

import pytest

from hrcplan.core.numbers import Number
from hrcplan.errors import HrcplanError, LimitError, UsageError
from hrcplan.pddl.generate import with_goal
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import FluentKey, Problem
from hrcplan.planners.allocation import Diagram, Line, diagram, line_of, lowest
from hrcplan.planners.exact import ExactPlanner
from hrcplan.planners.solve import solve
from hrcplan.plans import Plan
from hrcplan.task.regrounding import Groundings

MOTIVATION = ("motivation", "human")
WP4, WP5 = ("capacity", "human", "wp4"), ("capacity", "human", "wp5")


@pytest.fixture(scope="module")
def two_boxes() -> Problem:
    return read("transport", "two-boxes")


def tired(problem: Problem) -> Problem:
    """Return a problem in which every place asks something of both agents."""
    values = {key: i % 5 + 1 for i, key in enumerate(sorted(problem.values)) if len(key) > 2}
    return problem.with_values(values)


@pytest.mark.parametrize(("domain", "key", "most"), [
    ("transport", MOTIVATION, 20),
    ("transport", WP5, 20),
    ("transport", ("motivation", "robot"), 20),
    ("transport-coached", MOTIVATION, 12),
])  # fmt: skip
@pytest.mark.parametrize("uneven", [False, True])
def test_it_equals_a_fine_sweep(domain: str, key: FluentKey, most: int, uneven: bool) -> None:
    problem = read(domain, "two-boxes")
    problem = tired(problem) if uneven else problem
    found = diagram(problem, key, 0, most)
    groundings, planner = Groundings(), ExactPlanner()
    for step in range(2 * most + 1):
        value = Fraction(step, 2)
        now = problem.with_values({key: value})
        plan = planner.replan(groundings.task(now)).plan
        assert plan is not None
        assert line_of(now, plan, key).at(value) == found.metric(value), value
    assert_concave(found)


def assert_concave(found: Diagram) -> None:
    slopes = [piece.line.slope for piece in found.pieces]
    assert slopes == sorted(slopes, reverse=True)
    assert len(set(slopes)) == len(slopes)
    for one, other in zip(found.pieces, found.pieces[1:], strict=False):
        assert one.most == other.least
        assert one.line.at(one.most) == other.line.at(one.most)


def test_by_hand(two_boxes: Problem) -> None:
    """Four actions each in 200 s, or the robot's eight in 400 s: 24 + 34 + 4 (v - 1), or 92."""
    found = diagram(two_boxes, MOTIVATION)
    assert found.flips == (Fraction(19, 2),)
    assert [dict(p.n_actions) for p in found.pieces] == [
        {"human": 4, "robot": 4}, {"human": 0, "robot": 8}]  # fmt: skip
    assert [(p.line.intercept, p.line.slope) for p in found.pieces] == [(54, 4), (92, 0)]
    assert found.radius() == Fraction(17, 2)
    assert found.radius(9) == Fraction(1, 2)


def test_how_long_a_plan_stays_best(two_boxes: Problem) -> None:
    found = diagram(two_boxes, MOTIVATION, 0, 20)
    shared = solve(two_boxes, "exact").plan
    alone = solve(two_boxes.with_values({MOTIVATION: 20}), "exact").plan
    assert shared is not None
    assert alone is not None
    assert found.stays_best(line_of(two_boxes, shared, MOTIVATION)) == (0, Fraction(19, 2))
    assert found.stays_best(line_of(two_boxes, alone, MOTIVATION)) == (Fraction(19, 2), 20)
    assert found.stays_best(Line(Plan(), 60, 4)) is None
    assert line_of(two_boxes, shared, MOTIVATION) == found.at_now


@pytest.mark.parametrize("value", [9, 10])
def test_on_either_side_of_a_flip_the_planner_agrees(two_boxes: Problem, value: Number) -> None:
    best = solve(two_boxes.with_values({MOTIVATION: value}), "exact").plan
    assert best is not None
    piece = diagram(two_boxes, MOTIVATION).pieces[value > Fraction(19, 2)]
    assert sum(a.args[0] == "human" for a in best.actions) == piece.n_actions["human"]


def test_a_range_without_a_flip(two_boxes: Problem) -> None:
    found = diagram(two_boxes, MOTIVATION, 2, 5)
    assert (len(found.pieces), found.flips, found.radius()) == (1, (), None)


def test_what_makes_no_sense_is_refused(two_boxes: Problem) -> None:
    with pytest.raises(UsageError):
        diagram(two_boxes, ("motivation", "nobody"))
    with pytest.raises(UsageError):
        diagram(two_boxes, MOTIVATION, 5, 5)


def test_without_proofs_it_is_approximate(two_boxes: Problem) -> None:
    found = diagram(two_boxes, MOTIVATION, planner="kairos", timeout_s=2)
    assert not found.is_proven
    assert_concave(found)
    assert diagram(two_boxes, MOTIVATION).is_proven


def test_no_plan_is_told_from_no_time(two_boxes: Problem) -> None:
    with pytest.raises(HrcplanError) as caught:
        diagram(with_goal(two_boxes, "(and (free human) (holding human green))", "no"), MOTIVATION)
    assert caught.value.exit_code == 1
    with pytest.raises(LimitError):
        diagram(two_boxes, MOTIVATION, timeout_s=1e-9)


def test_of_plans_that_are_not_proven_the_best_ones_known_count_everywhere(
    two_boxes: Problem,
) -> None:
    """The plan for one end may be beaten there by one that was found for the other end."""
    lines = [
        Line(Plan(), Fraction(59, 2), 5),
        Line(Plan(), Fraction(55, 2), 4),
        Line(Plan(), 45, 0),
    ]
    pieces = lowest(lines, 0, 10, two_boxes)
    assert [(p.least, p.most, p.line.slope) for p in pieces] == [
        (0, Fraction(35, 8), 4),
        (Fraction(35, 8), 10, 0),
    ]
