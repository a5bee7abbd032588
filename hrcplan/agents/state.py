"""Agent state, read off the PDDL: which values touch which action, and how likely it then fails.

An *element* of an agent's state is a ground function such as ``("motivation", "human")``: its
first argument is the agent and it occurs in the cost of an action. A *sensed value* lies in
[0, 10], or in the range that the domain's note ``;; hrcplan: range`` gives; *low* is the problem's
initial value, at which the agent contributes.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cached_property

from hrcplan.core.numbers import Number, exact, int_text, number_text
from hrcplan.core.text import MAX_QUOTE, cut
from hrcplan.errors import UsageError
from hrcplan.pddl.conventions import agent_state_functions, robots
from hrcplan.pddl.model import TOTAL_COST, Action, FluentKey, Function, Problem
from hrcplan.pddl.semantics import ground_key
from hrcplan.pddl.walks import functions_in

LEAST, MOST = 0, 10
_PLACES = 6  # decimals of a sensed value that are kept, so that journals hold it exactly


def sensed_value(
    value: float | Number, least: Number = LEAST, most: Number = MOST, hint: str | None = None
) -> Number:
    """Return a sensed value as an exact number with at most six decimals.

    Raises:
        UsageError: if it is not a number in [least, most]; ``hint`` is the error's.

    >>> sensed_value(2.5)
    Fraction(5, 2)
    """
    if not _is_finite(value) or not least <= value <= most:
        limits = f"[{number_text(least)}, {number_text(most)}]"
        shown = cut(int_text(value) if isinstance(value, int) else f"{value}", MAX_QUOTE)
        raise UsageError(f"{shown} is no value in {limits}", code="bad-sensed-value", hint=hint)
    return exact(f"{float(value):.{_PLACES}f}")


def _is_finite(value: float | Number) -> bool:
    """Return whether a value is a finite number; a whole one may be too large for a float."""
    return not isinstance(value, float) or math.isfinite(value)


def failure_probability(value: Number, low: Number) -> float:
    """Return how likely an action fails because of one element (0 up to low, then value / 10).

    >>> failure_probability(1, 1), failure_probability(8, 1)
    (0.0, 0.8)
    """
    return 0.0 if value <= low else max(0.0, min(1.0, float(value) / MOST))


class AgentModel:
    """The agent state of one problem: its elements, their low values, and what they touch."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.robots = robots(problem)
        self.functions = agent_state_functions(problem.domain)
        self._keys: dict[tuple[str, ...], tuple[FluentKey, ...]] = {}

    @cached_property
    def low(self) -> Mapping[FluentKey, Number]:
        """Every element with its low value, in alphabetical order."""
        agents = set(self.problem.agents)
        return {
            key: value
            for key, value in sorted(self.problem.values.items())
            if key[0] in self.functions and key[1] in agents
        }

    def elements(self, agent: str) -> tuple[FluentKey, ...]:
        """Return the elements of one agent."""
        return tuple(key for key in self.low if key[1] == agent)

    def touching(self, name: str, args: tuple[str, ...]) -> tuple[FluentKey, ...]:
        """Return the elements that the cost of a ground action contains."""
        keys = self._keys.get((name, *args))
        if keys is None:
            schema = self.problem.domain.action(name)
            keys = tuple(key for key in _cost_keys(schema, args) if key in self.low)
            self._keys[name, *args] = keys
        return keys

    def is_interaction(self, name: str) -> bool:
        """Return whether an action decreases or assigns an agent state."""
        return name in self._interactions

    @cached_property
    def _interactions(self) -> frozenset[str]:
        return frozenset(
            action.name
            for action in self.problem.domain.actions
            for effect in action.effects
            if effect.target.name in self.functions and effect.kind in ("decrease", "assign")
        )

    @cached_property
    def residuals(self) -> Mapping[FluentKey, Number]:
        """The functions whose value an interaction assigns, with the least low value of each.

        They are sensed values as the elements are, so planners get them in the same way.
        """
        residuals: dict[FluentKey, Number] = {}
        for action in self.problem.domain.actions:
            for effect in action.effects:
                source = effect.value
                if effect.target.name not in self.functions or not isinstance(source, Function):
                    continue
                key = (source.name, *source.args)
                lows = [v for k, v in self.low.items() if k[0] == effect.target.name]
                if effect.kind == "assign" and key in self.problem.values and lows:
                    residuals[key] = min([*lows, residuals.get(key, MOST)])
        return residuals

    def failure_probability(self, key: FluentKey, values: Mapping[FluentKey, Number]) -> float:
        """Return how likely one element makes an action fail; unknown values count as low."""
        low = self.low[key]
        return failure_probability(values.get(key, low), low)

    def value_range(self, key: FluentKey) -> tuple[Number, Number]:
        """Return the least and greatest value of an element: the domain's note, else [0, 10]."""
        return self.problem.domain.value_range(key[0]) or (LEAST, MOST)

    def clamp(self, key: FluentKey, value: Number) -> Number:
        """Return the value in the range of an element that is nearest to a value."""
        least, most = self.value_range(key)
        return min(max(value, least), most)

    def check(self, key: FluentKey, value: float | Number) -> Number:
        """Return a sensed value as an exact number.

        Raises:
            UsageError: if the problem has no such element, or the value is not in its range.
        """
        if key not in self.low:
            raise UsageError(f"({' '.join(key)}) is no agent state here", code="bad-sensed-value")
        return sensed_value(value, *self.value_range(key), self._range_hint(key, value))

    def _range_hint(self, key: FluentKey, value: float | Number) -> str:
        """Return how the range of an element could be changed so that it holds a value."""
        least, most = self.value_range(key)
        if _is_finite(value):
            bound = exact(value)
            least, most = min(least, bound), max(most, bound)
        note = f";; hrcplan: range {key[0]} {number_text(least)} {number_text(most)}"
        reason = f"{MOST} is certain failure"
        return f"{reason}; a line '{note}' in the domain file changes the range"


def _cost_keys(action: Action, args: tuple[str, ...]) -> list[FluentKey]:
    binding = {param.name: arg for param, arg in zip(action.params, args, strict=True)}
    return [
        ground_key(function, binding)
        for effect in action.effects
        if effect.target.name == TOTAL_COST
        for function in functions_in(effect.value)
    ]
