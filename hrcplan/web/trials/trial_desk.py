"""One study as it goes on: participants move through its stages, and each trial is a session."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from hrcplan.collaboration.setup import plain_goals
from hrcplan.episodes.humans import Course
from hrcplan.errors import UsageError
from hrcplan.pddl.walks import conjuncts
from hrcplan.web.live_session import LiveSession, SessionSpec
from hrcplan.web.sessions import Sessions
from hrcplan.web.story import CHANGE, REASON
from hrcplan.web.trials import trial_pages as pages
from hrcplan.web.trials.participants import (
    CONSENT,
    END,
    INSTRUCTIONS,
    RUN,
    Participant,
    Participants,
)
from hrcplan.web.trials.study_file import CHOICE, SCALE, FormQuestion, TrialStudy, TrialTask

TRACE_FOLDER = "participants"


class TrialDesk:
    """Leads the participants of one study.

    Args:
        study: The study.
        folder: Where data are stored.
        sessions: The collaborations of the server.
    """

    def __init__(self, study: TrialStudy, folder: Path, sessions: Sessions) -> None:
        self.study, self.sessions = study, sessions
        self.participants = Participants(study, folder / TRACE_FOLDER)
        self.invitation = self.participants.invitation
        self.bank = sessions.banks.get(study.domain, study.goals).bank
        _, self._formulas = plain_goals(self.bank.goals)
        self._names = self.bank.names
        for task in study.tasks:
            for name in filter(None, (task.goal, task.change_to)):
                if name not in self._formulas:
                    known = ", ".join(self._formulas)
                    raise UsageError(f"there is no goal '{name}'", hint=f"goals: {known}")

    def course(self, task: TrialTask) -> Course:
        """Return what a participant is asked for over time."""
        goals = [self._names.index(task.goal)]
        if not task.change_to:
            return Course(tuple(goals))
        return Course((*goals, self._names.index(task.change_to)), (task.after,))

    # Pages.

    def page(self, person: Participant) -> str:
        """Return what a participant sees now."""
        match person.stage:
            case "consent":
                return pages.consent_page(self.study, person)
            case "instructions":
                return pages.instructions_page(self.study, person)
            case "run":
                session = self.trial_session(person)
                return pages.trial_page(self.study, person, session.name, self._meanings(person))
            case "end":
                return pages.end_page(self.study, person)
            case _:
                questions = self.study.questions_at(person.stage)
                return pages.questions_page(self.study, person, questions)

    def _meanings(self, person: Participant) -> list[tuple[str, str]]:
        task = self._task(person)
        return [
            (name, ", ".join(str(part).strip("()") for part in conjuncts(self._formulas[name])))
            for name in filter(None, (task.goal, task.change_to))
        ]

    def _task(self, person: Participant) -> TrialTask:
        return self.study.plan(person.number)[person.trial].task

    # Moves.

    def go_on(self, person: Participant, form: Mapping[str, str]) -> Participant:
        """Return a participant who has sent a form, at the next stage.

        Raises:
            UsageError: if the trial goes on, or an answer is missing or makes no sense.
        """
        if person.stage == END:
            return person
        if person.stage == RUN:
            if not self.trial_session(person).is_over:
                raise UsageError("this task goes on", code="over")
        elif person.stage not in (CONSENT, INSTRUCTIONS):
            person = replace(person, answers={**person.answers, **self._answers(person, form)})
        after = person.next(self.study)
        self.participants.save(after)
        return after

    def _answers(self, person: Participant, form: Mapping[str, str]) -> dict[str, str]:
        suffix = f".{person.trial + 1}" if person.stage == "trial" else ""
        return {
            f"{question.name}{suffix}": _answer(question, form.get(question.name, ""))
            for question in self.study.questions_at(person.stage)
        }

    def trial_session(self, person: Participant) -> LiveSession:
        """Return the session of the trial that goes on, which begins if it has not yet.

        Raises:
            UsageError: if its data are gone, or too many sessions go on.
        """
        if person.session is not None:
            session = self.sessions.get(person.session)
            if session is None:
                raise UsageError("the data of this task are gone", code="not-found")
            return session
        planned = self.study.plan(person.number)[person.trial]
        study = self.study
        spec = SessionSpec(study.domain, study.goals, "turns", planned.method, seed=study.seed)
        session = self.sessions.begin(spec)
        self.participants.save(replace(person, sessions=(*person.sessions, session.name)))
        return session

    def own_session(self, person: Participant, name: str) -> LiveSession:
        """Return the session of a participant's trial by its name.

        Raises:
            UsageError: if it is not theirs, or the trial is over.
        """
        if person.stage != RUN or person.session != name:
            raise UsageError("there is no such task", code="not-found")
        return self.trial_session(person)

    def delete(self, person: Participant) -> None:
        """Remove everything that is stored of a participant."""
        for name in person.sessions:
            self.sessions.delete(name)
        self.participants.delete(person)

    # News.

    def news(self, person: Participant, message: dict[str, Any]) -> dict[str, Any]:
        """Return news of a session without what participants must not know, but with the task."""
        message = json.loads(json.dumps(message))
        now = message["now"]
        course = self.course(self._task(person))
        goal = self._names[course.goal(int(now.get("round", 0)))]
        changed = len(course.goals) > 1 and goal == self._names[course.goals[1]]
        now["task"] = (
            f"Please change the plan: now make {goal}" if changed else f"Please make {goal}"
        )
        if self.study.shows_belief:
            return message
        now["steps"] = sorted(
            ({"action": step["action"]} for step in now.get("steps", [])),
            key=lambda step: step["action"],
        )
        for entry in message["entries"]:
            entry.pop("belief", None)
            notes = [n for n in entry.get("notes", []) if n["kind"] not in (REASON, CHANGE)]
            entry["notes"] = notes
        for key in ("method", "spec", "goals"):
            message.get("head", {}).pop(key, None)
        return message


def _answer(question: FormQuestion, text: str) -> str:
    """Return an answer.

    Raises:
        UsageError: if it is missing, or none of the options.
    """
    options = {
        CHOICE: question.options,
        SCALE: tuple(str(n) for n in range(1, question.points + 1)),
    }.get(question.kind)
    if options is not None and text not in options:
        raise UsageError(f"please answer: {question.text}", code="no-answer")
    return " ".join(text.split())[: pages.MAX_TEXT]
