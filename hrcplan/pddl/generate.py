"""New problems from old ones: another goal, checked like a file."""

from __future__ import annotations

from dataclasses import replace

from hrcplan.errors import PddlError
from hrcplan.pddl.formulas import read_formula
from hrcplan.pddl.model import Problem
from hrcplan.pddl.reader import read_one
from hrcplan.pddl.scope import Scope
from hrcplan.pddl.source import Source, in_order


def with_goal(problem: Problem, goal: str, name: str) -> Problem:
    """Return ``problem`` under another name, with the goal that a PDDL text describes.

    Raises:
        PddlError: with every fault of the goal; its path is ``<goal>``.
    """
    source = Source("<goal>", goal)
    root = read_one(source)
    if root is not None and not source.has_errors:
        formula = read_formula(root, Scope(source, problem.domain, problem.all_objects, {}))
    if source.has_errors:
        raise PddlError(in_order(source.diagnostics))
    return replace(problem, goal=formula, name=name, path="")
