"""The agents' states after a history, as far as they were sensed, said, or show in what happened.

Outcomes, pauses and durations are evidence: who fails, stands still with something to do, or takes
twice as long, may find it hard.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from hrcplan.agents import Profile
from hrcplan.agents.estimate import AgentStateEstimate
from hrcplan.agents.profile import Experience
from hrcplan.collaboration.history import (
    BegunAction,
    EndedAction,
    History,
    PassedTurn,
    SensedValues,
)
from hrcplan.core.numbers import Number
from hrcplan.execution import events as ev
from hrcplan.execution.model import ExecutionModel
from hrcplan.pddl.model import FluentKey

CHANGED, HAZARD = 0.05, 0.02  # before anything points to a change
_ALONE = 2  # the length of an element that depends on its agent alone


@dataclass(frozen=True, slots=True)
class AgentBelief:
    """What is believed of the agents: sensed values, and what outcomes say.

    ``waiting`` are those who have done nothing since they did so last.
    """

    sensed: Mapping[FluentKey, Number]
    experience: Experience
    running: Mapping[int, BegunAction] = field(default_factory=dict)
    waiting: frozenset[str] = frozenset()


class AgentFold:
    """Folds histories of one collaboration; remembers what it has folded last.

    Args:
        model: The problem.
        profile: What is learnt from outcomes.
        pause: How likely a person pauses after a history though nothing makes an action hard.
    """

    def __init__(
        self, model: ExecutionModel, profile: Profile,
        pause: Callable[[History, str], float] | None = None,
    ) -> None:  # fmt: skip
        self.model, self.agents, self.profile = model, model.agents, profile
        self._pause = pause
        self.start = AgentBelief({}, self._experience())
        self._history: History = ()
        self._beliefs = [self.start]

    def _experience(self) -> Experience:
        experience = self.profile.begin(self.agents)
        if not isinstance(experience, AgentStateEstimate):
            return experience
        prior = replace(experience.prior, changed=CHANGED, hazard=HAZARD)
        return AgentStateEstimate.begin(prior)

    def belief(self, history: History) -> AgentBelief:
        """Return what is believed after a history."""
        n = 0
        for mark, before in zip(history, self._history, strict=False):
            if mark is not before and mark != before:
                break
            n += 1
        del self._beliefs[n + 1 :]
        self._history = history
        for place in range(n, len(history)):
            self._beliefs.append(self._after(self._beliefs[-1], history, place))
        return self._beliefs[-1]

    def values(self, belief: AgentBelief) -> dict[FluentKey, Number]:
        """Return the function values that planners get; none where all agent states are low."""
        if not belief.sensed and not belief.experience.blame():
            return {}
        return self.profile.planner_values(self.agents, belief.sensed, belief.experience)

    def after_interaction(self, belief: AgentBelief, action: BegunAction) -> AgentBelief:
        """Return what is believed once an interaction has had its effect."""
        if not self.agents.is_interaction(action.action):
            return belief
        step = self.model.actions.step(action.planned)
        assert step is not None
        values = {**self.values(belief), **belief.sensed}
        for key, value in self.model.actions.influence(step, values).items():
            if key in self.agents.low:
                belief = _sensed(belief, key, self.agents.clamp(key, value))
        return belief

    def risks(self, belief: AgentBelief) -> dict[FluentKey, float]:
        """Return how likely each element makes an action fail, where that is noticeable."""
        low, risks = self.agents.low, dict(belief.experience.blame())
        for key, value in belief.sensed.items():
            p = self.agents.failure_probability(key, {key: value}) if key in low else 0.0
            risks[key] = max(p, risks.get(key, 0.0))
        return {key: p for key, p in risks.items() if p > 0}

    def _after(self, belief: AgentBelief, history: History, place: int) -> AgentBelief:
        match history[place]:
            case BegunAction() as mark:
                running = {**belief.running, mark.number: mark}
                return replace(belief, running=running, waiting=belief.waiting - {mark.agent})
            case EndedAction() as mark:
                return self._after_end(belief, mark)
            case SensedValues(values):
                for key, value in values.items():
                    belief = _sensed(belief, key, value)
                return belief
            case PassedTurn(agent):
                return self._after_pause(belief, history[:place], agent)
            case _:
                return belief

    def _after_end(self, belief: AgentBelief, mark: EndedAction) -> AgentBelief:
        running = dict(belief.running)
        action = running.pop(mark.number, None)
        belief = replace(belief, running=running)
        if action is None or mark.outcome not in (ev.DONE, ev.FAILED):
            return belief
        touched = self.agents.touching(action.action, action.args)
        experience = belief.experience
        if isinstance(experience, AgentStateEstimate):
            for _ in range(mark.n_late):
                experience = experience.failed(touched)
        if mark.outcome == ev.FAILED:
            return replace(belief, experience=experience.failed(touched))
        belief = replace(belief, experience=experience.went_well(touched))
        return self.after_interaction(belief, action)

    def _after_pause(self, belief: AgentBelief, before: History, agent: str) -> AgentBelief:
        experience = belief.experience
        is_news = agent not in belief.waiting and agent not in self.agents.robots
        belief = replace(belief, waiting=belief.waiting | {agent})
        if not is_news or self._pause is None or not isinstance(experience, AgentStateEstimate):
            return belief
        touched = [key for key in self.agents.elements(agent) if len(key) == _ALONE]
        usual = self._pause(before, agent)
        return replace(belief, experience=experience.hesitated(touched, usual))


def _sensed(belief: AgentBelief, key: FluentKey, value: Number) -> AgentBelief:
    sensed = {**belief.sensed, key: value}
    return replace(belief, sensed=sensed, experience=belief.experience.sensed(key))
