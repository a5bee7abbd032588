"""Collaborations with a robot: a program carries out what the companion decides."""

from __future__ import annotations

import shlex
import sys
import time
from pathlib import Path

import pytest

from hrcplan.bank import Bank, build_bank, from_problems
from hrcplan.cli.lines import InputLines, InterruptedInputError
from hrcplan.collaboration import events as shared
from hrcplan.collaboration.collaborate import Collaboration, bank_for, collaborate
from hrcplan.collaboration.events import PersonEvent
from hrcplan.collaboration.history import EndedAction, actions_in
from hrcplan.collaboration.journal import replay_collaboration
from hrcplan.collaboration.persons import ReportedPerson
from hrcplan.collaboration.run import CompanionRun
from hrcplan.errors import UsageError
from hrcplan.execution import events as ev
from hrcplan.execution.journal import read_journal
from hrcplan.execution.links import world as link_world
from hrcplan.pddl.inputs import read

ODD = Path(__file__).parents[1] / "execution" / "robots" / "odd.py"


@pytest.fixture(autouse=True)
def short_waits(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(link_world, "ACCEPT_S", 0.3)
    monkeypatch.setenv("HRCPLAN_CACHE", str(tmp_path / "cache"))


@pytest.fixture(scope="module")
def kitchen() -> Bank:
    return build_bank("kitchen", only=["smoothie-berry", "parfait-fruit"])


def boxes() -> Bank:
    return bank_for(from_problems([read("transport", "two-boxes")]))


def odd(*words: object) -> str:
    return f"cmd:{shlex.join([sys.executable, '-S', str(ODD), *map(str, words)])}"


class Obedient:
    """A live person who does what a plan asks for, after ``events`` of their own."""

    is_live = True

    def __init__(self, *events: PersonEvent) -> None:
        self.events = list(events)

    def act(self, run: CompanionRun, agents: tuple[str, ...]) -> tuple[PersonEvent, ...]:
        if run.question is not None:
            return (shared.Answered(run.t, shared.YES),)
        if self.events:
            return (self.events.pop(0),)
        for action in run.running:
            if action.index is not None and action.step.agent in agents:
                args = tuple(action.step.binding.values())
                begun = shared.Begun(run.t, action.step.agent, action.step.schema.name, args)
                return (begun,)
        return ()


def outcomes(done: Collaboration) -> list[str]:
    robots = {action.number for action in actions_in(done.run.history) if action.is_robot}
    ended = (mark for mark in done.run.history if isinstance(mark, EndedAction))
    return [mark.outcome for mark in ended if mark.number in robots]


@pytest.mark.parametrize("pace", ["turns", "free"])
def test_a_robot_helps_a_person_whose_goal_it_does_not_know(kitchen: Bank, pace: str) -> None:
    done = collaborate(kitchen, robot=odd("kitchen"), pace=pace, speed=1000, seed=1)
    assert done.outcome.ending == ev.GOAL
    assert done.outcome.done_robot > 0
    assert set(outcomes(done)) == {ev.DONE}


def test_a_plan_for_a_live_person_and_a_robot() -> None:
    done = collaborate(boxes(), human=Obedient(), robot=odd("alone"), speed=1000)
    assert done.outcome.ending == ev.GOAL
    assert (done.outcome.done_human, done.outcome.done_robot) == (4, 4)
    assert done.run.run.counts.n_replans == 0  # what was asked for is no deviation


def test_a_failure_is_planned_around() -> None:
    done = collaborate(boxes(), human=Obedient(), robot=odd("alone-fail"), speed=1000)
    assert done.outcome.ending == ev.GOAL
    assert outcomes(done)[0] == ev.FAILED


def test_people_stop_the_robot_and_let_it_go_on() -> None:
    """What runs is cancelled, nothing begins until it is released."""
    stop, go = shared.Stopped(0.0), shared.Continued(0.0)
    done = collaborate(boxes(), human=Obedient(stop, go), robot=odd("endless-alone"), speed=1000)
    assert done.outcome.ending == ev.GOAL
    assert outcomes(done)[0] == ev.CANCELLED


@pytest.mark.parametrize("part", [0.2, 0.5, 0.8])
def test_it_goes_on_after_its_end(tmp_path: Path, part: float) -> None:
    path = tmp_path / "run.jsonl"
    first = collaborate(boxes(), human=Obedient(), robot=odd("alone"), speed=1000, journal=path)
    assert replay_collaboration(read_journal(path)).row == first.outcome
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join(lines[: int(part * len(lines))]))
    done = collaborate(
        boxes(), human=Obedient(), robot=odd("alone"), speed=1000, journal=path, resume=True
    )
    assert done.outcome.ending == ev.GOAL
    again = replay_collaboration(read_journal(path))
    assert (again.row, again.difference) == (done.outcome, None)
    with pytest.raises(UsageError, match="of a run with a robot"):
        collaborate(boxes(), human=Obedient(), journal=path, resume=True)


def test_the_robots_program_says_what_people_do(kitchen: Bank) -> None:
    done = collaborate(boxes(), human=ReportedPerson(), robot=odd("reports"), speed=1000)
    assert done.outcome.ending == ev.GOAL
    assert done.outcome.done_human == 4


def test_words_are_read_while_something_may_happen(tmp_path: Path) -> None:
    path = tmp_path / "lines"
    path.write_text("one\ntwo\n")
    with path.open("rb") as stream:
        lines = InputLines(stream)
        until = time.monotonic() + 10
        assert lines.next(interrupt=lambda s: time.monotonic() > until) == "one"
        assert lines.next(interrupt=lambda s: time.monotonic() > until) == "two"


def test_something_happens_before_a_line_is_typed() -> None:
    import os

    read_end, write_end = os.pipe()
    with open(read_end, "rb") as stream, open(write_end, "wb") as typed:
        lines = InputLines(stream)
        with pytest.raises(InterruptedInputError):
            lines.next(interrupt=lambda s: True)
        typed.write(b"late\n")
        typed.flush()
        until = time.monotonic() + 10
        assert lines.next(interrupt=lambda s: time.monotonic() > until) == "late"
