"""Functions without a value, for planners that do not know them: facts say where there is one.

Each function that some objects have no value of gets a predicate ``has-FUNCTION``. It holds where
the function has a value: from the start, or since an action has assigned one. What reads the
function asks for that fact first. So a planner that takes a missing value for 0, or for a fault,
has the same plans as hrcplan.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import count, islice, product

from hrcplan.pddl.model import (
    CONTINUOUS,
    DURATION,
    TOTAL_COST,
    TOTAL_TIME,
    TRUE,
    VIOLATED,
    Action,
    And,
    Arithmetic,
    Atom,
    Axiom,
    Compare,
    Condition,
    Constant,
    Constraint,
    Domain,
    Effect,
    Expr,
    FluentKey,
    Formula,
    Function,
    Not,
    Or,
    Problem,
    Quantified,
    Signature,
    TimedChange,
)
from hrcplan.pddl.walks import functions_in, with_parts

MAX_VALUES = 20_000
"""Missing values that are written as 0; of a function with more they stay missing."""

_SPECIAL = frozenset([CONTINUOUS, DURATION, TOTAL_COST, TOTAL_TIME, VIOLATED])


def guarded(problem: Problem, *, fills: bool = True) -> Problem:
    """Return a problem with the same plans in which nothing reads a function without a value.

    Nothing divides by zero either. It is the same object if there is nothing to guard. Values that
    are missing are written as 0; with ``fills=False`` only where an action may set them, which is
    enough for planners that first look at conditions that never change.
    """
    assigned = _assigned(problem)
    most = {f: MAX_VALUES if fills or f in assigned else 0 for f in problem.domain.functions}
    missing = {name: _missing(name, problem, most[name]) for name in problem.domain.functions}
    partial = [name for name, keys in missing.items() if keys and name not in _SPECIAL]
    never_zero = _never_zero(problem, partial)
    every = _Guards(_predicates(problem.domain, partial), never_zero)
    every.problem(problem)
    if not every.reads and not every.divides:
        return problem
    names = {name: guard for name, guard in every.names.items() if name in every.reads}
    result = _Guards(names, never_zero).problem(problem)
    keys = [key for name in names if len(missing[name]) <= most[name] for key in missing[name]]
    facts = {(names[key[0]], *key[1:]) for key in problem.values if key[0] in names}
    signatures = {
        guard: Signature(guard, problem.domain.functions[name].params)
        for name, guard in names.items()
    }
    return replace(
        result,
        domain=replace(result.domain, predicates={**result.domain.predicates, **signatures}),
        facts=problem.facts | facts,
        values={**problem.values, **dict.fromkeys(keys, 0)},
    )


def _assigned(problem: Problem) -> frozenset[str]:
    """Return the functions to which an action, an event or the time gives values."""
    domain = problem.domain
    actions = (*domain.actions, *domain.processes, *domain.events)
    effects = (effect for action in actions for effect in action.effects)
    names = (effect.target.name for effect in effects if effect.kind == "assign")
    return frozenset([*names, *(change.key[0] for change in problem.timed)])


def _missing(name: str, problem: Problem, most: int) -> Sequence[FluentKey]:
    """Return instances of a function without a value: all, or one more than ``most``."""
    choices = (problem.objects_of(param.types) for param in problem.domain.functions[name].params)
    keys = ((name, *args) for args in product(*choices))
    return list(islice((key for key in keys if key not in problem.values), most + 1))


def _predicates(domain: Domain, names: Sequence[str]) -> dict[str, str]:
    """Return a predicate for each function, with a name that is not in use."""
    names_in_use = set(domain.predicates)
    guards: dict[str, str] = {}
    for name in names:
        numbered = (f"has-{name}{'' if i == 1 else f'-{i}'}" for i in count(1))
        guards[name] = next(guard for guard in numbered if guard not in names_in_use)
        names_in_use.add(guards[name])
    return guards


def _never_zero(problem: Problem, partial: Sequence[str]) -> frozenset[str]:
    """Return the functions that have a value other than 0 for all objects, at all times."""
    domain = problem.domain
    zero = {key[0] for key, value in problem.values.items() if value == 0}
    zero |= {change.key[0] for change in problem.timed}
    actions = (*domain.actions, *domain.processes, *domain.events)
    zero |= {effect.target.name for action in actions for effect in action.effects}
    return frozenset(domain.functions).difference(zero, partial, _SPECIAL)


@dataclass
class _Guards:
    """Conditions, effects and axioms with guards, and which guards these have needed so far."""

    names: Mapping[str, str]
    never_zero: frozenset[str]
    reads: set[str] = field(default_factory=set)
    divides: bool = False

    def problem(self, problem: Problem) -> Problem:
        domain = problem.domain
        guarded_domain = replace(
            domain,
            actions=tuple(map(self._action, domain.actions)),
            processes=tuple(map(self._action, domain.processes)),
            events=tuple(map(self._action, domain.events)),
            axioms=tuple(map(self._axiom, domain.axioms)),
            constraints=tuple(map(self._constraint, domain.constraints)),
        )
        wishes = (replace(p, formula=self._formula(p.formula)) for p in problem.preferences)
        return replace(
            problem,
            domain=guarded_domain,
            goal=self._formula(problem.goal),
            timed=tuple(change for t in problem.timed for change in self._timed(t)),
            preferences=tuple(wishes),
            constraints=tuple(map(self._constraint, problem.constraints)),
        )

    def _formula(self, formula: Formula, positive: bool = True) -> Formula:
        """Return a condition; one that reads a missing value is false, and so is its negation."""
        match formula:
            case Compare(_, left, right):
                needs = self._needs(left, right)
                if not needs:
                    return formula
                if positive:
                    return And((*needs, formula))
                return Or((*map(_negation, needs), formula))
            case Not(body):
                return Not(self._formula(body, not positive))
            case _:
                return with_parts(formula, lambda part: self._formula(part, positive))

    def _needs(self, *expressions: Expr | None) -> list[Formula]:
        """Return what must hold before expressions can be evaluated."""
        needs: list[Formula] = []
        for expression in expressions:
            needs += (self._has(f) for f in functions_in(expression) if f.name in self.names)
            for divisor in _divisors(expression):
                if not (isinstance(divisor, Function) and divisor.name in self.never_zero):
                    needs.append(Not(Compare("=", divisor, Constant(0))))
                    self.divides = True
        return list(dict.fromkeys(needs))

    def _has(self, function: Function) -> Atom:
        self.reads.add(function.name)
        return Atom(self.names[function.name], function.args)

    def _action(self, action: Action) -> Action:
        conditions = [replace(c, formula=self._formula(c.formula)) for c in action.conditions]
        lasts = self._needs(*(duration for _, duration in action.durations))
        if lasts:
            conditions.append(Condition("start", And(tuple(lasts))))
        effects: list[Effect] = []
        for effect in action.effects:
            new = replace(
                effect,
                condition=self._formula(effect.condition),
                start_condition=self._formula(effect.start_condition),
            )
            conditions += self._conditions(new, action)
            effects += (new, *self._definition(new))
        wishes = (replace(p, formula=self._formula(p.formula)) for p in action.preferences)
        return replace(
            action, conditions=tuple(dict.fromkeys(conditions)), effects=tuple(effects),
            preferences=tuple(wishes),
        )  # fmt: skip

    def _conditions(self, effect: Effect, action: Action) -> Iterator[Condition]:
        """Yield the condition without which an effect has no meaning.

        One that the start decides about cannot be said at the end; there its value is 0.
        """
        target, value = effect.target, effect.value
        if effect.kind == "scale-down" and isinstance(target, Function) and value is not None:
            value = Arithmetic("/", (target, value))
        needs = self._needs(value)
        if isinstance(target, Function) and effect.kind != "assign" and target.name in self.names:
            assigned = any(
                e.kind == "assign" and e.target == target and e.when == effect.when
                for e in action.effects
            )
            needs += [] if assigned else [self._has(target)]
        if needs and effect.start_condition == TRUE:
            body: Formula = And(tuple(needs))
            if effect.condition != TRUE:
                body = Or((_negation(effect.condition), body))
            if effect.params:
                body = Quantified(True, effect.params, body)
            yield Condition(effect.when, body)

    def _definition(self, effect: Effect) -> Iterator[Effect]:
        """Yield the effect on the guard of a function that gets a value."""
        target = effect.target
        if effect.kind == "assign" and isinstance(target, Function) and target.name in self.names:
            fact = Atom(self.names[target.name], target.args)
            yield replace(effect, kind="add", target=fact, value=None)

    def _axiom(self, axiom: Axiom) -> Axiom:
        return replace(axiom, body=self._formula(axiom.body))

    def _constraint(self, constraint: Constraint) -> Constraint:
        trajectories = (
            replace(t, parts=tuple(map(self._formula, t.parts))) for t in constraint.trajectories
        )
        return replace(constraint, trajectories=tuple(trajectories))

    def _timed(self, change: TimedChange) -> Iterator[TimedChange]:
        yield change
        if change.value is not None and change.key[0] in self.names:
            yield TimedChange(change.time, (self.names[change.key[0]], *change.key[1:]))


def _negation(formula: Formula) -> Formula:
    return formula.body if isinstance(formula, Not) else Not(formula)


def _divisors(expression: Expr | None) -> Iterator[Expr]:
    """Yield what an expression divides by, but for numbers other than 0."""
    if isinstance(expression, Arithmetic):
        if expression.op == "/":
            parts = expression.parts[1:]
            yield from (p for p in parts if not isinstance(p, Constant) or p.value == 0)
        for part in expression.parts:
            yield from _divisors(part)
