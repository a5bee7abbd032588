"""New problems from old ones: another goal, checked like a file."""

from __future__ import annotations

from dataclasses import replace

from hrcplan.errors import PddlError
from hrcplan.pddl.formulas import read_formula
from hrcplan.pddl.model import Problem
from hrcplan.pddl.reader import read_nodes
from hrcplan.pddl.scope import Scope
from hrcplan.pddl.source import Source, in_order


def with_goal(problem: Problem, goal: str, name: str) -> Problem:
    """Return ``problem`` under another name, with the goal that a PDDL text describes.

    Raises:
        PddlError: with every fault of the goal; its path is ``<goal>``.
    """
    source = Source("<goal>", goal)
    nodes = read_nodes(source)
    if len(nodes) != 1:
        at = nodes[1].at if nodes else 0
        source.error(at, "not-a-goal", "a goal is one condition, such as (and (p a) (q b))")
    scope = Scope(source, problem.domain, problem.all_objects, {})
    parts = tuple(read_formula(node, scope) for node in nodes)
    if source.has_errors:
        raise PddlError(in_order(source.diagnostics))
    return replace(problem, goal=parts[0], name=name, path="")
