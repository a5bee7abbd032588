"""New problems from old ones: another goal, more objects, other objects in a goal."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from hrcplan.errors import PddlError
from hrcplan.pddl.formulas import read_formula
from hrcplan.pddl.model import Atom, Equal, Fact, Formula, Problem
from hrcplan.pddl.reader import read_nodes
from hrcplan.pddl.scope import Scope
from hrcplan.pddl.source import SourceText, in_order
from hrcplan.pddl.walks import parts_of, with_parts


def with_goal(problem: Problem, goal: str, name: str) -> Problem:
    """Return ``problem`` under another name, with the goal that a PDDL text describes.

    Raises:
        PddlError: with every fault of the goal; its path is ``<goal>``.
    """
    source = SourceText("<goal>", goal)
    nodes = read_nodes(source)
    if len(nodes) != 1:
        at = nodes[1].at if nodes else 0
        source.error(at, "not-a-goal", "a goal is one condition, such as (and (p a) (q b))")
    scope = Scope(source, problem.domain, problem.all_objects, {})
    parts = tuple(read_formula(node, scope) for node in nodes)
    if source.has_errors:
        raise PddlError(in_order(source.diagnostics))
    return replace(problem, goal=parts[0], name=name, path="")


def with_copy(problem: Problem, old: str, new: str) -> Problem:
    """Return ``problem`` with an object ``new`` of which all is true that is true of ``old``.

    Facts and values that mention both another copy and ``old`` are copied too.
    """
    names = {old: new}
    facts = {_rename_fact(fact, names) for fact in problem.facts if old in fact[1:]}
    values = {_rename_fact(k, names): v for k, v in problem.values.items() if old in k[1:]}
    return replace(
        problem,
        objects={**problem.objects, new: problem.all_objects[old]},
        facts=problem.facts | facts,
        values={**problem.values, **values},
    )


def _rename_fact(fact: Fact, names: Mapping[str, str]) -> Fact:
    return (fact[0], *(names.get(word, word) for word in fact[1:]))


def rename(formula: Formula, names: Mapping[str, str]) -> Formula:
    """Return a formula with other objects in its atoms and equations; numbers stay as they are."""
    match formula:
        case Atom(name, args):
            return Atom(name, tuple(names.get(arg, arg) for arg in args))
        case Equal(left, right):
            return Equal(names.get(left, left), names.get(right, right))
        case _:
            return with_parts(formula, lambda part: rename(part, names))


def objects_in(formula: Formula) -> tuple[str, ...]:
    """Return the terms of a formula's atoms, each once, in order."""
    if isinstance(formula, Atom):
        return tuple(dict.fromkeys(formula.args))
    return tuple(dict.fromkeys(term for part in parts_of(formula) for term in objects_in(part)))
