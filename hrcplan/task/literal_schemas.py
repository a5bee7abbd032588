"""Action schemas of plain literals: their instances become bits by look-ups alone.

Most schemas are of this kind, and a general reading of formulas takes several times as long. A law
in the tests holds both ways together.
"""

from __future__ import annotations

from collections.abc import Mapping, Set

from hrcplan.core.numbers import Number
from hrcplan.pddl.model import (
    DURATION,
    TOTAL_COST,
    TRUE,
    Action,
    Atom,
    Constant,
    Effect,
    Expr,
    Fact,
    Formula,
    Not,
    Problem,
)
from hrcplan.pddl.rows import LiteralRows, Row, RowKey, picker
from hrcplan.pddl.semantics import evaluate
from hrcplan.pddl.walks import conjuncts, functions_in, lifted_names
from hrcplan.task.conditions import ALWAYS, NEVER, Tests
from hrcplan.task.numbers import functions_read, ground_expression, numeric_effects
from hrcplan.task.transitions import BitEffect, Effects

Figures = tuple[Number | None, tuple[Expr, ...]]
"""The duration of an instance (None if it is not fixed), and what it adds to total-cost."""
_UNIT_COST: tuple[Expr, ...] = (Constant(1),)


class LiteralSchema:
    """A schema whose conditions are literals and whose effects add, delete, or cost.

    Args:
        action: A schema that `is_literal`.
        problem: The problem.
        changing: What its actions change, from `changed_names`.
        powers: The state in which only a fact holds, of each fact that changes.
        fixed: The facts that hold and never change.
    """

    def __init__(
        self, action: Action, problem: Problem, changing: Set[str], powers: Mapping[Fact, int],
        fixed: Set[Fact],
    ) -> None:  # fmt: skip
        self._action, self._problem = action, problem
        self._powers, self._fixed = powers, fixed
        self.rows = LiteralRows([param.name for param in action.params])
        self._literals: dict[str, list[tuple[RowKey, bool]]] = {"start": [], "all": [], "end": []}
        for condition in action.conditions:
            for part in conjuncts(condition.formula):
                literal = _literal(part, changing)
                if literal is not None:
                    atom, positive = literal
                    key = self.rows.key(atom.name, atom.args)
                    self._literals[condition.when].append((key, positive))
        self._changes: dict[str, list[tuple[RowKey, bool]]] = {"start": [], "end": []}
        for effect in action.effects:
            if effect.value is None:
                key = self.rows.key(effect.target.name, effect.target.args)
                self._changes[effect.when].append((key, effect.kind == "add"))
        self._expressions = _figure_expressions(action, problem)
        used = {arg for e in self._expressions for f in functions_in(e) for arg in f.args}
        params = [param.name for param in action.params]
        self._used = [name for name in params if name in used]
        self._used_objects = picker([params.index(name) for name in self._used])
        self._figures: dict[Row, Figures] = {}

    def tests(self, row: Row, when: str) -> Tests:
        """Return the conditions of one phase as bits."""
        positives = negatives = 0
        for key, positive in self._literals[when]:
            fact = key(row)
            bit = self._powers.get(fact)
            if bit is None:
                if (fact in self._fixed) != positive:
                    return NEVER
            elif positive:
                positives |= bit
            else:
                negatives |= bit
        if negatives:
            if positives & negatives:
                return NEVER
            return ((positives | negatives, positives),)
        return ((positives, positives),) if positives else ALWAYS

    def effects(self, row: Row, when: str) -> Effects:
        """Return the changes of one instant: one effect, or none."""
        adds = deletes = 0
        for key, is_add in self._changes[when]:
            bit = self._powers.get(key(row))
            if bit is None:
                continue
            if is_add:
                adds |= bit
            else:
                deletes |= bit
        return (BitEffect(adds, deletes & ~adds),) if adds or deletes else ()

    def figures(self, row: Row) -> Figures:
        """Return duration and costs, over ground functions: once for the objects that they name.

        Raises:
            Undefined: if one needs a function without a value, or divides by zero.
        """
        objects = self._used_objects(row)
        figures = self._figures.get(objects)
        if figures is None:
            figures = self._ground(dict(zip(self._used, objects, strict=True)))
            self._figures[objects] = figures
        return figures

    def _ground(self, binding: Mapping[str, str]) -> Figures:
        action, values = self._action, self._problem.values
        duration: Number | None = 0
        if action.durative:
            length = action.fixed_duration
            duration = None if length is None else evaluate(length, values, binding)
        if TOTAL_COST not in self._problem.domain.functions:
            return duration, _UNIT_COST
        costs = tuple([ground_expression(value, binding, {}) for value in _cost_values(action)])
        for cost in costs:
            evaluate(cost, values, {})
        return duration, costs


def _figure_expressions(action: Action, problem: Problem) -> list[Expr]:
    """Return what the duration and the costs of an action are computed from."""
    expressions = [expression for _, expression in action.durations]
    return expressions + (_cost_values(action) if TOTAL_COST in problem.domain.functions else [])


def _cost_values(action: Action) -> list[Expr]:
    return [
        effect.value
        for effect in action.effects
        if effect.value is not None and effect.target.name == TOTAL_COST
    ]


def is_literal(action: Action, changing: Set[str], moving: Set[str]) -> bool:
    """Return whether an action has conditions that are literals, and plain effects.

    What no action changes may be of any form, since it holds in every reachable instance.
    ``changing`` is what actions change, ``moving`` are the functions among it.
    """
    parts = (part for c in action.conditions for part in conjuncts(c.formula))
    return (
        all(_literal(part, changing) is not None or _is_static(part, changing) for part in parts)
        and all(map(_is_plain, action.effects))
        and not any(numeric_effects(action))
        and moving.isdisjoint(function.name for function in functions_read(action))
        and moving.isdisjoint(
            function.name for effect in action.effects for function in functions_in(effect.value)
        )
    )


def _is_plain(effect: Effect) -> bool:
    """Return whether an effect has no condition, no quantifier, and no cost by duration."""
    by_duration = any(function.name == DURATION for function in functions_in(effect.value))
    is_simple = effect.condition == TRUE == effect.start_condition and not effect.params
    return is_simple and not by_duration


def changed_names(problem: Problem) -> Set[str]:
    """Return what actions change, and the duration, which is another one in each instance."""
    actions = problem.domain.actions
    return {DURATION, *(effect.target.name for action in actions for effect in action.effects)}


def _is_static(part: Formula, changing: Set[str]) -> bool:
    return changing.isdisjoint(lifted_names(part))


def _literal(part: Formula, changing: Set[str]) -> tuple[Atom, bool] | None:
    """Return a literal's atom, and whether it must hold; None for what is static, or no literal."""
    if _is_static(part, changing):
        return None
    match part:
        case Atom():
            return part, True
        case Not(Atom() as atom):
            return atom, False
    return None
