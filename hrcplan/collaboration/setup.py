"""What a collaboration depends on besides what happens in it: the first line of its journal."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from hrcplan.agents import Profile
from hrcplan.agents.profile import profile_from_table
from hrcplan.bank import Goals
from hrcplan.collaboration.robots import JOINT_ROBOTS
from hrcplan.core.json_values import DOCUMENT_FAULTS
from hrcplan.errors import InputError, UsageError
from hrcplan.execution.model import ExecutionModel
from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.conventions import MARK_ROBOTS, people, robots
from hrcplan.pddl.inlining import plain
from hrcplan.pddl.model import Formula, Problem
from hrcplan.pddl.semantics import LiftedState, holds
from hrcplan.pddl.source import SourceText
from hrcplan.pddl.write import (
    domain_text,
    problem_text,
    rounded_values,
    with_rounded_values,
)

TURNS, FREE = "turns", "free"
PACES = (TURNS, FREE)
Slots = tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class CollaborationSetup:
    """The goals, who acts when, and which robot helps.

    Attributes:
        problem: The problem of the first goal.
        goals: The goals by name, in order.
        profile: Which values planners get, if there is one goal only.
        pace: ``turns``, or ``free``: every agent begins at any time, and actions take their
            durations.
        slots: Who may act in which turn of a round; agents of one slot act for each other.
        method: The name of the assistant.
        human: Who the people are: ``me``, or a simulated human.
        seed: All random draws of a simulated human follow from it.
    """

    problem: Problem
    goals: Mapping[str, Formula]
    profile: Profile
    pace: str
    slots: Slots
    method: str = "hrcplan"
    human: Mapping[str, Any] = field(default_factory=dict)
    seed: int = 0

    @cached_property
    def model(self) -> ExecutionModel:
        """The problem, prepared for execution."""
        return ExecutionModel(self.problem)

    @cached_property
    def robots(self) -> frozenset[str]:
        """The agents that take commands."""
        return robots(self.problem)

    @cached_property
    def people(self) -> tuple[str, ...]:
        """The agents that take no commands, in the order of their turns."""
        humans = people(self.problem)
        return tuple(agent for slot in self.slots for agent in slot if agent in humans)

    @property
    def is_joint(self) -> bool:
        """Whether the robot weighs goal and agent state, and hears more than steps."""
        return self.method in JOINT_ROBOTS

    @property
    def has_one_goal(self) -> bool:
        """Whether there is nothing to guess, so that a plan is followed."""
        return len(self.goals) == 1

    def reached(
        self, state: LiftedState, goals: Mapping[str, Formula] | None = None
    ) -> frozenset[str]:
        """Return the goals that hold in a state: of the listed ones, or of others."""
        full = LiftedState(state.facts, {**self.problem.values, **state.values})
        return frozenset(
            name
            for name, goal in (self.goals if goals is None else goals).items()
            if holds(goal, full, {}, self.problem)
        )

    @cached_property
    def pddl_sha256(self) -> str:
        """A hash of domain and goals, as this package writes them."""
        texts = (domain_text(self.problem.domain), *self._goal_texts().values())
        return hashlib.sha256("\n".join(texts).encode()).hexdigest()

    def _goal_texts(self) -> dict[str, str]:
        return {
            name: problem_text(replace(self.problem, name=name, goal=goal))
            for name, goal in self.goals.items()
        }

    def to_json(self) -> dict[str, Any]:
        """Return the setup as a JSON object, complete in itself."""
        return {
            "kind": "collaboration",
            "domain": domain_text(self.problem.domain),
            "goals": self._goal_texts(),
            **({"values": values} if (values := rounded_values(self.problem)) else {}),
            "pddl_sha256": self.pddl_sha256,
            "profile": self.profile.to_json(),
            "pace": self.pace,
            "slots": [list(slot) for slot in self.slots],
            "method": self.method,
            "human": dict(self.human),
            "seed": self.seed,
        }


def slots_of(goals: Goals, team: tuple[str, ...]) -> Slots:
    """Return who may act in which turn: people first; one agent each where plans are team plans.

    Args:
        goals: The goals.
        team: The agents in the order of their turns; empty if plans do not say who acts.

    Raises:
        UsageError: if there is no human or no robot.
    """
    humans, machines = people(goals.problem), robots(goals.problem)
    for agents, who, hint in (
        (humans, "human", "an agent that is not (controllable ...)"),
        (machines, "robot", MARK_ROBOTS),
    ):
        if not agents:
            message = f"'{goals.problem.domain.name}' has no {who} to collaborate with"
            raise UsageError(message, code=f"no-{who}", hint=hint)
    if team:
        return tuple((agent,) for agent in team)
    agents_in_order = goals.problem.agents
    return (
        tuple(a for a in agents_in_order if a in humans),
        tuple(a for a in agents_in_order if a in machines),
    )


def plain_goals(goals: Goals) -> tuple[Problem, dict[str, Formula]]:
    """Return the problem of the first goal and all goals, without derived predicates."""
    by_name = zip(goals.names, goals.formulas, strict=True)
    problems = [plain(replace(goals.problem, name=n, goal=f)) for n, f in by_name]
    return problems[0], {problem.name: problem.goal for problem in problems}


def setup_in(table: Mapping[str, Any], path: str) -> CollaborationSetup:
    """Return the setup that the first line of a journal describes.

    Raises:
        InputError: if the line does not hold one.
    """
    try:
        domain = domain_in(SourceText("domain", table["domain"]))
        problems = [problem_in(domain, SourceText("problem", t)) for t in table["goals"].values()]
        first = with_rounded_values(problems[0], table.get("values", {}))
        first = replace(first, path="", domain=replace(domain, path=""))
        return CollaborationSetup(
            first,
            {problem.name: problem.goal for problem in problems},
            profile_from_table(table["profile"], path),
            str(table["pace"]),
            tuple(tuple(map(str, slot)) for slot in table["slots"]),
            str(table["method"]),
            dict(table["human"]),
            int(table["seed"]),
        )
    except DOCUMENT_FAULTS as error:
        message = f"the first line of the journal is no beginning: {error!r}"
        raise InputError(message, code="bad-journal", path=path, line=1) from None
