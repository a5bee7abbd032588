"""Policies and assistants: an assistant as a policy, and a learned policy as an assistant."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from hrcplan.assistance import ASSISTANTS, BeliefAssistant, StepChoice
from hrcplan.assistance.assistant import AssistantState
from hrcplan.assistance.per_human import PerHuman
from hrcplan.bank import Bank
from hrcplan.environments.encoding import ActionEncoding, Bits, RobotObservations
from hrcplan.episodes.observers import PerHumanObserver, TurnObserver
from hrcplan.episodes.turns import turns_of
from hrcplan.inference.registry import METHODS

if TYPE_CHECKING:
    from hrcplan.environments.collaboration import CollaborationEnv

DEFAULT_BELIEF = "switching"


class AssistantPolicy:
    """A robot of hrcplan that acts in an environment: to compare with what was learned.

    It does not learn the humans' goal, unless it is an ``oracle``.

    Args:
        env: The environment; wrappers around it do not matter.
        assistant: A robot by name or as ``module:Class``: see ``hrcplan.assistants``.
    """

    def __init__(self, env: CollaborationEnv, assistant: str = "hrcplan") -> None:
        base: CollaborationEnv = env.unwrapped  # type: ignore[assignment]
        self._env, self._rollout = base, base.rollout
        bank = self._rollout.bank
        if self._rollout.own_turns is None:
            self._robot: Any = ASSISTANTS.make(assistant, bank)
            self._observer = TurnObserver[Any](self._robot, self._rollout.turns)
        else:
            self._robot = PerHuman(bank, lambda view: ASSISTANTS.make(assistant, view))
            self._observer = PerHumanObserver(self._robot)
        self._moves, self._n_observed = self._rollout.moves, 0
        self._state = self._robot.start()

    def act(self) -> int:
        """Return the action of the robot whose turn it is."""
        rollout, moves = self._rollout, self._rollout.moves
        if moves is not self._moves:  # another episode
            self._moves, self._n_observed = moves, 0
            self._state = self._robot.start()
        for mover, step, goal in moves[self._n_observed :]:
            self._state = self._observer.after(self._state, mover, step)
            if mover.is_human:
                self._state = self._observer.inform(self._state, mover, goal)
        self._n_observed = len(moves)
        choice = self._robot.choose(self._state)
        able = self._env.actions.able(rollout.turns.state, rollout.turns.mover.agents)
        action = self._env.actions.action(choice)
        return action if able >> action & 1 else 0  # it is a step of another robot


class PolicyAssistant(BeliefAssistant[Any]):
    """A base for robots of studies that act by a learned policy; only ``act`` is left to write.

    It observes what a robot observes in `CollaborationEnv`. What it guesses about goals, which
    studies measure, is a belief of hrcplan.

    Attributes:
        belief_name: The belief.
        observes_belief: Whether its probabilities are in the observations, as in an environment
            with this ``belief``.
    """

    belief_name = DEFAULT_BELIEF
    observes_belief = False

    def __init__(self, bank: Bank) -> None:
        super().__init__(bank, METHODS.make(self.belief_name, bank))
        self._robots = [mover for mover in turns_of(bank).order if not mover.is_human]
        agents = frozenset[str]().union(*(robot.agents for robot in self._robots))
        n_probabilities = len(bank.names) if self.observes_belief else 0
        self.actions = ActionEncoding(bank, agents)
        self.observations = RobotObservations(bank, self._robots, n_probabilities)

    @abstractmethod
    def act(self, observation: NDArray[Any], action_mask: Bits) -> int:
        """Return the action for an observation."""

    def options(self, state: AssistantState[Any]) -> StepChoice:
        """Return the step of the action alone; none if that waits or cannot be done."""
        mover = self._robots[0]
        if self.tracker.moves is not None:
            name = self.bank.team[self.step_values.next_robot(state.progress).turn]
            mover = next(robot for robot in self._robots if robot.name == name)
        probabilities = self.posterior(state) if self.observes_belief else ()
        observation = self.observations.encode(state.world, mover, probabilities)
        mask = self.actions.mask(state.world, mover.agents)
        action = self.actions.valid(self.act(observation, mask))
        step = self.actions.step(action) if mask[action] else None
        return StepChoice() if step is None else StepChoice((step,), (1.0,))
