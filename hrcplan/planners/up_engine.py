"""hrcplan as an engine of unified-planning: ``OneshotPlanner(name="hrcplan")``."""

from __future__ import annotations

from collections.abc import Callable
from typing import IO

from unified_planning.engines import (
    Engine,
    LogLevel,
    LogMessage,
    PlanGenerationResult,
    PlanGenerationResultStatus,
)
from unified_planning.engines.mixins import OneshotPlannerMixin
from unified_planning.engines.mixins.oneshot_planner import OptimalityGuarantee
from unified_planning.model import Problem, ProblemKind, State
from unified_planning.model.problem_kind import FEATURES

from hrcplan.core.numbers import number_text
from hrcplan.errors import UnsupportedError
from hrcplan.planners.contract import Status
from hrcplan.planners.from_up import convert
from hrcplan.planners.solve import solve

NAME = "hrcplan"
DEFAULT_TIMEOUT_S = 60.0
_STATUSES = {
    Status.OPTIMAL: PlanGenerationResultStatus.SOLVED_OPTIMALLY,
    Status.SOLVED: PlanGenerationResultStatus.SOLVED_SATISFICING,
    Status.UNSOLVABLE: PlanGenerationResultStatus.UNSOLVABLE_PROVEN,
    Status.UNSOLVED: PlanGenerationResultStatus.TIMEOUT,
}
_WITHOUT = frozenset(
    ["HIERARCHICAL", "CONTINGENT", "ACTION_BASED_MULTI_AGENT", "SCHEDULING", "TAMP",
     "INTERMEDIATE_CONDITIONS_AND_EFFECTS", "EXTERNAL_CONDITIONS_AND_EFFECTS", "TIMED_GOALS",
     "SIMULATED_EFFECTS", "OVERSUBSCRIPTION", "TEMPORAL_OVERSUBSCRIPTION",
     *FEATURES["PARAMETERS"], *FEATURES["HIERARCHICAL"], *FEATURES["MULTI_AGENT"]]
)  # fmt: skip


def register() -> None:
    """Make hrcplan known to unified-planning as the engine ``hrcplan``.

    >>> register()
    >>> from unified_planning.environment import get_environment
    >>> "hrcplan" in get_environment().factory.engines
    True
    """
    from unified_planning.environment import get_environment

    get_environment().factory.add_engine(NAME, __name__, HrcplanEngine.__name__)


class HrcplanEngine(Engine, OneshotPlannerMixin):  # type: ignore[misc]
    """All planners of hrcplan, each plan replayed in PDDL's own semantics."""

    def __init__(self, planner: str = "auto", **options: bool) -> None:
        Engine.__init__(self)
        OneshotPlannerMixin.__init__(self)
        self._planner = planner

    @property
    def name(self) -> str:
        """The name in unified-planning."""
        return NAME

    @staticmethod
    def supported_kind() -> ProblemKind:
        """Return the features that a problem may have."""
        features = {feature for group in FEATURES.values() for feature in group}
        return ProblemKind(features - _WITHOUT)

    @staticmethod
    def supports(problem_kind: ProblemKind) -> bool:
        """Return whether PDDL holds a kind of problems."""
        return bool(problem_kind <= HrcplanEngine.supported_kind())

    @staticmethod
    def satisfies(optimality_guarantee: OptimalityGuarantee) -> bool:
        """Return whether every plan has a guarantee: proofs are tried, and not promised."""
        return bool(optimality_guarantee == OptimalityGuarantee.SATISFICING)

    def _solve(
        self, problem: Problem, heuristic: Callable[[State], float | None] | None = None,
        timeout: float | None = None, output_stream: IO[str] | None = None,
    ) -> PlanGenerationResult:  # fmt: skip
        try:
            conversion = convert(problem)
        except UnsupportedError as error:
            log = [LogMessage(LogLevel.ERROR, error.message)]
            status = PlanGenerationResultStatus.UNSUPPORTED_PROBLEM
            return PlanGenerationResult(status, None, NAME, log_messages=log)
        result = solve(conversion.problem, self._planner, timeout_s=timeout or DEFAULT_TIMEOUT_S)
        log = [LogMessage(LogLevel.INFO, f"{a.planner}: {a.outcome}") for a in result.attempts]
        plan = None if result.plan is None else conversion.plan_back(result.plan)
        metrics = {"planner": str(result.planner)}
        if result.objective is not None:
            metrics["metric"] = number_text(result.objective)
        return PlanGenerationResult(_STATUSES[result.status], plan, NAME, metrics, log)
