"""Derived predicates compiled away: each is replaced by the condition that it stands for.

That works for predicates that are not derived from themselves. Those that no action can change are
derived once, in the initial state, recursive ones too.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence, Set
from itertools import count

from hrcplan.core.records import record, replace
from hrcplan.errors import UnsupportedError
from hrcplan.pddl.axioms import levels, uses
from hrcplan.pddl.constructs import AXIOMS, EXECUTED, TIMED, constructs
from hrcplan.pddl.derivation import Derivation, substitute
from hrcplan.pddl.model import (
    Action,
    And,
    Atom,
    Axiom,
    Equal,
    Formula,
    Or,
    Problem,
    Quantified,
)
from hrcplan.pddl.semantics import LiftedState
from hrcplan.pddl.walks import lifted_names, with_parts


def plain(problem: Problem) -> Problem:
    """Return a problem that a ground task can hold: the same one, or without derived predicates.

    Raises:
        UnsupportedError: naming the construct that cannot be compiled away.
    """
    _refuse(problem, frozenset([AXIOMS]), "cannot be held by a ground task")
    return without_axioms(problem) if problem.domain.axioms else problem


def executable(problem: Problem) -> Problem:
    """Return a problem that can be executed: without derived predicates, if they can be inlined.

    Raises:
        UnsupportedError: naming the construct that an execution cannot hold.
    """
    _refuse(problem, EXECUTED, "cannot be executed")
    if not frozenset([AXIOMS, TIMED]).issuperset(constructs(problem)):
        return problem  # what else looks at derived predicates is not inlined
    try:
        return without_axioms(problem)
    except UnsupportedError:
        return problem  # they are evaluated in each state


def _refuse(problem: Problem, constructs_held: Set[str], what: str) -> None:
    for name in constructs(problem):
        if name not in constructs_held:
            commands = "'plan' and 'execute' hand" if name in EXECUTED else "'plan' hands"
            hint = f"{commands} them to planners that know them"
            raise UnsupportedError(f"{name} {what}", hint=hint)


def remaining(problem: Problem) -> frozenset[str]:
    """Return the constructs of a problem that cannot be compiled away, by name."""
    names = frozenset(constructs(problem))
    if names == {AXIOMS}:
        try:
            without_axioms(problem)
        except UnsupportedError:
            return names
        return frozenset()
    return names


def without_axioms(problem: Problem) -> Problem:
    """Return a problem that means the same and has no derived predicates.

    Raises:
        UnsupportedError: if a predicate that actions can change is derived from itself.
    """
    constant = _constant(problem)
    once = [axiom for axiom in problem.domain.axioms if axiom.name in constant]
    lasting = replace(problem, domain=replace(problem.domain, axioms=tuple(once)))
    if not problem.domain.axioms:
        return problem
    state = LiftedState(problem.facts, problem.values)
    facts = frozenset(Derivation(lasting).close(state).facts)
    rest = [axiom for axiom in problem.domain.axioms if axiom.name not in constant]
    inliner = _Inliner.of(rest, problem)
    actions = tuple(inliner.action(action) for action in problem.domain.actions)
    domain = replace(problem.domain, axioms=(), actions=actions)
    return replace(problem, domain=domain, facts=facts, goal=inliner.formula(problem.goal))


def _constant(problem: Problem) -> Set[str]:
    """Return the derived predicates that depend on nothing that an action can change."""
    domain = problem.domain
    changing = {e.target.name for action in domain.actions for e in action.effects}
    changing |= {change.key[0] for change in problem.timed}
    while True:
        more = {
            axiom.name
            for axiom in domain.axioms
            if axiom.name not in changing and not changing.isdisjoint(lifted_names(axiom.body))
        }
        if not more:
            return domain.derived - changing
        changing |= more


@record
class _Inliner:
    """Axioms without derived predicates in their bodies, by name."""

    axioms: Mapping[str, Sequence[Axiom]]
    problem: Problem
    numbers: Iterator[int]

    @classmethod
    def of(cls, axioms: Sequence[Axiom], problem: Problem) -> _Inliner:
        level = levels(axioms)
        inliner = cls({}, problem, count())
        bodies: dict[str, list[Axiom]] = {}
        for axiom in sorted(axioms, key=lambda a: level[a.name]):
            same = {name for name, other in level.items() if other == level[axiom.name]}
            if any(name in same for name, _ in uses(axiom.body)):
                message = f"'{axiom.name}' is derived from itself, which a ground task cannot hold"
                hint = "'plan' and 'execute' hand it to planners that know axioms"
                raise UnsupportedError(message, hint=hint)
            body = replace(inliner, axioms=bodies).formula(axiom.body)
            bodies.setdefault(axiom.name, []).append(replace(axiom, body=body))
        return replace(inliner, axioms=bodies)

    def action(self, action: Action) -> Action:
        """Return an action whose conditions name no derived predicate."""
        return replace(
            action,
            conditions=tuple(
                replace(c, formula=self.formula(c.formula)) for c in action.conditions
            ),
            effects=tuple(replace(e, condition=self.formula(e.condition)) for e in action.effects),
        )

    def formula(self, formula: Formula) -> Formula:
        """Return a condition with the bodies of axioms for its derived predicates."""
        match formula:
            case Atom(name) if name in self.axioms:
                bodies = [self._body(axiom, formula.args) for axiom in self.axioms[name]]
                return bodies[0] if len(bodies) == 1 else Or(tuple(bodies))
            case _:
                return with_parts(formula, self.formula)

    def _body(self, axiom: Axiom, args: Sequence[str]) -> Formula:
        """Return what an axiom says of some terms; its variables get names of their own."""
        body = self._rename(axiom.body)
        params = self.problem.domain.predicates[axiom.name].params
        if [p.types for p in params] == [p.types for p in axiom.params]:
            names = {param.name: arg for param, arg in zip(axiom.params, args, strict=True)}
            return substitute(body, names)
        fresh = tuple(replace(p, name=self._name(p.name)) for p in axiom.params)
        names = {old.name: new.name for old, new in zip(axiom.params, fresh, strict=True)}
        same = (Equal(new.name, arg) for new, arg in zip(fresh, args, strict=True))
        return Quantified(False, fresh, And((*same, substitute(body, names))))

    def _rename(self, formula: Formula) -> Formula:
        match formula:
            case Quantified(universal, params, body):
                fresh = tuple(replace(p, name=self._name(p.name)) for p in params)
                names = {old.name: new.name for old, new in zip(params, fresh, strict=True)}
                return Quantified(universal, fresh, substitute(self._rename(body), names))
            case _:
                return with_parts(formula, self._rename)

    def _name(self, name: str) -> str:
        return f"{name}-{next(self.numbers)}_"
