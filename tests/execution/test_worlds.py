"""The simulated world: real durations, failures from the truth, sensing when it is asked for."""

from pathlib import Path

import pytest

from hrcplan.errors import UsageError
from hrcplan.execution import Spec, engine_for, simulate
from hrcplan.execution import events as ev
from hrcplan.execution.events import Event
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.simulate import cause_of, nature_of
from hrcplan.execution.worlds import chance
from hrcplan.execution.worlds.simulated import FactChange, Nature, SimulatedWorld, StateChange
from hrcplan.pddl import library
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem

MOTIVATION = ("motivation", "human")


@pytest.fixture(scope="module")
def problem() -> Problem:
    return read("transport", "two-boxes")


def lost(t: float) -> StateChange:
    """At a time the human loses all motivation, so that every action fails."""
    return StateChange(t, {MOTIVATION: 10})


def moving(problem: Problem, nature: Nature, human_s: float = 50.0) -> SimulatedWorld:
    world = SimulatedWorld(ExecutionModel(problem), nature)
    world.begin()
    world.do(ev.Dispatch(0.0, 0, "robot", "move", ("robot", "wp0", "wp3"), 50.0))
    world.do(ev.Dispatch(0.0, 1, "human", "move", ("human", "wp1", "wp4"), human_s))
    return world


def everything(world: SimulatedWorld) -> list[Event]:
    found: list[Event] = []
    while events := world.next():
        found += [e for e in events if not isinstance(e, ev.Observed)]
    return found


def test_actions_take_their_own_time(problem: Problem) -> None:
    assert everything(moving(problem, Nature(), 70.0)) == [
        ev.Ended(50.0, 0, ev.DONE), ev.Ended(70.0, 1, ev.DONE),
    ]  # fmt: skip


def test_events_of_an_instant_come_together(problem: Problem) -> None:
    world = moving(problem, Nature(), 50.005)
    events = world.next()
    assert [type(e) for e in events] == [ev.Ended, ev.Ended, ev.Observed]
    assert {e.t for e in events} == {50.0}
    assert world.next() == ()


def test_the_human_fails_and_the_robot_does_not(problem: Problem) -> None:
    world = moving(problem, Nature(changes=(lost(0.0),)))
    assert everything(world) == [
        ev.Sensed(25.0, {MOTIVATION: 10}), ev.Ended(50.0, 0, ev.DONE), ev.Ended(50.0, 1, ev.FAILED),
    ]  # fmt: skip
    assert ("at", "human", "wp1") in world.state.facts


@pytest.mark.parametrize(("sensed", "t"), [("before", 0.0), ("during", 25.0), ("after", 50.0)])
def test_when_a_change_is_sensed(problem: Problem, sensed: str, t: float) -> None:
    world = SimulatedWorld(ExecutionModel(problem), Nature(changes=(lost(0.0),), sensed=sensed))
    first = [e.t for e in world.begin() if isinstance(e, ev.Sensed)]
    world.do(ev.Dispatch(0.0, 1, "human", "move", ("human", "wp1", "wp4"), 50.0))
    assert first + [e.t for e in everything(world) if isinstance(e, ev.Sensed)] == [t]


def test_an_outcome_comes_before_a_change_of_the_same_instant(problem: Problem) -> None:
    world = moving(problem, Nature(changes=(lost(50.002),)))
    assert ev.Ended(50.0, 1, ev.DONE) in everything(world)


def test_a_change_while_an_action_runs_lets_it_fail_and_is_sensed_before_its_end(
    problem: Problem,
) -> None:
    found = everything(moving(problem, Nature(changes=(lost(20.0),))))
    assert ev.Sensed(35.0, {MOTIVATION: 10}) in found
    assert ev.Ended(50.0, 1, ev.FAILED) in found


def test_actions_that_cannot_fail_do_not(problem: Problem) -> None:
    nature = Nature(changes=(lost(0.0),), can_fail=frozenset({"grasp"}))
    assert ev.Ended(50.0, 1, ev.DONE) in everything(moving(problem, nature))


def test_a_cancelled_action_leaves_no_trace(problem: Problem) -> None:
    world = moving(problem, Nature())
    before = SimulatedWorld(ExecutionModel(problem), Nature()).state.facts
    world.do(ev.Cancel(0.0, 0))
    world.do(ev.Cancel(0.0, 1))
    assert {(e.number, e.outcome) for e in everything(world) if isinstance(e, ev.Ended)} == {
        (0, ev.CANCELLED), (1, ev.CANCELLED),
    }  # fmt: skip
    assert world.state.facts == before


def test_an_accident_is_observed(problem: Problem) -> None:
    fact = ("box-at", "blue", "wp0")
    world = SimulatedWorld(
        ExecutionModel(problem), Nature(accidents=(FactChange(5.0, frozenset({fact})),))
    )
    (event, *_) = world.next()
    assert isinstance(event, ev.Observed)
    assert fact in event.facts


def test_outcomes_are_drawn_once_or_at_every_attempt(problem: Problem) -> None:
    def outcomes(draws: str) -> set[str]:
        change = StateChange(0.0, {MOTIVATION: 5})
        world = SimulatedWorld(ExecutionModel(problem), Nature("s", (change,), draws=draws))
        found = set()
        for n in range(30):
            world.do(ev.Dispatch(50.0 * n, n, "human", "move", ("human", "wp1", "wp1"), 50.0))
            found |= {e.outcome for e in everything(world) if isinstance(e, ev.Ended)}
        return found

    assert len(outcomes("once")) == 1
    assert outcomes("attempt") == {ev.DONE, ev.FAILED}


def test_chance_depends_on_the_purpose_only() -> None:
    assert chance.uniform(1, "a") == chance.uniform(1, "a")
    assert len({chance.uniform(s, p) for s in range(20) for p in "ab"}) == 40
    draws = [chance.choice("abcd", seed, "letter") for seed in range(4000)]
    assert all(900 < draws.count(letter) < 1100 for letter in "abcd")


def test_causes_are_uniform_over_functions_and_then_over_their_parameters() -> None:
    engine = engine_for(Spec())
    causes = [cause_of(Spec(seed=s), engine) for s in range(3000)]
    names = [cause[0] for cause in causes]
    assert all(900 < names.count(n) < 1100 for n in ("knowledge", "motivation", "capacity"))
    places = [cause[2] for cause in causes if cause[0] == "capacity"]
    assert all(120 < places.count(f"wp{i}") < 215 for i in range(6))
    assert {cause[1] for cause in causes} == {"human"}


def test_variants_are_paired() -> None:
    """What happens does not depend on the profile, the model, or when it is sensed."""
    for seed in range(5):
        natures = [
            nature_of(spec, engine_for(spec)).changes
            for spec in (Spec(case=2, seed=seed), Spec(case=2, seed=seed, model=False),
                         Spec(case=2, seed=seed, profile="hrcplan", sensed="before"))
        ]  # fmt: skip
        assert natures[0] == natures[1] == natures[2]


def test_a_random_change_comes_before_one_of_the_human_s_actions() -> None:
    engine = engine_for(Spec())
    times = {round(nature_of(Spec(seed=s, when="random"), engine).changes[0].t) for s in range(60)}
    assert times == {0, 50, 100, 150}


def test_unequal_durations_lose_no_time_and_reach_the_goal() -> None:
    """A human who takes one and a half times as long keeps the robot waiting for nothing."""
    engine = engine_for(Spec())
    slow = Nature("slow", stretch=(1.5, 1.5))
    run = engine.run(slow)
    assert run.ending == ev.GOAL
    assert run.counts.last_end_s == 300.0
    varied = Nature("varied", (lost(120.0),), stretch=(0.5, 2.0))
    assert engine_for(Spec(profile="hrcplan")).run(varied).ending == ev.GOAL


REMIND = """
  (:durative-action remind
    :parameters (?a - agent ?h - agent)
    :duration (= ?duration 10)
    :condition (and (at start (partner ?a ?h)) (at start (idle ?a)) (at start (idle ?h)))
    :effect (and (at start (not (idle ?a))) (at end (idle ?a))
      (at start (not (idle ?h))) (at end (idle ?h)) (at end (assign (motivation ?h) 1))
      (at start (increase (total-cost) 3)))))
"""


@pytest.mark.parametrize(("success", "value"), [("1", 1), ("0", 10)])
def test_an_interaction_changes_the_truth_if_it_succeeds(
    tmp_path: Path, success: str, value: int
) -> None:
    text = library.find_domain("transport").read_text()
    (tmp_path / "transport.pddl").write_text(
        f";; hrcplan: success remind {success}\n{text.rstrip()[:-1]}{REMIND}"
    )
    loaded = read(
        str(tmp_path / "transport.pddl"), str(library.find_problem("transport", "two-boxes"))
    )
    world = SimulatedWorld(ExecutionModel(loaded), Nature(changes=(lost(0.0),), sensed="before"))
    world.begin()
    world.do(ev.Dispatch(0.0, 0, "robot", "remind", ("robot", "human"), 10.0))
    assert everything(world) == [ev.Ended(10.0, 0, ev.DONE), ev.Sensed(10.0, {MOTIVATION: value})]


def test_a_change_known_before_the_first_plan_needs_no_replan() -> None:
    rows = [simulate(Spec(case=1, seed=s, sensed="before", profile="hrcplan")) for s in range(8)]
    assert all(row.success and row.replans == 0 and row.failed_human == 0 for row in rows)


@pytest.mark.parametrize("wrong", [{"case": 3}, {"when": "never"}, {"sensed": "x"}, {"draws": "x"}])
def test_wrong_specifications_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(UsageError):
        Spec(**wrong)  # type: ignore[arg-type]
