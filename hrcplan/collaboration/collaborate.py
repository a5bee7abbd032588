"""A collaboration from its goals to its end: what ``hrcplan collaborate`` does, as functions."""

from __future__ import annotations

import os
import random
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from hrcplan.agents import load_profile
from hrcplan.assistance.assistant import Assistant, KnowsGoal
from hrcplan.bank import Bank, Goals, StepTable, read_goals
from hrcplan.bank.cache import cached_bank
from hrcplan.bank.turn_moves import team_moves
from hrcplan.collaboration.adviser import Adviser
from hrcplan.collaboration.companion import Companion
from hrcplan.collaboration.events import KINDS, SHARED_QUESTIONS, SharedCommand, SharedEvent
from hrcplan.collaboration.journal import FORMAT, RecordedPerson, check_same_goals, setup_of
from hrcplan.collaboration.outcome import CollaborationOutcome, collaboration_outcome
from hrcplan.collaboration.persons import CooperativePerson, Person, SimulatedPerson
from hrcplan.collaboration.robots import ESTIMATED, JOINT_ROBOTS, assistant_maker, check_robot
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
from hrcplan.execution.journal import Journal, JournalWriter, open_journal
from hrcplan.execution.links import RobotLink, make_link
from hrcplan.execution.links.resumed import ResumedWorld
from hrcplan.execution.worlds.simulated import Nature

CollaborationWatch = Callable[[CompanionRun, SharedEvent, tuple[SharedCommand, ...]], None]
ROBOT = "hrcplan"
WITH_ROBOT = "with_robot"  # in a journal, about who is there: whether a robot's program is
ANSWERS = tuple(SHARED_QUESTIONS.values())


def make_setup(
    bank: Bank, *, pace: str = TURNS, method: str = ROBOT, profile: str | None = None,
    seed: int = 0, human: dict[str, Any] | None = None,
) -> CollaborationSetup:  # fmt: skip
    """Return what a collaboration depends on.

    Args:
        bank: The plans of its goals.
        pace: ``turns`` or ``free``.
        method: The robot: a name in `JOINT_ROBOTS` or ``ASSISTANTS``, or ``module:Class``.
        profile: What is learnt about agent states, and which values planners get; ``hrcplan`` by
            default, ``estimated`` for robots that weigh agent states of several goals.
        seed: All random draws of a simulated human follow from it.
        human: Who the people are, as JSON.

    Raises:
        UsageError: if a name is unknown, or there is no human or no robot.
        UnsupportedError: if the problem has a construct that an execution cannot hold.
    """
    if pace not in PACES:
        hint = nearest(pace, PACES) or " or ".join(PACES)
        raise UsageError(f"there is no pace '{pace}'", code="unknown-pace", hint=hint)
    check_robot(method)
    if profile is None:
        profile = ESTIMATED if method in JOINT_ROBOTS and len(bank.names) > 1 else "hrcplan"
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
        self, record: RunRecord | None = None, watch: CollaborationWatch | None = None,
        past: Journal | None = None,
    ) -> CompanionRun:  # fmt: skip
        """Return the finished run; with a robot, ``past`` says what happened so far."""
        world: SharedWorld | ResumedWorld[CompanionRun, SharedEvent, SharedCommand] = self.world
        if past is not None and self.world.keeps_deadlines:
            world = ResumedWorld(past, self.world, ANSWERS, KINDS, self.world.watch)

        def all_of(
            run: CompanionRun, event: SharedEvent, commands: tuple[SharedCommand, ...]
        ) -> None:
            self.adviser.watch(run, event, commands)
            world.watch(run, event, commands)
            if watch is not None:
                watch(run, event, commands)

        return Driver(
            Companion(self.setup), world, self.adviser, record or NullRecord(), all_of,
            SHARED_QUESTIONS,
        ).run()  # fmt: skip


def assistant_of(setup: CollaborationSetup) -> Callable[[Bank], Assistant[Any]]:
    """Return what makes the assistant of a collaboration from its bank."""
    return assistant_maker(setup.method)


def simulated(
    setup: CollaborationSetup, bank: Bank, course: Course, human: str = "frontier",
    make_assistant: Callable[[Bank], Assistant[Any]] | None = None, nature: Nature | None = None,
    robot: RobotLink | None = None, speed: float = 1.0,
) -> CollaborationParts:  # fmt: skip
    """Return the parts of a collaboration with a simulated human of turn-taking episodes."""
    adviser = Adviser(setup, bank, make_assistant or assistant_of(setup))
    if setup.has_one_goal:
        return parts_with(setup, bank, adviser, CooperativePerson(), nature, robot, speed)
    tells = isinstance(adviser.assistant, KnowsGoal)
    person = SimulatedPerson(setup, bank, HUMANS.make(human, bank, course), course, tells)
    return parts_with(setup, bank, adviser, person, nature, robot, speed)


def parts_with(
    setup: CollaborationSetup, bank: Bank, adviser: Adviser, person: Person,
    nature: Nature | None = None, robot: RobotLink | None = None, speed: float = 1.0,
) -> CollaborationParts:  # fmt: skip
    """Return the parts of a collaboration in which an object acts for the people."""
    world = SharedWorld(setup, nature or Nature(setup.seed), person, robot, speed)
    return CollaborationParts(setup, bank, adviser, world)


def bank_for(goals: Goals) -> Bank:
    """Return the bank of goals, built or from the cache; of one goal only its steps.

    Raises:
        UnsupportedError: if bits cannot hold the task.
        LimitError: if time or memory runs out.
    """
    if len(goals) == 1:
        return Bank(goals, StepTable(goals.task), ())
    return cached_bank(goals)


def course_of(bank: Bank, seed: int) -> Course:
    """Return a course drawn from a seed: one goal, and another one from some turn on."""
    chance = random.Random(f"{seed}/collaboration")
    n_goals = len(bank.names)
    goals = tuple(chance.sample(range(n_goals), min(2, n_goals)))
    if len(goals) < 2:
        return Course(goals, seed=str(seed))
    most = max(1, bank.graphs[goals[0]].n_steps // 2)
    return Course(goals, turns=(chance.randint(1, most),), seed=str(seed))


@dataclass(frozen=True)
class Collaboration:
    """A finished collaboration.

    Attributes:
        outcome: What it came to.
        run: The last state of the machine, with the history.
        setup: What it depends on.
        n_resumed: How many lines of a journal it was resumed from; 0 for a new one.
    """

    outcome: CollaborationOutcome
    run: CompanionRun
    setup: CollaborationSetup
    n_resumed: int = 0

    def __repr__(self) -> str:
        done, goals = self.outcome, ", ".join(self.outcome.reached) or "no goal"
        n = f"{done.done_human} human and {done.done_robot} robot actions"
        return f"<Collaboration: {done.ending}, {goals}, {n}>"


PartsMaker = Callable[[CollaborationSetup], CollaborationParts]
"""Makes the parts of a collaboration; called with the setup of the journal if one is resumed."""


def carry_out_collaboration(
    setup: CollaborationSetup, make_parts: PartsMaker, *, journal: Path | None = None,
    resume: bool = False, watch: CollaborationWatch | None = None, watch_all: bool = False,
) -> Collaboration:  # fmt: skip
    """Return the finished collaboration; a resumed one takes the setup of its journal.

    Args:
        setup: What it depends on.
        make_parts: Makes its parts.
        journal: Where to write it down.
        resume: Continue the collaboration in the journal, if there is one.
        watch: Is called after every step of the machine that is not repeated from a journal.
        watch_all: Let ``watch`` see the repeated steps, too.

    Raises:
        InputError: if the journal is damaged or of other PDDL.
        UsageError: if it exists and ``resume`` was not asked for, or cannot be written.
    """
    file, past = open_journal(journal, resume)
    parts: CollaborationParts | None = None
    try:
        if past is not None:
            setup = _with_setup_of(past, setup)
        parts = make_parts(setup)
        has_robot = parts.world.keeps_deadlines
        if past is not None and parts.world.person.is_live and not has_robot:
            parts.world.person = RecordedPerson(past, parts.world.person)
        writer = None
        if file is not None and past is None:
            writer = JournalWriter.begin(file, setup, FORMAT, KINDS)
        elif file is not None and past is not None:
            writer = JournalWriter.resume(file, past, KINDS)
        run = parts.run(writer, watch if watch_all else _watch_after(writer, watch), past)
        outcome = collaboration_outcome(run)
        if writer is not None:
            writer.finish(outcome)
        return Collaboration(outcome, run, setup, 0 if past is None else len(past.lines))
    finally:
        if parts is not None:
            parts.world.close()
        if file is not None:
            file.close()


def _watch_after(
    writer: JournalWriter | None, watch: CollaborationWatch | None
) -> CollaborationWatch | None:
    """Return a watch that does not see what is repeated from a journal."""
    if writer is None or watch is None:
        return watch

    def new_only(
        run: CompanionRun, event: SharedEvent, commands: tuple[SharedCommand, ...]
    ) -> None:
        if not writer.is_repeating:
            watch(run, event, commands)

    return new_only


def _with_setup_of(past: Journal, setup: CollaborationSetup) -> CollaborationSetup:
    """Return a setup as a journal has it, but with the problem as it was read.

    Raises:
        InputError: if the journal is of other PDDL.
        UsageError: if it names code that the user did not name.
    """
    check_same_goals(past, setup)
    theirs = setup_of(past)
    if bool(theirs.human.get(WITH_ROBOT)) != bool(setup.human.get(WITH_ROBOT)):
        has_robot = bool(theirs.human.get(WITH_ROBOT))
        message = f"the journal is of a {'run with a robot' if has_robot else 'simulation'}"
        hint = "name the robot with --robot" if has_robot else "leave --robot out"
        raise UsageError(message, path=str(past.path), hint=hint)
    if theirs.method != setup.method:
        check_robot(theirs.method, is_typed=False)  # a journal must not choose which code runs
    return replace(theirs, problem=setup.problem, goals=setup.goals)


def collaborate(
    source: str | Bank, goals: str | None = None, *, human: str | Person = "frontier",
    pace: str = TURNS, method: str = ROBOT, seed: int = 0,
    journal: str | os.PathLike[str] | None = None, resume: bool = False,
    watch: CollaborationWatch | None = None, robot: str | RobotLink | None = None,
    speed: float = 1.0,
) -> Collaboration:  # fmt: skip
    """Let a robot help people whose goal it does not know, and return what came of it.

    Args:
        source: A bank, or a domain: a path or a shipped name.
        goals: The goals of the domain; see ``build_bank``.
        human: The name of a simulated human (``frontier``, ``cc-htn``, ``plans``, or
            ``module:Class``), or an object that acts for the people. A simulated human has two
            goals one after the other, drawn from the seed.
        pace: ``turns``, or ``free``: every agent begins at any time.
        method: The robot: a name in ``assistants``, or ``module:Class``.
        seed: All random draws follow from it.
        journal: Where to write it down.
        resume: Continue the collaboration in the journal, if there is one.
        watch: Is called with the run, the event and the commands after every step.
        robot: What carries out the robots' actions instead of a simulation, in real time; see
            `execute`.
        speed: With a robot: seconds of the run in a real second.

    Raises:
        InputError: if a file is missing or has faults.
        PlannerError: if the robot's program is missing or does not start.
        UsageError: if a name is unknown.
        UnsupportedError: if a construct in the PDDL is not held.
        LimitError: if the plans of a goal do not fit.

    >>> collaborate("kitchen", seed=1).outcome.ending
    'goal reached'
    """
    bank = source if isinstance(source, Bank) else bank_for(read_goals(source, goals))
    name = human if isinstance(human, str) else type(human).__name__
    spec: dict[str, Any] = {"name": name}
    if robot is not None:
        spec[WITH_ROBOT] = True
    setup = make_setup(bank, pace=pace, method=method, seed=seed, human=spec)

    link = None if robot is None else make_link(robot, setup.problem)

    def make_parts(setup: CollaborationSetup) -> CollaborationParts:
        if isinstance(human, str):
            course = course_of(bank, setup.seed)
            return simulated(setup, bank, course, human, robot=link, speed=speed)
        adviser = Adviser(setup, bank, assistant_of(setup))
        return parts_with(setup, bank, adviser, human, robot=link, speed=speed)

    path = None if journal is None else Path(journal)
    return carry_out_collaboration(setup, make_parts, journal=path, resume=resume, watch=watch)
