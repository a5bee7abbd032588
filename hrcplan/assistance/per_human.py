"""A robot that helps several humans who each have a goal of their own.

There is a belief for each human. What one human does is evidence of that human's goal alone; for
the others it changes the world, as a step of the robot does. A step is worth the sum of what it
saves the humans. Where they share a goal, one belief observes them all, which is the product of
what each has shown: that is no matter of this module.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Generic

import numpy as np

from hrcplan.assistance.assistant import AssistantState, KnowsGoal
from hrcplan.assistance.expected_help import ExpectedHelp
from hrcplan.assistance.explanation import TIES, StepChoice
from hrcplan.bank import Bank
from hrcplan.core.arrays import Floats
from hrcplan.inference.belief import (
    Belief,
    S,
    after_attempt,
    after_others_attempt,
    after_wait,
    at_turn,
    n_declared,
)
from hrcplan.inference.run import UNKNOWN_HUMAN

HARM = 0.5  # timesteps that the best step for all may cost one human
CONTENT = 0.5  # the probability from which on a human is taken to have what it wants


class OneHumanHelp(ExpectedHelp):
    """The part of `PerHuman` for one human: its belief, and what steps save it."""

    def inform(self, state: AssistantState[Any], goal: int) -> AssistantState[Any]:
        """Return the state once the human's goal is known; the same if the belief cannot know."""
        if not isinstance(self.belief, KnowsGoal):
            return state
        return replace(state, belief=self.belief.inform(state.belief, goal))

    def need(self, state: AssistantState[Any]) -> float:
        """Return how many timesteps or steps the human's goal is expected to take still."""
        choices = self.step_values.in_turn(state.progress)
        posterior = self.posterior(state)
        if choices is not None:
            return float(posterior @ choices.costs.min(axis=1))
        goals = range(len(posterior))
        rests = [self.step_values.steps_to_go(goal, state.progress) for goal in goals]
        return float(posterior @ np.array(rests))

    def is_content(self, state: AssistantState[Any]) -> bool:
        """Return whether the human probably has what it wants."""
        goals = self.bank.goals
        held = [goals.is_reached(goal, state.world) for goal in range(len(self.bank.names))]
        return float(self.posterior(state)[held].sum()) > CONTENT


@dataclass(frozen=True, slots=True)
class PerHumanState(Generic[S]):
    """The state of `PerHuman`: for each human, in order, a part, and whether it is content.

    A human is content from when it probably has what it wants until it acts again.
    """

    parts: tuple[AssistantState[S], ...]
    content: tuple[bool, ...]
    ignored: str | None = None

    @property
    def world(self) -> int:
        """The state of the task, as bits."""
        return self.parts[0].world

    @property
    def n_declared(self) -> int:
        """How many changes of goal were declared, of all humans."""
        return sum(map(n_declared, self.parts))


class PerHuman(Generic[S]):
    """Helps the humans of a bank, each of whom has a goal of its own.

    It does what saves all humans together most steps. If that would cost one of them much, their
    goals are in conflict: then the human who needs least comes first.

    Args:
        bank: The plans.
        make: Makes the belief about one human, from the bank as this human sees it. It may be an
            assistant; then only its belief is used.
    """

    def __init__(self, bank: Bank, make: Callable[[Bank], Belief[S]]) -> None:
        self.bank, self.humans, self.names = bank, bank.humans, bank.names
        views = map(bank.for_human, self.humans)
        self.helpers = tuple(OneHumanHelp(view, make(view)) for view in views)
        actions = bank.goals.task.actions
        doers = ({actions[i].agent for i in bank.table[s].actions} for s in range(len(bank.table)))
        self._doers = [next(iter(who)) if len(who) == 1 else None for who in doers]

    def start(self) -> PerHumanState[S]:
        """Return the state before anything was done."""
        parts = tuple(helper.start() for helper in self.helpers)
        return PerHumanState(parts, (False,) * len(parts))

    def observe(
        self, state: PerHumanState[S], step: int, *, robot: bool = False
    ) -> PerHumanState[S]:
        """Return the state after one more step; that of an unknown human is no evidence."""
        if robot:
            return self._observe(state, step, None)
        doer = self._doer(state, step)
        after = self._observe(state, step, doer)
        return replace(after, ignored=after.ignored or (None if doer else UNKNOWN_HUMAN))

    def observe_by(self, state: PerHumanState[S], step: int, agent: str) -> PerHumanState[S]:
        """Return the state after one more step, done by an agent."""
        return self._observe(state, step, agent)

    def _observe(self, state: PerHumanState[S], step: int, agent: str | None) -> PerHumanState[S]:
        parts = tuple(
            helper.observe(part, step, robot=human != agent)
            for human, helper, part in zip(self.humans, self.helpers, state.parts, strict=True)
        )
        acts = [human == agent for human in self.humans]
        content = tuple(
            (was and not is_acting) or helper.is_content(part)
            for was, is_acting, helper, part in zip(
                state.content, acts, self.helpers, parts, strict=True
            )
        )
        place = acts.index(True) if any(acts) else 0
        return PerHumanState(parts, content, parts[place].ignored)

    def _doer(self, state: PerHumanState[S], step: int) -> str | None:
        """Return the human who does a step; None if that is not known."""
        moment = state.parts[0].progress.moment
        if len(self.humans) == 1:
            return self.humans[0]
        agent = self._doers[step]
        return self.bank.team[moment.turn] if agent is None and moment is not None else agent

    def observe_wait(self, state: PerHumanState[S]) -> PerHumanState[S]:
        """Return the state after a wait of the agent whose turn it is, where agents take turns."""
        pairs = zip(self.helpers, state.parts, strict=True)
        return replace(state, parts=tuple(after_wait(helper, part) for helper, part in pairs))

    def observe_attempt(self, state: PerHumanState[S], step: int) -> PerHumanState[S]:
        """Return the state after a step that a human tried to do: evidence, but no progress."""
        doer = self._doer(state, step)
        parts = tuple(
            (after_attempt if human == doer else after_others_attempt)(helper, part, step)
            for human, helper, part in zip(self.humans, self.helpers, state.parts, strict=True)
        )
        return replace(state, parts=parts)

    def at_turn(self, state: PerHumanState[S], agent: str) -> PerHumanState[S]:
        """Return the state as it is if it is an agent's turn, where agents take turns."""
        pairs = zip(self.helpers, state.parts, strict=True)
        return replace(state, parts=tuple(at_turn(helper, part, agent) for helper, part in pairs))

    def inform_by(self, state: PerHumanState[S], goal: int, human: str) -> PerHumanState[S]:
        """Return the state once one human's goal is known."""
        parts, place = list(state.parts), self.humans.index(human)
        parts[place] = self.helpers[place].inform(parts[place], goal)
        return replace(state, parts=tuple(parts))

    def posterior(self, state: PerHumanState[S]) -> Floats:
        """Return how probable each goal is as that of a human, the mean over the humans."""
        by_human = [self.posterior_of(state, human) for human in self.humans]
        mean: Floats = np.mean(by_human, axis=0)
        return mean

    def posterior_of(self, state: PerHumanState[S], human: str) -> Floats:
        """Return the probability of each goal as that of one human."""
        place = self.humans.index(human)
        return self.helpers[place].posterior(state.parts[place])

    def n_declared_of(self, state: PerHumanState[S], human: str) -> int:
        """Return how many changes of one human's goal were declared."""
        return n_declared(state.parts[self.humans.index(human)])

    def options(self, state: PerHumanState[S]) -> StepChoice:
        """Return the steps that the robot could do now, and what each is worth."""
        active = [i for i, content in enumerate(state.content) if not content]
        if len(self.humans) == 1 or not active:
            active = list(range(len(self.humans)))
        if self.helpers[0].team_help is None:
            return self._by_steps(state, active)
        return self._by_turns(state, active)

    def choose(self, state: PerHumanState[S]) -> int | None:
        """Return the step that the robot should do now, or None to wait."""
        return self.options(state).best

    def _by_steps(self, state: PerHumanState[S], active: Sequence[int]) -> StepChoice:
        """Return what steps are worth; a step is wasted if no goal of any human has it next."""
        helper, progress = self.helpers[0], state.parts[0].progress
        next_steps = helper.step_values.next_steps(progress)
        steps = helper.step_values.candidates(progress, next_steps)
        savings, unneeded = np.zeros(len(steps)), np.ones(len(steps))
        for place in active:
            posterior = self.helpers[place].posterior(state.parts[place])
            saving, need = helper.step_values.expected_saving(
                progress, next_steps, steps, posterior
            )
            savings, unneeded = savings + saving, unneeded * (1 - need)
        worth = savings - helper.waste_price * unneeded
        return StepChoice(tuple(steps), tuple(worth.tolist()))

    def _by_turns(self, state: PerHumanState[S], active: Sequence[int]) -> StepChoice:
        """Return what steps are worth in timesteps, to all humans or the one who comes first."""
        choices = [self.helpers[place].options(state.parts[place]) for place in active]
        steps, worth = choices[0].steps, np.array([choice.values for choice in choices])
        if not steps or len(active) == 1:
            return choices[0]
        total = worth.sum(axis=0)
        best = int(total.round(TIES).argmax())
        is_harmless = (worth[:, best] > -HARM).all()
        least = min(choice.wait for choice in choices)
        if not (total[best] > least and is_harmless):
            needs = [self.helpers[place].need(state.parts[place]) for place in active]
            for place in sorted(range(len(active)), key=needs.__getitem__):
                if choices[place].best is not None:
                    return choices[place]
        return StepChoice(steps, tuple(total.tolist()), least)
