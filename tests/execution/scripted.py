"""Helpers of the tests: a monitor that is fed events by hand, with plans written out."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from hrcplan.agents import load_profile
from hrcplan.execution import events as ev
from hrcplan.execution.events import Command, Event
from hrcplan.execution.execute import Execution, carry_out, prepare_run
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.monitor import Monitor
from hrcplan.execution.replanner import Replanner
from hrcplan.execution.run import Run
from hrcplan.execution.worlds.simulated import Nature
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.plans import Plan, parse_plan
from hrcplan.validation import objective, validate

PLAN = """
0.000: (move robot wp0 wp3) [50]
0.000: (move human wp1 wp4) [50]
50.001: (grasp robot green wp3) [50]
50.001: (grasp human blue wp4) [50]
100.002: (move robot wp3 wp2) [50]
100.002: (move human wp4 wp5) [50]
150.003: (place robot green wp2) [50]
150.003: (place human blue wp5) [50]
"""
# From the state after the first two moves, the human's too.
ROBOT_ONLY = """
0.000: (grasp robot green wp3) [50]
50.001: (move robot wp3 wp2) [50]
100.002: (place robot green wp2) [50]
150.003: (move robot wp2 wp4) [50]
200.004: (grasp robot blue wp4) [50]
250.005: (move robot wp4 wp5) [50]
300.006: (place robot blue wp5) [50]
"""


class Script:
    """One run under the hands of a test: ``tell`` an event, look at ``commands``."""

    def __init__(self, name: str = "replan-always", sensing: bool = True) -> None:
        problem = read("transport", "two-boxes")
        self.monitor = Monitor(ExecutionModel(problem), load_profile(name), sensing)
        self.run: Run = self.monitor.begin()
        self.commands: tuple[Command, ...] = ()

    def tell(self, *events: Event) -> tuple[Command, ...]:
        """Return what the monitor wants after these events."""
        found: list[Command] = []
        for event in events:
            self.run, commands = self.monitor.step(self.run, event)
            found += commands
        self.commands = tuple(found)
        return self.commands

    def settle(self, t: float) -> tuple[Command, ...]:
        """Return what the monitor wants now that an instant has settled."""
        return self.tell(ev.Settled(t))

    def plan(self, text: str, t: float = 0.0) -> tuple[Command, ...]:
        """Answer the request for a plan, and let the instant settle."""
        plan = parse_plan(text)
        now = self.monitor.decider.problem_now(self.run)
        report = validate(now, plan)
        metric = objective(now, report) if report.valid else None
        return self.tell(ev.Planned(t, plan, metric, "script"), ev.Settled(t))

    def begin(self) -> tuple[Command, ...]:
        """Begin the usual plan."""
        self.settle(0.0)
        return self.plan(PLAN)

    def first(self, kind: type) -> object:
        """Return the first of the last commands that is of a kind."""
        return next(command for command in self.commands if isinstance(command, kind))

    def has(self, kind: type) -> bool:
        """Return whether any of the last commands is of a kind."""
        return any(isinstance(command, kind) for command in self.commands)


def dispatched(commands: tuple[Command, ...]) -> list[str]:
    """Return the actions that are to begin, in order."""
    return [str(command) for command in commands if isinstance(command, ev.Dispatch)]


def adopted(commands: tuple[Command, ...]) -> Plan:
    """Return the plan that was taken over."""
    return next(command.plan for command in commands if isinstance(command, ev.Adopt))


class Plans:
    """Answers the n-th request with the n-th plan, if it is valid from then on."""

    def __init__(self, problem: Problem, plans: Sequence[str]) -> None:
        self.model, self.plans = ExecutionModel(problem), list(plans)
        self.asks: list[ev.AskPlan] = []

    def answer(self, ask: ev.AskPlan) -> ev.Planned:
        """Return the next plan."""
        self.asks.append(ask)
        if not self.plans:
            return ev.Planned(ask.t, None, note="no more plans")
        now = Replanner(self.model, timeout_s=1)._from_now(ask)[0]
        plan = parse_plan(self.plans.pop(0))
        report = validate(now, plan)
        assert report.valid, report.reason
        return ev.Planned(ask.t, plan, objective(now, report), "by hand")


def carried_out(
    problem: Problem, *plans: str, nature: Nature | None = None, journal: Path | None = None,
    resume: bool = False,
) -> tuple[Execution, Plans]:  # fmt: skip
    provider = Plans(problem, plans)
    prepared = prepare_run(problem, provider=provider)
    if nature is not None:
        prepared = replace(prepared, setup=replace(prepared.setup, nature=nature))
    return carry_out(prepared, journal=journal, resume=resume), provider
