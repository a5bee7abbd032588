"""An assistant's belief after a history: a fold, which remembers what it has folded last."""

from __future__ import annotations

from typing import Any

from hrcplan.assistance.assistant import Assistant, inform
from hrcplan.assistance.joint_help import JointHelp, JointState
from hrcplan.bank import Bank
from hrcplan.bank.turn_moves import team_moves
from hrcplan.collaboration.events import OTHER
from hrcplan.collaboration.history import (
    AskedGoal,
    DeniedGoals,
    History,
    SeenAction,
    SeenEnd,
    SeenFacts,
    SeenMark,
    SeenWait,
    WantedGoal,
    evidence_in,
)
from hrcplan.execution.action_model import ActionModel
from hrcplan.inference.belief import (
    IMPOSSIBLE,
    BeliefState,
    ObservesWaits,
    after_attempt,
    after_wait,
    at_turn,
    in_world,
)
from hrcplan.pddl.conventions import robots

_Folded = tuple[Any, frozenset[int]]
"""A state, and the numbers of actions that were impossible in it when they began."""


class BeliefFold:
    """Folds histories of one collaboration.

    Args:
        bank: The plans.
        assistant: Made from it.
        model: How actions end; without it, states that are observed change nothing.
    """

    def __init__(
        self, bank: Bank, assistant: Assistant[Any], model: ActionModel | None = None
    ) -> None:
        self.bank, self.assistant, self._model = bank, assistant, model
        self.has_turns = team_moves(bank) is not None
        self._robots = robots(bank.goals.problem)
        self._seen: tuple[SeenMark, ...] = ()
        self._states: list[_Folded] = [(assistant.start(), frozenset())]
        self._last: tuple[History, Any] = (), self._states[0][0]

    def state(self, history: History) -> Any:
        """Return the assistant's state after a history."""
        if history is not self._last[0]:
            self._last = history, self._state(history)
        return self._last[1]

    def _state(self, history: History) -> Any:
        seen = evidence_in(history, self._model)
        n = 0
        while n < min(len(seen), len(self._seen)) and seen[n] == self._seen[n]:
            n += 1
        if n < len(seen):  # of a history that is only shorter nothing is forgotten
            del self._states[n + 1 :]
            self._seen = seen
        for mark in seen[n:]:
            self._states.append(self._after(*self._states[-1], mark))
        return self._states[len(seen)][0]

    def in_turn_of(self, state: BeliefState, agent: str) -> Any:
        """Return a state in which it is an agent's turn, where plans are team plans."""
        return at_turn(self.assistant, state, agent) if self.has_turns else state

    def _after(self, state: BeliefState, impossible: frozenset[int], mark: SeenMark) -> _Folded:
        match mark:
            case SeenAction():
                return self._after_action(state, impossible, mark)
            case SeenEnd(number):
                return self._after_end(state, impossible, number)
            case SeenFacts(facts):
                world = self.bank.goals.task.state_of(facts)
                return in_world(self.assistant, state, world), impossible
            case SeenWait(agent, goes_on):
                return self._after_wait(state, agent, goes_on), impossible
            case AskedGoal(options, choice):
                return self._after_answer(state, options, choice), impossible
            case DeniedGoals(options):
                return self._after_answer(state, options, OTHER), impossible
            case WantedGoal(goal):
                return inform(self.assistant, state, self.bank.goal_index(goal)), impossible

    def _after_action(
        self, state: BeliefState, impossible: frozenset[int], mark: SeenAction
    ) -> _Folded:
        step = self.bank.table.find(mark.words)
        if step is None:  # no plan of any goal could have it
            return state, impossible
        if not mark.happens:
            return after_attempt(self.assistant, state, step), impossible
        after = self.assistant.observe(state, step, robot=mark.is_robot)
        if after.ignored == IMPOSSIBLE:
            return state, impossible | {mark.number}
        return after, impossible

    def _after_end(self, state: BeliefState, impossible: frozenset[int], number: int) -> _Folded:
        if number not in impossible:
            return state, impossible
        seen = (m for m in self._seen if isinstance(m, SeenAction) and m.number == number)
        action = next(seen)
        step = self.bank.table.find(action.words)
        assert step is not None
        after = self.assistant.observe(state, step, robot=action.is_robot)
        return after, impossible - {number}

    def _after_answer(self, state: BeliefState, options: tuple[str, ...], choice: str) -> Any:
        if not choice or not isinstance(self.assistant, JointHelp):
            return state
        assert isinstance(state, JointState)
        goals = tuple(map(self.bank.goal_index, options))
        answer = self.bank.goal_index(choice) if choice in options else None
        return self.assistant.observe_answer(state, goals, answer)

    def _after_wait(self, state: BeliefState, agent: str, goes_on: bool) -> Any:
        if isinstance(self.assistant, JointHelp) and agent not in self._robots:
            state = self.in_turn_of(state, agent)
            assert isinstance(state, JointState)
            return self.assistant.observe_pause(state, is_evidence=not goes_on)
        if not self.has_turns:
            return state  # a wait says nothing where it is not known whose turn it is
        if not isinstance(self.assistant, ObservesWaits):
            return state
        return after_wait(self.assistant, self.in_turn_of(state, agent))
