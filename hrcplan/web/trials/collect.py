"""What participants did, for analysis: rows, traces, answers; with numbers instead of links."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from hrcplan import __version__
from hrcplan.collaboration.companion import Companion
from hrcplan.collaboration.events import KINDS, Undone
from hrcplan.collaboration.journal import setup_of
from hrcplan.core.files import make_folder, write_atomically
from hrcplan.execution.journal import Journal, read_journal
from hrcplan.execution.journal.reader import event_in
from hrcplan.execution.traces import trace_of
from hrcplan.studies.participants import STUDY
from hrcplan.studies.participants.rows import moves_in, row_of_trial
from hrcplan.studies.store import Store
from hrcplan.studies.study import Episode, StudyRow
from hrcplan.web.trials.participants import Participant
from hrcplan.web.trials.trial_desk import TrialDesk

_FORMULA = re.compile(r"[=+@\t\r]|-(?![\d.]+$)")
"""How a text begins that a spreadsheet may take for a formula; negative numbers are none."""


@dataclass(frozen=True, slots=True)
class Collected:
    """How much was written: participants, those who came to the end, and trials."""

    participants: int
    complete: int
    trials: int


def collect(desk: TrialDesk, output: Path) -> Collected:
    """Write rows, traces and answers of a study to a folder.

    The folder then holds ``rows.sqlite`` (for ``hrcplan study report``), ``trials.csv`` (the same
    rows), ``answers.csv`` (a line per participant) and ``traces/`` (for ``hrcplan infer``).

    Raises:
        UsageError: if the folder holds other rows, or cannot be written.
        InputError: if a journal is damaged.
    """
    people = desk.participants.all()
    trials = [(person, *trial) for person in people for trial in _trials(desk, person)]
    make_folder(output / "traces")
    rows: list[tuple[Episode, StudyRow]] = []
    for person, number, journal in trials:
        name = f"p{person.number + 1:03}-t{number + 1}"
        setup = setup_of(journal)
        write_atomically(
            output / "traces" / f"{name}.jsonl", trace_of(journal.lines, setup.problem).text()
        )
        planned = desk.study.plan(person.number)[number]
        run = person.number * desk.study.trials + number
        episode = Episode("trials", ("people", planned.method), run)
        rows.append((episode, _row(desk, person, number, journal)))
    _store(desk, output, rows)
    write_atomically(output / "trials.csv", _csv(_trial_lines(rows)))
    write_atomically(output / "answers.csv", _csv(_answer_lines(people)))
    complete = sum(person.stage == "end" for person in people)
    return Collected(len(people), complete, len(rows))


def _trials(desk: TrialDesk, person: Participant) -> Iterator[tuple[int, Journal]]:
    """Yield the numbers and journals of a participant's trials that are over."""
    for number, name in enumerate(person.sessions):
        path = desk.sessions.folder / f"{name}.jsonl"
        journal = read_journal(path) if path.is_file() else None
        if journal is not None and journal.lines and "row" in journal.lines[-1]:
            yield number, journal


def _row(desk: TrialDesk, person: Participant, number: int, journal: Journal) -> StudyRow:
    setup = setup_of(journal)
    companion = Companion(setup)
    run = companion.begin()
    n_undone = 0
    for place, line in enumerate(journal.lines[1:], start=2):
        if "event" in line:
            event = event_in(line, place, journal.path, KINDS)
            n_undone += isinstance(event, Undone)
            run, _ = companion.step(run, event)
    planned = desk.study.plan(person.number)[number]
    bank = desk.bank
    moves = moves_in(run.history, setup.robots)
    row = row_of_trial(bank, desk.course(planned.task), planned.method, moves, n_undone)
    return {"participant": f"p{person.number + 1:03}", "trial": number + 1, **row}


def _store(desk: TrialDesk, output: Path, rows: list[tuple[Episode, StudyRow]]) -> None:
    study = desk.study
    about = {
        "study": STUDY.name, "version": __version__, "seed": study.seed,
        "options": {"methods": ",".join(dict.fromkeys(study.conditions)), "title": study.title,
                    "participants": ""},
        "inputs_sha256": study.sha256,
    }  # fmt: skip
    with Store.to_write(output, about, STUDY.tables) as store:
        if rows:
            store.add(STUDY.tables[0], rows)


def _trial_lines(rows: list[tuple[Episode, StudyRow]]) -> list[list[str]]:
    columns = list(STUDY.tables[0].columns)
    body = [
        [str(episode.cell[1]), *("" if row[c] is None else str(row[c]) for c in columns)]
        for episode, row in rows
    ]
    return [["method", *columns], *body]


def _answer_lines(people: list[Participant]) -> list[list[str]]:
    names = list(dict.fromkeys(name for person in people for name in person.answers))
    return [
        ["participant", "stage", *names],
        *(
            [f"p{p.number + 1:03}", p.stage, *(p.answers.get(name, "") for name in names)]
            for p in people
        ),
    ]


def _csv(lines: list[list[str]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(_harmless(line) for line in lines)
    return text.getvalue()


def _harmless(cells: list[str]) -> list[str]:
    """Return cells that a spreadsheet does not take for a formula."""
    return [f"'{cell}" if _FORMULA.match(cell) else cell for cell in cells]
