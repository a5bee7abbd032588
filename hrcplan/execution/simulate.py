"""One simulated run from a specification: what studies are made of.

``simulate(spec)`` returns the row of one run. Everything random follows from ``spec.seed``, and
nothing else of the specification changes it, so that runs with one seed are paired.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

from hrcplan.agents import REPLAN_ALWAYS, load_profile
from hrcplan.core.numbers import Number
from hrcplan.errors import UsageError
from hrcplan.execution import events as ev
from hrcplan.execution.driver import Driver, NullRecord, PlanProvider, RunRecord, RunWatch
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.monitor import Monitor
from hrcplan.execution.outcome import Outcome, outcome_of
from hrcplan.execution.replanner import Replanner
from hrcplan.execution.run import Run
from hrcplan.execution.worlds import EventWorld, chance
from hrcplan.execution.worlds.simulated import (
    DRAWS,
    DURING,
    ONCE,
    SENSED,
    FactChange,
    Nature,
    SimulatedWorld,
    StateChange,
)
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import FluentKey, Problem
from hrcplan.planners.expected_price import with_success
from hrcplan.plans import Plan

CASES = (0, 1, 2)
LEVELS = (5, 10)
START, RANDOM = "start", "random"


@dataclass(frozen=True, slots=True)
class Spec:
    """One simulated run.

    ``case``: 0 nothing changes, 1 the human does not contribute (value 10), 2 a value drawn from
    the integers ``levels``. ``model``: sensed values are used. ``when`` the change happens: at the
    ``start``, or just before a ``random`` one of the human's actions. ``sensed``, ``draws`` and
    ``can_fail`` are those of ``Nature``; ``values`` are put into the initial state. ``planner`` is
    a name, or several with commas, asked in turn. ``success`` is the probability with which
    interactions succeed, instead of those that the domain notes.

    ``n_elements`` of the human's state change, each to a level and at a time of its own. With
    ``drift_s`` an element rises by 1 every so many seconds, until it has its level. ``failure_s``
    is that of ``Nature``. ``without`` names actions that the domain has to do without.
    """

    domain: str = "transport"
    problem: str = "two-boxes"
    case: int = 1
    model: bool = True
    profile: str = REPLAN_ALWAYS
    seed: str | int = 0
    when: str = START
    sensed: str = DURING
    draws: str = ONCE
    can_fail: tuple[str, ...] | None = None
    levels: tuple[int, int] = LEVELS
    values: tuple[tuple[FluentKey, Number], ...] = ()
    replan_limit: int | None = None
    planner: str = "auto"
    success: float | None = None
    n_elements: int = 1
    drift_s: float = 0.0
    failure_s: float = 0.0
    without: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Check what has a few choices only.

        Raises:
            UsageError: naming the first field that is wrong.
        """
        for name, choices in (("case", CASES), ("when", (START, RANDOM)), ("sensed", SENSED),
                              ("draws", DRAWS)):  # fmt: skip
            if getattr(self, name) not in choices:
                words = ", ".join(map(str, choices))
                raise UsageError(f"{name} is one of {words}, not {getattr(self, name)!r}")


@dataclass(frozen=True)
class Engine:
    """What runs of one problem and profile share: monitor, and planner with its cached plans."""

    monitor: Monitor
    planner: PlanProvider

    @property
    def model(self) -> ExecutionModel:
        """The problem, prepared for execution."""
        return self.monitor.model

    def run(
        self, nature: Nature, record: RunRecord | None = None, watch: RunWatch | None = None,
        world: EventWorld | None = None,
    ) -> Run:  # fmt: skip
        """Return one finished run, in a simulated world with this nature or in another world."""
        world = world or SimulatedWorld(self.model, nature)
        return Driver(self.monitor, world, self.planner, record or NullRecord(), watch).run()

    def outcome(self, run: Run) -> Outcome:
        """Return what a run came to."""
        return outcome_of(run, self.model.agents.robots)

    def first_plan(self) -> Plan | None:
        """Return the plan that every run begins with; None if there is none."""
        _, commands = self.monitor.step(self.monitor.begin(), ev.Settled(0.0))
        ask = next(command for command in commands if isinstance(command, ev.AskPlan))
        return self.planner.answer(ask).plan


def simulate(spec: Spec) -> Outcome:
    """Return the row of one simulated run.

    Raises:
        InputError: if domain, problem or profile cannot be read.
    """
    engine = engine_for(spec)
    return engine.outcome(engine.run(nature_of(spec, engine)))


def engine_for(spec: Spec) -> Engine:
    """Return the engine of a specification; those that differ only in chance share one."""
    return _engine(spec.domain, spec.problem, spec.values, spec.planner, spec.profile, spec.model,
                   spec.replan_limit, spec.success, spec.without)  # fmt: skip


def forget() -> None:
    """Free what engines of earlier specifications keep: their groundings and plans."""
    _engine.cache_clear()
    _replanner.cache_clear()


@lru_cache(maxsize=64)
def _engine(
    domain: str, problem: str, values: tuple[tuple[FluentKey, Number], ...], planner: str,
    profile_name: str, model: bool, replan_limit: int | None,
    success: float | None, without: tuple[str, ...],
) -> Engine:  # fmt: skip
    replanner = _replanner(domain, problem, values, planner, success, without)
    profile = load_profile(profile_name).limited_to(replan_limit)
    return Engine(Monitor(replanner.model, profile, model), replanner)


@lru_cache(maxsize=16)
def _replanner(
    domain: str, problem: str, values: tuple[tuple[FluentKey, Number], ...], planner: str,
    success: float | None, without: tuple[str, ...],
) -> Replanner:  # fmt: skip
    task_problem = _without(read(domain, problem).with_values(dict(values)), without)
    if success is not None:
        task_problem = with_success(task_problem, success)
    return Replanner(ExecutionModel(task_problem), tuple(planner.split(",")))


def _without(problem: Problem, names: tuple[str, ...]) -> Problem:
    """Return a problem whose domain lacks some actions."""
    if not names:
        return problem
    actions = tuple(action for action in problem.domain.actions if action.name not in names)
    return replace(problem, domain=replace(problem.domain, actions=actions))


def nature_of(spec: Spec, engine: Engine) -> Nature:
    """Return how the world behaves in one run: all that chance decides, drawn from the seed."""
    can_fail = None if spec.can_fail is None else frozenset(spec.can_fail)
    changes: tuple[StateChange, ...] = ()
    accidents: tuple[FactChange, ...] = ()
    if spec.case:
        changes = tuple(sorted(_changes(spec, engine), key=lambda change: change.t))
    return Nature(
        spec.seed, changes, accidents, spec.sensed, spec.draws, can_fail, failure_s=spec.failure_s
    )


def _changes(spec: Spec, engine: Engine) -> Iterator[StateChange]:
    """Yield the changes of all elements that change."""
    keys: list[FluentKey] = []
    for i in range(spec.n_elements):
        about = replace(spec, seed=f"{spec.seed} {i}") if i else spec
        options = [key for key in _elements(engine) if key not in keys]
        if keys and not options:
            return
        keys.append(_cause(about, options))
        level, t = _level(about), _change_time(about, engine)
        low = int(engine.model.agents.low[keys[-1]])
        if spec.drift_s and level > low:
            for step, value in enumerate(range(low + 1, level + 1)):
                yield StateChange(t + step * spec.drift_s, {keys[-1]: value})
        else:
            yield StateChange(t, {keys[-1]: level})


def cause_of(spec: Spec, engine: Engine) -> FluentKey:
    """Return the element that changes: any function, then any of a human's elements of it.

    Raises:
        UsageError: if no human has an agent state that could change.
    """
    return _cause(spec, _elements(engine))


def _elements(engine: Engine) -> list[FluentKey]:
    agents = engine.model.agents
    return [key for key in agents.low if key[1] not in agents.robots]


def _cause(spec: Spec, keys: Sequence[FluentKey]) -> FluentKey:
    if not keys:
        raise UsageError("no human here has an agent state that could change", code="no-human")
    names = list(dict.fromkeys(key[0] for key in keys))
    name = chance.choice(names, spec.seed, "cause")
    return chance.choice([key for key in keys if key[0] == name], spec.seed, "where")


def _level(spec: Spec) -> int:
    if spec.case == 1:
        return 10
    low, high = spec.levels
    return chance.choice(range(low, high + 1), spec.seed, "level")


def _change_time(spec: Spec, engine: Engine) -> float:
    """Return when the change happens: 0, or the planned start of one of the human's actions."""
    if spec.when == START:
        return 0.0
    plan = engine.first_plan() or Plan()
    starts = [
        float(action.start_s or 0)
        for action in plan.actions
        if (step := engine.model.actions.step(action)) and engine.model.is_human(step.agent)
    ]
    return chance.choice(starts, spec.seed, "when") if starts else 0.0
