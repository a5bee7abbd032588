"""Simulated participants: they go through a whole study as people do, over the network."""

from __future__ import annotations

import http.client
import json
import random
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from html.parser import HTMLParser
from typing import Any
from urllib.parse import urlencode

from hrcplan.bank import Bank
from hrcplan.errors import UsageError

TIMEOUT_S = 120.0
MAX_PAGES = 500
THINK_S = (0.1, 0.5)  # people need more; without any only the server's queue is measured


@dataclass(frozen=True)
class RehearsalOutcome:
    """What came of a rehearsal: participants at the end, and how long answers took, in seconds."""

    finished: int
    answers_s: tuple[float, ...]

    def percentile(self, share: float) -> float:
        """Return the time within which a share of the answers came."""
        times = sorted(self.answers_s)
        return times[min(len(times) - 1, int(share * len(times)))] if times else 0.0


def rehearse(bank: Bank, address: tuple[str, int], invitation: str, n: int) -> RehearsalOutcome:
    """Let simulated participants go through a study at the same time.

    Args:
        bank: The plans of the study's goals, by which they choose their steps.
        address: Where the server listens.
        invitation: The path of the link for participants.
        n: How many.

    Raises:
        UsageError: if a page is not as it should be.
    """
    people = [SimulatedParticipant(bank, address, invitation, seed) for seed in range(n)]
    with ThreadPoolExecutor(n) as threads:
        ends = list(threads.map(lambda person: person.run(), people))
    return RehearsalOutcome(sum(ends), tuple(s for person in people for s in person.answers_s))


_LATER = (409, 504)  # something has happened since, or the robot still thinks: news will follow


class _Form(HTMLParser):
    """The fields of a page's form, each with its options; and the session of a trial."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.fields: dict[str, list[str]] = {}
        self.session: str | None = None
        self.has_form = False
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Take note of an element."""
        values = {name: value or "" for name, value in attrs}
        self.has_form = self.has_form or tag == "form"
        self.session = values.get("data-sessions", self.session)
        if tag == "input" and "name" in values:
            self.fields.setdefault(values["name"], []).append(values.get("value", "text"))


@dataclass
class SimulatedParticipant:
    """One simulated participant.

    Attributes:
        bank: The plans.
        address: Where the server listens.
        path: The page that the participant is at.
        seed: All chances follow from it.
        answers_s: How long the server took to answer each step.
    """

    bank: Bank
    address: tuple[str, int]
    path: str
    seed: int
    answers_s: list[float] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.chance = random.Random(f"participant {self.seed}")

    def run(self) -> bool:
        """Return whether the participant came to the end of the study.

        Raises:
            UsageError: if a page is not as it should be.
        """
        for _ in range(MAX_PAGES):
            page = _Form(self._ask("GET", self.path)[1])
            if not page.has_form:
                return True
            if page.session is not None:
                self._play(page.session)
            fields = {name: self.chance.choice(values) for name, values in page.fields.items()}
            _, text, location = self._ask("POST", self.path, urlencode(fields), is_form=True)
            if not location:
                raise UsageError(f"a form was refused: {text}", code="rehearsal")
            self.path = location
        return False

    def _ask(
        self, method: str, path: str, body: str | None = None, is_form: bool = False
    ) -> tuple[int, str, str]:
        """Return the status, the text and the new place of an answer."""
        connection = http.client.HTTPConnection(*self.address, timeout=TIMEOUT_S)
        kind = "application/x-www-form-urlencoded" if is_form else "application/json"
        connection.request(method, path, body, {"Content-Type": kind})
        answer = connection.getresponse()
        text = answer.read().decode()
        connection.close()
        if answer.status >= 400 and answer.status not in _LATER:
            raise UsageError(f"{path}: {answer.status} {text}", code="rehearsal")
        return answer.status, text, answer.getheader("Location") or ""

    # A trial.

    def _play(self, session: str) -> None:
        world = self.bank.initial
        for news in self._news(session):
            for entry in news["entries"]:
                for bar in entry.get("bars", []):
                    world = self._after(world, bar)
            now = news["now"]
            if now["phase"] in ("over", "error"):
                return
            if now["phase"] == "waiting":
                event = {**self._event(world, now), "after": now["n"]}
                time.sleep(self.chance.uniform(*THINK_S))
                began = time.monotonic()
                self._ask("POST", f"{self.path}/sessions/{session}/events", json.dumps(event))
                self.answers_s.append(time.monotonic() - began)

    def _news(self, session: str) -> Iterator[dict[str, Any]]:
        connection = http.client.HTTPConnection(*self.address, timeout=TIMEOUT_S)
        connection.request("GET", f"{self.path}/stream?sessions={session}")
        answer = connection.getresponse()
        try:
            while line := answer.readline():
                if line.startswith(b"data: "):
                    yield json.loads(line[6:])
        finally:
            connection.close()

    def _after(self, world: int, bar: dict[str, Any]) -> int:
        """Return the state after an action that has ended well."""
        step = self.bank.table.find((bar["action"], bar["agent"], *bar["args"]))
        if bar["outcome"] != "done" or step is None:
            return world
        after = self.bank.table.successor(world, step)
        return world if after is None else after

    def _event(self, world: int, now: dict[str, Any]) -> dict[str, Any]:
        """Return what the participant does: a step that a plan of the task has next."""
        goal = now["task"].split()[-1]
        question = now.get("question")
        if question is not None and question["kind"] == "done":
            return {"kind": "answered", "choice": "yes" if goal in question["options"] else "no"}
        graph, node = self.bank.locate(self.bank.goal_index(goal), world)
        following = set(graph.next(node)) if node is not None else set()
        fitting = [
            step["action"]
            for step in now["steps"]
            if self.bank.table.find(tuple(step["action"])) in following
        ]
        if not fitting:
            return {"kind": "passed"}
        return {"kind": "begun", "action": self.chance.choice(fitting)}
