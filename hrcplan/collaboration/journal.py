"""Journals of collaborations: written, continued, and derived again.

They have the form of execution's journals, with another format number: the first line is a
`CollaborationSetup`, then events and decisions alternate, and the last line is the outcome.
"""

from __future__ import annotations

from typing import get_args

from hrcplan.collaboration.companion import Companion
from hrcplan.collaboration.events import KINDS, PersonEvent
from hrcplan.collaboration.outcome import CollaborationOutcome, collaboration_outcome
from hrcplan.collaboration.persons import Person
from hrcplan.collaboration.run import CompanionRun
from hrcplan.collaboration.setup import CollaborationSetup, setup_in
from hrcplan.errors import InputError
from hrcplan.execution.journal import Journal
from hrcplan.execution.journal.reader import event_in
from hrcplan.execution.replay import Replayed, derive

FORMAT = 2


def is_collaboration(journal: Journal) -> bool:
    """Return whether a journal is that of a collaboration."""
    return bool(journal.lines) and journal.lines[0].get("journal") == FORMAT


def setup_of(journal: Journal) -> CollaborationSetup:
    """Return what the collaboration of a journal depends on.

    Raises:
        InputError: if the journal is no collaboration's, or its first line holds no setup.
    """
    if not is_collaboration(journal):
        message = "this is no journal of a collaboration"
        raise InputError(message, code="bad-journal", path=str(journal.path), line=1)
    return setup_in(journal.lines[0], str(journal.path))


def check_same_goals(journal: Journal, ours: CollaborationSetup) -> None:
    """Check that a journal is of the same PDDL, before it is continued.

    Raises:
        InputError: if it is not.
    """
    theirs = setup_of(journal)
    if theirs.pddl_sha256 == ours.pddl_sha256:
        return
    names = (theirs.problem.domain.name, ", ".join(theirs.goals))
    same = names == (ours.problem.domain.name, ", ".join(ours.goals))
    what = "another version of this PDDL" if same else f"other PDDL: domain {names[0]}"
    hint = "name the domain and the goals that it was begun with, or begin another journal"
    message = f"the journal is of {what}"
    raise InputError(message, code="other-pddl", path=str(journal.path), line=1, hint=hint)


def replay_collaboration(journal: Journal) -> Replayed[CollaborationOutcome]:
    """Return what follows from the events of a journal, compared with what it says.

    Raises:
        InputError: if it has no beginning.
    """
    companion = Companion(setup_of(journal))
    return derive(
        journal, companion, collaboration_outcome,
        lambda run: companion.decider.problem_now(run.run), KINDS,
    )  # fmt: skip


class RecordedPerson:
    """People who first do again what a journal says, and then what they want.

    Args:
        journal: The journal.
        person: Who acts when it ends.
    """

    def __init__(self, journal: Journal, person: Person) -> None:
        self.person, self.is_live = person, person.is_live
        self._events = _person_events(journal)

    @property
    def is_repeating(self) -> bool:
        """Whether the journal still says what people do."""
        return bool(self._events)

    def act(self, run: CompanionRun, agents: tuple[str, ...]) -> tuple[PersonEvent, ...]:
        """Return the next event of the journal, then what the people do."""
        if self._events:
            return (self._events.pop(0),)
        return self.person.act(run, agents)


def _person_events(journal: Journal) -> list[PersonEvent]:
    kinds = get_args(PersonEvent)
    events = [
        event_in(line, number, journal.path, KINDS)
        for number, line in enumerate(journal.lines[1:], start=2)
        if "event" in line
    ]
    return [event for event in events if isinstance(event, kinds)]
