"""A collaboration from its goals to its end: what ``hrcplan collaborate`` does, as functions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from hrcplan.agents import load_profile
from hrcplan.assistance.assistant import Assistant, KnowsGoal
from hrcplan.assistance.registry import ASSISTANTS
from hrcplan.bank import Bank
from hrcplan.bank.team_moves import team_moves
from hrcplan.collaboration.adviser import Adviser
from hrcplan.collaboration.companion import Companion
from hrcplan.collaboration.events import SHARED_QUESTIONS, SharedCommand, SharedEvent
from hrcplan.collaboration.persons import CooperativePerson, Person, SimulatedPerson
from hrcplan.collaboration.run import CompanionRun
from hrcplan.collaboration.setup import (
    PACES,
    TURNS,
    CollaborationSetup,
    plain_goals,
    slots_of,
)
from hrcplan.collaboration.world import SharedWorld
from hrcplan.core.text import nearest
from hrcplan.episodes.humans import HUMANS, Course
from hrcplan.errors import UsageError
from hrcplan.execution.driver import Driver, NullRecord, RunRecord
from hrcplan.execution.worlds.simulated import Nature

CollaborationWatch = Callable[[CompanionRun, SharedEvent, tuple[SharedCommand, ...]], None]
ROBOT = "hrcplan"


def make_setup(
    bank: Bank, *, pace: str = TURNS, method: str = ROBOT, profile: str = "hrcplan", seed: int = 0,
    human: dict[str, Any] | None = None,
) -> CollaborationSetup:  # fmt: skip
    """Return what a collaboration depends on.

    Args:
        bank: The plans of its goals.
        pace: ``turns`` or ``free``.
        method: The name of the assistant, or ``module:Class``.
        profile: Which values planners get, and when to replan, if there is one goal only.
        seed: All random draws of a simulated human follow from it.
        human: Who the people are, as JSON.

    Raises:
        UsageError: if a name is unknown, or there is no human or no robot.
        UnsupportedError: if the problem has a construct that an execution cannot hold.
    """
    if pace not in PACES:
        hint = nearest(pace, PACES) or " or ".join(PACES)
        raise UsageError(f"there is no pace '{pace}'", code="unknown-pace", hint=hint)
    ASSISTANTS.find(method)
    problem, goals = plain_goals(bank.goals)
    team = bank.team if team_moves(bank) is not None else ()
    return CollaborationSetup(
        problem, goals, load_profile(profile), pace, slots_of(bank.goals, team), method,
        human or {}, seed,
    )  # fmt: skip


@dataclass
class CollaborationParts:
    """What carries one collaboration out: the machine, who advises it, and the world.

    Attributes:
        setup: What it depends on.
        bank: The plans.
        adviser: Answers the machine's questions.
        world: Where it happens.
    """

    setup: CollaborationSetup
    bank: Bank
    adviser: Adviser
    world: SharedWorld

    def run(
        self, record: RunRecord | None = None, watch: CollaborationWatch | None = None
    ) -> CompanionRun:
        """Return the finished run."""

        def all_of(
            run: CompanionRun, event: SharedEvent, commands: tuple[SharedCommand, ...]
        ) -> None:
            self.adviser.watch(run, event, commands)
            self.world.watch(run, event, commands)
            if watch is not None:
                watch(run, event, commands)

        return Driver(
            Companion(self.setup), self.world, self.adviser, record or NullRecord(), all_of,
            SHARED_QUESTIONS,
        ).run()  # fmt: skip


def assistant_of(setup: CollaborationSetup) -> Callable[[Bank], Assistant[Any]]:
    """Return what makes the assistant of a collaboration from its bank."""
    return lambda bank: ASSISTANTS.make(setup.method, bank)


def simulated(
    setup: CollaborationSetup, bank: Bank, course: Course, human: str = "frontier",
    make_assistant: Callable[[Bank], Assistant[Any]] | None = None, nature: Nature | None = None,
) -> CollaborationParts:  # fmt: skip
    """Return the parts of a collaboration with a simulated human of turn-taking episodes."""
    adviser = Adviser(setup, bank, make_assistant or assistant_of(setup))
    if setup.has_one_goal:
        return parts_with(setup, bank, adviser, CooperativePerson(), nature)
    tells = isinstance(adviser.assistant, KnowsGoal)
    person = SimulatedPerson(setup, bank, HUMANS.make(human, bank, course), course, tells)
    return parts_with(setup, bank, adviser, person, nature)


def parts_with(
    setup: CollaborationSetup, bank: Bank, adviser: Adviser, person: Person,
    nature: Nature | None = None,
) -> CollaborationParts:  # fmt: skip
    """Return the parts of a collaboration with somebody who acts for the people."""
    world = SharedWorld(setup, nature or Nature(setup.seed), person)
    return CollaborationParts(setup, bank, adviser, world)
