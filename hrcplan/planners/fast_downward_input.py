"""What Fast Downward is given: the files as they are where it reads them, else the lowered task.

It finds invariants in the files that a ground task no longer shows, and searches faster with them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from hrcplan.core.numbers import Number
from hrcplan.core.records import record
from hrcplan.errors import UnsupportedError
from hrcplan.pddl.dialect import with_effects, without_numbers
from hrcplan.pddl.inlining import remaining
from hrcplan.pddl.model import (
    TOTAL_COST,
    TRUE,
    And,
    Atom,
    Constant,
    Effect,
    Equal,
    Formula,
    Function,
    Not,
    Problem,
)
from hrcplan.pddl.semantics import LiftedState, holds
from hrcplan.pddl.walks import compares
from hrcplan.pddl.write import domain_text, problem_text
from hrcplan.planners.contract import Request
from hrcplan.planners.handover import Handover
from hrcplan.planners.lowering import Lowering, lower
from hrcplan.plans import Plan, parse_plan

_REQUIREMENTS = frozenset({
    ":strips", ":adl", ":typing", ":equality", ":negative-preconditions", ":action-costs",
    ":disjunctive-preconditions", ":existential-preconditions", ":universal-preconditions",
    ":quantified-preconditions", ":conditional-effects", ":derived-predicates",
})  # fmt: skip
"""What Fast Downward lets a domain require; it refuses others, used or not."""
_MAX_INT = 2**31
_MAX_PRICE = _MAX_INT // 10**6  # no heuristic value of a lifted task overflows then


@record
class DownwardInput:
    """Two texts, and what an answer about them means.

    ``exact``: the cost is the problem's metric, and fits into 32 bits on the way to any plan.
    ``proof`` is the strongest search with an admissible heuristic. ``solved``: nothing is to do.
    """

    domain: str
    problem: str
    lowering: Lowering | None
    exact: bool
    proof: str
    is_solved: bool = False
    handover: Handover | None = None

    def plan(self, text: str) -> Plan:
        """Return Fast Downward's plan in the names of the task."""
        if self.lowering is not None:
            return self.lowering.plan(text)
        return parse_plan(text) if self.handover is None else self.handover.plan(text)

    def objective(self, cost: int, problem: Problem) -> Number | None:
        """Return the problem's metric of a plan with this cost; None where it is another thing."""
        if self.lowering is not None:
            return self.lowering.objective(cost)
        return cost + problem.values.get((TOTAL_COST,), 0) if self.exact else None

    def is_safe(self, cost: int) -> bool:
        """Return whether nothing that leads to a plan of this cost exceeds 32 bits.

        No expanded node has a larger g, and no generated one is more than an action above it.
        """
        most = max(self.lowering.costs, default=0) if self.lowering is not None else _MAX_PRICE
        return cost + most < _MAX_INT


def downward_input(request: Request) -> DownwardInput:
    """Return what Fast Downward is to be given for a request.

    Raises:
        UnsupportedError: if it cannot hold the task in either form.
        LimitError: if the task cannot be grounded within the limits, and has to be.
    """
    problem = request.problem
    lifted_input = _lifted_input(Handover.of(problem))
    if remaining(problem):
        if lifted_input is None:
            raise UnsupportedError("fast-downward knows no numbers with derived predicates")
        return lifted_input
    if lifted_input is not None and lifted_input.exact:
        return lifted_input
    needs_costs = not request.any_plan or (request.improves and request.ground_quickly())
    if lifted_input is not None and not needs_costs:
        return lifted_input  # without costs, but without the wait
    return grounded_input(request)


def grounded_input(request: Request) -> DownwardInput:
    """Return the lowered task, in which costs are whole numbers.

    Raises:
        UnsupportedError: if it cannot be lowered, or costs exceed 32 bits.
        LimitError: if the task cannot be grounded within the limits.
    """
    task = request.task
    lowering = lower(task)
    if not lowering.fits_32_bits:
        message = f"costs in whole numbers (times {abs(lowering.scale)}) exceed 32-bit integers"
        raise UnsupportedError(message, hint="round the function values, or use enhsp, kairos")
    proof = "astar(hmax())" if lowering.conditional else "astar(lmcut())"
    if len(task.goal) > 1:  # becomes an axiom, with which no heuristic here is admissible
        proof = "astar(blind())"
    exact = lowering.exact_for_metric and not request.problem.domain.is_temporal
    # An empty goal becomes an axiom in there.
    is_solved = task.is_goal(task.initial)
    return DownwardInput(
        lowering.domain_text, lowering.problem_text, lowering, exact, proof, is_solved
    )  # fmt: skip


def _lifted_input(handover: Handover) -> DownwardInput | None:
    """Return a task in its own files; None if it has numbers other than costs, or time."""
    problem = handover.problem
    domain = problem.domain
    if domain.is_temporal or any(compares(formula) for formula in _formulas(problem)):
        return None
    prices = list(_prices(problem))
    counts = TOTAL_COST in domain.functions
    plain = not problem.maximize and problem.metric in (None, Function(TOTAL_COST))
    exact = plain and all(price is not None for price in prices)
    exact = exact and not domain.changed_functions - {TOTAL_COST}
    if exact and counts:
        problem = replace(_costs_only(problem), metric=Function(TOTAL_COST))
    else:
        problem = without_numbers(problem)
    small = max((price for price in prices if price is not None), default=0) <= _MAX_PRICE
    known = tuple(flag for flag in problem.domain.requirements if flag in _REQUIREMENTS)
    texts = domain_text(replace(problem.domain, requirements=known)), problem_text(problem)
    return DownwardInput(
        *texts, None, exact and small, _proof(problem), _is_solved(problem), handover
    )  # fmt: skip


def _is_solved(problem: Problem) -> bool:
    """Whether the goal holds at once: one without any fact becomes an axiom in there."""
    initial = LiftedState(frozenset(problem.facts), {})
    return not problem.domain.axioms and holds(problem.goal, initial, {}, problem)


def _formulas(problem: Problem) -> Iterator[Formula]:
    yield problem.goal
    for action in problem.domain.actions:
        yield from (condition.formula for condition in action.conditions)
        yield from (effect.condition for effect in action.effects)
    yield from (axiom.body for axiom in problem.domain.axioms)


def _prices(problem: Problem) -> Iterator[int | None]:
    """Yield what actions may cost; None for a cost that Fast Downward cannot read."""
    for action in problem.domain.actions:
        for effect in action.effects:
            if effect.target.name == TOTAL_COST:
                yield from _price(effect, problem)


def _price(effect: Effect, problem: Problem) -> Iterator[int | None]:
    if effect.kind != "increase" or effect.condition != TRUE or effect.params:
        yield None
    match effect.value:
        case Constant(value):
            values = [value]
        case Function(name) if name not in problem.domain.changed_functions:
            values = [value for key, value in problem.values.items() if key[0] == name]
        case _:
            values = [-1]
    yield from (int(v) if v >= 0 and v.denominator == 1 else None for v in values)


def _costs_only(problem: Problem) -> Problem:
    """Return a problem with the functions that costs are made of, and no others."""
    domain = problem.domain
    names = {TOTAL_COST}
    for action in domain.actions:
        for effect in action.effects:
            if effect.target.name == TOTAL_COST and isinstance(effect.value, Function):
                names.add(effect.value.name)
    with_costs = with_effects(domain, lambda e: e.value is None or e.target.name == TOTAL_COST)
    functions = {name: f for name, f in domain.functions.items() if name in names}
    values = {key: value for key, value in problem.values.items() if key[0] in names}
    return replace(problem, domain=replace(with_costs, functions=functions), values=values)


def _proof(problem: Problem) -> str:
    """Return the strongest admissible search for what the files contain."""
    if problem.domain.axioms or not all(_is_simple(formula) for formula in _formulas(problem)):
        return "astar(blind())"  # the translator makes axioms, with which no other is admissible
    conditional = any(e.condition != TRUE for a in problem.domain.actions for e in a.effects)
    return "astar(hmax())" if conditional else "astar(lmcut())"


def _is_simple(formula: Formula) -> bool:
    """Return whether a condition is a conjunction of literals."""
    match formula:
        case Atom() | Equal():
            return True
        case Not(body):
            return isinstance(body, (Atom, Equal))
        case And(parts):
            return all(_is_simple(part) for part in parts)
    return False
