"""A task as parameterless classical PDDL with one integer cost per action.

Cost-optimal classical planners (Fast Downward, SymK, K*) know neither sums of functions as a cost
nor fractions nor functions that actions change. The lowered task means the same in words that all
of them read; a table leads back from its actions to the ground actions.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import lcm

from hrcplan.core.bits import positions
from hrcplan.core.numbers import Number, exact
from hrcplan.core.records import record
from hrcplan.errors import PlanFormatError, UnsupportedError
from hrcplan.pddl.model import TOTAL_COST, TOTAL_TIME
from hrcplan.pddl.write import decimal_text
from hrcplan.planners.gains import idle_gain
from hrcplan.planners.handover import KEYWORDS
from hrcplan.planners.instantaneous import unsure_changes
from hrcplan.plans import Plan, PlannedAction, parse_plan
from hrcplan.task import GroundAction, Task
from hrcplan.task.conditions import Test
from hrcplan.task.numbers import linear

MAX_COST = 2**30
"""Sum of all action costs up to which planners with 32-bit integers are safe: no relaxed plan, and
so no admissible heuristic value, is above it."""

NO_SEQUENCE = "no sequence of actions reaches the goal, one after the other"
"""What a lowered temporal task without a plan means: concurrency may be needed."""

_SMALL = "uniform-cost takes such tasks if they are small"
_FUNCTIONS = "  (:functions (total-cost) - number)\n"
_START = "    (= (total-cost) 0)\n"
_METRIC = "  (:metric minimize (total-cost))\n"
_ODD = re.compile(r"[^a-z0-9_-]")


@dataclass(frozen=True)
class Lowering:
    """Lowered PDDL and the way back from it.

    Attributes:
        domain_text: The domain; every predicate and action is without parameters.
        problem_text: The problem, with ``(:metric minimize (total-cost))``.
        actions: Lowered names to ground actions, in ground-action order.
        costs: The integer cost of each action, in that order.
        scale: Integer cost per unit of the problem's metric; negative where it is to be maximized.
        offset: What the metric adds to every plan, whatever its actions.
        exact_for_metric: Whether the lowered cost is the problem's metric; False where the metric
            of a temporal problem looks at time, or where a temporal problem has no metric.
        conditional: Whether some effect depends on the state (``when``).
        facts: Lowered names of the task's facts, in bit order.
    """

    domain_text: str
    problem_text: str
    actions: Mapping[str, GroundAction]
    costs: tuple[int, ...]
    scale: int
    offset: Number
    exact_for_metric: bool
    conditional: bool
    facts: tuple[str, ...]

    def plan(self, text: str) -> Plan:
        """Return a planner's plan for the lowered task in the names of the task itself.

        Raises:
            PlanFormatError: if the text is no plan, or names an action that is not in the table.
        """
        actions: list[PlannedAction] = []
        for lowered_action in parse_plan(text).actions:
            action = self.actions.get(lowered_action.name)
            if action is None or lowered_action.args:
                raise PlanFormatError(f"{lowered_action} is no action of the lowered task")
            actions.append(PlannedAction(action.name, action.args))
        return Plan(tuple(actions))

    def objective(self, cost: int | Fraction) -> Number | None:
        """Return the metric of a plan with this lowered cost; None where it is not the metric."""
        if not self.exact_for_metric:
            return None
        return exact(Fraction(cost) / self.scale + self.offset)

    def fits(self, bits: int, metric: Number) -> bool:
        """Return whether floats of so many bits hold all costs on the way to a plan exactly.

        A* expands no state that costs more than the plan, and looks one action further.
        """
        cost = abs(Fraction(metric - self.offset)) * abs(self.scale)
        return cost + max(self.costs, default=0) < 1 << bits

    @property
    def fits_32_bits(self) -> bool:
        """Whether a planner that adds in 32-bit integers cannot overflow on relaxed plans."""
        return sum(self.costs) < MAX_COST


def lower(task: Task) -> Lowering:
    """Return a task as grounded classical PDDL, in its sequential reading.

    Functions that no action changes are folded into the costs; rational costs are scaled to
    integers exactly; zero costs stay zero. ``total-time`` counts the actions of a classical task;
    a temporal metric's part in it is left out.

    Raises:
        UnsupportedError: if the metric is not a sum, or makes an action's cost negative (one that
            is to be maximized: positive); or if an end effect depends on what another start effect
            decides.

    >>> from hrcplan import ground
    >>> lowered = lower(ground("transport", "two-boxes"))
    >>> lowered.scale, lowered.exact_for_metric
    (1, False)
    >>> str(lowered.plan("(move--human--wp1--wp2)")).strip()
    '(move human wp1 wp2)'
    """
    metric = prices(task)
    _refuse_gains(task, metric.prices)
    scale = lcm(*(Fraction(price).denominator for price in metric.prices))
    costs = tuple(int(price * scale) for price in metric.prices)
    scale = -scale if task.problem.maximize else scale
    names = _Names(*KEYWORDS, task.problem.domain.name, task.problem.name)
    facts = [names.take(_fact_words(fact)) for fact in task.facts]
    actions = {names.take((a.name, *a.args)): a for a in task.actions}
    text = _Text(facts)
    return Lowering(
        domain_text=_lines(text.domain(task, actions, costs)),
        problem_text=_lines(text.problem(task)),
        actions=actions,
        costs=costs,
        scale=scale,
        offset=metric.offset,
        exact_for_metric=metric.exact,
        conditional=any(action.conditional for action in task.actions),
        facts=tuple(facts),
    )


@record
class Prices:
    """The metric as a price for every action, with the sign that is minimized, and a constant."""

    prices: Sequence[Number]
    offset: Number
    exact: bool


def prices(task: Task) -> Prices:
    """Return what each action adds to the metric; a negative price is for `lower` to refuse.

    Raises:
        UnsupportedError: if the metric is not a sum of costs, steps and constants.
    """
    problem = task.problem
    temporal = problem.domain.is_temporal
    initial_cost = problem.values.get((TOTAL_COST,), 0)
    if problem.metric is None:
        return Prices(_weigh(task, 1), initial_cost, not temporal)
    parts = linear(problem.metric, {})
    if parts is None:
        raise UnsupportedError(f"the metric {problem.metric} is not a weighted sum")
    weight = parts.get((TOTAL_COST,), 0)
    offset = weight * initial_cost
    for key, factor in parts.items():
        if key in ((TOTAL_COST,), (TOTAL_TIME,)) or not factor:
            continue
        if key and key[0] in problem.domain.changed_functions:
            raise UnsupportedError(f"the metric looks at ({' '.join(key)}), which actions change")
        if key and key not in problem.values:
            raise UnsupportedError(f"the metric looks at ({' '.join(key)}), which has no value")
        offset += factor * (problem.values[key] if key else 1)
    step = parts.get((TOTAL_TIME,), 0)
    if temporal and step and not weight:
        return Prices([a.duration or 0 for a in task.actions], offset, False)
    return Prices(_weigh(task, weight, 0 if temporal else step), offset, not (temporal and step))


def _weigh(task: Task, weight: Number, step: Number = 0) -> Sequence[Number]:
    """Return what each action adds to the metric, with the sign that is to be minimized."""
    sign = -1 if task.problem.maximize else 1
    return [sign * (weight * cost + step) for cost in task.costs]


def _refuse_gains(task: Task, prices: Sequence[Number]) -> None:
    """Raise if an action improves the metric, or if one may that the ground task leaves out."""
    for action, price in zip(task.actions, prices, strict=True):
        if price < 0:
            cannot = f"{action} costs {decimal_text(price)}; negative costs cannot be lowered"
            if task.problem.maximize:
                cannot = f"{action} adds {decimal_text(-price)} to the metric, which is maximized"
            raise UnsupportedError(cannot, hint=_SMALL)
    idle = idle_gain(task.problem, task.value_sets)
    if idle is not None:
        raise UnsupportedError(
            f"'{idle.name}' may improve the metric and change nothing else", hint=_SMALL
        )


class _Names:
    """Readable PDDL names, each given once: fact and action names never clash."""

    def __init__(self, *reserved_names: str) -> None:
        self._names = {"", *reserved_names}

    def take(self, words: Sequence[str]) -> str:
        """Return a new name made of words."""
        stem = "--".join(_ODD.sub("_", word) for word in words)
        if not stem[:1].isalpha():
            stem = f"x-{stem}"
        name, count = stem, 1
        while name in self._names:
            count += 1
            name = f"{stem}--v{count}"
        self._names.add(name)
        return name


def _fact_words(fact: Sequence[str]) -> Sequence[str]:
    return (*fact[1:-1], "is", fact[-1]) if fact[0] == "=" else fact


def _lines(lines: Iterable[str]) -> str:
    return "".join(f"{line}\n" for line in lines)


@dataclass(frozen=True)
class _Text:
    """Bits as PDDL, with the names of the facts."""

    facts: Sequence[str]

    def domain(
        self, task: Task, actions: Mapping[str, GroundAction], costs: Sequence[int]
    ) -> Iterator[str]:
        flags = [":strips", ":negative-preconditions", ":action-costs"]
        if any(len(a.tests) > 1 for a in actions.values()) or len(task.goal) > 1:
            flags.append(":disjunctive-preconditions")
        if any(action.conditional for action in actions.values()):
            flags += [":conditional-effects", ":disjunctive-preconditions"]
        yield f"(define (domain {task.problem.domain.name})"
        yield f"  (:requirements {' '.join(dict.fromkeys(flags))})"
        yield "  (:predicates"
        yield from (f"    ({name})" for name in self.facts)
        if not task.goal or not self.facts:
            yield "    (never)"
        yield "  )"
        yield _FUNCTIONS.rstrip()
        for (name, action), cost in zip(actions.items(), costs, strict=True):
            yield f"  (:action {name}"
            yield "    :parameters ()"
            yield f"    :precondition {self._tests(action.tests)}"
            effects = " ".join([*self._effects(action), f"(increase (total-cost) {cost})"])
            yield f"    :effect (and {effects}))"
        yield ")"

    def problem(self, task: Task) -> Iterator[str]:
        yield f"(define (problem {task.problem.name})"
        yield f"  (:domain {task.problem.domain.name})"
        yield "  (:init"
        yield from (f"    {atom}" for atom in self._atoms(task.initial))
        yield _START.rstrip()
        yield "  )"
        yield f"  (:goal {self._tests(task.goal) if task.goal else '(and (never))'})"
        yield _METRIC.rstrip()
        yield ")"

    def _atoms(self, bits: int) -> Iterator[str]:
        return (f"({self.facts[position]})" for position in positions(bits))

    def _literals(self, mask: int, value: int) -> str:
        wrong = (f"(not {atom})" for atom in self._atoms(mask & ~value))
        return f"({' '.join(['and', *self._atoms(value), *wrong])})"

    def _tests(self, tests: Sequence[Test]) -> str:
        each = [self._literals(*test) for test in tests]
        return each[0] if len(each) == 1 else f"({' '.join(['or', *each])})"

    def _effects(self, action: GroundAction) -> Iterator[str]:
        yield from self._atoms(action.adds)
        yield from (f"(not {atom})" for atom in self._atoms(action.deletes))
        if action.conditional:
            for change in unsure_changes(action):
                parts = [*self._atoms(change.adds)]
                parts += [f"(not {atom})" for atom in self._atoms(change.deletes & ~change.adds)]
                yield f"(when {self._tests(change.tests)} (and {' '.join(parts)}))"
