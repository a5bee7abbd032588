"""Laws of the worlds of event-driven execution."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from hrcplan.agents import load_profile
from hrcplan.execution import events as ev
from hrcplan.execution.driver import MAX_STEPS
from hrcplan.execution.events import Command, Event
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.monitor import Monitor
from hrcplan.execution.replanner import Replanner
from hrcplan.execution.simulate import Engine
from hrcplan.execution.worlds import EventWorld
from hrcplan.execution.worlds.simulated import Nature
from hrcplan.pddl.inlining import executable
from hrcplan.pddl.model import Problem
from hrcplan.testing.watched_world import DomainTruth, WatchedWorld

MakeWorld = Callable[[ExecutionModel, Nature], EventWorld]


def check_event_world(
    make: MakeWorld, problem: Problem, natures: Iterable[Nature] = (Nature(),), *,
    is_exact: bool = True,
) -> None:  # fmt: skip
    """Test the laws of worlds of event-driven execution.

    ``begin`` says what is observed at 0 s. The events of a later call belong to one instant, in the
    order of ``events.RANK``, and time never goes back. Every action that was dispatched ends once.
    A `Wake` has an instant at its time. What is observed and sensed are facts and elements of agent
    state that the problem has, and a journal can hold every event.

    Plans of hrcplan are carried out in the world; in another one, the first actions are broken off
    half-way. After `Finish`, a world may let go of its robots.

    Args:
        make: The class of the world (see `hrcplan.execution.worlds.EventWorld`).
        problem: A problem with a plan.
        natures: How the humans of it behave.
        is_exact: Whether actions have the effects and (but for ``stretch``) the durations that the
            domain says, and the same commands lead to the same events. False for real robots.

    Raises:
        AssertionError: if a law is broken.
    """
    model = ExecutionModel(executable(problem))
    engine = Engine(Monitor(model, load_profile("hrcplan")), Replanner(model))

    def watched(nature: Nature) -> WatchedWorld:
        truth = DomainTruth(model, nature) if is_exact else None
        return WatchedWorld(make(model, nature), model, truth)

    for nature in natures:
        world = watched(nature)
        engine.run(nature, world=world)
        if is_exact:
            _drain(world)
            again = watched(nature)
            engine.run(nature, world=again)
            _drain(again)
            message = "the same commands lead to other events in a second world"
            assert again.log == world.log, message
        _break_off(watched(nature), world.log)


def _drain(world: WatchedWorld) -> None:
    """Let the world go on until nothing happens any more."""
    for _ in range(MAX_STEPS):
        if not world.next():
            world.check_end()
            return
    raise AssertionError(f"the world goes on for more than {MAX_STEPS} instants without a command")


def _break_off(world: WatchedWorld, log: list[Command | Event]) -> None:
    """Begin the first actions of a run again, and break them off half-way."""
    first = [item for item in log if isinstance(item, ev.Dispatch) and item.t < ev.INSTANT_S]
    assert first, "the problem has no plan with an action: take another one"
    world.begin()
    for dispatch in first:
        world.do(dispatch)
    half_s = min(dispatch.duration_s for dispatch in first) / 2
    world.do(ev.Wake(0.0, half_s))
    while world.t < half_s - ev.INSTANT_S and world.next():
        pass
    for number in sorted(world.running):
        world.do(ev.Cancel(world.t, number))
    _drain(world)
    world.do(ev.Finish(world.t, ev.STOPPED))
