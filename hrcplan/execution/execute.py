"""Carry one problem out, with a journal if wanted: what ``hrcplan execute`` does, as functions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from hrcplan.agents import load_profile
from hrcplan.core.numbers import Number
from hrcplan.errors import UsageError
from hrcplan.execution.driver import PlanProvider, RunWatch
from hrcplan.execution.events import Command, Event
from hrcplan.execution.humans import STEADY, WorldChange, nature_for
from hrcplan.execution.journal import Journal, JournalFile, JournalWriter, RunSetup
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.monitor import Monitor
from hrcplan.execution.outcome import Outcome
from hrcplan.execution.replanner import DEFAULT_TIMEOUT_S, Replanner
from hrcplan.execution.run import Run
from hrcplan.execution.simulate import Engine, Spec
from hrcplan.execution.timeline import Timeline
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import FluentKey, Problem
from hrcplan.planners.registry import PLANNERS


@dataclass(frozen=True, slots=True)
class Executed:
    """A finished run: its row, its last state, what happened, and whether it was resumed."""

    row: Outcome
    run: Run
    timeline: Timeline
    n_resumed: int = 0


def execute(
    domain: str,
    problem: str,
    *,
    profile: str = "hrcplan",
    human: str = STEADY,
    changes: Sequence[WorldChange] = (),
    values: Mapping[FluentKey, Number] | None = None,
    model: bool = True,
    planner: str = "auto",
    seed: int | str = 1,
    replan_limit: int | None = None,
    journal: Path | None = None,
    resume: bool = False,
) -> Executed:
    """Return what came of a problem, given by paths or shipped names, in a simulated world.

    Args:
        domain: A path or a shipped name.
        problem: A path or a shipped name.
        profile: ``replan-always``, ``hrcplan``, or a ``.toml`` file.
        human: ``steady``, ``case1``, ``case2``, … (see ``humans.spec_of``), or ``module:Class``.
        changes: Changes of agent state or of facts at given times.
        values: Function values to put into the initial state.
        model: Whether what is sensed is used.
        planner: Asked first; the others take over if it fails.
        seed: Everything random follows from it.
        replan_limit: Instead of the profile's.
        journal: Where to write the run down.
        resume: Go on with the run in the journal, if there is one.

    Raises:
        InputError: if a file is missing or has faults.
        UsageError: if a name is unknown or a value out of range.

    >>> execute("transport", "two-boxes").row.ending
    'goal reached'
    """
    loaded = read(domain, problem).with_values(values or {})
    setup = make_setup(loaded, profile=profile, human=human, changes=changes, model=model,
                           planner=planner, seed=seed, replan_limit=replan_limit)  # fmt: skip
    return carry_out(setup, journal=journal, resume=resume)


def make_setup(
    problem: Problem, *, profile: str = "hrcplan", human: str = STEADY,
    changes: Sequence[WorldChange] = (), model: bool = True, planner: str = "auto",
    seed: int | str = 1, replan_limit: int | None = None, timeout_s: float = DEFAULT_TIMEOUT_S,
) -> RunSetup:  # fmt: skip
    """Return everything that a run depends on; what chance decides is drawn here.

    Raises:
        UsageError: if a name is unknown or a value out of range.
    """
    chosen = load_profile(profile).limited_to(replan_limit)
    planners = tuple(planner.split(",")) if not planner.startswith("cmd:") else (planner,)
    shared = ExecutionModel(problem)
    engine = Engine(Monitor(shared, chosen, model), Replanner(shared, planners, timeout_s))
    nature = nature_for(human, Spec(seed=seed), engine, changes)
    return RunSetup(problem, chosen, model, nature, planners)


def carry_out(
    setup: RunSetup, *, journal: Path | None = None, resume: bool = False,
    timeout_s: float = DEFAULT_TIMEOUT_S, watch: RunWatch | None = None,
    planner: PlanProvider | None = None,
) -> Executed:  # fmt: skip
    """Return the finished run of a setup; a resumed one takes the setup of its journal.

    ``planner`` answers instead of the planners that the setup names.

    Raises:
        InputError: if the journal is damaged or of another run.
        UsageError: if it exists and ``resume`` was not asked for, or cannot be written.
    """
    file, known = _opened(journal, resume)
    try:
        return _carried_out(setup, file, known, timeout_s, watch, planner)
    finally:
        if file is not None:
            file.close()


def _carried_out(
    setup: RunSetup, file: JournalFile | None, known: Journal | None, timeout_s: float,
    watch: RunWatch | None, planner: PlanProvider | None,
) -> Executed:  # fmt: skip
    if known is not None:
        setup = _same_problem(known, setup)
    writer = None
    if file is not None:
        begin, resume = JournalWriter.begin, JournalWriter.resume
        writer = begin(file, setup) if known is None else resume(file, known)
    model = ExecutionModel(setup.problem)
    answering = planner or Replanner(model, setup.planners, timeout_s)
    engine = Engine(Monitor(model, setup.profile, setup.sensing), answering)
    timeline = Timeline()

    def both(run: Run, event: Event, commands: tuple[Command, ...]) -> None:
        timeline.watch(run, event, commands)
        if watch is not None:
            watch(run, event, commands)

    run = engine.run(setup.nature, writer, both)
    row = engine.outcome(run)
    if writer is not None:
        writer.finish(row)
    return Executed(row, run, timeline, 0 if known is None else len(known.lines))


def _opened(path: Path | None, resume: bool) -> tuple[JournalFile | None, Journal | None]:
    """Return the file to write, and the journal in it to go on with, if there are any."""
    if path is None:
        if resume:
            hint = "--journal FILE --resume"
            raise UsageError("to resume a run its journal is needed", hint=hint)
        return None, None
    file = JournalFile(path)
    if not resume or not file.n_bytes:
        return file, None
    try:
        known = file.journal()
        if known.is_empty:  # killed before the first line was complete
            file.cut(0)
            return file, None
    except BaseException:
        file.close()
        raise
    return file, known


def _same_problem(known: Journal, setup: RunSetup) -> RunSetup:
    found = known.setup()
    ours, theirs = setup.problem, found.problem
    if (ours.domain.name, ours.name) != (theirs.domain.name, theirs.name):
        message = f"the journal is of {theirs.domain.name}/{theirs.name}"
        raise UsageError(message, path=str(known.path))
    for name in found.planners:
        if name not in ("auto", *setup.planners):
            PLANNERS.find_listed(name)  # a journal must not choose which code runs
    return found
