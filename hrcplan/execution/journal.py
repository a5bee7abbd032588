"""Journals: what happened and what was decided, one JSON object a line, on disk before it counts.

The first line holds everything that a run depends on (problem, profile, nature); then events and
decisions alternate, numbered without gaps; the last line is the row. A process that is killed
loses at most a torn last line, which is cut off when the run is resumed.
"""

from __future__ import annotations

import fcntl
import json
import os
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from hrcplan import __version__
from hrcplan.agents import Profile
from hrcplan.agents.profile import profile_of
from hrcplan.errors import InputError, UsageError
from hrcplan.execution import events as ev
from hrcplan.execution.events import Command, Event, from_json, to_json
from hrcplan.execution.row import Outcome
from hrcplan.execution.worlds.simulated import FactChange, Nature, StateChange
from hrcplan.pddl import check
from hrcplan.pddl.model import Fact, Problem
from hrcplan.pddl.write import domain_text, problem_text

FORMAT = 1


@dataclass(frozen=True)
class RunSetup:
    """What a run depends on besides what happens in it."""

    problem: Problem
    profile: Profile
    sensing: bool
    nature: Nature
    planners: tuple[str, ...] = ()

    def to_json(self) -> dict[str, Any]:
        """Return the setting as a JSON object, complete in itself."""
        return {
            "domain": domain_text(self.problem.domain),
            "problem": problem_text(self.problem),
            "profile": self.profile.to_json(),
            "sensing": self.sensing,
            "nature": _nature_to_json(self.nature),
            "planners": list(self.planners),
        }


def setting_of(table: Mapping[str, Any], path: str) -> RunSetup:
    """Return the setting that the first line of a journal describes.

    Raises:
        InputError: if the line does not hold one.
    """
    try:
        return RunSetup(
            _problem(table["domain"], table["problem"]),
            profile_of(table["profile"], path),
            bool(table["sensing"]),
            _nature(table["nature"]),
            tuple(table["planners"]),
        )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        message = f"the first line of the journal is no beginning: {error!r}"
        raise InputError(message, code="bad-journal", path=path, line=1) from None


def _problem(domain: str, problem: str) -> Problem:
    with tempfile.TemporaryDirectory() as folder:
        paths = Path(folder, "domain.pddl"), Path(folder, "problem.pddl")
        for path, text in zip(paths, (domain, problem), strict=True):
            path.write_text(text, encoding="utf-8")
        loaded = check.load_problem(check.load_domain(paths[0]), paths[1])
    return replace(loaded, path="", domain=replace(loaded.domain, path=""))


def _nature_to_json(nature: Nature) -> dict[str, Any]:
    changes = [to_json(ev.Sensed(c.t, c.values)) for c in nature.changes]
    accidents = [
        {"t": a.t, "adds": _words(a.adds), "deletes": _words(a.deletes)} for a in nature.accidents
    ]
    return {
        "seed": nature.seed, "changes": changes, "accidents": accidents, "sensed": nature.sensed,
        "draws": nature.draws,
        "can_fail": None if nature.can_fail is None else sorted(nature.can_fail),
        "stretch": list(nature.stretch),
    }  # fmt: skip


def _nature(table: Mapping[str, Any]) -> Nature:
    changes = [from_json(change) for change in table["changes"]]
    can_fail = table["can_fail"]
    return Nature(
        table["seed"],
        tuple(StateChange(c.t, c.values) for c in changes),
        tuple(
            FactChange(a["t"], _fact_set(a["adds"]), _fact_set(a["deletes"]))
            for a in table["accidents"]
        ),
        table["sensed"], table["draws"], None if can_fail is None else frozenset(can_fail),
        tuple(table["stretch"]),
    )  # fmt: skip


def _words(facts: frozenset[Fact]) -> list[str]:
    return sorted(" ".join(fact) for fact in facts)


def _fact_set(words: Sequence[str]) -> frozenset[Fact]:
    return frozenset(tuple(word.split(" ")) for word in words)


@dataclass(frozen=True)
class Journal:
    """What a journal file holds: complete lines only, and how many bytes they take."""

    path: Path
    lines: tuple[dict[str, Any], ...]
    n_bytes: int

    @property
    def is_empty(self) -> bool:
        """Whether not even the first line was written."""
        return not self.lines

    def setting(self) -> RunSetup:
        """Return what the run depends on.

        Raises:
            InputError: if the first line does not say so.
        """
        head = self.lines[0] if self.lines else {}
        if head.get("journal") != FORMAT:
            message = f"this is no journal of format {FORMAT}"
            raise InputError(message, code="bad-journal", path=str(self.path), line=1)
        return setting_of(head, str(self.path))


def read_journal(path: Path) -> Journal:
    """Return a journal without its torn last line, if there is one.

    Raises:
        InputError: if the file is missing, a line before the last is damaged, or a number is
            missing or out of order.
    """
    try:
        raw = path.read_bytes()
    except OSError as error:
        message = f"cannot read the journal: {error.strerror}"
        raise InputError(message, code="no-file", path=str(path)) from None
    lines: list[dict[str, Any]] = []
    whole = raw[: raw.rfind(b"\n") + 1]
    for number, text in enumerate(whole.splitlines(), start=1):
        lines.append(_line(text, number, path))
    return Journal(path, tuple(lines), len(whole))


def _line(text: bytes, number: int, path: Path) -> dict[str, Any]:
    try:
        line = json.loads(text)
        if isinstance(line, dict) and line["seq"] == number - 1:
            return line
        reason = f"its number is not {number - 1}"
    except (ValueError, KeyError):
        reason = "it is damaged"
    message = f"line {number} of the journal cannot be used: {reason}"
    raise InputError(message, code="bad-journal", path=str(path), line=number)


class Writer:
    """Appends to a journal; a run that is resumed first goes over the lines that are there.

    Lines are written at once, and on disk before a decision is acted on.
    """

    def __init__(self, path: Path, known: Sequence[Mapping[str, Any]], n_bytes: int) -> None:
        self.path = path
        self._known = known
        self._position = 1
        try:
            self._file = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            os.ftruncate(self._file, n_bytes)
            os.lseek(self._file, n_bytes, os.SEEK_SET)
        except BlockingIOError:
            message = "another process is writing this journal"
            raise UsageError(message, path=str(path)) from None
        except OSError as error:
            raise self._refused(error) from None

    def _refused(self, error: OSError) -> UsageError:
        message = f"cannot write the journal: {error.strerror}"
        return UsageError(message, path=str(self.path))

    @property
    def is_repeating(self) -> bool:
        """Whether the run still goes over what was recorded before."""
        return self._position < len(self._known)

    def take(self, event: Event) -> Event:
        """Write an event down and return it as it can be read again.

        Raises:
            InputError: if another event stands in the journal at this place.
        """
        found = self._line({"event": to_json(event)})
        return from_json(found["event"])  # type: ignore[no-any-return]

    def decided(self, commands: tuple[Command, ...]) -> None:
        """Write down what the monitor decided.

        Raises:
            InputError: if another decision stands in the journal at this place.
        """
        self._line({"decided": [to_json(command) for command in commands]})
        if commands and not self.is_repeating:
            os.fsync(self._file)  # what is acted on is on disk, with all that came before it

    def recorded_plan(self) -> ev.Planned | None:
        """Return the plan that was recorded at this place, if any."""
        event = self._known[self._position].get("event") if self.is_repeating else None
        if event is None or event.get("kind") != "planned":
            return None
        return from_json(event)  # type: ignore[no-any-return]

    def close(self, row: Outcome) -> None:
        """Write the row and close the file."""
        self._line({"row": row.to_json()})
        os.fsync(self._file)
        os.close(self._file)

    def _line(self, content: Mapping[str, Any]) -> Mapping[str, Any]:
        line = json.loads(json.dumps({"seq": self._position, **content}))
        if self.is_repeating:
            if self._known[self._position] != line:
                raise InputError(
                    "the journal goes another way than the run; was it made by this version?",
                    code="bad-journal", path=str(self.path), line=self._position + 1,
                    hint="hrcplan replay JOURNAL shows the first difference",
                )  # fmt: skip
        else:
            self._append(line)
        self._position += 1
        return line  # type: ignore[no-any-return]

    def _append(self, line: Mapping[str, Any]) -> None:
        text = json.dumps(line, ensure_ascii=False, separators=(",", ":")) + "\n"
        data = text.encode()
        try:
            while data:
                data = data[os.write(self._file, data) :]
        except OSError as error:  # no room left
            raise self._refused(error) from None

    @classmethod
    def begin(cls, path: Path, setting: RunSetup) -> Writer:
        """Return the writer of a new journal whose first line is the setting.

        Raises:
            UsageError: if the file exists and holds anything, or cannot be written.
        """
        if path.exists() and (path.is_dir() or path.stat().st_size):
            hint = "--resume goes on with it; or name another file"
            raise UsageError("the journal exists already", path=str(path), hint=hint)
        writer = cls(path, (), 0)
        writer._append({"seq": 0, "journal": FORMAT, "hrcplan": __version__, **setting.to_json()})
        return writer

    @classmethod
    def resume(cls, journal: Journal) -> Writer:
        """Return the writer that goes over a journal and then on; a torn last line is cut off."""
        return cls(journal.path, journal.lines, journal.n_bytes)
