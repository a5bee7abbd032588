"""Replay: derive every decision of a journal again and name the first that differs."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from hrcplan.execution import events as ev
from hrcplan.execution.codec import KINDS, Item, from_json, to_json
from hrcplan.execution.driver import DrivenRun, Machine
from hrcplan.execution.journal import Journal
from hrcplan.execution.journal.writer import HasJson
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.monitor import Monitor
from hrcplan.execution.outcome import Outcome, outcome_of
from hrcplan.pddl.model import Problem
from hrcplan.validation import validate

R = TypeVar("R", bound=DrivenRun)
O = TypeVar("O", bound=HasJson)  # noqa: E741
JsonObject = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Difference:
    """The first line of a journal that does not follow from those before it."""

    line: int
    expected: str
    recorded: str


@dataclass(frozen=True, slots=True)
class Replayed(Generic[O]):
    """What came of a replay; ``row`` is the one derived, of an unfinished run as far as it came."""

    n_events: int
    n_decisions: int
    row: O
    difference: Difference | None = None


def replay(journal: Journal) -> Replayed[Outcome]:
    """Return what follows from the events of a journal, compared with what it says.

    Raises:
        InputError: if the journal has no beginning, or an event cannot be read.
    """
    setup = journal.setup()
    monitor = Monitor(ExecutionModel(setup.problem), setup.profile, setup.sensing)
    return derive(
        journal, monitor, lambda run: outcome_of(run, monitor.model.agents.robots),
        monitor.decider.problem_now,
    )  # fmt: skip


def derive(
    journal: Journal, machine: Machine[R, Any, Any], outcome: Callable[[R], O],
    problem_now: Callable[[R], Problem], kinds: Mapping[str, type] = KINDS,
) -> Replayed[O]:  # fmt: skip
    """Return what follows from the events of a journal, compared with what it says.

    Args:
        journal: The journal.
        machine: What decides.
        outcome: Returns the outcome of a run.
        problem_now: Returns the problem that plans of a run solve.
        kinds: The classes of events and commands by ``kind``.
    """
    run = machine.begin()
    due: list[dict[str, Any]] | None = None
    n_events = n_decisions = 0
    difference: Difference | None = None
    for number, line in enumerate(journal.lines[1:], start=2):
        if due is not None:
            difference = _differs(number, {"decided": due}, line)
            n_decisions += difference is None
            due = None
        elif "row" in line:
            difference = _differs(number, {"row": _as_read(outcome(run).to_json())}, line)
        else:
            event, difference = _event(number, line, kinds)
            difference = difference or _without_reason(number, line, event, run, problem_now)
            if difference is None:
                run, commands = machine.step(run, event)
                due = _as_read([to_json(command) for command in commands])
                n_events += 1
        if difference is not None:
            break
    return Replayed(n_events, n_decisions, outcome(run), difference)


def _as_read(value: JsonObject | list[JsonObject]) -> Any:
    return json.loads(json.dumps(value))


def _event(
    number: int, line: Mapping[str, Any], kinds: Mapping[str, type]
) -> tuple[Any, Difference | None]:
    try:
        return from_json(line["event"], kinds), None
    except (KeyError, ValueError):
        return None, Difference(number, "an event", json.dumps({**line}))


def _differs(
    number: int, expectation: Mapping[str, Any], line: Mapping[str, Any]
) -> Difference | None:
    content = {key: value for key, value in line.items() if key != "seq"}
    if content == expectation:
        return None
    return Difference(number, json.dumps(expectation), json.dumps(content))


def _without_reason(
    number: int, line: Mapping[str, Any], event: Item, run: R,
    problem_now: Callable[[R], Problem],
) -> Difference | None:  # fmt: skip
    """Return what is wrong with an event as such: the run is over, or its plan is not valid."""
    if run.is_over and not isinstance(event, ev.Settled):
        return Difference(number, "nothing: the run is over", json.dumps({**line}))
    if isinstance(event, ev.Planned) and event.plan is not None:
        report = validate(problem_now(run), event.plan)
        if not report.valid:
            return Difference(number, "a valid plan", f"{report.reason}")
    return None
