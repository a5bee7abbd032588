"""Team plan graphs against every sequence of turns of small random worlds."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from hrcplan.bank import BuildLimits, build, build_bank, find_fault, load, save
from hrcplan.bank.audit import fault
from hrcplan.bank.cost_to_go import CostToGo
from hrcplan.bank.team_graphs import TeamGraphs
from hrcplan.bank.walk import is_prefix, plans
from hrcplan.errors import InputError, LimitError
from tests.worlds import ERRAND, ERRANDS, HALL, world

FACTS = [f"p{i}" for i in range(4)]
TEAMS = ["ann", "robo", "ann bob", "ann robo", "robo ann", "ann bob robo", "ann robo rob2"]
MAX_PLANS = 2_000


@st.composite
def actions(draw, index):
    """Draw an action: some agents lack the skill for it, and it may move who does it."""
    before = draw(st.lists(st.sampled_from(FACTS), max_size=1))
    before = [f"({fact})" for fact in before]
    after = [f"({FACTS[index % len(FACTS)]})"]
    if index and draw(st.booleans()):
        before.append(f"({FACTS[index - 1]})")
    if draw(st.integers(0, 3)) == 0:
        after.append(f"(not ({draw(st.sampled_from(FACTS))}))")
    if draw(st.integers(0, 7)) == 0:  # whoever's turn it is
        conditions, effects = " ".join(before), " ".join(after)
        return (
            f"(:action do{index} :parameters () :precondition (and {conditions})"
            f" :effect (and {effects}))"
        )
    if draw(st.booleans()):
        before.append(draw(st.sampled_from([f"(skill{index} ?a)", "(out ?a)", "(not (out ?a))"])))
    if draw(st.integers(0, 2)) == 0:
        after.append(draw(st.sampled_from(["(out ?a)", "(not (out ?a))"])))
    return (
        f"(:action do{index} :parameters (?a - agent) :precondition (and {' '.join(before)})"
        f" :effect (and {' '.join(after)}))"
    )


@st.composite
def teams(draw):
    n = draw(st.integers(3, 5))
    text = " ".join(draw(actions(i)) for i in range(n))
    agents = draw(st.sampled_from(TEAMS)).split()
    skills = " ".join(f"(skill{i} ?a - agent)" for i in range(n))
    domain = f"""(define (domain d) (:requirements :adl) (:types agent)
      (:predicates (controllable ?a - agent) (out ?a - agent) {skills}
        {" ".join(f"({f})" for f in FACTS)})
      {text}
      (:action leave :parameters (?a - agent) :precondition (not (out ?a)) :effect (out ?a)))"""
    able = [f"(skill{i} {a})" for i in range(n) for a in agents if draw(st.booleans())]
    able += [f"(controllable {a})" for a in agents if a.startswith("rob")]
    goal = draw(st.lists(st.sampled_from(FACTS), min_size=1, max_size=2, unique=True))
    objects, goals = " ".join(agents), " ".join(f"({fact})" for fact in goal)
    problem = f"""(define (problem g) (:domain d) (:objects {objects} - agent)
      (:init {" ".join(able)}) (:goal (and {goals})))"""
    return domain, problem


@dataclass(frozen=True)
class Turns:
    """All that a team can do, turn by turn, the slow way: states are (state, whose turn)."""

    task: object
    agents: list

    @classmethod
    def of(cls, task):
        people = [a for a in task.problem.agents if not a.startswith("rob")]
        return cls(task, people + [a for a in task.problem.agents if a not in people])

    def moves(self, state, turn, has_waited):
        """Yield (action or None, state after); what names no agent is done without a wait."""
        yield None, state
        for action in self.task.applicable(state):
            agent = self.task.actions[action].agent
            if agent == self.agents[turn] or (agent is None and not has_waited):
                yield action, self.task.successor(state, action)

    def best(self, state, turn):
        """Return (timesteps, actions) of the best plans; None if there is none."""
        n = len(self.agents)
        reached = {(state, turn): 0}
        for timesteps in range(200):
            done = [n_actions for (s, _), n_actions in reached.items() if self.task.is_goal(s)]
            if done:
                return timesteps, min(done)
            after = {}
            for (s, i), n_actions in reached.items():
                for action, to in self.moves(s, i, False):
                    key, paid = (to, (i + 1) % n), n_actions + (action is not None)
                    after[key] = min(paid, after.get(key, paid))
            if set(after) == set(reached) and timesteps > 50:
                return None
            reached = after
        return None

    def plans(self, state, turn, best):
        """Return the optimal plans as sequences of actions."""
        found, n = [], len(self.agents)

        def walk(s, i, left, n_left, path, has_waited):
            if self.task.is_goal(s):
                found.append(path)
            elif left and n_left >= 0 and self.can_end(s, i, left, n_left):
                for action, to in self.moves(s, i, has_waited):
                    waits = action is None
                    walk(to, (i + 1) % n, left - 1, n_left - (not waits),
                         path if waits else (*path, action), waits)  # fmt: skip

        walk(state, turn, *best, (), False)
        return found

    def can_end(self, state, turn, left, n_left):
        best = self.best(state, turn)
        return best is not None and best <= (left, n_left)


@settings(max_examples=80, deadline=None)
@given(world=teams(), data=st.data())
def test_graphs_hold_exactly_the_best_plans_of_all_turns(world, data, read_world):
    bank = build(read_world(*world))
    assume(bank.agents == "kept")
    graph, slow = bank.graphs[0], Turns.of(bank.goals.task)
    assert bank.team == tuple(slow.agents)
    best = slow.best(bank.initial, 0)
    assert (best is None) == (not graph.n_nodes)
    assert fault(bank, 0) is None
    if best is None or graph.plans > MAX_PLANS:
        return
    assert (graph.optimal_cost, graph.n_steps) == best
    wanted = slow.plans(bank.initial, 0, best)
    found = [tuple(bank.table[s].actions[0] for s in plan) for plan in plans(graph)]
    assert sorted(found) == sorted(wanted)
    assert len(set(found)) == graph.plans
    steps = [bank.table.of_action[a] for a in data.draw(st.sampled_from(wanted))]
    assert is_prefix(graph, steps)
    state, turn = bank.initial, data.draw(st.integers(0, len(bank.team) - 1))
    for step in steps[: data.draw(st.integers(0, len(steps)))]:
        state = bank.table.successor(state, step)
    best = slow.best(state, turn)
    other, node = bank.locate(0, state, turn=turn)
    assert (best is None) == (node is None)
    if best is not None and best[0]:
        total = other.optimal_cost - other.layers[other.layer_of[node]][0]
        assert (total, other.steps_left[node]) == best
        wanted = slow.plans(state, turn, best)
        assert other.plans_from(node) == len(wanted) == len(set(wanted))


@settings(max_examples=40, deadline=None)
@given(world=teams(), data=st.data())
def test_costs_to_go_give_the_graphs_that_a_search_finds(world, data, read_world):
    bank = build(read_world(*world))
    assume(bank.agents == "kept")
    graphs = TeamGraphs(bank, CostToGo(bank))
    state = bank.initial
    for _ in range(data.draw(st.integers(0, 4))):
        steps = list(bank.table.applicable(state))
        assume(steps)
        state = bank.table.successor(state, data.draw(st.sampled_from(steps)))
    turn = data.draw(st.integers(0, len(bank.team) - 1))
    by_search, by_costs = bank.graph_from(0, state, turn=turn), graphs.graph_from(0, state, turn)
    assert by_search.layers == by_costs.layers
    assert by_search.team == by_costs.team
    assert by_search.packing == by_costs.packing
    for name in ("rows", "first", "steps", "targets", "is_goal"):
        assert getattr(by_search, name).tolist() == getattr(by_costs, name).tolist()
    assert (graphs.locate(0, state, turn)[1] is None) == (not by_search.n_nodes)


def test_static_skills_and_two_of_a_kind():
    """Only ann may use things, so both robots' help ends with her; nobody waits for nothing."""
    domain = HALL.replace("(has ?a - agent ?x - thing)", "(has ?a - agent ?x - thing)"
                          " (skilled ?a - agent)").replace(
        ":precondition (has ?a ?x)", ":precondition (and (has ?a ?x) (skilled ?a))")  # fmt: skip
    problem = ERRAND.replace("(at ann b)", "(skilled ann) (at ann b)")
    bank = build(world(domain, problem, ERRANDS))
    assert bank.team == ("ann", "robot")
    for graph in bank.graphs:
        assert all(bank.table[s].words[1] == "ann" for s in graph.used_steps)
    assert bank.graphs[0].optimal_cost == 5  # ann, wait, ann, wait, ann


def test_plans_are_drawn_uniformly():
    bank = build(world(HALL, ERRAND, {"all": "(ready cup) (ready pen) (ready key)"}))
    graph = bank.graphs[0]
    listed = list(plans(graph))
    assert 1 < len(listed) == graph.plans < 200
    drawn = bank.sample(0, 200 * len(listed), np.random.default_rng(1))
    counts = [drawn.count(plan) for plan in listed]
    assert sum(counts) == len(drawn)
    assert min(counts) > 120
    assert max(counts) < 280


@pytest.fixture
def stored(tmp_path):
    (tmp_path / "hall.pddl").write_text(HALL)
    (tmp_path / "goals").mkdir()
    for name, goal in ERRANDS.items():
        text = ERRAND.format(name=name, goal=goal)
        (tmp_path / "goals" / f"{name}.pddl").write_text(text)
    bank = build_bank(str(tmp_path / "hall.pddl"), str(tmp_path / "goals"))
    save(bank, tmp_path / "hall.bank")
    return bank, tmp_path / "hall.bank"


def test_a_bank_of_team_plans_is_read_as_it_was_written(stored):
    bank, path = stored
    again = load(path)
    assert find_fault(path) is None
    assert again.team == bank.team == ("ann", "robot")
    assert path.read_bytes()[8] == 2
    for one, other in zip(bank.graphs, again.graphs, strict=True):
        assert list(plans(one)) == list(plans(other))
        assert one.team == other.team


def test_old_banks_of_sequences_are_read_and_stay_sequences(stored):
    bank, path = stored
    from hrcplan.bank.construct import optimal_graph

    old = [optimal_graph(bank.table, tests, bank.initial, name=name)
           for name, tests in zip(bank.names, bank.goals.tests, strict=True)]  # fmt: skip
    save(replace(bank, graphs=tuple(old)), path)
    again = load(path)
    assert path.read_bytes()[8] == 1
    assert again.team == ()
    assert find_fault(path) is None
    assert [list(plans(g)) for g in again.graphs] == [list(plans(g)) for g in old]


@pytest.mark.parametrize("agents", [("robot", "ann"), ("ann",), ("ann", "robot", "eve")])
def test_a_team_that_is_not_the_problems_is_a_fault(stored, agents):
    bank, path = stored
    other = [replace(g, team=replace(g.team, agents=agents)) for g in bank.graphs]
    save(replace(bank, graphs=tuple(other)), path)
    with pytest.raises(InputError, match="take turns"):
        load(path)


def test_edges_out_of_turn_are_a_fault(stored):
    bank, _ = stored
    graph = bank.graphs[0]
    late = tuple((cost + (cost > 0), first) for cost, first in graph.layers)
    wrong = replace(bank, graphs=(replace(graph, layers=late), *bank.graphs[1:]))
    assert "turns" in fault(wrong, 0)


def test_what_does_not_fit_names_what_to_lower():
    goals = world(HALL, ERRAND, ERRANDS)
    with pytest.raises(LimitError, match="MiB") as caught:
        build(goals, mib=0)
    assert "fewer objects" in caught.value.hint
    bank = build(goals)
    with pytest.raises(LimitError):
        bank.graph_from(0, bank.initial, BuildLimits(mib=0), turn=1)
