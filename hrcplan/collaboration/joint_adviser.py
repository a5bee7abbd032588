"""What a robot that weighs goal and agent state does: a step, an interaction, or a question."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import cached_property

import numpy as np

from hrcplan.assistance.joint_help import JointHelp, JointState
from hrcplan.assistance.questions import AskingRecord
from hrcplan.assistance.situation import Advice, PossibleInteraction, Situation, Values
from hrcplan.assistance.step_prices import action_cost
from hrcplan.collaboration import events as shared
from hrcplan.collaboration.agent_fold import AgentBelief, AgentFold
from hrcplan.collaboration.belief_fold import BeliefFold
from hrcplan.collaboration.history import (
    AskedGoal,
    BegunAction,
    History,
    PassedTurn,
    as_failed,
    state_after,
)
from hrcplan.collaboration.robots import JOINT_ROBOTS
from hrcplan.collaboration.setup import TURNS, CollaborationSetup
from hrcplan.execution.action_model import BoundAction
from hrcplan.pddl.model import FluentKey
from hrcplan.pddl.semantics import instances
from hrcplan.plans import PlannedAction

Explain = Callable[[shared.Chosen, JointState, PlannedAction], shared.Chosen]
HARD = 0.5  # the probability of a failure from which on a step is said to be taken over


class JointAdviser:
    """Answers for one robot.

    Args:
        setup: The collaboration.
        fold: The belief about the goal.
        assistant: The robot.
        explain: Adds an action, and the goals that it helps, to a choice.
    """

    def __init__(
        self, setup: CollaborationSetup, fold: BeliefFold, assistant: JointHelp, explain: Explain
    ) -> None:
        self.setup, self.fold, self.assistant, self._explain = setup, fold, assistant, explain
        self.agents = AgentFold(setup.model, setup.profile, self._chance_of_pause)
        robot = JOINT_ROBOTS.get(setup.method)
        self.weighs_agents = robot is None or robot.weighs_agents

    def _chance_of_pause(self, history: History, agent: str) -> float:
        state = self.fold.in_turn_of(self.fold.state(history), agent)
        return self.assistant.chance_of_pause(state, agent)

    def choose(self, ask: shared.AskStep, history: History, chosen: shared.Chosen) -> shared.Chosen:
        """Return what the robot does after a history.

        Args:
            ask: What was asked for.
            history: What was seen.
            chosen: What is believed about the goals.
        """
        agents = self.agents.belief(history) if self.weighs_agents else None
        state = self.fold.state(self._as_it_will_end(history, agents))
        chosen = replace(chosen, none_of_these=round(float(state.none), 4))
        has_turns = self.fold.has_turns
        for doers in [(agent,) for agent in ask.agents] if has_turns else [ask.agents]:
            if self.setup.pace != TURNS:
                state = self.fold.in_turn_of(state, doers[0])
            advice = self.assistant.advise(state, self._situation(history, agents, doers))
            if advice.question is not None:
                names = tuple(self.assistant.names[goal] for goal in advice.question.goals)
                return replace(chosen, asks=names)
            if advice.interaction is not None:
                name, *args = advice.interaction.words
                return replace(chosen, action=name, args=tuple(args))
            action = self._action(state, advice, frozenset(doers))
            if action is not None:
                return self._with_action(chosen, state, action, agents)
        return chosen

    def _as_it_will_end(self, history: History, agents: AgentBelief | None) -> History:
        """Return a history in which what people attempt has failed if that is likelier than not.

        What runs counts as done; a robot that built on an attempt in vain would do so, too.
        """
        risks = {} if agents is None else self.agents.risks(agents)
        if agents is None or not risks:
            return history
        for number, action in agents.running.items():
            if not action.is_robot and self._failure(action.words, risks) >= HARD:
                history = as_failed(history, number)
        return history

    def _failure(self, words: tuple[str, ...], risks: Mapping[FluentKey, float]) -> float:
        return self.assistant.price_model.failure(words, risks)

    def values(self, history: History) -> Values:
        """Return the agent state after a history, as function values that planners get."""
        return self.agents.values(self.agents.belief(history)) if self.weighs_agents else {}

    def _action(
        self, state: JointState, advice: Advice, doers: frozenset[str]
    ) -> PlannedAction | None:
        """Return the ground action by which one of several robots does a step; None to wait."""
        if advice.step is None:
            return None
        table = self.fold.bank.table
        action = table.doer(state.world, advice.step, doers)
        if action is None:
            return None  # another robot has to do it
        ground = table.task.actions[action]
        return PlannedAction(ground.name, ground.args)

    def _with_action(
        self,
        chosen: shared.Chosen,
        state: JointState,
        action: PlannedAction,
        agents: AgentBelief | None,
    ) -> shared.Chosen:
        chosen = self._explain(chosen, state, action)
        if not chosen.claims:
            chosen = replace(chosen, helps=())
        why = "" if agents is None else self._takes_over(action, agents)
        return replace(chosen, takes_over=why)

    def _takes_over(self, action: PlannedAction, agents: AgentBelief) -> str:
        """Return why people should not do the action of a robot; "" if they can do it well."""
        risks = self.agents.risks(agents)
        if not risks:
            return ""
        chances = [
            (self._failure(words, risks), words[0], person)
            for person, words in self._by_people(action)
        ]
        p, name, person = min(chances, default=(0.0, "", ""))
        return f"{name} would fail with {person} ({100 * p:.0f} %)" if p >= HARD else ""

    def _by_people(self, action: PlannedAction) -> Iterator[tuple[str, tuple[str, ...]]]:
        """Yield who else could do an action, with its words."""
        doer = next((arg for arg in action.args if arg in self.setup.robots), None)
        for person in self.setup.people:
            args = tuple(person if arg == doer else arg for arg in action.args)
            if self.setup.model.actions.step(PlannedAction(action.name, args)) is not None:
                yield person, (action.name, *args)

    # What a robot knows besides what was done.

    def _situation(
        self, history: History, agents: AgentBelief | None, doers: tuple[str, ...]
    ) -> Situation:
        answers = [mark.choice for mark in history if isinstance(mark, AskedGoal)]
        n_pauses = self._n_pauses(history)
        asking = AskingRecord(len(answers), sum(map(bool, answers)), n_pauses > 0)
        values = {} if agents is None else self.agents.values(agents)
        interactions = [] if agents is None else self._interactions(history, agents, doers)
        return Situation(values, asking, n_pauses > 1, tuple(interactions))

    def _n_pauses(self, history: History) -> int:
        """Return how often people have done nothing since one of them has acted."""
        n_pauses = 0
        for mark in reversed(history):
            if isinstance(mark, BegunAction) and not mark.is_robot:
                break
            n_pauses += isinstance(mark, PassedTurn) and mark.agent not in self.setup.robots
        return n_pauses

    def _interactions(
        self, history: History, agents: AgentBelief, doers: tuple[str, ...]
    ) -> Iterator[PossibleInteraction]:
        """Yield what robots could do for the state of another agent now."""
        values = self.agents.values(agents)
        if not self._ground_interactions or not values:
            return
        state, running = state_after(history, self.setup.model.actions)
        busy = {
            agent for mark in history
            if isinstance(mark, BegunAction) and mark.number in running
            for agent in (mark.agent, *mark.args)
        }  # fmt: skip
        for step in self._ground_interactions:
            is_free = step.agent in doers and not step.busy & busy
            if is_free and self.setup.model.actions.obstacle(state, step, values) is None:
                yield self._interaction(step, agents, values)

    def _interaction(
        self, step: BoundAction, agents: AgentBelief, values: Values
    ) -> PossibleInteraction:
        args = tuple(step.binding.values())
        words = (step.schema.name, *args)
        begun = BegunAction(-1, step.agent, words[0], args, 0.0, True)
        after = self.agents.values(self.agents.after_interaction(agents, begun))
        success = float(self.setup.problem.domain.success(words[0]))
        n_people = len(step.busy & set(self.setup.people))
        price = action_cost(self.setup.model.agents, words, {}) / self._usual_cost + n_people
        return PossibleInteraction(words, success, after, price)

    @cached_property
    def _ground_interactions(self) -> list[BoundAction]:
        """All interactions of robots."""
        return list(self._all_interactions())

    def _all_interactions(self) -> Iterator[BoundAction]:
        problem, model = self.setup.problem, self.setup.model
        for schema in problem.domain.actions:
            if not model.agents.is_interaction(schema.name):
                continue
            for binding in instances(schema.params, {}, problem):
                args = tuple(binding[param.name] for param in schema.params)
                step = model.actions.step(PlannedAction(schema.name, args))
                if step is not None and step.agent in self.setup.robots:
                    yield step

    @cached_property
    def _usual_cost(self) -> float:
        """What a step costs on average while every agent state is low."""
        actions = self.fold.bank.table.task.actions
        agents = self.setup.model.agents
        costs = [action_cost(agents, (a.name, *a.args), {}) for a in actions]
        return max(1.0, float(np.mean(costs)))
