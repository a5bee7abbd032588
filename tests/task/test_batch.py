"""Many states at once: everything equals what the task says of one state."""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import hrcplan
from hrcplan import BatchSimulator, HrcplanError, Problem, Task, UnsupportedError
from hrcplan.pddl import library

PUBLIC = Path(__file__).parents[1] / "data" / "public"
N_STATES, N_ACTIONS = 70, 50  # more than one word of states; actions that are tried in all of them


def states_of_walk(task: Task, n_states: int = N_STATES, seed: int = 0) -> list[int]:
    """Return states of random walks, with some in which facts were changed at random."""
    chance, states = random.Random(seed), [task.initial]
    while len(states) < n_states:
        actions = task.applicable(states[-1])
        state = task.successor(states[-1], chance.choice(actions)) if actions else task.initial
        noise = chance.getrandbits(len(task.facts)) if task.facts and chance.random() < 0.3 else 0
        states.append(state ^ noise & chance.getrandbits(len(task.facts)) if noise else state)
    return states


def compare(task: Task, states: list[int]) -> None:
    """Compare applicable actions, goal, and what (some) actions do, in all of the states."""
    simulator, n_states = BatchSimulator(task), len(states)
    rows = simulator.pack(states)
    assert simulator.unpack(rows) == states
    applicable = simulator.applicable(rows)
    assert applicable.shape == (n_states, len(task.actions))
    assert [list(np.flatnonzero(row)) for row in applicable] == [*map(task.applicable, states)]
    assert simulator.is_goal(rows).tolist() == [*map(task.is_goal, states)]
    chance = random.Random(1)
    for index in chance.sample(range(len(task.actions)), min(N_ACTIONS, len(task.actions))):
        after = simulator.step(rows, np.full(n_states, index))
        assert simulator.unpack(after) == [task.successor(state, index) for state in states]
    assert simulator.unpack(rows) == states, "step left its argument as it was"


def shipped() -> Iterator[Path]:
    for folder in sorted((library.root() / "problems").iterdir()):
        yield from sorted(folder.glob("*.pddl"))[:2]


@pytest.mark.parametrize(
    "path", list(shipped()), ids=lambda path: f"{path.parent.name}/{path.stem}"
)
def test_shipped_domains(path: Path) -> None:
    task = hrcplan.ground(path)
    compare(task, states_of_walk(task))


def test_small_domains(small_problem: Problem) -> None:
    task = Task(small_problem)
    compare(task, states_of_walk(task))


def public_tasks() -> Iterator[tuple[str, Task]]:
    """Yield the tasks of the files of other projects that bits can hold."""
    for domain in sorted(PUBLIC.glob("*/*/domain.pddl")):
        try:
            yield domain.parent.name, hrcplan.ground(domain, domain.with_name("problem.pddl"))
        except HrcplanError:
            continue  # tests/pddl/test_public_files.py says which files are refused, and why


def test_public_domains() -> None:
    names = []
    for name, task in public_tasks():
        compare(task, states_of_walk(task))
        names.append(name)
    assert len(names) > 30
    assert {"citycar", "fridge", "viplan_hh"} <= {*names}, "domains with conditional effects"


def test_walks_are_walks_of_the_task() -> None:
    task = hrcplan.ground("household", "guest")
    simulator = BatchSimulator(task)
    actions, last = simulator.walk(simulator.initial(100), 12, np.random.default_rng(3))
    assert actions.shape == (12, 100)
    for walk, end in zip(actions.T.tolist(), simulator.unpack(last), strict=True):
        state = task.initial
        for index in walk:
            assert index in task.applicable(state)
            state = task.successor(state, index)
        assert state == end


def test_draws_are_uniform_among_the_allowed() -> None:
    task = hrcplan.ground("transport", "two-boxes")
    simulator, n_draws = BatchSimulator(task), 20_000
    agents = np.array([action.agent == "human" for action in task.actions])
    expected = [i for i in task.applicable(task.initial) if task.actions[i].agent == "human"]
    drawn = simulator.draw(simulator.initial(n_draws), np.random.default_rng(5), agents)
    counts = np.bincount(drawn, minlength=len(agents))
    assert list(np.flatnonzero(counts)) == expected
    mean = n_draws / len(expected)
    assert np.abs(counts[expected] - mean).max() < 5 * mean**0.5
    none = simulator.draw(simulator.initial(3), np.random.default_rng(5), agents & False)
    assert none.tolist() == [-1, -1, -1]


def test_dead_ends_stay_where_they_are() -> None:
    folder = PUBLIC / "unified-planning" / "visit_precedence"
    task = hrcplan.ground(folder / "domain.pddl", folder / "problem.pddl")
    simulator = BatchSimulator(task)
    actions, last = simulator.walk(simulator.initial(5), 50, np.random.default_rng(0))
    assert (actions[-1] == -1).all()
    assert (simulator.step(last, actions[-1]) == last).all()
    assert not simulator.applicable(last).any()


def test_facts_are_those_of_the_state() -> None:
    task = hrcplan.ground("kitchen", "pasta-bean")
    simulator = BatchSimulator(task)
    (row,) = simulator.facts(simulator.initial(1))
    assert {task.facts[i] for i in np.flatnonzero(row)} == task.facts_of(task.initial)


def test_no_states() -> None:
    simulator = BatchSimulator(hrcplan.ground("transport", "two-boxes"))
    states = simulator.initial(0)
    assert simulator.applicable(states).shape == (0, 132)
    assert simulator.is_goal(states).shape == (0,)
    assert simulator.step(states, []).shape == states.shape
    assert simulator.draw(states, np.random.default_rng(0)).shape == (0,)


def test_parts_of_large_batches_equal_small_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    task = hrcplan.ground("transport", "two-boxes")
    states = states_of_walk(task, 300)
    whole = BatchSimulator(task).applicable(BatchSimulator(task).pack(states))
    monkeypatch.setattr("hrcplan.task.batch.BITS", 1)
    simulator = BatchSimulator(task)
    assert (simulator.applicable(simulator.pack(states)) == whole).all()


@pytest.mark.parametrize("actions", [[0], [0, 1, 2], [0, 132], [-2, 0], [[0, 1]]])
def test_wrong_actions(actions: list[int]) -> None:
    simulator = BatchSimulator(hrcplan.ground("transport", "two-boxes"))
    with pytest.raises(hrcplan.UsageError, match="actions"):
        simulator.step(simulator.initial(2), actions)


def test_wrong_states() -> None:
    simulator = BatchSimulator(hrcplan.ground("kitchen", "stew-lentil"))
    with pytest.raises(hrcplan.UsageError, match=r"rows of 4 words .* not int64 of shape \(2, 4\)"):
        simulator.applicable(np.zeros((2, 4), dtype=np.int64))
    with pytest.raises(hrcplan.UsageError, match="rows of 4 words"):
        simulator.is_goal(np.zeros((2, 1), dtype=np.uint64))


def test_tasks_with_other_numbers_are_refused_by_name() -> None:
    folder = PUBLIC / "unified-planning" / "counters"
    with pytest.raises(UnsupportedError, match="changes \\(value …\\)"):
        BatchSimulator(hrcplan.ground(folder / "domain.pddl", folder / "problem.pddl"))


@given(st.lists(st.integers(0, 2**130 - 1), max_size=70))
def test_transposed_bits(numbers: list[int]) -> None:
    from hrcplan.core.bit_rows import pack, transpose, unpack

    columns = unpack(transpose(pack(numbers, 130)))
    assert len(columns) == 192
    for place, column in enumerate(columns):
        assert column == sum((number >> place & 1) << i for i, number in enumerate(numbers))
