"""What of a domain one problem can use at all."""

from __future__ import annotations

from dataclasses import replace

from hrcplan.pddl.joins import needed_atoms
from hrcplan.pddl.model import Problem


def possible(problem: Problem) -> Problem:
    """Return a problem whose domain has no action that needs what nothing ever makes true.

    Planners search differently when actions are declared that never run, so an extension of a
    domain that a problem does not use would change plans; without them it does not.

    >>> from hrcplan.facade import load_problem
    >>> len(possible(load_problem("transport", "two-boxes")).domain.actions)
    4
    """
    domain = problem.domain
    actions = domain.actions
    while True:
        known = {fact[0] for fact in problem.facts}
        known.update(e.target.name for a in actions for e in a.effects if e.kind == "add")
        left = tuple(a for a in actions if all(atom.name in known for atom in needed_atoms(a)))
        if len(left) == len(actions):
            break
        actions = left
    if len(actions) == len(domain.actions):
        return problem
    return replace(problem, domain=replace(domain, actions=actions))
