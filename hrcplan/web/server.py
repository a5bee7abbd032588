"""The server: listens, prints its link, and ends at once on a signal."""

from __future__ import annotations

import os
import secrets
import socket
import threading
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from types import FrameType, TracebackType

import uvicorn

from hrcplan.core.files import make_folder, reason_of
from hrcplan.core.text import harmless
from hrcplan.errors import UsageError
from hrcplan.web.app import PageApp
from hrcplan.web.banks import Banks
from hrcplan.web.board import Board
from hrcplan.web.looks import LookFile
from hrcplan.web.safety import AccessRules
from hrcplan.web.sessions import Sessions
from hrcplan.web.streams import Streams
from hrcplan.web.trials.rehearsal import RehearsalOutcome, rehearse
from hrcplan.web.trials.study_file import TrialStudy
from hrcplan.web.trials.trial_desk import TrialDesk
from hrcplan.web.trials.trial_routes import TrialRoutes

LOOPBACK, PORT, HTTP_PORT = "127.0.0.1", 8765, 80
_TOKEN_FILE, _TOKEN_LENGTH = "serve-token", 24
_HEADER_BYTES = 16 << 10


@dataclass(frozen=True)
class ServerOptions:
    """How to serve.

    Attributes:
        folder: Holds journals, and the token, so that a page goes on after a restart.
        host: The address to listen at.
        port: The port; None for the usual one, or a free one if that is taken.
        study: A study with participants.
        files: Files to look at.
    """

    folder: Path
    host: str = LOOPBACK
    port: int | None = None
    study: TrialStudy | None = None
    files: Sequence[LookFile] = ()


class PageServer(uvicorn.Server):
    """A server whose streams end when it is asked to stop."""

    def __init__(self, config: uvicorn.Config, board: Board) -> None:
        super().__init__(config)
        self.board = board

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """Let streams end, and then the server."""
        self.board.close()
        super().handle_exit(sig, frame)


class PageService:
    """A server of pages that listens already; a context manager.

    Args:
        options: Where.

    Raises:
        UsageError: if the port is taken, the folder cannot be written, or the study names goals
            that do not exist.
    """

    def __init__(self, options: ServerOptions) -> None:
        self.options = options
        self.board = Board()
        self.sessions = Sessions(options.folder / "sessions", Banks(), self.board.notify)
        self.desk: TrialDesk | None = None
        if options.study is not None:
            self.desk = TrialDesk(options.study, options.folder, self.sessions)
        token = _token(options.folder)
        self._listener = _listener(options)
        self.port: int = self._listener.getsockname()[1]
        self.rules = AccessRules(_hosts(options.host, self.port), token, f"hrcplan-{self.port}")
        self._server = PageServer(self._config(), self.board)

    def __enter__(self) -> PageService:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:  # fmt: skip
        self._listener.close()
        self.sessions.close()

    @property
    def link(self) -> str:
        """The link to open; it holds the token."""
        return f"{self._address}/?token={self.rules.token}"

    @property
    def invitation(self) -> str | None:
        """The link for participants; None without a study."""
        return None if self.desk is None else f"{self._address}/p/{self.desk.invitation}"

    @property
    def _address(self) -> str:
        return f"http://{_shown(self.options.host)}:{self.port}"

    def run(self) -> None:
        """Serve until a signal comes."""
        self._server.run(sockets=[self._listener])

    def rehearse(self, n: int) -> RehearsalOutcome:
        """Return what came of simulated participants, for whom it serves.

        Raises:
            UsageError: if there is no study, or a page is not as it should be.
        """
        if self.desk is None:
            raise UsageError("there is no study to rehearse")
        thread = threading.Thread(target=self.run)
        thread.start()
        try:
            path = f"/p/{self.desk.invitation}"
            return rehearse(self.desk.bank, (LOOPBACK, self.port), path, n)
        finally:
            self.board.close()
            self._server.should_exit = True
            thread.join()

    def _config(self) -> uvicorn.Config:
        streams = Streams(self.board)
        trials = None if self.desk is None else TrialRoutes(self.desk, streams)
        app = PageApp(self.sessions, streams, self.rules, trials, self.options.files).asgi()
        return uvicorn.Config(
            app, log_level="critical", access_log=False, server_header=False, ws="none",
            timeout_graceful_shutdown=1, h11_max_incomplete_event_size=_HEADER_BYTES,
            lifespan="off", http="h11", loop="asyncio",
        )  # fmt: skip


def _shown(host: str) -> str:
    """Return an address as links have it."""
    name = socket.gethostname() if host in ("0.0.0.0", "::") else host
    return f"[{name}]" if ":" in name else name


def _hosts(host: str, port: int) -> frozenset[str]:
    names = {_shown(host), LOOPBACK, "localhost", "[::1]"}
    bare = names if port == HTTP_PORT else set()  # browsers leave this port out
    return frozenset({f"{name}:{port}" for name in names} | bare)


def _listener(options: ServerOptions) -> socket.socket:
    """Return a socket that listens.

    Raises:
        UsageError: if the port is taken.
    """
    ports = [PORT, 0] if options.port is None else [options.port]
    family = socket.AF_INET6 if ":" in options.host else socket.AF_INET
    for port in ports:
        listener: socket.socket | None = None
        try:
            listener = socket.socket(family, socket.SOCK_STREAM)
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            listener.bind((options.host, port))
            listener.listen(128)
        except (OSError, ValueError, TypeError) as error:  # also a name of strange characters
            if listener is not None:
                listener.close()
            if port != ports[-1]:
                continue
            message = f"cannot listen at {harmless(options.host)}:{port}: {reason_of(error)}"
            raise UsageError(message, code="port", hint="another --port N") from None
        return listener
    raise AssertionError("there is always a last port")


def _token(folder: Path) -> str:
    """Return the secret of a folder, made at its first use: a page goes on after a restart.

    Raises:
        UsageError: if it cannot be written.
    """
    path = folder / _TOKEN_FILE
    try:
        make_folder(folder)
        if path.is_file():
            token = path.read_text(encoding="ascii").strip()
            if len(token) < _TOKEN_LENGTH:  # cut, or empty: easy to guess
                raise ValueError(f"{_TOKEN_FILE} holds no secret; remove it, and a new one is made")
            return token
        token = secrets.token_urlsafe(_TOKEN_LENGTH)
        handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with open(handle, "w", encoding="ascii") as file:
            file.write(f"{token}\n")
    except (OSError, ValueError) as error:
        raise UsageError(f"cannot use the folder: {reason_of(error)}", path=str(folder)) from None
    return token
