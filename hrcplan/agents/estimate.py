"""The agent state inferred from outcomes alone: a Bayesian filter over causes and levels.

Nothing is sensed. At some time at most one element of an agent's state may have changed to a level
L, and an action that it touches then fails with probability L / 10: either once and for all (who
fails at it fails every time, who does not never does), or drawn again at every attempt. Each
observed outcome updates what is believed of all that; besides, any action can slip.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

from hrcplan.agents.state import AgentModel
from hrcplan.core.numbers import Number
from hrcplan.pddl.model import FluentKey

LEVELS = tuple(range(1, 11))
NOTICEABLE = 0.02
_LASTING, _ANEW = "lasting", "anew"
Cause = tuple[FluentKey, int, str, bool]
"""Element, level, whether it is lasting or per attempt, and if lasting, whether it strikes."""


@dataclass(frozen=True)
class Prior:
    """How agent states change, as far as that is known before anything is observed.

    ``changed``: that some element has changed at the start; ``hazard``: that one does so just
    before an observed action. Then any function is as likely as any other, and so is any of its
    elements, and any of ``levels``. ``lasting``: that an outcome holds for all attempts. ``slip``:
    that an action fails for no such reason. ``lows`` are the elements that can change, with the
    values up to which nothing fails.
    """

    lows: Mapping[FluentKey, Number]
    changed: float = 0.5
    hazard: float = 0.05
    lasting: float = 0.8
    slip: float = 0.001
    levels: tuple[int, ...] = LEVELS

    @classmethod
    def of(cls, model: AgentModel) -> Prior:
        """Return the prior for the humans of a problem: all whose actions can fail."""
        return cls({k: low for k, low in model.low.items() if k[1] not in model.robots})

    @cached_property
    def causes(self) -> Mapping[Cause, float]:
        """The probability of each cause, given that there is one."""
        names = Counter(key[0] for key in self.lows)
        probabilities: dict[Cause, float] = {}
        for key, low in self.lows.items():
            levels = [level for level in self.levels if level > low]
            for level in levels:
                share = 1 / len(names) / names[key[0]] / len(levels)
                p = level / 10
                probabilities[key, level, _LASTING, True] = share * self.lasting * p
                probabilities[key, level, _LASTING, False] = share * self.lasting * (1 - p)
                probabilities[key, level, _ANEW, True] = share * (1 - self.lasting)
        return probabilities


@dataclass(frozen=True)
class AgentStateEstimate:
    """What is believed after some outcomes; replaces ``Memory``.

    ``weights`` are the probabilities of the causes; what is missing from 1 is "nothing changed".

    >>> prior = Prior({("motivation", "human"): 1, ("knowledge", "human"): 1})
    >>> start = AgentStateEstimate.begin(prior)
    >>> after = start.failed([("motivation", "human")])
    >>> start.blame()[("motivation", "human")] < 0.2 < 0.8 < after.blame()[("motivation", "human")]
    True
    """

    prior: Prior
    weights: Mapping[Cause, float] = field(repr=False)
    known: frozenset[FluentKey] = frozenset()

    @classmethod
    def begin(cls, prior: Prior) -> AgentStateEstimate:
        """Return what is believed before anything is observed."""
        return cls(prior, {cause: prior.changed * p for cause, p in prior.causes.items()})

    def failed(self, touched: Iterable[FluentKey]) -> AgentStateEstimate:
        """Return what is believed after an action that ``touched`` touch has failed."""
        return self._after_outcome(frozenset(touched), True)

    def went_well(self, touched: Iterable[FluentKey]) -> AgentStateEstimate:
        """Return what is believed after an action that ``touched`` touch has succeeded."""
        return self._after_outcome(frozenset(touched), False)

    def hesitated(self, touched: Iterable[FluentKey], usual: float) -> AgentStateEstimate:
        """Return what is believed after an agent has paused instead of acting.

        Args:
            touched: The elements that its next actions touch.
            usual: The probability of such a pause where nothing keeps the agent from acting.
        """
        return self._after_outcome(frozenset(touched), True, usual)

    def sensed(self, key: FluentKey) -> AgentStateEstimate:
        """Return what is believed once an element's value is known: it needs no estimate."""
        rest = {cause: p for cause, p in self.weights.items() if cause[0] != key}
        nothing = 1 - sum(self.weights.values())
        total = nothing + sum(rest.values())
        weights = {cause: p / total for cause, p in rest.items()} if total else rest
        return replace(self, weights=weights, known=self.known | {key})

    def blame(self) -> dict[FluentKey, float]:
        """Return how likely each element makes the next action fail that it touches.

        What is too unlikely to matter is left out, so that plans do not depend on it.
        """
        return {key: p for key, p in self.failing().items() if p >= NOTICEABLE}

    def failing(self) -> dict[FluentKey, float]:
        """Return the same without leaving anything out."""
        risks: dict[FluentKey, float] = {}
        for cause, p in self.weights.items():
            risks[cause[0]] = risks.get(cause[0], 0.0) + p * _strikes(cause)
        return risks

    def levels(self, key: FluentKey) -> dict[int, float]:
        """Return how likely an element has changed to each level."""
        probabilities = dict.fromkeys(self.prior.levels, 0.0)
        for cause, p in self.weights.items():
            if cause[0] == key:
                probabilities[cause[1]] += p
        return probabilities

    def _after_outcome(
        self, touched: frozenset[FluentKey], failure: bool, slip: float | None = None
    ) -> AgentStateEstimate:
        if not touched & self.prior.lows.keys():
            return self
        nothing = 1 - sum(self.weights.values())
        changes = nothing * self.prior.hazard
        before = {
            cause: self.weights.get(cause, 0.0) + changes * p
            for cause, p in self.prior.causes.items()
            if cause[0] not in self.known
        }
        slip = self.prior.slip if slip is None else slip
        after: dict[Cause, float] = {}
        for cause, p in before.items():
            well = (1 - slip) * (1 - _strikes(cause) * (cause[0] in touched))
            after[cause] = p * (1 - well if failure else well)
        rest = (1 - sum(before.values())) * (slip if failure else 1 - slip)
        total = rest + sum(after.values())
        return replace(self, weights={cause: p / total for cause, p in after.items()})


def _strikes(cause: Cause) -> float:
    """Return how likely a cause makes an action fail that it touches."""
    _, level, kind, strikes = cause
    return float(strikes) if kind == _LASTING else level / 10
