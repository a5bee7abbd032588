"""Episodes in turns: laws on small worlds, and how they end."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrcplan import bank as banks
from hrcplan.assistance import ASSISTANTS
from hrcplan.episodes.episode import PATIENCE, REACHED, STUCK, UNFINISHED, SimulatedTurns, play
from hrcplan.episodes.humans import Course, Frontier, HumanMove
from hrcplan.errors import UsageError
from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.source import SourceText

# A door is built by anybody and painted by who is able; a lamp is of no use to anybody.
DOOR = """
(define (domain door) (:requirements :strips :typing) (:types agent - object)
  (:predicates (controllable ?a - agent) (able ?a - agent) (built) (painted) (lit) (dark) (flown))
  (:action build :parameters (?a - agent) :precondition (and) :effect (built))
  (:action paint :parameters (?a - agent) :precondition (and (built) (able ?a)) :effect (painted))
  (:action on :parameters (?a - agent) :precondition (dark) :effect (and (lit) (not (dark))))
  (:action off :parameters (?a - agent) :precondition (lit) :effect (and (dark) (not (lit))))
  (:action fly :parameters (?a - agent) :precondition (flown) :effect (flown)))
"""
BUILT, PAINTED, FLOWN = range(3)


def door(able="robo", agents="ann robo", controllable="robo"):
    domain = domain_in(SourceText("d", DOOR))
    problems = [
        problem_in(domain, SourceText("p", f"""(define (problem {goal}) (:domain door)
          (:objects {agents} - agent)
          (:init (controllable {controllable}) (able {able}) (dark)) (:goal ({goal})))"""))
        for goal in ("built", "painted", "flown")
    ]  # fmt: skip
    return banks.build(banks.from_problems(problems))


class Scripted:
    """A robot that does what it is told by its turn, and remembers nothing."""

    def __init__(self, bank, steps=()):
        self.bank, self.steps, self.told_goals = bank, list(steps), []

    def start(self):
        return ()

    def observe(self, state, step, *, robot=False):
        return (*state, (step, robot))

    def inform(self, state, goal):
        self.told_goals.append(goal)
        return state

    def posterior(self, state):
        return np.array([0.2, 0.5, 0.3])

    def choose(self, state):
        return self.steps.pop(0) if self.steps else None


class Waiter:
    """A human who does the same in every turn, nothing if None."""

    def __init__(self, step=None):
        self.step = step

    def move(self, turn, world, last):
        return HumanMove(self.step)


def find(bank, name):
    return bank.table.find([name])


@settings(max_examples=60)
@given(data=st.data())
def test_with_an_oracle_a_goal_takes_its_optimal_number_of_steps(data, small_bank):
    """Where everybody can do everything, and no one errs or waits."""
    bank = data.draw(small_bank(kinds=("free",)))
    assert bank.agents == "dropped"
    goal, seed = data.draw(st.integers(0, 2)), data.draw(st.text(max_size=3))
    if not bank.graphs[goal].n_nodes:
        return
    course = Course((goal,), seed=seed)
    record = play(bank, Frontier(bank, course), ASSISTANTS.find("oracle")(bank), course)
    assert record.ending == REACHED
    assert record.n_turns == bank.graphs[goal].n_steps
    assert all(turn.is_needed for turn in record.turns)
    assert all(turn.guess == goal and turn.rank == 0 for turn in record.turns if turn.is_human)


@pytest.mark.parametrize("method", ["oracle", "hrcplan"])
@settings(max_examples=60)
@given(data=st.data())
def test_a_record_can_be_done_again_and_says_what_was_needed(method, data, small_bank):
    """Where facts mention no agent; `test_team` has those in which agents take turns."""
    bank = data.draw(small_bank(kinds=("free", "able")))
    course = Course(
        goals=tuple(data.draw(st.permutations(range(3)))[:2]),
        turns=(data.draw(st.integers(1, 4)),),
        mistake_rate=data.draw(st.sampled_from([0.0, 0.5])),
        wait_rate=data.draw(st.sampled_from([0.0, 0.3])), seed=data.draw(st.text(max_size=2)),
    )  # fmt: skip
    watched = []
    robot = ASSISTANTS.find(method)(bank)
    record = play(
        bank, Frontier(bank, course), robot, course, watch=lambda t, belief: watched.append(t)
    )
    assert watched == list(record.turns)
    assert [turn.t for turn in record.turns] == list(range(record.n_turns))
    assert [turn.is_human for turn in record.turns] == [t % 2 == 0 for t in range(record.n_turns)]
    assert len(record.decisions_ms) == record.n_turns // 2
    state, most = bank.initial, PATIENCE * sum(bank.graphs[g].n_steps for g in course.goals) + 2
    for turn in record.turns:
        assert turn.goal == course.goal(turn.t // 2)
        assert (
            (turn.guess is None) == (turn.rank is None) == (not turn.is_human or turn.step is None)
        )
        graph, node = bank.locate(turn.goal, state)
        assert turn.is_needed == (node is not None and turn.step in graph.next(node))
        assert not (turn.is_needed and turn.is_mistake)
        if turn.step is not None:
            agents = {"ann", "bob"} if turn.is_human else {"robo"}
            assert bank.table.doer(state, turn.step, agents) is not None
            state = bank.table.successor(state, turn.step)
    if record.ending == REACHED:
        assert record.n_turns >= 2 * course.turns[0] - 1
    reached = bank.goals.is_reached(course.goals[-1], state)
    assert reached == (record.ending == REACHED) or record.n_turns < 2 * course.turns[0]
    if record.ending == UNFINISHED:
        assert record.n_turns in (most, most + 1)
    if record.ending == STUCK:
        assert [turn.step for turn in record.turns[-2:]] == [None, None]
        graph, node = bank.locate(course.goals[-1], state)
        able = (
            []
            if node is None
            else [bank.table.doer(state, s, {"ann", "bob"}) for s in graph.next(node)]
        )
        assert able == [None] * len(able)


def test_a_goal_that_holds_from_the_start_takes_no_turn():
    bank = door()
    state = bank.table.successor(bank.initial, find(bank, "build"))

    class Built(SimulatedTurns):
        def begin(self):
            return state

    course = Course((BUILT,))
    record = play(bank, Waiter(), Scripted(bank), course, Built(bank))
    assert (record.ending, record.turns, record.decisions_ms) == (REACHED, (), ())


def test_the_last_goal_has_to_be_wanted_before_it_counts():
    bank = door(able="ann")
    course = Course((PAINTED, BUILT), (2,))
    record = play(bank, Frontier(bank, course), Scripted(bank), course)
    assert record.ending == REACHED
    assert [turn.step for turn in record.turns] == [
        find(bank, "build"), None, find(bank, "paint"), None
    ]  # fmt: skip
    assert [turn.goal for turn in record.turns] == [PAINTED] * 4


def test_patience_ends():
    """A human who plays with the lamp for ever, and a robot that lets it."""
    bank = door()
    course = Course((BUILT,), mistake_rate=1.0)
    record = play(bank, Frontier(bank, course), Scripted(bank), course)
    assert record.ending == UNFINISHED
    assert (
        record.n_turns == record.cost == PATIENCE * 1 + 1 + 1
    )  # the robot has its turn after the human's last
    assert all(turn.is_mistake == turn.is_human for turn in record.turns)


def test_the_very_last_turn_counts():
    bank = door()
    course = Course((BUILT,), mistake_rate=1.0)
    robot = Scripted(bank, [None, None, find(bank, "build")])
    record = play(bank, Frontier(bank, course), robot, course)
    assert record.ending == REACHED
    assert record.n_turns == PATIENCE * 1 + 1 + 1


@pytest.mark.parametrize(("goal", "n_turns"), [(FLOWN, 2), (PAINTED, 4)])
def test_stuck_when_the_human_can_do_nothing_and_the_robot_does_nothing(goal, n_turns):
    """Nobody can fly; and only the robot could paint."""
    bank, course = door(), Course((goal,))
    record = play(bank, Frontier(bank, course), Scripted(bank), course)
    assert record.ending == STUCK
    assert record.n_turns == n_turns
    assert record.is_reachable == (goal == PAINTED)
    assert record.cost == max(n_turns, record.cap)  # a short episode that failed is not a cheap one
    assert [turn.step for turn in record.turns[-2:]] == [None, None]


def test_not_stuck_while_a_goal_is_still_to_come():
    bank = door(able="ann")
    course = Course((FLOWN, BUILT), (2,))
    record = play(bank, Frontier(bank, course), Scripted(bank), course)
    assert record.ending == REACHED
    assert [turn.step for turn in record.turns] == [None] * 4 + [find(bank, "build")]


def test_not_stuck_while_the_human_waits_by_choice():
    bank = door(able="ann")
    both_waited = 0
    for seed in range(20):
        course = Course((PAINTED,), wait_rate=0.5, seed=str(seed))
        record = play(bank, Frontier(bank, course), Scripted(bank), course)
        both_waited += record.turns[0].step is None
        assert record.ending in (REACHED, UNFINISHED)
        if record.ending == UNFINISHED:
            assert record.n_turns == PATIENCE * 2 + 2
    assert 5 <= both_waited <= 15


def test_who_chooses_what_it_cannot_do_is_told():
    bank = door()
    course = Course((PAINTED,))
    with pytest.raises(UsageError, match=r"\(paint\) cannot be done by robo here"):
        play(bank, Waiter(), Scripted(bank, [find(bank, "paint")]), course)
    with pytest.raises(UsageError, match=r"\(paint\) cannot be done by ann here"):
        play(bank, Waiter(find(bank, "paint")), Scripted(bank), course)
    alone = door(agents="robo")
    with pytest.raises(UsageError, match=r"\(build\) cannot be done by any agent here"):
        play(alone, Waiter(find(alone, "build")), Scripted(alone), course)


@pytest.mark.parametrize("step", [-1, 10**6, "build", 0.0])
def test_what_is_no_step_is_refused(step):
    bank = door()
    course = Course((BUILT,))
    for human, robot in ((step, ()), (None, (step,))):
        with pytest.raises(UsageError, match=f"{step!r} is no step"):
            play(bank, Waiter(human), Scripted(bank, robot), course)


@pytest.mark.parametrize(
    "said", [None, [1.0], [[1.0, 0.0, 0.0]], [0.5, 0.5, 0.5], [1.5, 0.0, -0.5], ["a", "b", "c"],
             [float("nan")] * 3],
)  # fmt: skip
def test_beliefs_that_are_no_probabilities_are_refused(said):
    bank = door()
    robot = Scripted(bank)
    robot.posterior = lambda state: said
    with pytest.raises(UsageError, match="no probability for each goal"):
        play(bank, Waiter(find(bank, "build")), robot, Course((PAINTED,)))


def test_what_the_robot_is_told_and_sees():
    bank = door(able="ann")
    course = Course((PAINTED, BUILT), (1,))
    robot = Scripted(bank, [None, find(bank, "build")])
    seen, beliefs = [], []

    class Human(Waiter):
        def move(self, turn, world, last):
            seen.append((turn, last))
            return HumanMove(None if turn else find(bank, "on"), is_mistake=not turn)

    record = play(bank, Human(), robot, course, watch=lambda turn, belief: beliefs.append(belief))
    on, build = find(bank, "on"), find(bank, "build")
    lit = ((on, False),)
    assert beliefs == [lit, lit, lit, (*lit, (build, True))]
    assert robot.told_goals == [PAINTED, BUILT]  # also if the human waits
    assert (record.turns[0].guess, record.turns[0].rank) == (1, 0)
    assert seen == [(0, None), (1, on)]


@pytest.mark.parametrize(("goal", "rank"), [(0, 2), (1, 0), (2, 1)])
def test_rank_counts_likelier_goals(goal, rank):
    bank = door(able="ann")
    course = Course((goal, BUILT), (1,))
    record = play(bank, Waiter(find(bank, "build")), Scripted(bank), course)
    assert (record.turns[0].guess, record.turns[0].rank) == (1, rank)


def test_equals_rank_in_the_order_of_goals():
    bank = door(able="ann")

    class Even(Scripted):
        def posterior(self, state):
            return np.array([0.4, 0.2, 0.4])

    course = Course((FLOWN, BUILT), (1,))
    record = play(bank, Waiter(find(bank, "build")), Even(bank), course)
    assert (record.turns[0].guess, record.turns[0].rank) == (0, 1)
