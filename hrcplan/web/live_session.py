"""One collaboration that goes on: a thread carries it out, pages follow its story."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from hrcplan.collaboration.collaborate import (
    CollaborationParts,
    carry_out_collaboration,
    course_of,
    make_setup,
    parts_with,
    simulated,
)
from hrcplan.collaboration.events import SharedCommand, SharedEvent
from hrcplan.collaboration.outcome import CollaborationOutcome
from hrcplan.collaboration.persons import idle_wait_s
from hrcplan.collaboration.run import CompanionRun
from hrcplan.collaboration.setup import TURNS, CollaborationSetup
from hrcplan.errors import HrcplanError, UsageError
from hrcplan.execution.worlds.simulated import Nature
from hrcplan.web.banks import Banks, SharedAdviser, SharedBank
from hrcplan.web.page_person import (
    PagePerson,
    PageRequest,
    Question,
    SessionStoppedError,
    adviser_offer,
    event_of,
)
from hrcplan.web.run_head import collaboration_head
from hrcplan.web.story import Story

ME = "me"


@dataclass(frozen=True)
class SessionSpec:
    """What a session is made of; it is stored next to the journal.

    Attributes:
        domain: The domain, as in ``hrcplan collaborate``.
        goals: The goals; None for those of the domain.
        pace: ``turns`` or ``free``.
        method: The robot.
        human: ``me``, or the name of a simulated human.
        seed: All random draws follow from it.
    """

    domain: str
    goals: str | None = None
    pace: str = TURNS
    method: str = "hrcplan"
    human: str = ME
    seed: int = 0

    def to_json(self) -> dict[str, Any]:
        """Return it as a JSON object."""
        return asdict(self)


class LiveSession:
    """One collaboration with its thread.

    ``changed`` is called, in that thread, whenever there is something new for pages.

    Args:
        name: Names it in addresses and files.
        spec: What it is made of.
        banks: Where its bank comes from.
        journal: Where it is written down.
        changed: Tells pages.
    """

    def __init__(
        self, name: str, spec: SessionSpec, banks: Banks, journal: Path,
        changed: Callable[[], None],
    ) -> None:  # fmt: skip
        self.name, self.spec, self.journal = name, spec, journal
        self.story: Story | None = None
        self.head: dict[str, Any] = {}
        self.now: dict[str, Any] = {"phase": "starting"}
        self.version = 0
        self._banks, self._changed = banks, changed
        self._person = PagePerson(self._offer, lambda: self.line)
        self._adviser: SharedAdviser | None = None
        self._setup: CollaborationSetup | None = None
        self._thread = threading.Thread(target=self._run, name=f"session {name}", daemon=True)

    def start(self) -> None:
        """Begin, or continue what the journal holds."""
        self._thread.start()

    def stop(self, wait_s: float = 1.0) -> None:
        """Stop; the journal is whole."""
        self._person.stop()
        self._thread.join(wait_s)

    @property
    def line(self) -> int:
        """The number of the journal's line that the newest entry stands for."""
        return self.story.line if self.story is not None else 0

    @property
    def is_over(self) -> bool:
        """Whether nothing more happens."""
        return self.now["phase"] in ("over", "error")

    def entries(self, after: int) -> list[dict[str, Any]]:
        """Return what has happened after a line of the journal."""
        if self.story is None:
            return []
        return [entry for entry in list(self.story.entries) if entry["n"] > after]

    def send(self, document: dict[str, Any]) -> Future[Any]:
        """Return what will hold the line of the journal after an event of a page.

        Raises:
            UsageError: if it is no event, or the collaboration is over.
        """
        if self._setup is None or self.is_over:
            raise UsageError("the collaboration is over, or has not begun", code="over")
        after = document.get("after")
        if after is not None and type(after) is not int:
            raise UsageError("'after' is no number", code="bad-request")
        return self._person.ask(PageRequest(after, event_of(document, self._setup)))

    def why(self) -> Future[Any]:
        """Return what will hold the robot's reasons, as a JSON object.

        Raises:
            UsageError: if the collaboration is over.
        """
        return self._ask(self._explanation)

    def _ask(self, question: Question) -> Future[Any]:
        if self._setup is None or self.is_over:
            raise UsageError("the collaboration is over, or has not begun", code="over")
        return self._person.ask(PageRequest(question=question))

    def _explanation(self, run: CompanionRun) -> dict[str, Any]:
        adviser, setup = self._adviser, self._setup
        assert adviser is not None
        assert setup is not None
        if setup.has_one_goal:
            return {"text": "The robot follows the plan that is cheapest as things are."}
        why = adviser.locked(lambda: adviser.explain(adviser.fold.state(run.history)))
        if why is None:
            return {"text": f"The robot '{setup.method}' does not say why."}
        return {
            "goals": why.goals,
            "candidates": [
                {"action": c.action, "value": round(c.value, 3), "saves": round(c.saves, 3),
                 "helps": [goal for goal, _ in c.helps]}
                for c in why.candidates
            ],
        }  # fmt: skip

    # In the thread.

    def _run(self) -> None:
        error: Exception | None = None
        try:
            self._carry_out()
        except SessionStoppedError:
            self._show({"phase": "stopped"})
        except HrcplanError as fault:
            error = fault
            self._show({"phase": "error", "message": fault.message, "hint": fault.hint})
        except Exception as fault:  # noqa: BLE001  # one session must not end the others
            error = fault
            what = f"{type(fault).__name__}: {fault}"
            self._show({"phase": "error", "message": f"internal error: {what}", "hint": None})
        finally:
            self._person.close(error)

    def _carry_out(self) -> None:
        shared_bank = self._banks.get(self.spec.domain, self.spec.goals)
        setup = make_setup(
            shared_bank.bank, pace=self.spec.pace, method=self.spec.method, seed=self.spec.seed,
            human={"name": self.spec.human},
        )  # fmt: skip
        done = carry_out_collaboration(
            setup, lambda final: self._parts(final, shared_bank), journal=self.journal,
            resume=True, watch=self._watch, watch_all=True,
        )  # fmt: skip
        self._finish(done.outcome)

    def _parts(self, setup: CollaborationSetup, shared_bank: SharedBank) -> CollaborationParts:
        self._setup, self._adviser = setup, SharedAdviser(setup, shared_bank)
        shared_bank.prepare(setup.method)
        story = Story(setup.problem)
        self.head = collaboration_head(setup) | {"name": self.name, "spec": self.spec.to_json()}
        self.story = story
        bank = shared_bank.bank
        self._person.wait_s = lambda run: idle_wait_s(run, setup)
        if self.spec.human == ME:
            return parts_with(setup, bank, self._adviser, self._person, Nature(setup.seed))
        course = course_of(bank, setup.seed)
        return simulated(setup, bank, course, self.spec.human)

    def _watch(
        self, run: CompanionRun, event: SharedEvent, commands: tuple[SharedCommand, ...]
    ) -> None:
        assert self.story is not None
        if self.story.add(run.run.state, event, commands) is not None:
            self._tell()

    def _offer(self, run: CompanionRun, agents: tuple[str, ...]) -> None:
        """Show what people can do now."""
        adviser, story = self._adviser, self.story
        assert adviser is not None
        assert story is not None
        question = run.question
        now = {
            "phase": "waiting", "n": self.line, "t": run.t, "agents": list(agents),
            "paused": run.is_paused, "round": run.round,
            "steps": adviser.locked(lambda: adviser_offer(adviser, run, agents)),
            "can_undo": run.last_reported is not None,
        }  # fmt: skip
        if question is not None:
            now["question"] = {
                "kind": question.question, "options": list(question.options),
                "text": story.question_text(question.question, question.options),
            }  # fmt: skip
        self._show(now)

    def _finish(self, outcome: CollaborationOutcome) -> None:
        self._show({"phase": "over", "n": self.line, "outcome": outcome.to_json()})

    def _show(self, now: dict[str, Any]) -> None:
        self.now = now
        self._tell()

    def _tell(self) -> None:
        self.version += 1
        self._changed()
