"""Carry one problem out, with a journal if wanted: what ``hrcplan execute`` does, as functions."""

from __future__ import annotations

import os
from collections.abc import Hashable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from html import escape
from pathlib import Path

from hrcplan.agents import Profile, load_profile
from hrcplan.core.deprecation import warn_old_name
from hrcplan.core.numbers import Number
from hrcplan.core.svg import LaneBar, gantt
from hrcplan.core.text import type_text
from hrcplan.errors import MissingPlannerError, UsageError
from hrcplan.execution.changes import WorldChange
from hrcplan.execution.driver import PlanProvider, RunWatch
from hrcplan.execution.events import FAILED, Command, Event
from hrcplan.execution.journal import Journal, JournalFile, JournalWriter, RunSetup, open_journal
from hrcplan.execution.links import RobotLink, make_link
from hrcplan.execution.links.resumed import ResumedWorld
from hrcplan.execution.links.world import LinkWorld
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.monitor import Monitor
from hrcplan.execution.natures import STEADY, NatureSource, nature_for
from hrcplan.execution.outcome import Outcome
from hrcplan.execution.replanner import DEFAULT_TIMEOUT_S, Replanner
from hrcplan.execution.run import Run
from hrcplan.execution.simulate import Engine, Spec
from hrcplan.execution.timeline import Timeline
from hrcplan.execution.worlds import EventWorld
from hrcplan.execution.worlds.registry import EVENT_WORLDS, ROBOT, SIMULATED
from hrcplan.pddl.inlining import executable
from hrcplan.pddl.inputs import Readable, as_problem
from hrcplan.pddl.model import Domain, FluentKey, Problem
from hrcplan.pddl.settings import check_function
from hrcplan.planners.contract import Planner
from hrcplan.planners.registry import PLANNERS


@dataclass(frozen=True, slots=True)
class Execution:
    """A finished run.

    Attributes:
        outcome: How it ended, and what was counted.
        run: The last state of the monitor.
        timeline: Every action, plan and message, with times.
        n_resumed: How many lines of a journal the run was resumed from; 0 for a new run.
    """

    outcome: Outcome
    run: Run
    timeline: Timeline
    n_resumed: int = 0

    @property
    def row(self) -> Outcome:
        """The earlier name of ``outcome``, deprecated."""
        warn_old_name("attribute", "row", "outcome")
        return self.outcome

    def __repr__(self) -> str:
        return f"Execution({self.outcome!r}, {len(self.timeline.bars)} actions)"

    def rows(self) -> list[dict[str, str | float | None]]:
        """Return one row per action, in the order in which they began, for ``pandas.DataFrame``.

        Keys: ``agent``, ``action``, ``args`` (separated by spaces), ``start_s``, ``end_s``,
        ``outcome`` (None if it was still running).
        """
        return [
            {"agent": bar.agent or None, "action": bar.action, "args": " ".join(bar.args),
             "start_s": bar.start_s, "end_s": bar.end_s, "outcome": bar.outcome or None}
            for bar in self.timeline.bars.values()
        ]  # fmt: skip

    def _repr_html_(self) -> str:
        """Return what was done as a picture, failed actions with a dashed frame."""
        bars = [
            LaneBar(bar.agent, " ".join([bar.action, *(a for a in bar.args if a != bar.agent)]),
                    bar.start_s, bar.end_s, bar.outcome == FAILED)
            for bar in self.timeline.bars.values()
        ]  # fmt: skip
        return f"{gantt(bars)}<p>{escape(repr(self.outcome))}</p>"


@dataclass(frozen=True, slots=True)
class PreparedRun:
    """A run before it begins: what it depends on, and the engine that carries it out."""

    setup: RunSetup
    engine: Engine
    timeout_s: float = DEFAULT_TIMEOUT_S
    robot: RobotLink | None = None
    speed: float = 1.0


def execute(
    domain: Readable | Domain | Problem,
    problem: Readable | None = None,
    *,
    profile: str | Profile = "hrcplan",
    human: str | NatureSource = STEADY,
    changes: Sequence[str | WorldChange] = (),
    values: Mapping[FluentKey, Number] | None = None,
    model: bool = True,
    planner: str | Planner = "auto",
    seed: int | str = 1,
    replan_limit: int | None = None,
    journal: str | os.PathLike[str] | None = None,
    resume: bool = False,
    robot: str | RobotLink | None = None,
    speed: float = 1.0,
) -> Execution:
    """Carry a problem out in a simulated world or with a robot, and return what happened.

    Args:
        domain: A `Problem`, or whatever `hrcplan.read` takes.
        problem: The problem, if ``domain`` is only its domain.
        profile: ``replan-always``, ``hrcplan``, ``estimated``, a ``.toml`` file, or a `Profile`.
        human: ``steady``, ``uncooperative``, ``partly-cooperative``, more words after commas (see
            ``natures.parse_human``), ``module:Class``, or an object with a method ``nature``.
        changes: Changes at given times, as text (``"motivation human=9@0"``, ``"not box-at blue
            wp4@60"``) or as ``StateChange`` and ``FactChange``.
        values: Function values to put into the initial state, as ``{("motivation", "human"): 8}``.
        model: Whether sensed values are used.
        planner: Is asked first; the others are asked if it fails. A name, or an object.
        seed: All random draws follow from it.
        replan_limit: Replans per run, instead of the profile's number.
        journal: Where to write the run down.
        resume: Continue the run in the journal, if there is one.
        robot: What carries out the robots' actions instead of the simulation, in real time:
            ``cmd:PROGRAM``, ``ros:MAPPING.toml``, ``plansys2``, ``simulated``, ``module:Class``,
            or a `RobotLink`.
        speed: With a robot: seconds of the run in a real second.

    Raises:
        InputError: if a file is missing or has faults.
        PlannerError: if the robot's program is missing or does not start.
        UsageError: if a name is unknown or a value out of range.
        TypeError: if an argument is of a wrong type.

    >>> execute("transport/two-boxes", changes=["motivation human=9@0"]).outcome.ending
    'goal reached'
    """
    initial = as_problem(domain, problem)
    for key in values or {}:
        check_function(key, initial)
    prepared_run = prepare_run(
        initial.with_values(values or {}), profile=profile, human=human, changes=changes,
        model=model, planner=planner, seed=seed, replan_limit=replan_limit, robot=robot,
        speed=speed,
    )  # fmt: skip
    return carry_out(
        prepared_run, journal=None if journal is None else Path(journal), resume=resume
    )


def prepare_run(
    problem: Problem, *, profile: str | Profile = "hrcplan", human: str | NatureSource = STEADY,
    changes: Sequence[str | WorldChange] = (), model: bool = True,
    planner: str | Planner = "auto", seed: int | str = 1, replan_limit: int | None = None,
    timeout_s: float = DEFAULT_TIMEOUT_S, world: str = SIMULATED,
    provider: PlanProvider | None = None, robot: str | RobotLink | None = None,
    speed: float = 1.0, ros_python: str | None = None,
) -> PreparedRun:  # fmt: skip
    """Return a run that is ready to begin; what chance decides is drawn here.

    Args as for `execute`. ``timeout_s``: seconds per plan. ``world``: a name in ``EVENT_WORLDS``.
    ``provider``: answers requests for plans instead of the planners. ``ros_python``: the Python
    of ROS.

    Raises:
        UnsupportedError: if the problem has a construct that an execution cannot hold.
        UsageError: if a name is unknown or a value out of range.
        TypeError: if an argument is of a wrong type.
    """
    _check_type("seed", seed, int, str)
    _check_type("replan_limit", replan_limit, int, type(None))
    _check_type("profile", profile, str, Profile)
    problem = executable(problem)
    own_profile = load_profile(profile) if isinstance(profile, str) else profile
    planners = _planners(planner)
    names = tuple(p if isinstance(p, str) else p.card.name for p in planners)
    execution_model = ExecutionModel(problem)
    provider = provider or Replanner(execution_model, planners, timeout_s)
    engine = Engine(Monitor(execution_model, own_profile.limited_to(replan_limit), model), provider)
    EVENT_WORLDS.find(world)
    nature = nature_for(human, Spec(seed=seed), engine, changes)
    world = ROBOT if robot is not None else world
    setup = RunSetup(problem, engine.monitor.profile, model, nature, names, world)
    link = None if robot is None else make_link(robot, problem, ros_python)
    return PreparedRun(setup, engine, timeout_s, link, speed)


def _planners(planner: str | Planner) -> tuple[str | Planner, ...]:
    """Return the planners to ask first, in order.

    Raises:
        UsageError: if a name is unknown; one that is not installed is left to its successors.
    """
    if isinstance(planner, Planner):
        return (planner,)
    _check_type("planner", planner, str, Planner)
    names = tuple(planner.split(",")) if not planner.startswith("cmd:") else (planner,)
    for name in names:
        if name != "auto":
            try:
                PLANNERS.find(name)
            except MissingPlannerError:
                continue
    return names


def _check_type(name: str, value: Hashable, *types: type) -> None:
    if not isinstance(value, types) or isinstance(value, bool):
        types_text = " or ".join("None" if t is type(None) else t.__name__ for t in types)
        raise TypeError(f"{name} is {types_text}, not {type_text(value)}")


def carry_out(
    prepared_run: PreparedRun, *, journal: Path | None = None, resume: bool = False,
    watch: RunWatch | None = None,
) -> Execution:  # fmt: skip
    """Return the finished run; a resumed one takes the setup of its journal.

    Raises:
        InputError: if the journal is damaged or of another run.
        UsageError: if it exists and ``resume`` was not asked for, or cannot be written.
    """
    file, past = open_journal(journal, resume)
    try:
        return _carry_out(prepared_run, file, past, watch)
    finally:
        if file is not None:
            file.close()


def _carry_out(
    prepared_run: PreparedRun, file: JournalFile | None, past: Journal | None,
    watch: RunWatch | None,
) -> Execution:  # fmt: skip
    writer = None
    if past is not None:
        prepared_run = _with_setup_of(past, prepared_run)
    setup, engine = prepared_run.setup, prepared_run.engine
    if file is not None:
        begin, resume = JournalWriter.begin, JournalWriter.resume
        writer = begin(file, setup) if past is None else resume(file, past)
    timeline = Timeline()
    with _world(prepared_run, past) as world:
        watches: list[RunWatch] = [timeline.watch]
        if isinstance(world, ResumedWorld):
            watches.append(world.watch)
        if watch is not None:
            watches.append(watch)

        def all_of(run: Run, event: Event, commands: tuple[Command, ...]) -> None:
            for one in watches:
                one(run, event, commands)

        run = engine.run(setup.nature, writer, all_of, world)
    outcome = engine.outcome(run)
    if writer is not None:
        writer.finish(outcome)
    return Execution(outcome, run, timeline, 0 if past is None else len(past.lines))


@contextmanager
def _world(prepared_run: PreparedRun, past: Journal | None) -> Iterator[EventWorld]:
    """Yield the world of a run; a robot is let go of at the end, whatever happens."""
    setup, model = prepared_run.setup, prepared_run.engine.model
    if prepared_run.robot is None:
        yield EVENT_WORLDS.make(setup.world, model, setup.nature)
        return
    world = LinkWorld(model, setup.nature, prepared_run.robot, speed=prepared_run.speed)
    try:
        yield world if past is None else ResumedWorld(past, world)
    finally:
        world.close()


def _with_setup_of(past: Journal, prepared_run: PreparedRun) -> PreparedRun:
    """Return the run that a journal began, with the planner of ``prepared_run`` if it fits.

    Raises:
        UsageError: if the journal is of another problem, or names code that the user did not name.
    """
    setup, own_setup = past.setup(), prepared_run.setup
    if (setup.world == ROBOT) != (own_setup.world == ROBOT):
        has_robot = setup.world == ROBOT
        message = f"the journal is of a {'run with a robot' if has_robot else 'simulation'}"
        hint = "name the robot with --robot" if has_robot else "leave --robot out"
        raise UsageError(message, path=str(past.path), hint=hint)
    ours, theirs = own_setup.problem, setup.problem
    if (ours.domain.name, ours.name) != (theirs.domain.name, theirs.name):
        message = f"the journal is of {theirs.domain.name}/{theirs.name}"
        raise UsageError(message, path=str(past.path))
    for name in setup.planners:
        if name not in ("auto", *own_setup.planners):
            PLANNERS.find_listed(name)  # a journal must not choose which code runs
    if setup.world != own_setup.world:
        EVENT_WORLDS.find_listed(setup.world)
    if _without_paths(ours) == theirs and setup.planners == own_setup.planners:
        execution_model, provider = prepared_run.engine.model, prepared_run.engine.planner
    else:
        execution_model = ExecutionModel(theirs)
        provider = Replanner(execution_model, setup.planners, prepared_run.timeout_s)
    engine = Engine(Monitor(execution_model, setup.profile, setup.sensing), provider)
    return replace(prepared_run, setup=setup, engine=engine)


def _without_paths(problem: Problem) -> Problem:
    return replace(problem, path="", domain=replace(problem.domain, path=""))
