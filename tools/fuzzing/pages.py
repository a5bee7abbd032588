"""Requests to the server of pages: mutated addresses, headers, forms and events of people."""

from __future__ import annotations

import asyncio
import json
import random
import time
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any
from urllib.parse import quote, urlencode

from starlette.types import ASGIApp, Message

from fuzzing import mutate
from hrcplan.web.app import PageApp
from hrcplan.web.banks import Banks
from hrcplan.web.board import Board
from hrcplan.web.live_session import LiveSession, SessionSpec
from hrcplan.web.looks import look_files
from hrcplan.web.safety import AccessRules, RateLimit
from hrcplan.web.sessions import Sessions
from hrcplan.web.streams import Streams
from hrcplan.web.trials.study_file import read_study_file
from hrcplan.web.trials.trial_desk import TrialDesk
from hrcplan.web.trials.trial_routes import TrialRoutes

TOKEN, HOST = "secret", "localhost:80"
HEADERS = {"host": HOST, "cookie": f"hrcplan={TOKEN}", "content-type": "application/json"}
MORE_HEADERS = ("origin", "content-length", "last-event-id", "accept")
SLOW, SERVER_ERROR = 504, 500  # 504: the robot still thinks
SPECS = (
    SessionSpec("transport", "transport-goals", human="me"),
    SessionSpec("kitchen", "kitchen", pace="free", method="recursive", human="me"),
    SessionSpec("transport/two-boxes", pace="free"),
)
EVENTS: tuple[dict[str, Any], ...] = (
    {"kind": "begun", "agent": "human", "action": ["move", "human", "wp3", "wp4"], "after": 3},
    {"kind": "said", "agent": "human", "text": "I want the door"},
    {"kind": "passed", "agent": "human"},
    {"kind": "answered", "choice": "yes"},
    {"kind": "undone"},
    {"kind": "failed"},
    {"kind": "state", "key": ["motivation", "human"], "value": 3},
    {"kind": "paused"},
    {"kind": "continued"},
)
FORMS: tuple[dict[str, str], ...] = (
    {"world": "transport transport-goals", "pace": "turns", "robot": "hrcplan", "human": "me"},
    {"agree": "yes"},
    {"age": "old", "fluent": "3", "remarks": "good"},
)
STUDY = """title = "Boxes"
domain = "transport"
goals = "transport-goals"
conditions = ["hrcplan", "recursive"]
instructions = "Carry boxes together."
consent = {text = "Ask us.", keep_days = 30}
tasks = [{goal = "swap", change_to = "together", after = 2}, {goal = "door"}]
[[questions]]
name = "age"
text = "How old?"
when = "before"
kind = "choice"
options = ["young", "old"]
"""


@dataclass
class Served:
    """A server without sockets.

    Attributes:
        app: The application.
        sessions: Its collaborations.
        code: The secret of one participant.
        live: One session for each of ``SPECS``.
    """

    app: ASGIApp
    sessions: Sessions
    code: str
    live: list[LiveSession] = field(default_factory=list)

    def names(self) -> list[str]:
        """Return the names of sessions in which a person can act; those over begin anew."""
        for number, spec in enumerate(SPECS):
            if len(self.live) <= number:
                self.live.append(_ready(self.sessions.begin(spec)))
            elif self.live[number].is_over:
                self.sessions.delete(self.live[number].name)
                self.live[number] = _ready(self.sessions.begin(spec))
        return [session.name for session in self.live]


def _ready(session: LiveSession) -> LiveSession:
    while session.now["phase"] == "starting":
        time.sleep(0.01)
    return session


@cache
def served(folder: Path) -> Served:
    """Return the server that all mutants ask."""
    place = folder / "served"
    place.mkdir(exist_ok=True)
    (place / "study.toml").write_text(STUDY)
    (place / "a.plan").write_text("(move robot wp0 wp1)\n")
    board = Board()
    sessions, streams = Sessions(place / "sessions", Banks(), board.notify), Streams(board)
    desk = TrialDesk(read_study_file(place / "study.toml"), place, sessions)
    rules = AccessRules(frozenset([HOST]), TOKEN, "hrcplan")
    files = look_files([place / "a.plan"])
    page_app = PageApp(sessions, streams, rules, TrialRoutes(desk, streams), files)
    return Served(page_app.asgi(RateLimit(1e12, 1e12)), sessions, desk.participants.arrive().code)


def requests(rng: random.Random, folder: Path) -> None:
    """Send one mutated request: it is answered, and no session fails for a reason of its own."""
    server = served(folder.parent)
    method, path, query, body = _seed(rng, server)
    headers = dict(HEADERS)
    match rng.randrange(6):
        case 0:
            path = f"/{_mutant_of_words(rng, path)}"
        case 1:
            query = quote(mutate.text(rng, query), safe="=&")
        case 2:
            headers[rng.choice([*headers, *MORE_HEADERS])] = _header(rng)
        case _:
            body = mutate.data(rng, body) if rng.random() < 0.2 else body
    status = asyncio.run(_ask(server.app, method, path, query, headers, body))
    assert status < SERVER_ERROR or status == SLOW, f"{method} {path[:80]}: status {status}"
    for session in server.live:
        failed = session.now["phase"] == "error" and "internal" in session.now["message"]
        assert not failed, f"{body[:200]!r}: {session.now['message']}"


def _seed(rng: random.Random, server: Served) -> tuple[str, str, str, bytes]:
    """Return a request: method, path, query and a body that may be a mutant already."""
    name = rng.choice(server.names())
    pages = ("/", f"/c/{name}", f"/api/sessions/{name}/why", "/look/0", f"/p/{server.code}", "/c",
             "/static/live.js", f"/api/sessions/{name}")  # fmt: skip
    match rng.randrange(5):
        case 0:
            return rng.choice(("GET", "GET", "HEAD")), rng.choice(pages[:-1]), "name=x&goal=y", b""
        case 1:
            return "GET", "/api/stream", f"sessions={name}", b""
        case 2:
            form = {key: _field(rng, value) for key, value in rng.choice(FORMS).items()}
            path = rng.choice(("/begin", f"/p/{server.code}"))
            return "POST", path, "", urlencode(form, errors="surrogatepass").encode()
    event = rng.choice(EVENTS)
    event = event if rng.random() < 0.2 else mutate.value(rng, event)
    return "POST", f"/api/sessions/{name}/events", "", json.dumps(event).encode()


def _field(rng: random.Random, value: str) -> str:
    return mutate.text(rng, value) if rng.random() < 0.3 else value


def _mutant_of_words(rng: random.Random, path: str) -> str:
    words = path.strip("/").split("/")
    at = rng.randrange(len(words))
    words[at] = rng.choice((*mutate.NUMBERS, *mutate.WORDS, "..", "%00", "a" * 300, words[at]))
    return "/".join(words)


def _header(rng: random.Random) -> str:
    return str(rng.choice((*mutate.NUMBERS, *mutate.WORDS, HOST, f"http://{HOST}", "null", ":,:1")))


async def _ask(
    app: ASGIApp, method: str, path: str, query: str, headers: dict[str, str], body: bytes
) -> int:
    """Return the status of an answer; the page goes as soon as it has asked."""
    messages: list[Message] = [{"type": "http.request", "body": body, "more_body": False}]
    statuses: list[int] = []

    async def receive() -> Message:
        await asyncio.sleep(0)
        return messages.pop() if messages else {"type": "http.disconnect"}

    async def send(message: Message) -> None:
        if message["type"] == "http.response.start":
            statuses.append(message["status"])
        if message["type"] == "http.response.body":
            assert isinstance(message.get("body", b""), bytes)

    scope = {
        "type": "http", "asgi": {"version": "3.0"}, "http_version": "1.1", "method": method,
        "path": path, "raw_path": path.encode("utf-8", "replace"), "scheme": "http",
        "query_string": query.encode("latin-1", "replace"), "root_path": "",
        "headers": [(k.encode(), v.encode("latin-1", "replace")) for k, v in headers.items()],
        "client": ("127.0.0.1", 1), "server": ("localhost", 80),
    }  # fmt: skip
    await app(scope, receive, send)
    return statuses[0] if statuses else 0
