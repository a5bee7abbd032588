"""Laws that every part of a kind must keep, as functions: call them in your own tests."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from hrcplan.pddl.conventions import robots
from hrcplan.pddl.model import Problem
from hrcplan.pddl.source import read_text
from hrcplan.planners.contract import Planner
from hrcplan.planners.solve import Result, compare, solve
from hrcplan.validation import Report, validate

if TYPE_CHECKING:
    from hrcplan.bank import Bank


def check_plan(domain: str, problem: str, plan: str) -> Report:
    """Return the replay of a plan, given as text in IPC format or as a file's path.

    Raises:
        AssertionError: if the plan is invalid; the message names the first wrong step.
    """
    text = plan if "(" in plan or not plan.strip() else read_text(plan)
    report = validate(domain, problem, text)
    step = "" if report.failed_step is None else f"step {report.failed_step + 1}: "
    if not report.valid:
        raise AssertionError(f"invalid plan for {domain}/{problem}: {step}{report.reason}")
    return report


def check_planner(
    planner: Planner, problems: Iterable[Problem], *, timeout_s: float = 20.0, slack_s: float = 3.0
) -> list[Result]:
    """Return a planner's results after holding it to the laws of planners.

    It answers in time; a plan it gives is valid and costs what it says (``solve`` sees to that);
    what it claims to have proven is no worse than what ``auto`` finds, and what it calls unsolvable
    has no plan.

    Args:
        planner: An object with ``card``, ``missing`` and ``solve`` (see planners/answer.py).
        problems: Problems that its card says it can hold.
        timeout_s: Limit for each problem, in seconds.
        slack_s: How much later than the limit it may answer, in seconds.

    Raises:
        AssertionError: if it answers too late.
        PlannerError: if it is missing, gives an invalid plan, or its figures differ from hrcplan's.
    """
    results: list[Result] = []
    for problem in problems:
        mine = solve(problem, planner, timeout_s=timeout_s)
        if mine.wall_s > timeout_s + slack_s:
            raise AssertionError(f"{planner.card.name} answered after {mine.wall_s:.1f} s")
        compare([mine, solve(problem, timeout_s=timeout_s)])
        results.append(mine)
    return results


def check_belief(belief: Any, runs: Iterable[Sequence[int]]) -> None:
    """Hold a belief to the laws of beliefs.

    Its posterior sums to one, before and after every step; one step at a time gives what a second
    walk gives, also if a state is followed in another direction in between; states never change;
    a step of the robot that changes nothing is allowed.

    Args:
        belief: An object with ``names``, ``start``, ``observe`` and ``posterior`` (see
            inference/belief.py).
        runs: Observed steps, as ids of the step table that the belief speaks of.

    Raises:
        AssertionError: if it breaks a law.
    """
    runs = [tuple(run) for run in runs]
    for run, other in zip(runs, [*runs[1:], *runs[:1]], strict=True):
        states, seen = [belief.start()], []
        for step in run:
            seen.append(_posterior(belief, states[-1]))
            states.append(belief.observe(states[-1], step))
        state = belief.start()
        for step in other:
            state = belief.observe(state, step, robot=True)
            _posterior(belief, state)
        again = [_posterior(belief, earlier) for earlier in states]
        assert again[:-1] == seen, "a state has changed after it was followed"
        state = belief.start()
        for place, step in enumerate(run):
            state = belief.observe(state, step)
            assert _posterior(belief, state) == again[place + 1], "a second walk differs"


def check_assistant(assistant: Any, bank: Bank, runs: Iterable[Sequence[int]]) -> None:
    """Hold an assistant to the laws of assistants.

    It keeps the laws of beliefs. Beside a human who does one of the runs, it chooses None or a step
    that the robot can do and that changes something, and it knows what state the task is in.
    Choosing changes no state, and a state gives the same choice whenever, and in whatever walk, it
    is asked for. An assistant with a method ``told`` is told a goal after each of the human's
    actions.

    Args:
        assistant: An object with ``names``, ``start``, ``observe``, ``posterior`` and ``choose``
            (see assistance/assistant.py).
        bank: The bank that it was made from.
        runs: Steps of the human; those that cannot be done when their turn comes are left out.

    Raises:
        AssertionError: if it breaks a law.
    """
    runs = [tuple(run) for run in runs]
    check_belief(assistant, runs)
    seen: list[tuple[Any, int | None]] = []
    for i, run in enumerate(runs):
        goal = i % len(assistant.names)
        walked = _side_by_side(assistant, bank, run, goal)
        state = assistant.start()
        for step, is_robot, choice, posterior in walked:
            if step is not None:
                state = _observe(assistant, state, step, is_robot, goal)
            if not is_robot:
                assert _posterior(assistant, state) == posterior, "a second walk differs"
                assert assistant.choose(state) == choice, "a second walk is answered differently"
                seen.append((state, choice))
    for state, choice in seen:
        assert assistant.choose(state) == choice, "a choice depends on what was asked in between"


_Walked = tuple[int | None, bool, int | None, list[float]]
"""A step, whether the robot did it, and after a human's the choice and the posterior."""


def _side_by_side(assistant: Any, bank: Bank, run: Sequence[int], goal: int) -> list[_Walked]:
    """Let a human do a run and the robot what it chooses, in turns; return all steps."""
    state, world = assistant.start(), bank.initial
    walked: list[_Walked] = []
    for step in (*run, None):
        after = None if step is None else bank.table.successor(world, step)
        if step is not None:
            if after is None:
                continue
            world, state = after, _observe(assistant, state, step, False, goal)
        choice, posterior = _choice(assistant, state, bank, world)
        walked.append((step, False, choice, posterior))
        if choice is not None:
            world = bank.table.successor(world, choice) or world
            state = _observe(assistant, state, choice, True, goal)
            walked.append((choice, True, None, []))
            assert state.world == world, "it does not know what state the task is in"
    return walked


def _choice(assistant: Any, state: Any, bank: Bank, world: int) -> tuple[int | None, list[float]]:
    """Return what an assistant chooses and believes in a state; hold the choice to the laws."""
    assert state.world == world, "it does not know what state the task is in"
    posterior = _posterior(assistant, state)
    choice: int | None = assistant.choose(state)
    assert _posterior(assistant, state) == posterior, "choosing has changed what is believed"
    assert state.world == world, "choosing has changed the state"
    assert assistant.choose(state) == choice, "the same state is answered differently"
    if choice is not None:
        assert 0 <= choice < len(bank.table), f"there is no step {choice}"
        can = bank.table.doer(world, choice, robots(bank.goals.problem))
        assert can is not None, f"the robot cannot do {bank.table[choice]}, or it changes nothing"
    return choice, posterior


def _observe(assistant: Any, state: Any, step: int, is_robot: bool, goal: int) -> Any:
    state = assistant.observe(state, step, robot=is_robot)
    is_told = not is_robot and hasattr(assistant, "told")
    return assistant.told(state, goal) if is_told else state


def _posterior(belief: Any, state: Any) -> list[float]:
    found = [float(p) for p in belief.posterior(state)]
    assert len(found) == len(belief.names), "one probability for each goal"
    assert all(0 <= p <= 1 for p in found), f"not probabilities: {found}"
    assert abs(sum(found) - 1) < 1e-9, f"the posterior sums to {sum(found)}"
    return found
