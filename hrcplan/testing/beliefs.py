"""Laws of beliefs and assistants."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from hrcplan.assistance.assistant import Assistant, inform
from hrcplan.bank import Bank
from hrcplan.core.registry import members
from hrcplan.inference.belief import Belief, S
from hrcplan.pddl.conventions import robots


def check_belief(belief: Belief[S], runs: Iterable[Sequence[int]]) -> None:
    """Test the laws of beliefs.

    The posterior has a probability for each goal, before and after every step. States never change,
    also if one is continued in another direction. The same steps lead to the same posterior. Steps
    of the robot are accepted, also such that change nothing.

    Args:
        belief: The belief (see `hrcplan.inference.belief.Belief`).
        runs: Observed steps, as indices of the step table of the belief.

    Raises:
        AssertionError: if a law is broken.
    """
    _has_members(belief, Belief)
    runs = [tuple(run) for run in runs]
    for run, other in zip(runs, [*runs[1:], *runs[:1]], strict=True):
        states, earlier = [belief.start()], []
        for step in run:
            earlier.append(_posterior(belief, states[-1]))
            states.append(belief.observe(states[-1], step))
        state = belief.start()
        for step in other:
            state = belief.observe(state, step, robot=True)
            _posterior(belief, state)
        later = [_posterior(belief, state) for state in states]
        assert later[:-1] == earlier, "a state has changed after it was followed"
        state = belief.start()
        for place, step in enumerate(run):
            state = belief.observe(state, step)
            assert _posterior(belief, state) == later[place + 1], "a second walk differs"


def check_assistant(assistant: Assistant[S], bank: Bank, runs: Iterable[Sequence[int]]) -> None:
    """Test the laws of assistants, which include those of beliefs.

    Together with a human who does one of the runs, the assistant chooses None or a step that the
    robot can do and that changes the state; ``world`` of its state is the state of the task. A
    choice changes no state, and it depends on nothing but the state. An assistant that `KnowsGoal`
    receives a goal after each of the human's steps.

    Args:
        assistant: The assistant (see `hrcplan.assistance.Assistant`).
        bank: The bank that it was made from.
        runs: Steps of the human; those that are not applicable in their turn are left out.

    Raises:
        AssertionError: if a law is broken.
    """
    _has_members(assistant, Assistant)
    runs = [tuple(run) for run in runs]
    check_belief(assistant, runs)
    choices: list[tuple[S, int | None]] = []
    for i, run in enumerate(runs):
        goal = i % len(assistant.names)
        walk = _side_by_side(assistant, bank, run, goal)
        state = assistant.start()
        for step, is_robot, choice, posterior in walk:
            if step is not None:
                state = _observe(assistant, state, step, is_robot, goal)
            if not is_robot:
                assert _posterior(assistant, state) == posterior, "a second walk differs"
                assert assistant.choose(state) == choice, "a second walk is answered differently"
                choices.append((state, choice))
    for state, choice in choices:
        assert assistant.choose(state) == choice, "a choice depends on what was asked in between"


WalkStep = tuple[int | None, bool, int | None, list[float]]
"""A step, whether the robot did it, and after a human's step the choice and the posterior."""


def _side_by_side(
    assistant: Assistant[S], bank: Bank, run: Sequence[int], goal: int
) -> list[WalkStep]:
    """Return the steps of a human who does a run, and of the robot, in turns."""
    state, world = assistant.start(), bank.initial
    walk: list[WalkStep] = []
    for step in (*run, None):
        after = None if step is None else bank.table.successor(world, step)
        if step is not None:
            if after is None:
                continue
            world, state = after, _observe(assistant, state, step, False, goal)
        choice, posterior = _choice(assistant, state, bank, world)
        walk.append((step, False, choice, posterior))
        if choice is not None:
            world = bank.table.successor(world, choice) or world
            state = _observe(assistant, state, choice, True, goal)
            walk.append((choice, True, None, []))
            assert state.world == world, "it does not know what state the task is in"
    return walk


def _choice(
    assistant: Assistant[S], state: S, bank: Bank, world: int
) -> tuple[int | None, list[float]]:
    """Return choice and posterior of an assistant in a state; the choice keeps the laws."""
    assert state.world == world, "it does not know what state the task is in"
    posterior = _posterior(assistant, state)
    choice = assistant.choose(state)
    assert _posterior(assistant, state) == posterior, "choosing has changed what is believed"
    assert state.world == world, "choosing has changed the state"
    assert assistant.choose(state) == choice, "the same state is answered differently"
    if choice is not None:
        assert 0 <= choice < len(bank.table), f"there is no step {choice}"
        actor = bank.table.doer(world, choice, robots(bank.goals.problem))
        assert actor is not None, f"the robot cannot do {bank.table[choice]}, or it changes nothing"
    return choice, posterior


def _observe(assistant: Assistant[S], state: S, step: int, is_robot: bool, goal: int) -> S:
    state = assistant.observe(state, step, robot=is_robot)
    return state if is_robot else inform(assistant, state, goal)


def _posterior(belief: Belief[S], state: S) -> list[float]:
    posterior = [float(p) for p in belief.posterior(state)]
    assert len(posterior) == len(belief.names), "one probability for each goal"
    assert all(0 <= p <= 1 for p in posterior), f"not probabilities: {posterior}"
    assert abs(sum(posterior) - 1) < 1e-9, f"the posterior sums to {sum(posterior)}"
    return posterior


def _has_members(part: Belief[S], protocol: type) -> None:
    lacks = [name for name in members(protocol) if name not in dir(part)]
    assert not lacks, f"{type(part).__name__} has no {', '.join(lacks)} (see {protocol.__name__})"
