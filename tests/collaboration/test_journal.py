"""A collaboration that is killed anywhere goes on to the same end, and can be derived again."""

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any

import pytest

from hrcplan.assistance.expected_help import ExpectedHelp
from hrcplan.bank import Bank, build
from hrcplan.collaboration import events as shared
from hrcplan.collaboration.adviser import Adviser
from hrcplan.collaboration.collaborate import (
    Collaboration,
    CollaborationParts,
    carry_out_collaboration,
    collaborate,
    make_setup,
    parts_with,
    simulated,
)
from hrcplan.collaboration.events import PersonEvent
from hrcplan.collaboration.journal import is_collaboration, replay_collaboration
from hrcplan.collaboration.persons import Person
from hrcplan.collaboration.run import CompanionRun
from hrcplan.collaboration.setup import CollaborationSetup
from hrcplan.episodes.humans import Course
from hrcplan.errors import InputError, UsageError
from hrcplan.execution import events as ev
from hrcplan.execution.journal import read_journal
from tests.worlds import ERRAND, ERRANDS, HALL, PACKED, PARCELS, WORKSHOP, world


class ScriptedPerson:
    """A live person who says what a script says, and then nothing any more."""

    is_live = True

    def __init__(self, *events: Callable[[CompanionRun], PersonEvent]) -> None:
        self.events = list(events)

    def act(self, run: CompanionRun, agents: tuple[str, ...]) -> tuple[PersonEvent, ...]:
        if run.question is not None and run.question.question == shared.DONE:
            return (shared.Answered(run.t, shared.YES),)
        if not self.events:
            return (ev.StopAsked(run.t, "enough"),)
        return (self.events.pop(0)(run),)


def begins(text: str) -> Callable[[CompanionRun], PersonEvent]:
    name, *args = text.split()
    return lambda run: shared.Begun(run.t, "", name, tuple(args))


def undoes(run: CompanionRun) -> PersonEvent:
    assert run.last_reported is not None
    return shared.Undone(run.t, run.last_reported.number)


def passes(run: CompanionRun) -> PersonEvent:
    return shared.Passed(run.t)


def says(text: str) -> Callable[[CompanionRun], PersonEvent]:
    return lambda run: shared.Said(run.t, "", text)


@lru_cache
def robot(bank: Bank) -> ExpectedHelp:
    return ExpectedHelp(bank)


@lru_cache
def workshop() -> Bank:
    return build(world(WORKSHOP, PACKED, PARCELS))


SCRIPT = (
    says("cut wire"), says("nonsense"), begins("seal ann red"), undoes, begins("cut ann pipe"),
    passes, begins("pack ann pipe blue"), passes,
)  # fmt: skip


def live(bank: Bank, path: Path | None, resume: bool = False, pace: str = "turns",
         script: tuple[Any, ...] = SCRIPT) -> Collaboration:  # fmt: skip
    person: Person = ScriptedPerson(*script)

    def make_parts(setup: CollaborationSetup) -> CollaborationParts:
        return parts_with(setup, bank, Adviser(setup, bank, robot), person)

    return carry_out_collaboration(make_setup(bank, pace=pace), make_parts, journal=path,
                                   resume=resume)  # fmt: skip


def test_a_live_collaboration_killed_at_any_line_goes_on_to_the_same_end(tmp_path: Path) -> None:
    """What was said is played back; what was not yet written down is said again."""
    bank, path = workshop(), tmp_path / "whole.jsonl"
    whole = live(bank, path)
    assert whole.outcome.done_human >= 2
    assert whole.outcome.done_robot >= 1
    lines = path.read_bytes().splitlines(keepends=True)
    for n in range(len(lines) + 1):
        n_said = sum(is_said(line) for line in lines[:n])
        torn = [*lines, b'{"seq'][n][: 40 * (n % 2)]  # half of the time in the middle of a line
        killed = tmp_path / "killed.jsonl"
        killed.write_bytes(b"".join(lines[:n]) + torn)
        again = live(bank, killed, resume=True, script=SCRIPT[n_said:])
        assert (again.outcome, again.run.run.state) == (whole.outcome, whole.run.run.state), n
        assert again.run.history == whole.run.history
        assert killed.read_bytes() == path.read_bytes(), n


def is_said(line: bytes) -> bool:
    kinds = (b'"kind":"said"', b'"kind":"begun"', b'"kind":"undone"', b'"kind":"passed"')
    return b'"event":' in line and any(kind in line for kind in kinds)


@pytest.mark.parametrize("pace", ["turns", "free"])
def test_a_simulated_collaboration_killed_at_any_line_goes_on(tmp_path: Path, pace: str) -> None:
    bank = build(world(HALL, ERRAND, ERRANDS))
    course = Course((1, 0), turns=(2,), mistake_rate=0.1, seed="one")

    def play(path: Path, resume: bool = False) -> Collaboration:
        return carry_out_collaboration(
            make_setup(bank, pace=pace),
            lambda setup: simulated(setup, bank, course, make_assistant=robot),
            journal=path, resume=resume,
        )  # fmt: skip

    whole = play(tmp_path / "whole.jsonl")
    lines = (tmp_path / "whole.jsonl").read_bytes().splitlines(keepends=True)
    for n in range(0, len(lines) + 1, 7):
        killed = tmp_path / "killed.jsonl"
        killed.write_bytes(b"".join(lines[:n]))
        again = play(killed, resume=True)
        assert again.outcome == whole.outcome
        assert killed.read_bytes() == b"".join(lines)


def test_every_decision_follows_without_an_assistant(tmp_path: Path) -> None:
    path = tmp_path / "whole.jsonl"
    whole = live(workshop(), path)
    journal = read_journal(path)
    assert is_collaboration(journal)
    replayed = replay_collaboration(journal)
    assert replayed.difference is None
    assert replayed.row == whole.outcome
    assert replayed.n_events == replayed.n_decisions


@pytest.mark.parametrize(
    ("old", "new"),
    [('"kind":"dispatch","t":0.0,"number":0', '"kind":"dispatch","t":0.0,"number":3'),
     ('"outcome":"done"', '"outcome":"failed"'),
     ('"done_human":', '"done_human":1'),
     ('"kind":"said"', '"kind":"sung"')],
)  # fmt: skip
def test_a_changed_journal_is_noticed(tmp_path: Path, old: str, new: str) -> None:
    path = tmp_path / "changed.jsonl"
    live(workshop(), path)
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    assert replay_collaboration(read_journal(path)).difference is not None


def test_a_journal_of_other_pddl_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "whole.jsonl"
    live(workshop(), path)
    fewer = {name: goal for name, goal in PARCELS.items() if name != "either"}
    with pytest.raises(InputError, match="other PDDL"):
        live(build(world(WORKSHOP, PACKED, fewer)), path, resume=True)
    with_rule = WORKSHOP.replace(":effect (open ?b))", ":effect (and (open ?b) (not (sealed ?b))))")
    with pytest.raises(InputError, match="another version"):
        live(build(world(with_rule, PACKED, PARCELS)), path, resume=True)
    with pytest.raises(UsageError, match="exists"):
        live(workshop(), path)


def test_a_journal_chooses_no_code(tmp_path: Path) -> None:
    path = tmp_path / "whole.jsonl"
    live(workshop(), path)
    path.write_text(path.read_text().replace('"method":"hrcplan"', '"method":"evil:Robot"', 1))
    with pytest.raises(UsageError, match="evil"):
        live(workshop(), path, resume=True)


def test_a_simulated_human_is_helped_to_its_goal() -> None:
    bank = build(world(HALL, ERRAND, ERRANDS))
    for seed in range(3):
        for pace in ("turns", "free"):
            assert collaborate(bank, seed=seed, pace=pace).outcome.success
