"""A lowered task as a unified-planning problem, built directly.

unified-planning's PDDL reader needs 4 s for the 340 actions of a recipe, this 0.1 s. The module
does not import unified-planning (only ``up.py`` does): it is given its ``model``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from types import ModuleType
from typing import TYPE_CHECKING, Any, Protocol

from hrcplan.planners.instantaneous import unsure_changes
from hrcplan.planners.lowering import Lowering
from hrcplan.task import BitEffect, GroundAction, Task
from hrcplan.task.conditions import Test

if TYPE_CHECKING:
    from unified_planning.model import Problem as UpProblem

UpTable = Mapping[str, Any]


def table(task: Task, lowering: Lowering, *, costs: bool) -> UpTable:
    """Return what ``build`` needs, as JSON can carry it; without costs for planners without."""
    return {
        "name": task.problem.name,
        "facts": lowering.facts,
        "initial": task.initial,
        "goal": task.goal,
        "actions": [
            {
                "name": name,
                "tests": action.tests,
                "changes": [
                    (((0, 0),), action.adds, action.deletes),
                    *((c.tests, c.adds, c.deletes & ~c.adds) for c in _unsure(action)),
                ],
                "cost": cost if costs else None,
            }
            for (name, action), cost in zip(lowering.actions.items(), lowering.costs, strict=True)
        ],
    }


def _unsure(action: GroundAction) -> Iterable[BitEffect]:
    return unsure_changes(action) if action.conditional else ()


class _UpExpression(Protocol):
    """An expression of unified-planning: it is only passed on."""

    def is_constant(self) -> bool: ...


class _UpAction(Protocol):
    """What is used of an action of unified-planning."""

    def add_precondition(self, condition: _UpExpression) -> None: ...
    def add_effect(self, fluent: _UpExpression, value: bool, condition: _UpExpression) -> None: ...


class _UpModel(Protocol):
    """What is used of ``unified_planning.model``."""

    @property
    def Problem(self) -> Callable[[str], Any]: ...  # noqa: N802
    @property
    def InstantaneousAction(self) -> Callable[[str], _UpAction]: ...  # noqa: N802
    @property
    def metrics(self) -> ModuleType: ...


class Build:
    """Builds a problem out of a table with the classes of ``unified_planning.model``."""

    def __init__(self, model: _UpModel, source: UpTable) -> None:
        self._problem = model.Problem(source["name"])
        self._expressions = self._problem.environment.expression_manager
        fluents = [self._problem.add_fluent(name, default_initial_value=False)
                   for name in source["facts"]]  # fmt: skip
        self._atoms = [self._expressions.FluentExp(fluent) for fluent in fluents]
        for atom in self._of(source["initial"]):
            self._problem.set_initial_value(atom, True)
        prices = {}
        for row in source["actions"]:
            action = model.InstantaneousAction(row["name"])
            self._fill(action, row)
            self._problem.add_action(action)
            if row["cost"] is not None:
                prices[action] = self._expressions.Int(row["cost"])
        self._problem.add_goal(self._any(source["goal"]))
        if prices:
            self._problem.add_quality_metric(model.metrics.MinimizeActionCosts(prices))

    @property
    def problem(self) -> UpProblem:
        """The ``unified_planning.model.Problem``."""
        return self._problem

    def _fill(self, action: _UpAction, row: UpTable) -> None:
        for literal in self._parts(row["tests"]):
            action.add_precondition(literal)
        for tests, adds, deletes in row["changes"]:
            condition = self._any(tests)
            for atom in self._of(adds):
                action.add_effect(atom, True, condition)
            for atom in self._of(deletes):
                action.add_effect(atom, False, condition)

    def _parts(self, tests: Sequence[Test]) -> Sequence[_UpExpression]:
        return self._literals(*tests[0]) if len(tests) == 1 else [self._any(tests)]

    def _any(self, tests: Sequence[Test]) -> _UpExpression:
        alternatives = [self._expressions.And(self._literals(*t)) for t in tests]
        either: _UpExpression = self._expressions.Or(alternatives)
        return either

    def _literals(self, mask: int, value: int) -> list[_UpExpression]:
        wrong = [self._expressions.Not(atom) for atom in self._of(mask & ~value)]
        return [*self._of(value), *wrong]

    def _of(self, bits: int) -> list[_UpExpression]:
        return [atom for position, atom in enumerate(self._atoms) if bits >> position & 1]
