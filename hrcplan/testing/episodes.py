"""Laws of the humans and worlds of turn-taking episodes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from hrcplan.bank import Bank
from hrcplan.episodes.episode import TurnWorld
from hrcplan.episodes.humans import Course, EpisodeHuman, HumanMove
from hrcplan.pddl.conventions import people, robots

WAITS = 3  # turns in a row without a step that end a walk


def check_human(
    make: Callable[[Bank, Course], EpisodeHuman], bank: Bank, courses: Iterable[Course]
) -> None:
    """Test the laws of humans who take turns with a robot.

    A move is None or a step that a human can do in the state, and that changes it; a wait is no
    mistake. The course decides about chance: two humans of one course move alike, and so does one
    that is asked again, in any order.

    Args:
        make: The class of the human, made from a bank and a course.
        bank: The plans.
        courses: What the humans want.

    Raises:
        AssertionError: if a law is broken.
    """
    for course in courses:
        human, twin = make(bank, course), make(bank, course)
        assert isinstance(human, EpisodeHuman), f"{type(human).__name__} has no move()"
        walk = _walk(human, bank, course)
        for turn, world, last, move in reversed(walk):
            assert human.move(turn, world, last) == move, "the same turn is answered differently"
            assert twin.move(turn, world, last) == move, "two humans of one course differ"


def _walk(
    human: EpisodeHuman, bank: Bank, course: Course
) -> list[tuple[int, int, int | None, HumanMove]]:
    """Return the turns of a human with a robot that helps in every other turn."""
    humans, helpers = people(bank.goals.problem), robots(bank.goals.problem)
    world, last, n_waits = bank.initial, None, 0
    walk: list[tuple[int, int, int | None, HumanMove]] = []
    most = 2 * sum(bank.graphs[goal].n_steps for goal in course.goals) + len(course.goals)
    for turn in range(most):
        move = human.move(turn, world, last)
        walk.append((turn, world, last, move))
        _check_move(move, bank, world, humans)
        n_waits = n_waits + 1 if move.step is None else 0
        if n_waits > WAITS and turn > max(course.turns, default=0):
            break
        if move.step is not None:
            last, world = move.step, bank.table.successor(world, move.step) or world
        graph, node = bank.locate(course.goal(turn), world)
        steps = () if node is None else graph.next(node)
        help_step = next(iter(bank.table.able(world, steps, helpers)), None)
        if turn % 2 and help_step is not None:
            world = bank.table.successor(world, help_step) or world
    return walk


def _check_move(move: HumanMove, bank: Bank, world: int, humans: frozenset[str]) -> None:
    assert isinstance(move, HumanMove), f"move() returns a HumanMove, not {move!r}"
    if move.step is None:
        assert not move.is_mistake, "a wait is no mistake"
        return
    assert 0 <= move.step < len(bank.table), f"there is no step {move.step}"
    actor = bank.table.doer(world, move.step, humans)
    assert actor is not None, f"no human can do {bank.table[move.step]}, or it changes nothing"


def check_world(
    world: TurnWorld, bank: Bank, runs: Iterable[Sequence[int]], *, is_exact: bool = True
) -> None:
    """Test the laws of worlds of turn-taking episodes.

    ``begin`` returns the initial state, also after an episode. ``do`` returns the state of the task
    after an action, as the domain says (``is_exact``), or at least a state of the task.

    Args:
        world: The world.
        bank: The bank it was made from.
        runs: Steps to do, one after the other; those that are not applicable are left out.
        is_exact: Whether every action has the effects that the domain says.

    Raises:
        AssertionError: if a law is broken.
    """
    assert isinstance(world, TurnWorld), f"{type(world).__name__} has no begin() and do()"
    task = bank.goals.task
    everybody = frozenset(bank.goals.problem.agents)
    for run in runs:
        state = world.begin()
        assert state == task.initial, "an episode does not begin in the initial state"
        for step in run:
            action = bank.table.doer(state, step, everybody)
            if action is None:
                continue
            expected, state = task.successor(state, action), world.do(state, action)
            assert isinstance(state, int), f"do() returns the state as bits, not {state!r}"
            assert 0 <= state < 1 << len(task.facts), "there are facts that the task has not"
            if is_exact:
                assert state == expected, f"{bank.table[step]} has another effect than it says"
    assert world.begin() == task.initial, "begin() does not forget the last episode"
