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

import numpy as np

from hrcplan.agents.state import AgentModel
from hrcplan.core.arrays import Floats, Ids
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

    @cached_property
    def table(self) -> _CauseTable:
        """The causes as arrays."""
        keys = tuple(self.lows)
        place = {key: i for i, key in enumerate(keys)}
        causes = list(self.causes)
        return _CauseTable(
            keys,
            np.array([place[cause[0]] for cause in causes], dtype=np.int64),
            np.array(list(self.causes.values()), dtype=np.float64),
            np.array([_strikes(cause) for cause in causes], dtype=np.float64),
            np.array([cause[1] for cause in causes], dtype=np.int64),
        )


@dataclass(frozen=True)
class _CauseTable:
    """The causes of a prior as arrays: element, probability, and how likely it strikes."""

    keys: tuple[FluentKey, ...]
    element: Ids
    prior: Floats
    strikes: Floats
    level: Ids

    @cached_property
    def place(self) -> Mapping[FluentKey, int]:
        """The index of each element."""
        return {key: place for place, key in enumerate(self.keys)}

    def touches(self, touched: Iterable[FluentKey]) -> Floats:
        """Return for each cause whether it is about one of some elements, as 1 or 0."""
        is_touched = np.zeros(len(self.keys))
        is_touched[[self.place[key] for key in touched if key in self.place]] = 1.0
        return is_touched[self.element]


@dataclass(frozen=True, eq=False)
class AgentStateEstimate:
    """What is believed after some outcomes; replaces ``Memory``.

    ``weights`` are the probabilities of the causes, in the order of ``prior.causes``; what is
    missing from 1 is "nothing changed".

    >>> prior = Prior({("motivation", "human"): 1, ("knowledge", "human"): 1})
    >>> start = AgentStateEstimate.begin(prior)
    >>> after = start.failed([("motivation", "human")])
    >>> start.blame()[("motivation", "human")] < 0.2 < 0.8 < after.blame()[("motivation", "human")]
    True
    """

    prior: Prior
    weights: Floats = field(repr=False)
    known: frozenset[FluentKey] = frozenset()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, AgentStateEstimate):
            return NotImplemented
        same = self.prior == other.prior and self.known == other.known
        return same and np.array_equal(self.weights, other.weights)

    __hash__ = None  # type: ignore[assignment]

    @classmethod
    def begin(cls, prior: Prior) -> AgentStateEstimate:
        """Return what is believed before anything is observed."""
        return cls(prior, prior.changed * prior.table.prior)

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
        rest = self.weights * (1 - self.prior.table.touches([key]))
        total = 1 - float(self.weights.sum()) + float(rest.sum())
        weights = rest / total if total > 0 else rest
        return replace(self, weights=weights, known=self.known | {key})

    def blame(self) -> dict[FluentKey, float]:
        """Return how likely each element makes the next action fail that it touches.

        What is too unlikely to matter is left out, so that plans do not depend on it.
        """
        return {key: p for key, p in self.failing().items() if p >= NOTICEABLE}

    def failing(self) -> dict[FluentKey, float]:
        """Return the same without leaving anything out."""
        table = self.prior.table
        risks = np.bincount(table.element, self.weights * table.strikes, len(table.keys))
        by_key = zip(table.keys, risks.tolist(), strict=True)
        return {key: risk for key, risk in by_key if key not in self.known}

    def levels(self, key: FluentKey) -> dict[int, float]:
        """Return how likely an element has changed to each level."""
        table = self.prior.table
        own = self.weights * table.touches([key])
        return {level: float(own[table.level == level].sum()) for level in self.prior.levels}

    def _after_outcome(
        self, touched: frozenset[FluentKey], failure: bool, slip: float | None = None
    ) -> AgentStateEstimate:
        if not touched & self.prior.lows.keys():
            return self
        table, slip = self.prior.table, self.prior.slip if slip is None else slip
        changes = (1 - float(self.weights.sum())) * self.prior.hazard
        before = (self.weights + changes * table.prior) * (1 - table.touches(self.known))
        well = (1 - slip) * (1 - table.strikes * table.touches(touched))
        after = before * (1 - well if failure else well)
        rest = (1 - float(before.sum())) * (slip if failure else 1 - slip)
        return replace(self, weights=after / (rest + float(after.sum())))


def _strikes(cause: Cause) -> float:
    """Return how likely a cause makes an action fail that it touches."""
    _, level, kind, strikes = cause
    return float(strikes) if kind == _LASTING else level / 10
