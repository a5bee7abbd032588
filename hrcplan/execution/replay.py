"""Replay: derive every decision of a journal again and name the first that differs."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hrcplan.execution import events as ev
from hrcplan.execution.codec import from_json, to_json
from hrcplan.execution.journal import Journal
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.monitor import Monitor
from hrcplan.execution.outcome import Outcome, outcome_of
from hrcplan.execution.run import Run
from hrcplan.validation import validate


@dataclass(frozen=True, slots=True)
class Difference:
    """The first line of a journal that does not follow from those before it."""

    line: int
    expected: str
    recorded: str


@dataclass(frozen=True, slots=True)
class Replayed:
    """What came of a replay; ``row`` is the one derived, of an unfinished run as far as it came."""

    n_events: int
    n_decisions: int
    row: Outcome
    difference: Difference | None = None


def replay(journal: Journal) -> Replayed:
    """Return what follows from the events of a journal, compared with what it says.

    Raises:
        InputError: if the journal has no beginning, or an event cannot be read.
    """
    setup = journal.setup()
    monitor = Monitor(ExecutionModel(setup.problem), setup.profile, setup.sensing)
    run = monitor.begin()
    due: list[dict[str, Any]] | None = None
    n_events = n_decisions = 0
    difference: Difference | None = None
    for number, line in enumerate(journal.lines[1:], start=2):
        if due is not None:
            difference = _differs(number, {"decided": due}, line)
            n_decisions += difference is None
            due = None
        elif "row" in line:
            row = outcome_of(run, monitor.model.agents.robots).to_json()
            difference = _differs(number, {"row": row}, line)
        else:
            difference = _without_reason(number, line, run, monitor)
            if difference is None:
                run, commands = monitor.step(run, from_json(line["event"]))
                due = json.loads(json.dumps([to_json(command) for command in commands]))
                n_events += 1
        if difference is not None:
            break
    return Replayed(n_events, n_decisions, outcome_of(run, monitor.model.agents.robots), difference)


def _differs(
    number: int, expectation: Mapping[str, Any], line: Mapping[str, Any]
) -> Difference | None:
    content = {key: value for key, value in line.items() if key != "seq"}
    if content == expectation:
        return None
    return Difference(number, json.dumps(expectation), json.dumps(content))


def _without_reason(
    number: int, line: Mapping[str, Any], run: Run, monitor: Monitor
) -> Difference | None:
    """Return what is wrong with an event as such: it cannot be read, or its plan is not valid."""
    try:
        event = from_json(line["event"])
    except (KeyError, ValueError):
        return Difference(number, "an event", json.dumps({**line}))
    if run.is_over:
        return Difference(number, "nothing: the run is over", json.dumps({**line}))
    if isinstance(event, ev.Planned) and event.plan is not None:
        report = validate(monitor.decider.problem_now(run), event.plan)
        if not report.valid:
            return Difference(number, "a valid plan", f"{report.reason}")
    return None
