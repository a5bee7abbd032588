"""Problems of unified-planning as problems of hrcplan, and the way back for plans."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from hrcplan.errors import MissingPlannerError, PddlError, UnsupportedError
from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.model import TOTAL_COST, TOTAL_TIME, Problem
from hrcplan.pddl.source import SourceText
from hrcplan.plans import Plan, format_plan

if TYPE_CHECKING:
    from unified_planning.engines import CompilationKind
    from unified_planning.model import Problem as UpProblem
    from unified_planning.plans import ActionInstance
    from unified_planning.plans import Plan as UpPlan

    _MapBack = Callable[[ActionInstance], ActionInstance | None]


@dataclass(frozen=True)
class UpConversion:
    """A problem of unified-planning in PDDL.

    Attributes:
        problem: The problem; names that PDDL does not allow are changed.
        plan_back: Returns a plan of ``problem`` as one of the problem that was converted.
    """

    problem: Problem
    plan_back: Callable[[Plan], UpPlan]


def from_up(problem: UpProblem) -> Problem:
    """Return a ``unified_planning.model.Problem`` as a problem of hrcplan.

    A fluent ``total-time`` without parameters is read as the time that PDDL calls so (``to_up``
    makes one). Fluents whose values are objects, and bounds of numbers, are compiled away by
    unified-planning.

    Raises:
        UnsupportedError: if PDDL cannot hold the problem (a hierarchy, for one); the message is
            that of unified-planning.
        MissingPlannerError: if unified-planning is not installed.
    """
    return convert(problem).problem


def convert(problem: UpProblem) -> UpConversion:
    """Return what ``from_up`` does, with the way back for plans.

    Raises:
        UnsupportedError: if PDDL cannot hold the problem.
        MissingPlannerError: if unified-planning is not installed.
    """
    try:
        from unified_planning.exceptions import UPException
        from unified_planning.io import PDDLReader, PDDLWriter
    except ImportError as error:
        raise MissingPlannerError(f"unified-planning cannot be imported: {error}") from error
    try:
        plain, back = _compile(problem)
        writer = PDDLWriter(plain)
        domain, text = writer.get_domain(), writer.get_problem()
        if plain.has_fluent(TOTAL_TIME):
            name = writer.get_pddl_name(plain.fluent(TOTAL_TIME))
            domain, text = _with_time(name, domain, text)
        ours = problem_in(domain_in(SourceText("domain", domain)), SourceText("problem", text))
    except (UPException, NotImplementedError, AttributeError, PddlError) as error:
        reason = str(error).split("\n")[0] or "it has a part that its PDDL writer does not know"
        message = f"PDDL cannot hold this problem of unified-planning: {reason}"
        raise UnsupportedError(message) from None

    def plan_back(plan: Plan) -> UpPlan:
        read = PDDLReader().parse_plan_string(
            plain, format_plan(plan), get_item_named=writer.get_item_named
        )
        for map_back in reversed(back):
            read = read.replace_action_instances(map_back)
        return read

    return UpConversion(ours, plan_back)


def _compile(problem: UpProblem) -> tuple[UpProblem, list[_MapBack]]:
    """Return a problem that its PDDL writer can hold, and the maps that lead back to this one.

    The maps are applied from the last to the first.
    """
    from unified_planning.engines import CompilationKind

    back: list[_MapBack] = []
    if problem.kind.has_object_fluents():
        problem = _without(problem, CompilationKind.USERTYPE_FLUENTS_REMOVING, back)
    if problem.kind.has_bounded_types():
        problem = _without(problem, CompilationKind.BOUNDED_TYPES_REMOVING, back)
    if problem.kind.has_actions_cost():
        problem = _with_cost_effects(problem, back)
    return problem, back


def _without(problem: UpProblem, kind: CompilationKind, back: list[_MapBack]) -> UpProblem:
    environment = problem.environment
    with environment.factory.Compiler(problem_kind=problem.kind, compilation_kind=kind) as compiler:
        result = compiler.compile(problem, kind)
    back.append(result.map_back_action_instance)
    return result.problem


def _with_cost_effects(problem: UpProblem, back: list[_MapBack]) -> UpProblem:
    """Return a problem whose costs of actions are effects on a fluent.

    The PDDL writer declares the objects that effects name, and forgets those that costs name.
    """
    from unified_planning.model import DurativeAction, EndTiming
    from unified_planning.model.metrics import MinimizeActionCosts, MinimizeExpressionOnFinalState
    from unified_planning.plans import ActionInstance

    (metric,) = problem.quality_metrics
    assert isinstance(metric, MinimizeActionCosts)
    costs = {action.name: metric.get_action_cost(action) for action in problem.actions}
    copy = problem.clone()
    copy.clear_quality_metrics()
    if not copy.has_fluent(TOTAL_COST):
        types = copy.environment.type_manager
        total = copy.add_fluent(TOTAL_COST, types.RealType(), default_initial_value=0)
    else:
        total = copy.fluent(TOTAL_COST)
    for action in copy.actions:
        cost = costs[action.name]
        if cost is not None and isinstance(action, DurativeAction):
            action.add_increase_effect(EndTiming(), total, cost)
        elif cost is not None:
            action.add_increase_effect(total, cost)
    copy.add_quality_metric(
        MinimizeExpressionOnFinalState(copy.environment.expression_manager.FluentExp(total))
    )
    back.append(
        lambda instance: ActionInstance(
            problem.action(instance.action.name), instance.actual_parameters
        )
    )
    return copy


def _with_time(name: str, domain: str, text: str) -> tuple[str, str]:
    """Return the texts with the function ``name`` as PDDL's own total-time."""
    function = re.escape(f"({name})")
    domain = re.sub(rf"^\s*{function}\s*$", "", domain, count=1, flags=re.MULTILINE)
    text = re.sub(rf"\(=\s*{function}\s*[^()]*\)", "", text, count=1)
    return domain, re.sub(function, f"({TOTAL_TIME})", text)
