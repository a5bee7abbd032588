"""Which values that its actions can need does a problem not set, and is a duration below zero?

PDDL 2.1 lets a function be without a value: what reads it cannot run (or is false), so a table of
the distances that exist is right. A gap is a warning all the same, since it may be forgotten.

An action needs a function only for objects that its parameters can stand for: bindings that the
types, the facts that no action changes, or an (in)equality rule out are not looked at.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Set
from functools import cached_property
from itertools import islice, product
from math import prod

from hrcplan.core.records import record, replace
from hrcplan.core.text import quote
from hrcplan.pddl.joins import FactIndex, Join, needed_atoms
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
    Compare,
    Constant,
    Equal,
    Expr,
    FluentKey,
    Formula,
    Function,
    Not,
    Or,
    Param,
    Problem,
    Quantified,
)
from hrcplan.pddl.semantics import (
    Binding,
    LiftedState,
    Undefined,
    evaluate,
    ground_key,
    holds,
    instances,
)
from hrcplan.pddl.source import SourceText
from hrcplan.pddl.walks import conjuncts, formula_functions, functions_in

MAX_BINDINGS = 20_000  # looked at per action; beyond that a gap is found when the task is grounded
MAX_REPORTS = 20
_SPECIAL = frozenset([CONTINUOUS, DURATION, TOTAL_COST, TOTAL_TIME, VIOLATED])


def check_values(
    problem: Problem, at: int, places: Mapping[FluentKey, int], source: SourceText
) -> None:
    """Report functions without a value, and durations below zero.

    ``at`` is the offset of ``:init``; ``places`` says where each value is set.
    """
    checker = _Checker(problem)
    gaps: dict[str, dict[FluentKey, str]] = {}
    for key, user in checker.unset():
        gaps.setdefault(key[0], {})[key] = user
    for name, unset in gaps.items():
        _report_gaps(name, unset, at, source)
    _check_goal_and_metric(problem, checker.later, at, source)
    negative = dict(checker.negative_durations())
    for key, user in islice(negative.items(), MAX_REPORTS):
        message = f"{user} lasts less than nothing"
        source.error(places.get(key, at), "negative-duration", message)


def _report_gaps(name: str, unset: Mapping[FluentKey, str], at: int, source: SourceText) -> None:
    """Warn once about all values of one function that some action can need."""
    (key, user), n_more = next(iter(unset.items())), len(unset) - 1
    example = f"({' '.join(key)})"
    more = f" and {n_more} more values of {quote(name)} are" if n_more else " is"
    message = f"{quote(example)}{more} not set: {user} cannot run where it needs one"
    source.warn(at, "unset-function", message, f"add (= {example} NUMBER) unless that is meant")


def _check_goal_and_metric(problem: Problem, later: Set[str], at: int, source: SourceText) -> None:
    for function in formula_functions(problem.goal):
        key = (function.name, *function.args)
        bound = any(arg.startswith("?") for arg in function.args)
        if not bound and key not in problem.values and function.name not in later:
            message = f"{quote(str(function))} is not set, so the goal cannot hold"
            source.warn(at, "unset-function", message, f"add (= {function} NUMBER)")
    for function in functions_in(problem.metric):
        key = (function.name, *function.args)
        if key not in problem.values and function.name not in later:
            message = f"{quote(str(function))} is not set, but the metric needs it"
            source.error(at, "unset-function", message, f"add (= {function} NUMBER)")


@record
class _Need:
    """A function that an action reads, for all instances of ``params``, if ``given`` holds."""

    function: Function
    params: tuple[Param, ...] = ()
    condition: Formula = TRUE


class _Checker:
    """One problem, with what no action changes."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        effects = [effect for action in problem.domain.actions for effect in action.effects]
        self.changing = {e.target.name for e in effects if e.value is None}
        # What an action assigns may be unset until then.
        self.later = {e.target.name for e in effects if e.kind == "assign"} | _SPECIAL

    @cached_property
    def static(self) -> FactIndex:
        return FactIndex(fact for fact in self.problem.facts if fact[0] not in self.changing)

    @cached_property
    def state(self) -> LiftedState:
        return LiftedState(self.static.facts, self.problem.values)

    def unset(self) -> Iterator[tuple[FluentKey, str]]:
        """Yield functions without a value, and who needs them; some more than once."""
        values = self.problem.values
        for action in self.problem.domain.actions:
            gaps = [need for need in _needs(action) if self._may_be_unset(need, action)]
            for key in self._keys(action, gaps):
                if key not in values:
                    yield key, f"action {quote(action.name)}"

    def negative_durations(self) -> Iterator[tuple[FluentKey, str]]:
        """Yield a function behind a negative duration, and such a ground action."""
        for action in self.problem.domain.actions:
            for op, duration in action.durations:
                if op != ">=" and self._may_be_negative(duration):
                    yield from self._negative(action, duration)

    def _negative(self, action: Action, duration: Expr) -> Iterator[tuple[FluentKey, str]]:
        functions = list(functions_in(duration))
        names = {arg for function in functions for arg in function.args}
        for binding in self._bindings(action, names):
            try:
                value = evaluate(duration, self.problem.values, binding)
            except Undefined:
                continue
            if value < 0:
                full = next(instances(_unbound(action, binding), binding, self.problem))
                words = [action.name, *(full[param.name] for param in action.params)]
                yield ground_key(functions[0], binding), quote(f"({' '.join(words)})")

    def _may_be_negative(self, duration: Expr) -> bool:
        names = {function.name for function in functions_in(duration)}
        if not names or names & self.problem.domain.changed_functions:
            return False
        values = self.problem.values
        return _subtracts(duration) or any(v < 0 and k[0] in names for k, v in values.items())

    def _may_be_unset(self, need: _Need, action: Action) -> bool:
        """Whether any choice of objects that fits the types lacks a value."""
        function, values = need.function, self.problem.values
        if function.name in self.later:
            return False
        types = {param.name: param.types for param in (*action.params, *need.params)}
        options = [
            self.problem.objects_of(types[arg]) if arg in types else (arg,) for arg in function.args
        ]
        if prod(map(len, options)) > len(values):
            return True
        return any((function.name, *args) not in values for args in product(*options))

    def _keys(self, action: Action, needs: list[_Need]) -> Iterator[FluentKey]:
        if not needs:
            return
        names = {arg for need in needs for arg in need.function.args}
        names |= {name for need in needs for name in _variables(need.condition)}
        readings = (
            (need, inner)
            for binding in self._bindings(action, names)
            for need in needs
            for inner in instances(need.params, binding, self.problem)
        )
        for need, inner in islice(readings, MAX_BINDINGS):
            if not self._is_false(need.condition, inner):
                yield ground_key(need.function, inner)

    def _bindings(self, action: Action, wanted: set[str]) -> Iterator[Binding]:
        """Yield bindings of the wanted parameters (and those tied to them) that can occur."""
        if not all(self.problem.objects_of(param.types) for param in action.params):
            return
        atoms = [
            atom
            for atom in needed_atoms(action, self.problem.domain)
            if atom.name not in self.changing
        ]
        others = [
            part
            for condition in action.conditions
            for part in conjuncts(condition.formula)
            if not isinstance(part, Atom) and self._is_static(part)
        ]
        names = wanted.union(*(_variables(part) for part in (*atoms, *others)))
        tied = replace(action, params=tuple(p for p in action.params if p.name in names))
        bindings = Join(tied, atoms, self.problem).bindings(self.static)
        for binding in islice(bindings, MAX_BINDINGS):
            if not any(self._is_false(part, binding) for part in others):
                yield binding

    def _is_false(self, formula: Formula, binding: Binding) -> bool:
        """Whether a condition is false whatever the actions do."""
        return any(
            self._is_static(part) and not holds(part, self.state, binding, self.problem)
            for part in conjuncts(formula)
            if not isinstance(part, Compare) or self._has_values(part, binding)
        )

    def _has_values(self, part: Compare, binding: Binding) -> bool:
        """Whether a comparison can be made: one that cannot is a gap to report, not a reason."""
        keys = (ground_key(function, binding) for function in formula_functions(part))
        return all(key in self.problem.values for key in keys)

    def _is_static(self, formula: Formula) -> bool:
        has_static_atoms = self.changing.isdisjoint(a.name for a in _atoms(formula))
        changing = self.problem.domain.changed_functions
        return has_static_atoms and changing.isdisjoint(f.name for f in formula_functions(formula))


def _unbound(action: Action, binding: Binding) -> tuple[Param, ...]:
    return tuple(param for param in action.params if param.name not in binding)


def _needs(action: Action) -> Iterator[_Need]:
    """Yield the functions whose value the action reads."""
    for condition in action.conditions:
        for part in conjuncts(condition.formula):
            if isinstance(part, Compare):
                yield from map(_Need, formula_functions(part))
    for effect in action.effects:
        if isinstance(effect.target, Function):
            read = list(functions_in(effect.value))
            if effect.kind != "assign":
                read.append(effect.target)
            yield from (_Need(function, effect.params, effect.condition) for function in read)
    for _, duration in action.durations:
        yield from map(_Need, functions_in(duration))


def _subtracts(expression: Expr) -> bool:
    """Whether an expression could be below zero although no function in it is."""
    if isinstance(expression, Constant):
        return expression.value < 0
    if isinstance(expression, Arithmetic):
        return expression.op == "-" or any(map(_subtracts, expression.parts))
    return False


def _parts(formula: Formula) -> Iterator[Formula]:
    """Yield a formula and all formulas in it."""
    yield formula
    inner: Iterable[Formula] = ()
    if isinstance(formula, And | Or):
        inner = formula.parts
    elif isinstance(formula, Not | Quantified):
        inner = (formula.body,)
    for part in inner:
        yield from _parts(part)


def _atoms(formula: Formula) -> Iterator[Atom]:
    return (part for part in _parts(formula) if isinstance(part, Atom))


def _variables(formula: Formula) -> Iterator[str]:
    """Yield the arguments of a formula, bound ones and objects too."""
    for part in _parts(formula):
        if isinstance(part, Atom):
            yield from part.args
        elif isinstance(part, Equal):
            yield from (part.left, part.right)
    for function in formula_functions(formula):
        yield from function.args
