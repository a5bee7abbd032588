"""What is stored of participants: a number, answers, and the journals of trials; no names."""

from __future__ import annotations

import json
import os
import re
import secrets
import threading
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from hrcplan.core.files import make_folder, read_bytes, write_atomically
from hrcplan.core.json_values import DOCUMENT_FAULTS, json_of
from hrcplan.errors import InputError, UsageError
from hrcplan.web.trials.study_file import AFTER, BEFORE, TRIAL, TrialStudy

CONSENT, INSTRUCTIONS, RUN, END = "consent", "instructions", "run", "end"
STAGES = (CONSENT, BEFORE, INSTRUCTIONS, RUN, TRIAL, AFTER, END)
_CODE = re.compile(r"[A-Za-z0-9_-]{20,40}")


@dataclass(frozen=True)
class Participant:
    """One participant.

    Attributes:
        code: The secret of the participant's own link.
        number: From 0, in the order of arrival.
        stage: ``consent``, ``before``, ``instructions``, ``run``, ``trial`` (its questions),
            ``after`` or ``end``.
        trial: The number of the trial, from 0.
        sessions: The names of the sessions of the trials so far.
        answers: The answers by question; those after a trial as ``NAME.TRIAL``.
    """

    code: str
    number: int
    stage: str = CONSENT
    trial: int = 0
    sessions: tuple[str, ...] = ()
    answers: Mapping[str, str] = field(default_factory=dict)

    def next(self, study: TrialStudy) -> Participant:
        """Return the participant at the next stage that has something to show."""
        following = self._following(study)
        is_form = following.stage in (BEFORE, TRIAL, AFTER)
        if is_form and not study.questions_at(following.stage):
            return following.next(study)
        return following

    def _following(self, study: TrialStudy) -> Participant:
        match self.stage:
            case "trial" if self.trial + 1 < study.trials:
                return replace(self, stage=RUN, trial=self.trial + 1)
            case "trial":
                return replace(self, stage=AFTER)
            case _:
                place = STAGES.index(self.stage) + 1
                return replace(self, stage=STAGES[min(place, len(STAGES) - 1)])

    @property
    def session(self) -> str | None:
        """The session of the trial that goes on; None if it has not begun."""
        return self.sessions[self.trial] if self.trial < len(self.sessions) else None


class Participants:
    """The participants of one study, one file each.

    Args:
        study: The study.
        folder: Holds the files.
    """

    def __init__(self, study: TrialStudy, folder: Path) -> None:
        self.study, self.folder = study, folder
        self._lock = threading.Lock()

    @property
    def invitation(self) -> str:
        """The secret of the link by which participants arrive, made at its first use.

        Raises:
            UsageError: if the folder is that of another study, or cannot be written.
        """
        path = self.folder / "study.json"
        if os.path.isfile(path):
            about = _about(path)
            if about.get("sha256") != self.study.sha256:
                message = f"{self.folder} holds participants of another version of the study file"
                raise UsageError(message, code="other-study", hint="take a new --folder")
            return str(about["invitation"])
        make_folder(self.folder)
        about = {"sha256": self.study.sha256, "invitation": secrets.token_urlsafe(18), "n": 0}
        write_atomically(path, json.dumps(about) + "\n")
        return str(about["invitation"])

    def arrive(self) -> Participant:
        """Return a new participant; numbers are never used twice.

        Raises:
            UsageError: if the study is full.
        """
        with self._lock:
            path = self.folder / "study.json"
            about = _about(path)
            if about["n"] >= self.study.participants:
                raise UsageError("this study has all its participants", code="study-full")
            person = Participant(secrets.token_urlsafe(18), about["n"])
            write_atomically(path, json.dumps({**about, "n": about["n"] + 1}) + "\n")
            self._write(person)
            return person

    def get(self, code: str) -> Participant | None:
        """Return a participant by their code; None if there is none."""
        if not _CODE.fullmatch(code) or not os.path.isfile(self._path(code)):
            return None
        path = self._path(code)
        return _participant(_read(path), path, self.study)

    def save(self, person: Participant) -> None:
        """Write a participant down."""
        with self._lock:
            self._write(person)

    def delete(self, person: Participant) -> None:
        """Remove what is stored of a participant here."""
        self._path(person.code).unlink(missing_ok=True)

    def all(self) -> list[Participant]:
        """Return the participants in the order of their numbers."""
        codes = [path.stem for path in self.folder.glob("*.json") if path.stem != "study"]
        people = [person for person in map(self.get, codes) if person is not None]
        return sorted(people, key=lambda person: person.number)

    def _path(self, code: str) -> Path:
        return self.folder / f"{code}.json"

    def _write(self, person: Participant) -> None:
        table = {**asdict(person), "sessions": list(person.sessions)}
        write_atomically(self._path(person.code), json.dumps(table) + "\n")


def _read(path: Path) -> dict[str, Any]:
    try:
        table = json_of(read_bytes(path))
    except ValueError as error:
        raise _damage(path, str(error)) from None
    if not isinstance(table, dict):
        raise _damage(path, "it is no JSON object")
    return table


def _damage(path: Path, why: str) -> InputError:
    return InputError(f"{path} is damaged: {why}", code="bad-session", path=str(path))


def _about(path: Path) -> dict[str, Any]:
    """Return what is stored of the study itself.

    Raises:
        InputError: if the file is damaged.
    """
    about = _read(path)
    if not isinstance(about.get("invitation"), str) or type(about.get("n")) is not int:
        raise _damage(path, "it has no invitation, or no number of participants")
    return about


def _participant(table: dict[str, Any], path: Path, study: TrialStudy) -> Participant:
    """Return what a file holds of a participant.

    Raises:
        InputError: if the file is damaged.
    """
    try:
        person = Participant(**{**table, "sessions": tuple(table["sessions"])})
    except DOCUMENT_FAULTS as error:
        raise _damage(path, str(error)) from None
    answers = person.answers
    is_whole = (
        person.code == path.stem
        and type(person.number) is int
        and type(person.trial) is int
        and min(person.number, person.trial) >= 0
        and person.trial < study.trials
        and person.stage in STAGES
        and all(isinstance(name, str) for name in person.sessions)
        and isinstance(answers, dict)
        and all(isinstance(answer, str) for answer in answers.values())
    )
    if not is_whole:
        raise _damage(path, "a value makes no sense")
    return person
