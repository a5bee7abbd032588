"""Domains and problems that a test writes as text."""

from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.model import Problem
from hrcplan.pddl.source import SourceText


def problem_of(domain: str, problem: str) -> Problem:
    """Return the problem of two texts."""
    return problem_in(domain_in(SourceText("d.pddl", domain)), SourceText("p.pddl", problem))
