"""Traces are written from journals, and read by inference if they are of the same PDDL."""

from pathlib import Path

import pytest

import hrcplan
from hrcplan.bank import Bank
from hrcplan.errors import InputError
from hrcplan.execution.journal import read_journal
from hrcplan.execution.traces import trace_of
from hrcplan.inference import infer
from hrcplan.inference.traces import ActionTrace, TraceAction, is_trace, read_trace, world_sha256
from tests.worlds import PACKED, PARCELS, WORKSHOP, world

ACTIONS = (
    TraceAction(0.0, "ann", "cut", ("ann", "pipe")),
    TraceAction(1.0, "ann", "cut", ("ann", "rope"), "failed"),
    TraceAction(2.0, "robo", "unfold", ("robo", "blue")),
)


def trace(workshop: Bank) -> ActionTrace:
    return ActionTrace("workshop", world_sha256(workshop.goals.problem), ACTIONS)


def test_a_trace_is_read_as_it_was_written(workshop: Bank) -> None:
    text = trace(workshop).text()
    assert is_trace(text)
    assert read_trace(text) == trace(workshop)


def test_what_was_done_is_observed(workshop: Bank, tmp_path: Path) -> None:
    path = tmp_path / "x.trace"
    path.write_text(trace(workshop).text())
    inferred = infer(workshop, path)
    expected = infer(workshop, "(cut ann pipe)\n(unfold robo blue)")
    assert inferred.posterior == expected.posterior
    assert infer(workshop, trace(workshop).text()).posterior == expected.posterior


def test_a_trace_of_other_pddl_is_refused(workshop: Bank) -> None:
    changed = WORKSHOP.replace(":effect (open ?b))", ":effect (and (open ?b) (not (sealed ?b))))")
    other = world(changed, PACKED, PARCELS).problem
    text = ActionTrace("workshop", world_sha256(other), ACTIONS).text()
    with pytest.raises(InputError, match="other PDDL"):
        infer(workshop, text)
    assert world_sha256(workshop.goals.problem) == world_sha256(
        world(WORKSHOP, PACKED, {"one": "(cut rope)"}).problem
    )  # goals make no difference


@pytest.mark.parametrize(
    ("line", "number"),
    [('{"trace": 2}', 1), ('{"trace": 1}', 1), ("[]", 2), ('{"t": 0}', 2), ("{", 2),
     ('{"t": 0, "action": "cut", "args": ["ann"], "outcome": "perhaps"}', 2)],
)  # fmt: skip
def test_a_damaged_line_is_named(workshop: Bank, line: str, number: int) -> None:
    head = trace(workshop).text().partition("\n")[0]
    text = line if number == 1 else f"{head}\n{line}"
    with pytest.raises(InputError) as caught:
        read_trace(text)
    assert caught.value.line == number


def test_a_run_of_execute_is_a_trace(tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    done = hrcplan.execute("transport/two-boxes", journal=path, planner="exact")
    journal = read_journal(path)
    actions = trace_of(journal.lines, journal.setup().problem).actions
    rows = [(row["action"], row["args"], row["outcome"]) for row in done.rows()]
    assert [(a.action, " ".join(a.args), a.outcome) for a in actions] == rows


@pytest.mark.parametrize(
    "line",
    [
        '{"t": 1%s, "agent": "human", "action": "a", "args": []}' % ("0" * 400),
        '{"t": 1, "agent": "human", "action": "a", "args": [], "posterior": [1%s]}' % ("0" * 400),
        "[" * 100_000,
    ],
    ids=["time", "posterior", "deep"],
)
def test_a_number_beyond_every_float_is_refused_with_its_line(line: str) -> None:
    with pytest.raises(InputError, match="no action of a trace") as error:
        read_trace('{"trace": 1, "domain": "d", "pddl_sha256": ""}\n' + line)
    assert error.value.line == 2
