"""Episodes of teams whose agents move, carry and differ: nobody waits for ever."""

from collections import Counter

import numpy as np
import pytest

from hrcplan.assistance.expected_help import ExpectedHelp
from hrcplan.assistance.oracle import Oracle
from hrcplan.bank import Bank, BuildOptions, build, builder
from hrcplan.bank.cost_to_go import NEVER, TIMESTEP, CostToGo, cost_to_go_of
from hrcplan.bank.team_moves import Moment, TeamMoves
from hrcplan.episodes.episode import REACHED, STUCK, play
from hrcplan.episodes.humans import HUMANS, Course, Frontier, HumanMove
from hrcplan.errors import LimitError, UsageError
from hrcplan.testing import check_human
from tests.worlds import world

# Crates are carried from place to place; who is strong carries the heavy ones. Who is trained
# fits a part into the frame, and who has the tool tests the frame: nobody can do all of it.
YARD = """
(define (domain yard) (:requirements :strips :typing)
  (:types agent place crate - object)
  (:predicates (controllable ?a - agent) (strong ?a - agent) (trained ?a - agent)
    (equipped ?a - agent) (light ?c - crate) (heavy ?c - crate) (road ?p ?q - place)
    (bench ?p - place) (at ?a - agent ?p - place) (on ?c - crate ?p - place)
    (free ?a - agent) (holds ?a - agent ?c - crate) (fitted ?c - crate) (tested ?c - crate))
  (:action walk :parameters (?a - agent ?p ?q - place)
    :precondition (and (at ?a ?p) (road ?p ?q)) :effect (and (at ?a ?q) (not (at ?a ?p))))
  (:action lift :parameters (?a - agent ?c - crate ?p - place)
    :precondition (and (at ?a ?p) (on ?c ?p) (free ?a) (light ?c))
    :effect (and (holds ?a ?c) (not (on ?c ?p)) (not (free ?a))))
  (:action heave :parameters (?a - agent ?c - crate ?p - place)
    :precondition (and (at ?a ?p) (on ?c ?p) (free ?a) (heavy ?c) (strong ?a))
    :effect (and (holds ?a ?c) (not (on ?c ?p)) (not (free ?a))))
  (:action drop :parameters (?a - agent ?c - crate ?p - place)
    :precondition (and (at ?a ?p) (holds ?a ?c))
    :effect (and (on ?c ?p) (free ?a) (not (holds ?a ?c))))
  (:action fit :parameters (?a - agent ?c - crate ?p - place)
    :precondition (and (at ?a ?p) (on ?c ?p) (bench ?p) (trained ?a)) :effect (fitted ?c))
  (:action test :parameters (?a - agent ?c - crate ?p - place)
    :precondition (and (at ?a ?p) (on ?c ?p) (fitted ?c) (equipped ?a)) :effect (tested ?c)))
"""
PLACES = """
(define (problem {name}) (:domain yard)
  (:objects AGENTS - agent gate hall yard - place box case drum - crate)
  (:init (controllable robo) (controllable rob2) STATE
    (road gate hall) (road hall gate) (road hall yard) (road yard hall) (bench hall)
    (light box) (light case) (heavy drum)    (on box gate) (on case yard) (on drum yard))
  (:goal (and {goal})))
"""
GOALS = {
    "box": "(fitted box)", "case": "(fitted case)", "drum": "(on drum hall)",
    "checked": "(tested box)", "both": "(fitted box) (fitted case)", "out": "(on box yard)",
    "swap": "(on box yard) (on case gate)", "all": "(tested case) (on drum gate)",
}  # fmt: skip
ONE_EACH = ("ann robo", "(at ann gate) (free ann) (trained ann)"
            "(at robo yard) (free robo) (strong robo) (equipped robo)")  # fmt: skip
TWO_ROBOTS = ("ann robo rob2", "(at ann hall) (trained ann) (free ann)"
              "(at robo yard) (free robo) (strong robo)"
              "(at rob2 gate) (free rob2) (equipped rob2)")  # fmt: skip
TWO_HUMANS = ("robo ann bob", "(at ann hall) (trained ann) (free ann) (at bob gate) (free bob)"
              "(at robo yard) (free robo) (strong robo) (equipped robo)")  # fmt: skip


def yard(agents: str, state: str) -> Bank:
    problem = PLACES.replace("AGENTS", agents).replace("STATE", state)
    names = agents.split()
    for robot in ("robo", "rob2"):
        if robot not in names:
            problem = problem.replace(f"(controllable {robot})", "")
    return build(world(YARD, problem, GOALS))


@pytest.fixture(scope="module")
def _shared(bank: Bank) -> TeamMoves:
    """Keeps the costs to go, which all tests of a bank share."""
    return TeamMoves(bank)


@pytest.fixture(scope="module", params=[ONE_EACH, TWO_ROBOTS, TWO_HUMANS],
                ids=["one-each", "two-robots", "two-humans"])  # fmt: skip
def bank(request: pytest.FixtureRequest) -> Bank:
    return yard(*request.param)


def courses(n_goals: int, n: int, mistake_rate: float, wait_rate: float = 0.0) -> list[Course]:
    found = []
    for seed in range(n):
        rng = np.random.default_rng(seed)
        first, second = rng.choice(n_goals, 2, replace=False).tolist()
        changes = bool(seed % 2)
        goals, turns = ((first, second), (int(rng.integers(1, 6)),)) if changes else ((first,), ())
        found.append(Course(goals, turns, mistake_rate, wait_rate, seed=str(seed)))
    return found


@pytest.mark.usefixtures("_shared")
@pytest.mark.parametrize("rates", [(0.0, 0.0), (0.1, 0.0), (0.1, 0.2)], ids=str)
def test_every_goal_is_reached(bank, rates):
    robot, oracle_robot, endings, extra = ExpectedHelp(bank), Oracle(bank), Counter(), []
    for course in courses(len(bank.names), 24, *rates):
        record = play(bank, Frontier(bank, course), robot, course)
        endings[record.ending] += 1
        oracle = play(bank, Frontier(bank, course), oracle_robot, course)
        assert oracle.ending == REACHED
        extra.append(record.n_turns - oracle.n_turns)
    assert endings[REACHED] >= (23 if any(rates) else 24)  # mistakes and waits may take too long
    assert not endings[STUCK]
    assert np.mean(extra) < 6


@pytest.mark.usefixtures("_shared")
def test_agents_act_in_the_order_of_their_turns(bank):
    course = courses(len(bank.names), 1, 0.2)[0]
    record = play(bank, Frontier(bank, course), ExpectedHelp(bank), course)
    moves, task, state = TeamMoves(bank), bank.goals.task, bank.initial
    for turn in record.turns:
        agent = bank.team[turn.t % len(bank.team)]
        assert turn.is_human == (not moves.is_robot[turn.t % len(bank.team)])
        if turn.step is not None:
            assert task.actions[bank.table[turn.step].actions[0]].agent == agent
            state = bank.table.successor(state, turn.step)
    assert bank.goals.is_reached(course.goals[-1], state)


class Idle(ExpectedHelp):
    """A robot that never does anything."""

    def choose(self, state):
        return None


def test_a_human_does_alone_what_it_can_and_waits_for_the_rest():
    bank = yard(*ONE_EACH)
    endings = {}
    for goal, name in enumerate(bank.names):
        course = Course((goal,), seed="alone")
        endings[name] = play(bank, Frontier(bank, course), Idle(bank), course).ending
    needs_robot = {"drum", "checked", "all"}
    assert endings == {n: STUCK if n in needs_robot else REACHED for n in bank.names}


class Lazy(Frontier):
    """A human who leaves everything to the robot."""

    def move_in_turn(self, turn, world, last, moment):
        return HumanMove(None)


def test_a_robot_does_not_wait_in_vain():
    """It does all that it can for the goal that it finds likeliest."""
    bank = yard(*ONE_EACH)
    course = Course((bank.goal_index("out"),), seed="lazy")
    record = play(bank, Lazy(bank, course), ExpectedHelp(bank), course)
    assert sum(turn.step is not None for turn in record.turns) > 2


@pytest.mark.usefixtures("_shared")
def test_the_cost_to_go_is_that_of_the_graphs(bank):
    costs = cost_to_go_of(bank)
    rng = np.random.default_rng(5)
    state = bank.initial
    for _ in range(3):
        turn = int(rng.integers(len(bank.team)))
        found = costs.of(np.array([costs.place(state)]), turn)[:, 0]
        for goal, cost in enumerate(found.tolist()):
            graph = bank.graph_from(goal, state, turn=turn)
            if not graph.n_nodes:
                assert cost == NEVER
            else:
                assert divmod(cost, TIMESTEP) == (graph.optimal_cost, graph.n_steps)
        options = bank.table.applicable(state)
        state = bank.table.successor(state, options[rng.integers(len(options))])


@pytest.mark.usefixtures("_shared")
def test_next_steps_are_the_edges_of_the_graphs(bank):
    moves, state, moment = TeamMoves(bank), bank.initial, Moment()
    rng = np.random.default_rng(3)
    for _ in range(4):
        choices = moves.choices(state, moment)
        mine = set(choices.steps.tolist())
        for goal in range(len(bank.names)):
            graph = bank.graph_from(goal, state, turn=moment.turn)
            edges = mine & graph.next(0).keys() if graph.n_nodes else set()
            assert set(choices.next_steps(goal)) == edges
        step = int(rng.choice(choices.steps)) if rng.random() < 0.8 and len(mine) else None
        state = state if step is None else bank.table.successor(state, step)
        moment = Moment(moves.after(moment, step).turn)


@pytest.mark.parametrize("name", HUMANS.built_in)
def test_every_human_of_a_team_keeps_the_laws(name):
    bank = yard(*ONE_EACH)
    check_human(HUMANS.find(name), bank, courses(len(bank.names), 2, 0.2))


def test_too_many_states_are_refused_by_number():
    with pytest.raises(LimitError, match="more than 100 states"):
        CostToGo(yard(*ONE_EACH), max_states=100)


def test_too_many_states_are_named_or_approximated(monkeypatch, tmp_path):
    """Solo plans of each agent still take turns, and the bank says that they are used."""
    monkeypatch.setattr(builder, "has_few_states", lambda *args: False)
    bank = yard(*ONE_EACH)
    assert bank.turns == "solo"
    assert bank.note is not None
    endings = Counter()
    for goal in range(len(bank.names)):
        course = Course((goal,), seed=str(goal))
        endings[play(bank, Frontier(bank, course), ExpectedHelp(bank), course).ending] += 1
    assert endings == {REACHED: len(bank.names)}


def test_turns_can_be_asked_for():
    goals = yard(*ONE_EACH).goals
    assert build(goals, BuildOptions(turns="solo")).turns == "solo"
    with pytest.raises(UsageError, match="--turns"):
        BuildOptions(cost="task", turns="solo")
