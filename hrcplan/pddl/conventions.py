"""The conventions that bind hrcplan to a collaborative domain; a broken one is a warning.

A domain is collaborative if it has a type ``agent``. An *agent state* is a function whose first
parameter is an agent and that occurs in a cost.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hrcplan.core.text import quote
from hrcplan.pddl.model import TOTAL_COST, Action, Domain, Effect, Function, Param, Problem
from hrcplan.pddl.reader import GroupNode, ParseNode
from hrcplan.pddl.source import SourceText
from hrcplan.pddl.walks import functions_in

AGENT = "agent"
ROBOT = "robot"
CONTROLLABLE = "controllable"
MARK_ROBOTS = f"mark an agent with ({CONTROLLABLE} AGENT) in :init, or call it {ROBOT}"
"""The hint where no agent is a robot."""
_INTERACTIONS = frozenset(["decrease", "assign"])


def robots(problem: Problem) -> frozenset[str]:
    """Return the agents that take commands: the controllable ones, else the one called robot."""
    controllable = frozenset(a for a in problem.agents if (CONTROLLABLE, a) in problem.facts)
    return controllable or frozenset({ROBOT}.intersection(problem.agents))


def people(problem: Problem) -> frozenset[str]:
    """Return the agents that take no commands: all that are not robots."""
    return frozenset(problem.agents) - robots(problem)


def check_domain(
    domain: Domain, actions: Sequence[tuple[GroupNode, Action]], source: SourceText
) -> None:
    """Warn about actions without an agent, and about changes that no interaction makes."""
    if AGENT not in domain.types:
        return
    states = agent_state_functions(domain)
    for node, action in actions:
        if not (action.params and _is_agent(domain, action.params[0])):
            message = f"the first parameter of {quote(action.name)} is not an agent"
            source.warn(node.at, "agent-first", message, "begin with '?a - agent'")
        for effect in action.effects:
            if _is_odd_change(effect, states):
                message = f"{quote(action.name)} makes {effect.target} {effect.kind}"
                hint = "an interaction decreases or assigns an agent state"
                at = _place(node, effect) or node.at
                source.warn(at, "agent-state-change", message, hint)


def check_problem(problem: Problem, at: int, source: SourceText) -> None:
    """Warn, at the offset of ``:init``, if agents are there and none of them is the robot."""
    if problem.agents and not robots(problem):
        message = f"no agent is marked ({CONTROLLABLE} …) and none is called '{ROBOT}'"
        source.warn(at, "no-robot", message, MARK_ROBOTS)


def agent_state_functions(domain: Domain) -> frozenset[str]:
    """Return the functions that are agent state: first parameter an agent, part of a cost."""
    return frozenset(
        function.name
        for action in domain.actions
        for effect in action.effects
        if isinstance(effect.target, Function) and effect.target.name == TOTAL_COST
        for function in functions_in(effect.value)
        if _of_agent(domain, function)
    )


def interactions(domain: Domain) -> frozenset[str]:
    """Return the names of the actions that change agent state."""
    states = agent_state_functions(domain)
    return frozenset(
        action.name
        for action in domain.actions
        if any(effect.target.name in states for effect in action.effects)
    )


def _of_agent(domain: Domain, function: Function) -> bool:
    signature = domain.functions.get(function.name)
    if signature is None or not signature.params:
        return False
    return _is_agent(domain, signature.params[0])


def _is_agent(domain: Domain, param: Param) -> bool:
    return all(domain.is_a(kind, (AGENT,)) for kind in param.types)


def _is_odd_change(effect: Effect, states: frozenset[str]) -> bool:
    changes = isinstance(effect.target, Function) and effect.target.name in states
    return changes and effect.kind not in _INTERACTIONS


def _place(node: ParseNode, effect: Effect) -> int | None:
    """Return the offset of the first tree below ``node`` that changes what the effect does."""
    places = (
        group.at
        for group in _groups(node)
        if group.head == effect.kind
        and len(group) > 1
        and isinstance(group[1], GroupNode)
        and group[1].head == effect.target.name
    )
    return next(places, None)


def _groups(node: ParseNode) -> Iterator[GroupNode]:
    if isinstance(node, GroupNode):
        yield node
        for part in node:
            yield from _groups(part)
