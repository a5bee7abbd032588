"""A person at a page: acts when a request of the page arrives."""

from __future__ import annotations

import queue
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any

from hrcplan.collaboration import events as shared
from hrcplan.collaboration.adviser import Adviser
from hrcplan.collaboration.events import PersonEvent
from hrcplan.collaboration.run import CompanionRun
from hrcplan.collaboration.setup import CollaborationSetup
from hrcplan.core.text import harmless
from hrcplan.errors import UsageError
from hrcplan.execution import events as ev

MAX_LINE = 2000  # characters that a person can say at once
MAX_WORDS = 50
Question = Callable[[CompanionRun], Any]


class SessionStoppedError(Exception):
    """The session is to stop here; its journal lets it go on later."""


class StaleRequestError(UsageError):
    """A request was made for a situation that is over."""


@dataclass
class PageRequest:
    """What a page asks for: an event, or an answer that leaves the machine as it is.

    Attributes:
        after: The line of the journal that the page had seen; None if that does not matter.
        event: Returns the event; None if ``question`` is asked.
        question: Returns an answer about the run as it is.
        reply: Gets the line of the journal after the event, or the answer.
    """

    after: int | None = None
    event: Callable[[CompanionRun], PersonEvent] | None = None
    question: Question | None = None
    reply: Future[Any] = field(default_factory=Future)


class PagePerson:
    """Acts for all people of one collaboration.

    Args:
        offer: Is called before a person acts, with the run and who can act.
        line: Returns the line of the journal that pages have seen.

    ``wait_s`` says for how many seconds people may think until they stand still; None for ever.
    """

    is_live = True

    def __init__(
        self, offer: Callable[[CompanionRun, tuple[str, ...]], None], line: Callable[[], int]
    ) -> None:
        self._offer, self._line = offer, line
        self.wait_s: Callable[[CompanionRun], float | None] = lambda run: None
        self._requests: queue.SimpleQueue[PageRequest | None] = queue.SimpleQueue()
        self._open: PageRequest | None = None

    def ask(self, request: PageRequest) -> Future[Any]:
        """Return what will hold the reply to a request."""
        self._requests.put(request)
        return request.reply

    def stop(self) -> None:
        """End the session as soon as a person could act."""
        self._requests.put(None)

    def close(self, error: Exception | None = None) -> None:
        """Reply to all that wait: nothing more happens."""
        self._reply(error)
        while not self._requests.empty():
            self._open = self._requests.get()
            self._reply(error or StaleRequestError("the collaboration is over", code="over"))

    def _reply(self, error: Exception | None = None) -> None:
        request, self._open = self._open, None
        if request is None or request.reply.done():
            return
        if error is None:
            request.reply.set_result(self._line())
        else:
            request.reply.set_exception(error)

    def act(self, run: CompanionRun, agents: tuple[str, ...]) -> tuple[PersonEvent, ...]:
        """Return what these people do now.

        Raises:
            SessionStoppedError: if the session is to stop.
        """
        self._offer(run, agents)
        self._reply()
        while True:
            wait_s = self.wait_s(run)
            try:
                request = self._requests.get(timeout=wait_s)
            except queue.Empty:
                return (shared.Idle(run.t, wait_s or 0.0),)
            if request is None:
                raise SessionStoppedError
            event = self._event(request, run)
            if event is not None:
                return (event,)

    def _event(self, request: PageRequest, run: CompanionRun) -> PersonEvent | None:
        self._open = request
        if request.after is not None and request.after != self._line():
            self._reply(StaleRequestError("something has happened since", code="stale"))
            return None
        try:
            if request.event is not None:
                return request.event(run)
            assert request.question is not None
            request.reply.set_result(request.question(run))
        except UsageError as error:
            self._reply(error)
        return None


def event_of(
    document: dict[str, Any], setup: CollaborationSetup
) -> Callable[[CompanionRun], PersonEvent]:
    """Return what makes the event that a page has sent, once the run is known.

    Raises:
        UsageError: if the document is no event of a person.
    """
    kind = document.get("kind")
    agent = _text(document, "agent", "")
    if agent and agent not in setup.people:
        raise UsageError(f"'{agent}' is no person here", code="unknown-agent")
    match kind:
        case "begun":
            name, *args = _words(document, "action")
            return lambda run: shared.Begun(run.t, agent, name, tuple(args))
        case "said":
            text = " ".join(c for c in _text(document, "text").split() if c.isprintable())
            if not text:
                raise UsageError("there is nothing said", code="empty")
            return lambda run: shared.Said(run.t, agent, text)
        case "passed":
            return lambda run: shared.Passed(run.t, agent)
        case "answered":
            choice = harmless(_text(document, "choice"))
            return lambda run: shared.Answered(run.t, choice)
        case "undone" | "failed":
            return lambda run: _undone(run, attempted=kind == "failed")
        case "state":
            key = tuple(_words(document, "key"))
            number = document.get("value")
            if isinstance(number, bool) or not isinstance(number, int | float):
                raise UsageError("a state has a number", code="bad-request")
            setup.model.agents.check(key, number)
            return lambda run: shared.StateTold(run.t, {key: float(number)})
        case "paused":
            return lambda run: shared.Paused(run.t)
        case "continued":
            return lambda run: shared.Continued(run.t)
        case "stop":
            return lambda run: ev.StopAsked(run.t, "quit")
    raise UsageError("this is no event of a person", code="bad-request")


def _undone(run: CompanionRun, attempted: bool) -> PersonEvent:
    last = run.last_reported
    if last is None:
        raise UsageError("there is nothing to take back", code="nothing-to-undo")
    return shared.Undone(run.t, last.number, attempted)


def _text(document: dict[str, Any], key: str, default: str | None = None) -> str:
    """Return a short text.

    Raises:
        UsageError: if there is none, or it is too long.
    """
    value = document.get(key, default)
    if not isinstance(value, str):
        raise UsageError(f"'{key}' is no text", code="bad-request")
    if len(value) > MAX_LINE:
        message = f"a line has at most {MAX_LINE} characters"
        raise UsageError(message, code="too-long")
    return value


def _words(document: dict[str, Any], key: str) -> list[str]:
    """Return a short list of words, at least one.

    Raises:
        UsageError: if there is none.
    """
    words = document.get(key)
    if not isinstance(words, list) or not 1 <= len(words) <= MAX_WORDS:
        raise UsageError(f"'{key}' is no list of words", code="bad-request")
    return [harmless(_text({"word": word}, "word")) for word in words]  # all pages show them


def adviser_offer(
    adviser: Adviser, run: CompanionRun, agents: tuple[str, ...]
) -> list[dict[str, Any]]:
    """Return the steps that people can begin now, the likeliest first, as JSON objects.

    ``asked`` marks what a plan asks a person to do.
    """
    possible = adviser.possible(agents)
    prior = adviser.prior(possible) if adviser.is_ready else {}
    requests = {
        (r.step.schema.name, *r.step.binding.values())
        for r in run.running
        if r.index is not None and r.step.agent in agents
    }
    steps = [*(s for s in possible if s in requests), *(s for s in possible if s not in requests)]
    steps.sort(key=lambda step: (step not in requests, -prior.get(step, 0.0)))
    return [
        {"action": list(step), "p": round(prior.get(step, 0.0), 4)}
        | ({"asked": True} if step in requests else {})
        for step in steps
    ]
