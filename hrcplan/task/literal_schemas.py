"""Action schemas of plain literals: their instances become bits by look-ups alone.

Most schemas are of this kind, and a general reading of formulas takes several times as long. A law
in the tests holds both ways together.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set
from operator import itemgetter

from hrcplan.core.records import record
from hrcplan.pddl.model import (
    DURATION,
    TOTAL_COST,
    TRUE,
    Action,
    Atom,
    Effect,
    Expr,
    Fact,
    Formula,
    Not,
    Problem,
)
from hrcplan.pddl.semantics import evaluate
from hrcplan.pddl.walks import conjuncts, functions_in, lifted_names
from hrcplan.task.conditions import ALWAYS, NEVER, Tests
from hrcplan.task.numbers import functions_read, ground_expression, numeric_effects
from hrcplan.task.transitions import BitEffect, Effects

Row = tuple[str, ...]
"""The names that the atoms of a schema hold, then the objects of its parameters."""
RowKey = Callable[[Row], tuple[str, ...]]
"""What makes the fact of an atom, or the key of a function, from a row."""


class LiteralRows:
    """The rows of a schema, and what makes facts from them.

    >>> rows = LiteralRows(["?a", "?b"])
    >>> fact = rows.key("at", ["?b", "home"])
    >>> fact(rows.of(("ann", "box")))
    ('at', 'box', 'home')
    """

    def __init__(self, params: Sequence[str]) -> None:
        self._places = {name: place for place, name in enumerate(params)}
        self._names: list[str] = []
        self._n_params = len(params)

    def key(self, name: str, args: Sequence[str]) -> RowKey:
        """Return what makes the key ``(name, *args)`` from a row, with variables replaced."""
        if not args:
            fact = (name,)
            return lambda row: fact
        places = [self._place(name, is_variable=False)]
        places += [self._place(arg, is_variable=True) for arg in args]
        return itemgetter(*places)

    def _place(self, name: str, is_variable: bool) -> int:
        if is_variable and name in self._places:
            return self._places[name]
        if name not in self._names:
            self._names.append(name)
        return self._n_params + self._names.index(name)

    def of(self, args: tuple[str, ...]) -> Row:
        """Return the row of an instance."""
        return (*args, *self._names)


@record
class _Literal:
    key: RowKey
    positive: bool


@record
class _Change:
    key: RowKey
    adds: bool


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
        self._powers, self._fixed, self._values = powers, fixed, problem.values
        self.rows = LiteralRows([param.name for param in action.params])
        self._literals: dict[str, list[_Literal]] = {"start": [], "all": [], "end": []}
        for condition in action.conditions:
            for part in conjuncts(condition.formula):
                literal = _literal(part, changing)
                if literal is not None:
                    atom, positive = literal
                    key = self.rows.key(atom.name, atom.args)
                    self._literals[condition.when].append(_Literal(key, positive))
        self._changes: dict[str, list[_Change]] = {"start": [], "end": []}
        for effect in action.effects:
            if effect.value is None:
                key = self.rows.key(effect.target.name, effect.target.args)
                self._changes[effect.when].append(_Change(key, effect.kind == "add"))
        self._cost_values = [
            effect.value
            for effect in action.effects
            if effect.value is not None and effect.target.name == TOTAL_COST
        ]

    def tests(self, row: Row, when: str) -> Tests:
        """Return the conditions of one phase as bits."""
        positives = negatives = 0
        for literal in self._literals[when]:
            fact = literal.key(row)
            bit = self._powers.get(fact)
            if bit is None:
                if (fact in self._fixed) != literal.positive:
                    return NEVER
            elif literal.positive:
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
        for change in self._changes[when]:
            bit = self._powers.get(change.key(row))
            if bit is None:
                continue
            if change.adds:
                adds |= bit
            else:
                deletes |= bit
        return (BitEffect(adds, deletes & ~adds),) if adds or deletes else ()

    def costs(self, binding: Mapping[str, str]) -> tuple[Expr, ...]:
        """Return what an instance adds to total-cost, over ground functions.

        Raises:
            Undefined: if a cost needs a function without a value, or divides by zero.
        """
        costs = tuple([ground_expression(value, binding, {}) for value in self._cost_values])
        for cost in costs:
            evaluate(cost, self._values, {})
        return costs


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
