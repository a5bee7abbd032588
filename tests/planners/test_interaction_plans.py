"""Interactions in PDDL: chosen by cost alone, exactly where they pay."""

from collections.abc import Iterator
from fractions import Fraction
from heapq import heappop, heappush
from itertools import count, product
from pathlib import Path

import pytest

from hrcplan.core.numbers import Number
from hrcplan.errors import UnsupportedError, UsageError
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import TOTAL_COST, Action, Function, Problem
from hrcplan.pddl.semantics import Binding, LiftedState, changes, evaluate, holds
from hrcplan.planners.exact import ExactPlanner
from hrcplan.planners.expected_price import expected_retries, with_success
from hrcplan.planners.solve import solve
from hrcplan.task import Task
from hrcplan.validation import validate

MOTIVATION = ("motivation", "human")
TINY = """(define (problem tiny) (:domain transport-coached)
  (:objects robot human - agent wp0 wp1 - wp box - box)
  (:init (controllable robot) (coach robot human) (path wp0 wp1) (path wp1 wp0)
    (reach human wp0) (reach human wp1) (reach robot wp0)
    (at human wp0) (free human) (idle human) (at robot wp0) (free robot) (idle robot)
    (box-at box wp0) (= (total-cost) 0) (= (help-price) {price}) (= (residual) {residual})
    (= (knowledge human) {knowledge}) (= (motivation human) {motivation})
    (= (capacity human wp0) {here}) (= (capacity human wp1) {there})
    (= (knowledge robot) 1) (= (motivation robot) 1)
    (= (capacity robot wp0) 1) (= (capacity robot wp1) 1))
  (:goal (box-at box wp1)) (:metric minimize (total-cost)))"""


def tiny(folder: Path, **values: int) -> Problem:
    path = folder / "tiny.pddl"
    path.write_text(TINY.format(**values))
    return read(path)


@pytest.fixture(scope="module")
def coached() -> Problem:
    return read("transport-coached", "two-boxes")


def helped(problem: Problem) -> bool:
    found = solve(problem, "exact")
    assert found.plan is not None
    return any(a.name in ("remind", "instruct", "assist") for a in found.plan.actions)


def test_the_coached_domain_repeats_transport(coached: Problem) -> None:
    plain = read("transport", "two-boxes")
    theirs = {action.name: action for action in coached.domain.actions}
    assert all(theirs[action.name] == action for action in plain.domain.actions)
    assert coached.facts - plain.facts == {("coach", "robot", "human")}
    assert plain.facts <= coached.facts
    assert plain.values.items() <= coached.values.items()


def test_while_both_contribute_the_best_plan_is_the_same(coached: Problem) -> None:
    plain = solve(read("transport", "two-boxes"), "exact")
    found = solve(coached, "exact")
    assert str(found.plan) == str(plain.plan)


# By hand: four of the human's actions carry the motivation, and a reminder costs its price and one
# step of 50 s, 0.17 each: it pays where 4 (v - 1) > price + 8.5.
@pytest.mark.parametrize(("probability", "boundary"), [(1, "3.875"), ("0.8", "4.0625")])
def test_an_interaction_is_planned_exactly_when_cheaper(
    coached: Problem, probability: str, boundary: str
) -> None:
    problem = expected_retries(with_success(coached, Fraction(probability)))
    edge, little = Fraction(boundary), Fraction(1, 100)
    assert not helped(problem.with_values({MOTIVATION: edge - little}))
    assert helped(problem.with_values({MOTIVATION: edge + little}))


@pytest.mark.parametrize(("here", "there", "helps"), [(30, 1, True), (1, 30, False)])
def test_help_with_a_place_is_given_at_the_place(
    tmp_path: Path, here: int, there: int, helps: bool
) -> None:
    """The robot of the tiny problem is here and cannot go there; only the human can carry."""
    state = {"knowledge": 1, "motivation": 1, "here": here, "there": there}
    assert helped(tiny(tmp_path, price=3, residual=1, **state)) is helps


def test_the_validator_keeps_the_price_of_the_domain(coached: Problem) -> None:
    raised = coached.with_values({MOTIVATION: 8})
    priced = solve(expected_retries(raised), "exact")
    assert priced.plan is not None
    own = validate(raised, priced.plan)
    assert priced.report is not None
    assert own.cost == 27
    assert priced.report.cost == Fraction(111, 4)  # 3 / 0.8 instead of 3


def test_what_never_succeeds_is_never_planned(coached: Problem) -> None:
    hopeless = expected_retries(with_success(coached, 0))
    assert not helped(hopeless.with_values({MOTIVATION: 10}))
    with pytest.raises(UsageError):
        with_success(coached, 1.5)


# Brute force: the lifted semantics, with numbers as numbers, and nothing of the grounded task.


def bindings(action: Action, problem: Problem) -> Iterator[Binding]:
    options = [problem.objects_of(param.types) for param in action.params]
    for args in product(*options):
        yield {param.name: arg for param, arg in zip(action.params, args, strict=True)}


def steps(state: LiftedState, problem: Problem) -> Iterator[tuple[LiftedState, Number]]:
    for action in problem.domain.actions:
        for binding in bindings(action, problem):
            conditions = {c.when: [] for c in action.conditions}  # type: ignore[var-annotated]
            for c in action.conditions:
                conditions[c.when].append(c.formula)
            if not all(holds(f, state, binding, problem) for f in conditions.get("start", ())):
                continue
            price = sum(
                evaluate(e.value, state.values, binding)
                for e in action.effects
                if e.target.name == TOTAL_COST and e.value is not None
            )
            after = state
            for when in ("start", "end"):
                effects = [e for e in action.effects
                           if e.when == when and e.target.name != TOTAL_COST]  # fmt: skip
                after = changes(effects, after, binding, problem).apply(after)
                rest = conditions.get("all", ()) if when == "start" else ()
                if not all(holds(f, after, binding, problem) for f in rest):
                    break
            else:
                yield after, price


def cheapest(problem: Problem) -> Number | None:
    order = count()
    start = LiftedState(frozenset(problem.facts), dict(problem.values))
    waiting: list[tuple[Number, int, LiftedState]] = [(0, next(order), start)]
    done = set()
    while waiting:
        cost, _, state = heappop(waiting)
        mark = (frozenset(state.facts), frozenset(state.values.items()))
        if mark in done:
            continue
        done.add(mark)
        if holds(problem.goal, state, {}, problem):
            return cost
        for after, price in steps(state, problem):
            heappush(waiting, (cost + price, next(order), after))
    return None


@pytest.mark.parametrize("price", [1, 5])
@pytest.mark.parametrize("residual", [1, 2])
@pytest.mark.parametrize("state", [(1, 1, 1, 1), (1, 9, 1, 1), (4, 7, 1, 9), (2, 3, 6, 2)])
def test_the_optimum_is_that_of_brute_force(
    tmp_path: Path, price: int, residual: int, state: tuple[int, ...]
) -> None:
    values = dict(zip(("knowledge", "motivation", "here", "there"), state, strict=True))
    problem = tiny(tmp_path, price=price, residual=residual, **values)
    wanted = cheapest(problem)
    assert ExactPlanner().replan(Task(problem)).objective == wanted


def test_lowered_for_classical_planners_the_optimum_is_the_same(tmp_path: Path) -> None:
    problem = tiny(tmp_path, price=5, residual=1, knowledge=4, motivation=7, here=1, there=9)
    found = solve(problem, "fast-downward")
    assert found.report is not None
    assert found.report.cost == cheapest(problem)


DELETES_LATE = """(define (domain late)
  (:requirements :typing :durative-actions :action-costs)
  (:types agent)
  (:predicates (idle ?a - agent) (open) (done))
  (:functions (total-cost))
  (:durative-action shut :parameters (?a - agent) :duration (= ?duration 2)
    :condition (and (at start (idle ?a)))
    :effect (and (at start (not (idle ?a))) (at end (idle ?a)) (at end (not (open)))))
  (:durative-action pass :parameters (?a - agent) :duration (= ?duration 1)
    :condition (and (at start (idle ?a)) (at start (open)))
    :effect (and (at start (not (idle ?a))) (at end (idle ?a)) (at end (done)))))"""
LATE = """(define (problem p) (:domain late) (:objects {agents} - agent)
  (:init (open) {idle}) (:goal (and (done) (not (open)))) (:metric minimize (total-time)))"""


def late(tmp_path: Path, *agents: str) -> Task:
    (tmp_path / "late.pddl").write_text(DELETES_LATE)
    idle = " ".join(f"(idle {a})" for a in agents)
    (tmp_path / "p.pddl").write_text(LATE.format(agents=" ".join(agents), idle=idle))
    return Task(read(tmp_path / "p.pddl"))


def test_what_is_deleted_at_an_end_may_not_be_looked_at_until_then(tmp_path: Path) -> None:
    """Two agents could pass while the other shuts: left to others. One alone cannot."""
    with pytest.raises(UnsupportedError, match="at its end"):
        ExactPlanner().replan(late(tmp_path, "a", "b"))
    plan = ExactPlanner().replan(late(tmp_path, "a")).plan
    assert plan is not None
    assert [action.name for action in plan.actions] == ["pass", "shut"]


def test_agent_state_is_read_from_the_functions_alone(coached: Problem) -> None:
    """No action changes what the price of an interaction and its residual are."""
    changed = {e.target.name for a in coached.domain.actions for e in a.effects
               if isinstance(e.target, Function)}  # fmt: skip
    assert changed == {"motivation", "knowledge", "capacity", "total-cost"}
