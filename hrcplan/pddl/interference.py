"""When two happenings of a plan interfere, so that a gap must separate them."""

from __future__ import annotations

from typing import NamedTuple

from hrcplan.pddl.model import Action, Fact, FluentKey, Formula, Problem
from hrcplan.pddl.semantics import Binding, ground_key, instances, mentions
from hrcplan.pddl.walks import functions_in

_ROLE = {"add": "add", "delete": "delete", "increase": "sum", "decrease": "sum"}


class Access(NamedTuple):
    """What one event reads and writes: facts, and functions (summed or otherwise changed)."""

    reads: frozenset[Fact]
    adds: frozenset[Fact]
    deletes: frozenset[Fact]
    function_reads: frozenset[FluentKey]
    sums: frozenset[FluentKey]
    assigns: frozenset[FluentKey]


def clash(a: Access, b: Access) -> Fact | None:
    """Return a fact or function about which two happenings interfere, or None.

    Fox and Long (2003), Definition 12: neither may write what the other reads, add what the
    other deletes, or assign what the other changes; increases of one function commute.
    """
    for one, other in ((a, b), (b, a)):
        facts = (one.reads | one.adds) & other.deletes | one.reads & other.adds
        writes = other.sums | other.assigns
        functions = one.function_reads & writes | one.assigns & writes
        if facts or functions:
            return min(facts | functions)
    return None


def depends(problem: Problem, a: Access, b: Access) -> bool:
    """Return whether the order of two events matters: they interfere, also by what is derived.

    One that writes what a derived predicate depends on comes before or after one that reads it.
    """
    if clash(a, b) is not None:
        return True
    if not problem.domain.axioms:
        return False
    for one, other in ((a, b), (b, a)):
        writes = {key[0] for part in (other.adds, other.deletes, other.sums, other.assigns)
                  for key in part}  # fmt: skip
        for name in {fact[0] for fact in one.reads} & problem.domain.derived:
            if not writes.isdisjoint(problem.domain.sources[name]):
                return True
    return False


def access(problem: Problem, action: Action, binding: Binding, when: str) -> Access:
    """Return what the ``start`` or ``end`` of an action under a binding reads and writes."""
    atoms: set[Fact] = set()
    functions: set[FluentKey] = set()

    def look(formula: Formula, bound: Binding) -> None:
        for is_fact, key in mentions(formula, bound, problem):
            (atoms if is_fact else functions).add(key)

    for condition in action.conditions:
        if condition.when == when:
            look(condition.formula, binding)
    if when == "start":
        functions.update(
            ground_key(f, binding) for _, d in action.durations for f in functions_in(d)
        )
        for effect in action.effects:
            for inner in instances(effect.params, binding, problem):
                look(effect.start_condition, inner)
    writes: dict[str, set[Fact]] = {role: set() for role in ("add", "delete", "sum", "assign")}
    for effect in action.effects:
        if effect.when != when:
            continue
        for inner in instances(effect.params, binding, problem):
            look(effect.condition, inner)
            functions.update(ground_key(f, inner) for f in functions_in(effect.value))
            writes[_ROLE.get(effect.kind, "assign")].add(ground_key(effect.target, inner))
    return Access(
        frozenset(atoms), frozenset(writes["add"]), frozenset(writes["delete"]),
        frozenset(functions), frozenset(writes["sum"]), frozenset(writes["assign"]),
    )  # fmt: skip
