"""What a file may say and yet mean nothing: unset functions, negative durations, and the
conventions that bind hrcplan to a collaborative domain (those are warnings)."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from itertools import islice

from hrcplan.pddl.joins import FactIndex, Join, needed_atoms
from hrcplan.pddl.model import (
    TOTAL_COST,
    TOTAL_TIME,
    Action,
    Constant,
    Domain,
    Expr,
    FluentKey,
    Function,
    Problem,
    functions_in,
)
from hrcplan.pddl.reader import Group
from hrcplan.pddl.semantics import evaluate, ground_key
from hrcplan.pddl.source import Source

AGENT = "agent"
ROBOT = "robot"
MAX_BINDINGS = 20_000
MAX_REPORTS = 5


def check_domain(domain: Domain, root: Group, source: Source) -> None:
    """Warn about broken conventions of a collaborative domain; report negative durations."""
    for node, action in _with_nodes(domain, root):
        if AGENT in domain.types and not _agent_first(domain, action):
            message = f"the first parameter of '{action.name}' is not an agent"
            source.warn(node.at, "agent-first", message, "begin with '?a - agent'")
        for _, duration in action.durations:
            if isinstance(duration, Constant) and duration.value < 0:
                message = f"'{action.name}' lasts {duration}: less than nothing"
                source.error(node.at, "negative-duration", message)


def check_problem(problem: Problem, root: Group, source: Source) -> None:
    """Report functions that are needed but not set, and durations below zero."""
    section = next((n for n in root if isinstance(n, Group) and n.head == ":init"), root)
    static = _static_index(problem)
    reported: set[FluentKey] = set()
    for action in problem.domain.actions:
        for binding in islice(_bindings(problem, action, static), MAX_BINDINGS):
            missing = [k for k in _needed(problem, action, binding) if k not in reported]
            for key in missing:
                reported.add(key)
                if len(reported) <= MAX_REPORTS:
                    message = f"({' '.join(key)}) is not set, but '{action.name}' needs it"
                    hint = f"add (= ({' '.join(key)}) NUMBER)"
                    source.error(section.at, "unset-function", message, hint)
            if not missing:
                _check_duration(problem, action, binding, section, source)
    if len(reported) > MAX_REPORTS:
        message = f"{len(reported) - MAX_REPORTS} more functions are not set"
        source.error(section.at, "unset-function", message)
    for key in _unset_metric(problem):
        source.error(section.at, "unset-function", f"the metric needs ({' '.join(key)})")
    if problem.agents and not _has_robot(problem):
        message = "no agent is marked (controllable …) and none is called 'robot'"
        source.warn(section.at, "no-robot", message)


def _with_nodes(domain: Domain, root: Group) -> Iterator[tuple[Group, Action]]:
    actions = {action.name: action for action in domain.actions}
    for node in root:
        if isinstance(node, Group) and node.head in (":action", ":durative-action"):
            name = node[1] if len(node) > 1 else None
            if isinstance(name, str) and name in actions:
                yield node, actions[name]


def _agent_first(domain: Domain, action: Action) -> bool:
    return bool(action.params) and all(domain.is_a(t, (AGENT,)) for t in action.params[0].types)


def _has_robot(problem: Problem) -> bool:
    return ROBOT in problem.agents or any(f[0] == "controllable" for f in problem.facts)


def _static_index(problem: Problem) -> FactIndex:
    changed = _changed_predicates(problem.domain)
    return FactIndex(fact for fact in problem.facts if fact[0] not in changed)


def _changed_predicates(domain: Domain) -> frozenset[str]:
    return frozenset(
        effect.target.name
        for action in domain.actions
        for effect in action.effects
        if effect.kind in ("add", "delete")
    )


def _bindings(problem: Problem, action: Action, static: FactIndex) -> Iterator[dict[str, str]]:
    changed = _changed_predicates(problem.domain)
    atoms = [atom for atom in needed_atoms(action) if atom.name not in changed]
    return Join(action, atoms, problem).bindings(static)


def _expressions(action: Action) -> Iterator[Expr]:
    for effect in action.effects:
        if effect.value is not None and not effect.params:
            yield effect.value
        if isinstance(effect.target, Function) and effect.target.name != TOTAL_COST:
            if effect.kind != "assign" and not effect.params:
                yield effect.target
    for _, duration in action.durations:
        yield duration


def _needed(problem: Problem, action: Action, binding: dict[str, str]) -> Iterator[FluentKey]:
    for expression in _expressions(action):
        for function in functions_in(expression):
            key = ground_key(function, binding)
            if key not in problem.values and function.name not in ("?duration", TOTAL_COST):
                yield key


def _unset_metric(problem: Problem) -> Iterator[FluentKey]:
    for function in functions_in(problem.metric):
        key = (function.name, *function.args)
        if key not in problem.values and function.name not in (TOTAL_COST, TOTAL_TIME):
            yield key


def _check_duration(
    problem: Problem, action: Action, binding: dict[str, str], section: Group, source: Source
) -> None:
    changed = problem.domain.changed_functions
    for op, duration in action.durations:
        if op == ">=" or any(f.name in changed for f in functions_in(duration)):
            continue
        value = evaluate(duration, problem.values, binding)
        if value < Fraction(0):
            shown = " ".join([action.name, *binding.values()])
            message = f"({shown}) lasts {value}: less than nothing"
            source.error(section.at, "negative-duration", message)
            return
