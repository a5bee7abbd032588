"""A study with participants as a TOML file: tasks, robots, texts and questions."""

from __future__ import annotations

import hashlib
import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hrcplan.assistance.assistant import KnowsGoal
from hrcplan.assistance.registry import ASSISTANTS
from hrcplan.core.files import read_bytes
from hrcplan.core.json_values import DOCUMENT_FAULTS, JsonValue
from hrcplan.core.text import nearest
from hrcplan.core.toml import read_toml
from hrcplan.errors import HrcplanError, InputError

BEFORE, TRIAL, AFTER = "before", "trial", "after"
WHEN = (BEFORE, TRIAL, AFTER)
CHOICE, SCALE, TEXT = "choice", "scale", "text"
KINDS = (CHOICE, SCALE, TEXT)
MAX_PARTICIPANTS = 1000
_CODE = "bad-study-file"
_KEYS: Mapping[str, tuple[type, ...]] = {
    "title": (str,), "domain": (str,), "goals": (str,), "conditions": (list,), "seed": (int,),
    "trials": (int,), "participants": (int,), "shows_belief": (bool,), "consent": (dict,),
    "instructions": (str,), "tasks": (list,), "questions": (list,),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class TrialTask:
    """What a participant is asked to do.

    Attributes:
        goal: The goal.
        change_to: The goal from some step on; "" if it stays.
        after: How many steps of the participant come before the change.
    """

    goal: str
    change_to: str = ""
    after: int = 0


@dataclass(frozen=True, slots=True)
class FormQuestion:
    """A question of a questionnaire.

    Attributes:
        name: The column of its answers.
        text: The question.
        when: ``before`` the first trial, after each ``trial``, or ``after`` the last one.
        kind: ``choice`` between options, a ``scale`` between two ends, or a ``text``.
        options: The options, or what the two ends of the scale mean.
        points: How many points the scale has.
    """

    name: str
    text: str
    when: str = AFTER
    kind: str = TEXT
    options: tuple[str, ...] = ()
    points: int = 7


@dataclass(frozen=True, slots=True)
class PlannedTrial:
    """One trial of a participant: the task, and the robot, which the participant does not see."""

    task: TrialTask
    method: str


@dataclass(frozen=True)
class TrialStudy:
    """A study with participants.

    Attributes:
        title: Its title, which participants see.
        domain: The domain, as in ``hrcplan collaborate``.
        goals: The goals; None for those of the domain.
        conditions: The robots that are compared.
        tasks: What participants are asked to do.
        trials: How many trials a participant has.
        participants: How many participants there are at most.
        seed: Orders of tasks follow from it.
        consent: What participants agree to: the researcher's own words.
        keep_days: For how long data are stored.
        instructions: What they read before the first trial.
        questions: The questionnaires.
        shows_belief: Whether participants see what the robot believes, and why it acts.
        sha256: A hash of the file.
    """

    title: str
    domain: str
    goals: str | None
    conditions: tuple[str, ...]
    tasks: tuple[TrialTask, ...]
    trials: int
    participants: int
    seed: int
    consent: str
    keep_days: int
    instructions: str
    questions: tuple[FormQuestion, ...]
    shows_belief: bool
    sha256: str

    def plan(self, number: int) -> tuple[PlannedTrial, ...]:
        """Return the trials of a participant: conditions rotate, tasks are shuffled.

        Args:
            number: The participant's number, from 0.
        """
        tasks = list(self.tasks)
        random.Random(f"{self.seed}/tasks/{number // len(self.conditions)}").shuffle(tasks)
        return tuple(
            PlannedTrial(
                tasks[i % len(tasks)], self.conditions[(number + i) % len(self.conditions)]
            )
            for i in range(self.trials)
        )

    def questions_at(self, when: str) -> tuple[FormQuestion, ...]:
        """Return the questions of one place in the study."""
        return tuple(question for question in self.questions if question.when == when)


def read_study_file(path: Path) -> TrialStudy:
    """Return the study that a TOML file describes.

    Raises:
        InputError: if the file is missing, no TOML, or something in it makes no sense.
    """
    table = read_toml(path, _CODE)
    try:
        return _study(table, hashlib.sha256(read_bytes(path)).hexdigest())
    except (*DOCUMENT_FAULTS, HrcplanError) as error:
        what = f"'{error.args[0]}' is missing" if isinstance(error, KeyError) else str(error)
        raise InputError(f"{path}: {what}", code=_CODE, path=str(path)) from None


def _study(table: Mapping[str, Any], sha256: str) -> TrialStudy:
    _check(table, _KEYS, "the study")
    conditions = tuple(map(str, table["conditions"]))
    for method in conditions:
        # A file must not choose which code runs.
        if isinstance(ASSISTANTS.find_listed(method), KnowsGoal):
            raise ValueError(f"the robot '{method}' has to know the goal")
    tasks = tuple(_task(one) for one in table["tasks"])
    questions = tuple(_question(one) for one in table.get("questions", []))
    names = [question.name for question in questions]
    if len(set(names)) < len(names):
        raise ValueError("two questions have one name")
    if not conditions or not tasks:
        raise ValueError("at least one condition and one task are needed")
    consent = table["consent"]
    _check(consent, {"text": (str,), "keep_days": (int,)}, "consent")
    return TrialStudy(
        str(table["title"]), str(table["domain"]), table.get("goals"), conditions, tasks,
        _in_range(table.get("trials", len(tasks)), 1, 50, "trials"),
        _in_range(table.get("participants", 100), 1, MAX_PARTICIPANTS, "participants"),
        int(table.get("seed", 0)), str(consent["text"]),
        _in_range(consent["keep_days"], 1, 36_500, "keep_days"), str(table["instructions"]),
        questions, bool(table.get("shows_belief", False)), sha256,
    )  # fmt: skip


def _task(table: Mapping[str, Any]) -> TrialTask:
    _check(table, {"goal": (str,), "change_to": (str,), "after": (int,)}, "a task")
    task = TrialTask(table["goal"], table.get("change_to", ""), table.get("after", 0))
    if bool(task.change_to) != (task.after > 0) or task.after < 0:
        raise ValueError("'change_to' and 'after' (at least 1) belong together")
    return task


def _question(table: Mapping[str, Any]) -> FormQuestion:
    known = {"name": (str,), "text": (str,), "when": (str,), "kind": (str,), "options": (list,),
             "points": (int,)}  # fmt: skip
    _check(table, known, "a question")
    question = FormQuestion(
        table["name"], table["text"], table.get("when", AFTER), table.get("kind", TEXT),
        tuple(map(str, table.get("options", []))),
        _in_range(table.get("points", 7), 2, 11, "points"),
    )  # fmt: skip
    if not question.name.isidentifier():
        raise ValueError(f"'{question.name}' cannot be the name of a question")
    for value, values in ((question.when, WHEN), (question.kind, KINDS)):
        if value not in values:
            raise ValueError(f"'{value}' is none of {', '.join(values)}")
    least = {CHOICE: 2, SCALE: 2, TEXT: 0}[question.kind]
    if len(question.options) < least:
        raise ValueError(f"the question '{question.name}' needs {least} options")
    return question


def _check(table: JsonValue, known: Mapping[str, Sequence[type]], what: str) -> None:
    """Check the keys and types of a table.

    Raises:
        ValueError: if it is no table, or one of them is unknown, or of another type.
    """
    if not isinstance(table, Mapping):
        raise ValueError(f"{what} is a table of keys and values")
    for key, value in table.items():
        if key not in known:
            raise ValueError(f"{what} has no '{key}'; {nearest(key, known) or ', '.join(known)}")
        if not isinstance(value, tuple(known[key])) or (
            isinstance(value, bool) and bool not in known[key]
        ):
            raise ValueError(f"'{key}' makes no sense")


def _in_range(number: int, least: int, most: int, name: str) -> int:
    if not least <= number <= most:
        raise ValueError(f"'{name}' is {number}, and not from {least} to {most}")
    return number
