"""Planners that crash, hang or lie in the middle of a run: the next one takes over."""

import time

import pytest

from hrcplan.agents import load_profile
from hrcplan.errors import PlannerError
from hrcplan.execution import events as ev
from hrcplan.execution import replanner
from hrcplan.execution.execute import execute
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.monitor import Monitor
from hrcplan.execution.replanner import Replanner
from hrcplan.execution.run import Run
from hrcplan.execution.simulate import Engine
from hrcplan.execution.timeline import Timeline
from hrcplan.execution.worlds.simulated import Nature, StateChange
from hrcplan.pddl.inputs import read
from hrcplan.planners import registry
from hrcplan.planners.contract import Answer, Capabilities, Request, Status
from hrcplan.plans import parse_plan
from tests.texts import problem_of

DISTRACTED = Nature(0, (StateChange(0.0, {("motivation", "human"): 9}),))


class Faulty:
    """Answers well ``n_good`` times and then does something else."""

    def __init__(self, fault: str, n_good: int = 1) -> None:
        self.card = Capabilities(
            "faulty", "a planner with a fault", temporal=True, metric="cost+time"
        )
        self.fault = fault
        self.n_good = n_good
        self.good = registry.make("exact")

    def missing(self) -> str | None:
        return None

    def solve(self, request: Request) -> Answer:
        self.n_good -= 1
        if self.n_good >= 0:
            return self.good.solve(request)
        match self.fault:
            case "crash":
                raise PlannerError("segmentation fault")
            case "bug":
                raise ZeroDivisionError("a stranger's bug")
            case "timeout":
                time.sleep(request.time_left_s)
                return Answer(Status.UNSOLVED)
            case _:  # a plan that is none
                return Answer(Status.SOLVED, parse_plan("0: (move robot wp5 wp2) [50]"))


def engine_with(planner: Replanner) -> Engine:
    return Engine(Monitor(planner.model, load_profile("replan-always")), planner)


@pytest.mark.parametrize("fault", ["crash", "bug", "timeout", "lie"])
def test_the_next_planner_takes_over(fault: str) -> None:
    problem = read("transport", "two-boxes")
    planner = Replanner(ExecutionModel(problem), (Faulty(fault),), timeout_s=1.0)
    timeline = Timeline()
    asked: list[ev.Planned] = []

    def watch(run: Run, event: ev.Event, commands: tuple[ev.Command, ...]) -> None:
        timeline.watch(run, event, commands)
        if isinstance(event, ev.Planned):
            asked.append(event)

    run = engine_with(planner).run(DISTRACTED, None, watch)
    assert run.ending == ev.GOAL
    assert [p.planner for p in asked][:2] == ["faulty", "exact"]
    assert "faulty: " in asked[1].note


class Silent(Replanner):
    """No planner has an answer after the first plan."""

    def answer(self, ask: ev.AskPlan) -> ev.Planned:
        return ev.Planned(ask.t, None, note="all crashed") if ask.reasons else super().answer(ask)


def test_without_any_planner_the_running_plan_goes_on_and_the_run_ends_by_name() -> None:
    planner = Silent(ExecutionModel(read("transport", "two-boxes")))
    last: list[ev.Command] = []

    def watch(run: Run, event: ev.Event, commands: tuple[ev.Command, ...]) -> None:
        last.extend(commands)

    run = engine_with(planner).run(DISTRACTED, None, watch)
    assert run.ending == ev.REPLAN_LIMIT
    assert isinstance(last[-1], ev.Finish)  # nobody is left without a command or a stop


def test_an_unsolvable_rest_is_a_named_ending() -> None:
    """The robot alone cannot hand a box over, and the human's actions have no cause to fail."""
    problem = read("transport", "two-boxes")
    stranded = Monitor(ExecutionModel(problem), load_profile("replan-always"))
    facts = problem.facts - {("free", "human"), ("free", "robot")}
    actions, low = stranded.model.actions, dict(stranded.model.agents.low)
    ask = ev.AskPlan(0.0, actions.changing(actions.initial()) & facts, {}, low, ("failure: x",))
    planned = Replanner(ExecutionModel(problem)).answer(ask)
    assert planned.plan is None
    assert planned.note == "the goal is unsolvable"


def test_equal_questions_are_answered_once() -> None:
    planner = Replanner(ExecutionModel(read("transport", "two-boxes")))
    engine = engine_with(planner)
    first = engine.outcome(engine.run(DISTRACTED))
    n_asked = planner.n_asked
    assert engine.outcome(engine.run(DISTRACTED)) == first
    assert planner.n_asked == n_asked


def test_replanning_is_quick() -> None:
    """The goal is 20 ms in the median; the bound here leaves room for a busy machine."""
    planner = Replanner(ExecutionModel(read("transport", "two-boxes")))
    engine = engine_with(planner)
    for value in range(2, 11):
        engine.run(Nature(0, (StateChange(0.0, {("motivation", "human"): value}),)))
    walls = sorted(planner.wall_s[1:])
    assert len(walls) >= 8
    assert walls[len(walls) // 2] < 0.1


class Claims:
    """Answers with the plan of one planner, and proves nothing."""

    def __init__(self, name: str, text: str | None) -> None:
        self.card = Capabilities(name, "a plan that is written down", temporal=True)
        self.text = text
        self.any_plan: list[bool] = []

    def missing(self) -> str | None:
        return None

    def solve(self, request: Request) -> Answer:
        self.any_plan.append(request.any_plan)
        if self.text is None:
            return Answer(Status.UNSOLVABLE)
        return Answer(Status.SOLVED, parse_plan(self.text))


GOOD = """0: (move human wp1 wp4) [50]
0: (move robot wp0 wp3) [50]
50.001: (grasp human blue wp4) [50]
50.001: (grasp robot green wp3) [50]
100.002: (move robot wp3 wp2) [50]
100.002: (move human wp4 wp5) [50]
150.003: (place robot green wp2) [50]
150.003: (place human blue wp5) [50]"""
SLOW = GOOD.replace("150.003: (place human", "950.003: (place human")


@pytest.mark.parametrize(("named", "asked", "best"), [((), 3, "good"), (("slow",), 1, "slow")])
def test_plans_that_are_not_proven_are_compared(
    named: tuple[str, ...], asked: int, best: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A planner that was named has the word for itself."""
    claims = [Claims("slow", SLOW), Claims("none", None), Claims("good", GOOD)]
    monkeypatch.setattr(replanner, "fixed_order", lambda problem: claims)
    model = ExecutionModel(read("transport", "two-boxes"))
    planner = Replanner(model, claims[:1] if named else ("auto",))
    problem = model.problem
    answer = planner.answer(ev.AskPlan(0.0, problem.facts, {}, problem.values))
    assert answer.planner == best
    assert [claim.any_plan for claim in claims][:asked] == [[False], [True], [True]][:asked]
    assert sum(len(claim.any_plan) for claim in claims) == asked


def test_numbers_that_no_bits_hold_are_executed():
    """A classical task whose actions change a function: steps stay with their agents."""
    problem = problem_of(
        """(define (domain room) (:requirements :typing :numeric-fluents)
          (:types agent item) (:predicates (controllable ?a - agent) (clean ?i - item))
          (:functions (water))
          (:action wash :parameters (?a - agent ?i - item)
            :precondition (and (>= (water) 0.4)) :effect (and (clean ?i) (decrease (water) 0.4)))
          (:action fetch :parameters (?a - agent)
            :precondition (and) :effect (increase (water) 0.5)))""",
        """(define (problem p) (:domain room) (:objects ann rob - agent cup jar - item)
          (:init (controllable rob) (= (water) 0.5))
          (:goal (and (clean cup) (clean jar))))""",
    )
    outcome = execute(problem).outcome
    assert outcome.ending == "goal reached"
    assert outcome.replans == 0
