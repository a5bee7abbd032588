"""The adviser answers what the companion asks: which step, which plan, what words mean."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from itertools import takewhile
from typing import Any

import numpy as np

from hrcplan.assistance.assistant import Assistant, BankAssistant, Explains
from hrcplan.assistance.explanation import Explanation
from hrcplan.assistance.joint_help import JointHelp, JointState
from hrcplan.assistance.step_values import NextSteps
from hrcplan.bank import Bank
from hrcplan.bank.composed_goals import GoalComposer, with_composed
from hrcplan.collaboration import events as shared
from hrcplan.collaboration.belief_fold import BeliefFold
from hrcplan.collaboration.events import SharedCommand, SharedEvent
from hrcplan.collaboration.history import (
    BegunAction,
    ComposedGoals,
    EndedAction,
    History,
    PassedTurn,
    actions_in,
    composed_in,
)
from hrcplan.collaboration.joint_adviser import JointAdviser
from hrcplan.collaboration.reading import ActionWords, Reader, named_agent, read_exactly, reader_of
from hrcplan.collaboration.robots import JOINT_ROBOTS, assistant_maker
from hrcplan.collaboration.run import CompanionRun
from hrcplan.collaboration.setup import TURNS, CollaborationSetup
from hrcplan.errors import UsageError
from hrcplan.execution import events as ev
from hrcplan.execution.driver import PlanProvider
from hrcplan.execution.replanner import Replanner
from hrcplan.inference.belief import BeliefState, HasProgress, n_declared
from hrcplan.pddl.model import fact_text
from hrcplan.pddl.semantics import LiftedState
from hrcplan.plans import PlannedAction

N_HELPED = 3  # goals that are named as reasons for a step
MOST_COMPOSED, MOST_AT_ONCE = 20, 6  # goals that are composed in all, and for the same reason
N_BETWEEN = 6  # actions and waits before goals are composed for another reason


class Adviser:
    """Answers the questions of one collaboration.

    The assistant is made when it is needed first: people can begin before it is ready.

    Args:
        setup: The collaboration.
        bank: The plans of its goals.
        make_assistant: Makes the assistant from the bank.
        planner: Answers requests for plans; by default the built-in planners.
        reader: Finds the action that a person means; by default in free text.
    """

    def __init__(
        self, setup: CollaborationSetup, bank: Bank,
        make_assistant: Callable[[Bank], Assistant[Any]], planner: PlanProvider | None = None,
        reader: Reader | None = None,
    ) -> None:  # fmt: skip
        self.setup, self.listed = setup, bank
        self._make, self._planner, self._reader = make_assistant, planner, reader
        self.run: CompanionRun | None = None
        self._banks: dict[tuple[str, ...], Bank] = {(): bank}
        self._folds: dict[tuple[str, ...], BeliefFold] = {}
        self._without_plan: set[str] = set()
        self._joint: tuple[BeliefFold, JointAdviser] | None = None

    @cached_property
    def planner(self) -> PlanProvider:
        """What answers requests for plans."""
        return self._planner or Replanner(self.setup.model)

    @cached_property
    def reader(self) -> Reader:
        """What finds the action that a person means."""
        return self._reader or reader_of(self.listed.goals.problem)

    @property
    def fold(self) -> BeliefFold:
        """The belief of the assistant, with the goals that were composed so far."""
        return self._fold_with(composed_in(self.history))

    @property
    def bank(self) -> Bank:
        """The plans of the goals that are listed, and of those that were composed so far."""
        names = composed_in(self.history)
        return self._fold_with(names).bank if names else self.listed

    def _fold_with(self, composed: tuple[str, ...]) -> BeliefFold:
        fold = self._folds.get(composed)
        if fold is None:
            bank = self._bank_with(composed)
            make = assistant_maker(self.setup.method) if composed else self._make
            fold = self._folds[composed] = BeliefFold(bank, make(bank), self.setup.model.actions)
        return fold

    def _bank_with(self, composed: tuple[str, ...]) -> Bank:
        bank = self._banks.get(composed)
        if bank is None:
            bank = self._banks[composed] = with_composed(self.listed, composed)
        return bank

    @cached_property
    def _composer(self) -> GoalComposer:
        return GoalComposer(self.listed)

    @property
    def is_ready(self) -> bool:
        """Whether the assistant has been made."""
        return bool(self._folds)

    @property
    def assistant(self) -> Assistant[Any]:
        """The assistant."""
        return self.fold.assistant

    def watch(
        self, run: CompanionRun, event: SharedEvent, commands: tuple[SharedCommand, ...]
    ) -> None:
        """Take note of the run that the next question is about."""
        self.run = run

    def answer(
        self, ask: ev.AskPlan | shared.AskStep | shared.AskReading
    ) -> ev.Planned | shared.Chosen | shared.Read:
        """Return the event that answers a question."""
        match ask:
            case ev.AskPlan():
                return self.planner.answer(ask)
            case shared.AskStep():
                return self.choose(ask, self.history)
            case shared.AskReading():
                return self.read(ask)

    @property
    def joint(self) -> JointAdviser:
        """What answers for a robot that weighs goal and agent state."""
        return self._joint_with(self.fold)

    def _joint_with(self, fold: BeliefFold) -> JointAdviser:
        if self._joint is None or self._joint[0] is not fold:
            assert isinstance(fold.assistant, JointHelp)
            self._joint = (
                fold,
                JointAdviser(self.setup, fold, fold.assistant, partial(self._explained, fold)),
            )
        return self._joint[1]

    @property
    def history(self) -> History:
        """What was seen so far."""
        return () if self.run is None else self.run.history

    def choose(self, ask: shared.AskStep, history: History) -> shared.Chosen:
        """Return what the assistant does after a history, and what it believes.

        Raises:
            UsageError: if it chooses what is no step, or what none of these robots can do.
        """
        names = composed_in(history)
        new = self._composed_now(history, names)
        fold = self._fold_with(names + new)
        state = fold.state(history)
        goals = _likeliest(fold, state)
        chosen = shared.Chosen(ask.t, goals=goals, n_declared=n_declared(state), composed=new)
        if isinstance(fold.assistant, JointHelp):
            return self._joint_with(fold).choose(ask, history, chosen)
        # Where plans say who acts, each robot is asked in its own turn.
        for agents in [(agent,) for agent in ask.agents] if self.fold.has_turns else [ask.agents]:
            if self.setup.pace != TURNS:
                state = self.fold.in_turn_of(state, agents[0])
            action = self._action(state, frozenset(agents))
            if action is not None:
                return self._explained(fold, chosen, state, action)
        return chosen

    def _composed_now(self, history: History, names: tuple[str, ...]) -> tuple[str, ...]:
        """Return the goals that are composed after a history, if people seem to have no listed one.

        Args:
            history: What was seen.
            names: The goals that were composed before.
        """
        if not self._may_compose(history, names):
            return ()
        most = min(MOST_AT_ONCE - len(names) % MOST_AT_ONCE, MOST_COMPOSED - len(names))
        moves = list(_moves_of_people(history, self.listed))
        left_out = {*names, *self._without_plan}
        new = self._composer.compose(moves, min(most, self._composer.n_at_once), left_out)
        if not new:
            return ()
        larger = with_composed(self._bank_with(names), new)
        all_names = larger.names[len(self.listed.names) :]
        self._without_plan.update(set(new).difference(all_names))
        # Of the tables of a large team no more than two are held.
        self._banks = {(): self.listed, names: self._bank_with(names), all_names: larger}
        self._folds = {names: self._fold_with(names)}
        return all_names[len(names) :]

    def _may_compose(self, history: History, names: tuple[str, ...]) -> bool:
        """Return whether goals are composed now: a few after one step, the rest after the next."""
        robot = JOINT_ROBOTS.get(self.setup.method)
        if robot is None or robot.knows_goal or not robot.weighs_goal:
            return False
        since = tuple(takewhile(lambda mark: not isinstance(mark, ComposedGoals), history[::-1]))
        n_since = sum(isinstance(mark, BegunAction | PassedTurn) for mark in since)
        if len(names) >= MOST_COMPOSED or (names and not n_since):
            return False
        if len(names) % MOST_AT_ONCE:
            return True
        state = self._fold_with(names).state(history)
        is_none = isinstance(state, JointState) and state.none > shared.HALF
        return is_none and (not names or n_since >= N_BETWEEN)

    def likeliest(self, state: BeliefState) -> tuple[tuple[str, float], ...]:
        """Return every goal with its probability, the likeliest first."""
        return _likeliest(self.fold, state)

    def _action(self, state: BeliefState, agents: frozenset[str]) -> PlannedAction | None:
        """Return the ground action that the assistant wants one of the robots to do now."""
        step = self.assistant.choose(state)
        if step is None:
            return None
        table = self.bank.table
        if not isinstance(step, int | np.integer) or not 0 <= step < len(table):
            raise UsageError(f"{step!r} is no step", code="bad-step")
        others = self.setup.robots - agents
        action = table.doer(state.world, int(step), agents)
        if action is None:
            if table.doer(state.world, int(step), others) is not None:
                return None  # another robot has to do it
            who = " or ".join(sorted(agents))
            message = f"{table[int(step)]} cannot be done by {who} here"
            raise UsageError(message, code="bad-step")
        ground = table.task.actions[action]
        return PlannedAction(ground.name, ground.args)

    def _explained(
        self, fold: BeliefFold, chosen: shared.Chosen, state: BeliefState, action: PlannedAction
    ) -> shared.Chosen:
        """Return a choice with its action, and the likeliest goals that it helps."""
        step = fold.bank.table.find((action.name, *action.args))
        following = _following(fold, state)
        helps: tuple[str, ...] = ()
        if following is not None:
            goals = following.goals[following.steps == step].tolist()
            names = {fold.bank.names[goal] for goal in goals}
            helps = tuple(name for name, _ in chosen.goals if name in names)[:N_HELPED]
        return replace(chosen, action=action.name, args=action.args, helps=helps)

    def explain(self, state: BeliefState) -> Explanation | None:
        """Return what the assistant weighs in a state; None if it does not say."""
        if isinstance(self.assistant, JointHelp) and isinstance(state, JointState):
            return self.assistant.explain_at(state, self.joint.values(self.history))
        return self.assistant.explain(state) if isinstance(self.assistant, Explains) else None

    # What people can do, and what they mean.

    def possible(self, agents: Sequence[str]) -> list[ActionWords]:
        """Return the ground actions that people can begin now, in order."""
        state = self._state_for(agents)
        return [
            words
            for words in self._actions(agents)
            if not self._obstacles(words, state) and self._changes(words, state)
        ]

    def _changes(self, words: ActionWords, state: LiftedState) -> bool:
        """Return whether an action that can begin leaves another state."""
        model = self.setup.model.actions
        step = model.step(PlannedAction(words[0], words[1:]))
        assert step is not None
        after = model.finish(model.begin(state, step)[0], step)
        return frozenset(after.facts) != frozenset(state.facts) or after.values != state.values

    def _state_for(self, agents: Sequence[str]) -> LiftedState:
        """Return the state in which people begin: what a plan asks of them has not begun."""
        model = self.setup.model.actions
        if self.run is None:
            return model.initial()
        state = self.run.run.state
        for action in self.run.running:
            if action.index is not None and action.step.agent in agents:
                state = model.revert(state, action.start_effects)
        return state

    def _actions(self, agents: Sequence[str]) -> Iterator[ActionWords]:
        """Yield the ground actions of agents."""
        table = self.bank.table
        for step in range(len(table)):
            for action in (table.task.actions[i] for i in table[step].actions):
                if action.agent is None or action.agent in agents:
                    yield action.name, *action.args

    def _obstacles(self, words: ActionWords, state: LiftedState) -> Sequence[str]:
        """Return what keeps an action from beginning in a state."""
        model = self.setup.model.actions
        step = model.step(PlannedAction(words[0], words[1:]))
        return ["an action of the domain"] if step is None else list(model.obstacles(state, step))

    def read(self, ask: shared.AskReading) -> shared.Read:
        """Return what a person means; of an action that cannot begin, what it needs."""
        other = named_agent(ask.text, self.setup.problem)
        if other is not None and other not in ask.agents:
            note = f"these words name {other}; they are read for {' or '.join(ask.agents)}"
            return shared.Read(ask.t, shared.NONE, (), note)
        steps = self.possible(ask.agents)
        reading = self.reader(ask.text, steps, self.prior(steps))
        options = tuple(map(fact_text, reading.options))
        if reading.outcome != shared.ACT and (note := self._why_not(ask, steps, reading.options)):
            return shared.Read(ask.t, shared.NONE, (), note)
        return shared.Read(ask.t, reading.outcome, options, "")

    def _why_not(
        self, ask: shared.AskReading, steps: Sequence[ActionWords], options: Sequence[ActionWords]
    ) -> str:
        """Return what an action needs that the words say better than any of the ``options``.

        Where the words leave objects open, the action is the one that lacks the fewest conditions.
        The ``steps`` are possible, so they need nothing.
        """
        actions = list(self._actions(ask.agents))
        named = read_exactly(ask.text, actions, {}).options
        if not named:
            named = self.reader(ask.text, actions, {}).options
        if not named or set(named) & set(options):
            return ""
        objects = frozenset(named[0]).intersection(*named)
        state = self._state_for(ask.agents)
        obstacles = {
            words: self._obstacles(words, state)
            for words in actions
            if words[0] == named[0][0] and objects <= set(words) and words not in steps
        }
        if not obstacles:
            return ""
        words = min(obstacles, key=lambda words: len(obstacles[words]))
        needs = f"needs {obstacles[words][0]}" if obstacles[words] else "changes nothing now"
        return f"{fact_text(words)} {needs}"

    def prior(self, steps: Sequence[ActionWords]) -> Mapping[ActionWords, float]:
        """Return how probable each of several next actions of a person is, as the belief says.

        The plans' next steps of a goal are equally likely; what no goal has next is left out.
        """
        if self.setup.has_one_goal:
            return {}
        state = self.fold.state(self.history)
        following = _following(self.fold, state)
        if following is None or not len(following.steps):
            return {}
        posterior = self.assistant.posterior(state)
        n_next = np.maximum(1, np.bincount(following.goals, minlength=len(posterior)))
        chances = np.bincount(
            following.steps, (posterior / n_next).take(following.goals), len(self.bank.table)
        )
        by_step = ((words, self.bank.table.find(words)) for words in steps)
        return {w: float(chances[s]) for w, s in by_step if s is not None and chances[s] > 0}


def _moves_of_people(history: History, bank: Bank) -> Iterator[tuple[int, int]]:
    """Yield the states before and after each step of people, as bits; what runs is done."""
    failed = {m.number for m in history if isinstance(m, EndedAction) and m.outcome != ev.DONE}
    world = bank.initial
    for action in actions_in(history):
        step = bank.table.find(action.words)
        after = None if step is None else bank.table.successor(world, step)
        if after is None or action.number in failed:
            continue
        if not action.is_robot:
            yield world, after
        world = after


def _likeliest(fold: BeliefFold, state: BeliefState) -> tuple[tuple[str, float], ...]:
    posterior = fold.assistant.posterior(state)
    order = np.argsort(-np.asarray(posterior), kind="stable").tolist()
    return tuple((fold.bank.names[goal], float(posterior[goal])) for goal in order)


def _following(fold: BeliefFold, state: BeliefState) -> NextSteps | None:
    """Return what each goal has next; None if the assistant does not follow plan graphs."""
    if isinstance(fold.assistant, BankAssistant) and isinstance(state, HasProgress):
        return fold.assistant.step_values.next_steps(state.progress)
    return None
