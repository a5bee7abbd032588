"""Episodes in turns as traces: what was done in which timestep, and what the robot believed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Generic

from hrcplan.bank import Bank
from hrcplan.core.arrays import Floats
from hrcplan.episodes.episode import EpisodeRecord, EpisodeTurn
from hrcplan.episodes.humans import Course
from hrcplan.inference.belief import S
from hrcplan.inference.traces import (
    ALL_HUMANS,
    ActionTrace,
    TraceAction,
    TraceAnswer,
    TracedEpisode,
    world_sha256,
)
from hrcplan.pddl.conventions import people, robots

PosteriorOf = Callable[[S, EpisodeTurn], Floats]
"""Returns what a robot believes in a state, about the human whose turn it was."""
Beliefs = dict[int, tuple[tuple[float, ...], int]]
"""By timestep of each action of a human: the posterior after it, and the changes declared."""


class BeliefLog(Generic[S]):
    """Watches an episode: what the robot believes after each action of a human.

    Args:
        posterior: Returns the belief.
        beliefs: What is believed is added to it; None to note nothing.
    """

    def __init__(self, posterior: PosteriorOf[S], beliefs: Beliefs | None) -> None:
        self._posterior, self._beliefs = posterior, beliefs

    def watch(self, turn: EpisodeTurn, state: S) -> None:
        """Note the belief after a turn."""
        if self._beliefs is not None and turn.guess is not None:
            posterior = tuple(self._posterior(state, turn).tolist())
            self._beliefs[turn.t] = posterior, turn.n_declared


def trace_of_episode(bank: Bank, record: EpisodeRecord, beliefs: Beliefs) -> ActionTrace:
    """Return an episode as a trace.

    Args:
        bank: The plans.
        record: The episode.
        beliefs: What a `BeliefLog` noted.
    """
    problem = bank.goals.problem
    courses = record.courses or {ALL_HUMANS: record.course}
    answers = {who: answer_of(bank, course) for who, course in courses.items()}
    episode = TracedEpisode(bank.names, record.n_turns, answers)
    actions = tuple(_actions(bank, record.turns, beliefs))
    return ActionTrace(problem.domain.name, world_sha256(problem), actions, episode)


def answer_of(bank: Bank, course: Course) -> TraceAnswer:
    """Return what a human wanted, in words."""
    return TraceAnswer(tuple(bank.names[goal] for goal in course.goals), course.turns)


def _actions(bank: Bank, turns: Sequence[EpisodeTurn], beliefs: Beliefs) -> Iterator[TraceAction]:
    task, state = bank.goals.task, bank.initial
    for turn in turns:
        if turn.step is None:
            continue
        agents = agents_of(bank, turn)
        index = bank.table.doer(state, turn.step, agents)
        assert index is not None, f"{bank.table[turn.step]} cannot be done in timestep {turn.t}"
        action, state = task.actions[index], task.successor(state, index)
        agent = action.agent or (next(iter(agents)) if len(agents) == 1 else None)
        posterior, declared = beliefs.get(turn.t, (None, None))
        yield TraceAction(
            float(turn.t), agent, action.name, tuple(action.args), posterior=posterior,
            declared=declared,
        )  # fmt: skip


def agents_of(bank: Bank, turn: EpisodeTurn) -> frozenset[str]:
    """Return the agents who may have acted in a turn: one, where agents take turns."""
    if turn.agent is not None:
        return frozenset({turn.agent})
    if bank.team:
        return frozenset({bank.team[turn.t % len(bank.team)]})
    return people(bank.goals.problem) if turn.is_human else robots(bank.goals.problem)
