"""A server of its own for each test module: real requests over a real socket."""

import http.client
import json
import os
import socket
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

import pytest
import uvicorn

from hrcplan.web.app import PageApp
from hrcplan.web.banks import Banks
from hrcplan.web.board import Board
from hrcplan.web.safety import AccessRules
from hrcplan.web.sessions import Sessions
from hrcplan.web.streams import Streams

# A browser is needed for these; `tools/test --all` installs one and names it.
collect_ignore = [] if "HRCPLAN_CHROMIUM" in os.environ else ["test_browser.py"]

TOKEN, COOKIE = "secret-of-the-test", "hrcplan-test"


def form(world: str = "transport transport-goals", **fields: Any) -> bytes:
    """Return what the form of the first page sends."""
    return urlencode({"world": world, **fields}).encode()


class Client:
    """A page without a browser."""

    def __init__(self, port: int, sessions: Sessions) -> None:
        self.port, self.sessions = port, sessions
        self.host = f"127.0.0.1:{port}"

    def ask(
        self, method: str, path: str, body: Any = None, **headers: str
    ) -> tuple[int, str, dict[str, str]]:
        """Return status, text and headers of an answer; the token is sent."""
        all_headers = {"Cookie": f"{COOKIE}={TOKEN}", **headers}
        return self.ask_as(method, path, body, all_headers)

    def ask_as(
        self, method: str, path: str, body: Any, headers: dict[str, str]
    ) -> tuple[int, str, dict[str, str]]:
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        data = body if isinstance(body, bytes | None) else json.dumps(body).encode()
        host = headers.pop("Host", self.host)
        connection.request(method, path, data, {"Host": host, **headers})
        answer = connection.getresponse()
        text = answer.read().decode()
        connection.close()
        return answer.status, text, {k.lower(): v for k, v in answer.getheaders()}

    def json(self, method: str, path: str, body: Any = None) -> Any:
        """Return the JSON of an answer."""
        return json.loads(self.ask(method, path, body)[1])

    def begin(self, **spec: Any) -> str:
        """Return the name of a new session in which a person can act."""
        status, _, headers = self.ask("POST", "/begin", form(**spec))
        assert status == 303
        name = headers["location"].rpartition("/")[2]
        self.wait(name, "waiting" if spec.get("human", "me") == "me" else "over")
        return name

    def wait(self, name: str, phase: str = "waiting") -> dict[str, Any]:
        """Return the situation of a session as soon as it is in a phase."""
        session = self.sessions.get(name)
        assert session is not None
        for _ in range(6000):
            if session.now["phase"] in (phase, "error"):
                assert session.now["phase"] == phase, session.now
                return session.now
            time.sleep(0.01)
        raise AssertionError(f"{session.now['phase']}, not {phase}")

    def send(self, name: str, **event: Any) -> Any:
        """Return the answer to an event."""
        return self.json("POST", f"/api/sessions/{name}/events", event)

    def news(self, name: str, last: str = "", n: int = 1) -> list[dict[str, Any]]:
        """Return the first messages of a stream, each with its number."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        headers = {"Host": self.host, "Cookie": f"{COOKIE}={TOKEN}", "Last-Event-ID": last}
        connection.request("GET", f"/api/stream?sessions={name}", headers=headers)
        answer = connection.getresponse()
        messages, number = [], ""
        while len(messages) < n:
            line = answer.readline().decode()
            if line.startswith("id: "):
                number = line[4:].strip()
            if line.startswith("data: "):
                messages.append({**json.loads(line[6:]), "number": number})
        connection.close()
        return messages


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    """A client of a server that runs in this process."""
    folder = tmp_path_factory.mktemp("served")
    listener = socket.create_server(("127.0.0.1", 0))
    port = listener.getsockname()[1]
    board = Board()
    sessions = Sessions(Path(folder) / "sessions", Banks(), board.notify)
    rules = AccessRules(frozenset([f"127.0.0.1:{port}"]), TOKEN, COOKIE)
    config = uvicorn.Config(PageApp(sessions, Streams(board), rules).asgi(), log_level="critical",
                            lifespan="off", timeout_graceful_shutdown=1)  # fmt: skip
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, args=([listener],))
    thread.start()
    yield Client(port, sessions)
    board.close()
    server.should_exit = True
    thread.join()
    sessions.close()
