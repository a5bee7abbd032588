"""The server: listens, prints its link, and ends at once on a signal."""

from __future__ import annotations

import contextlib
import os
import secrets
import socket
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import FrameType

import uvicorn

from hrcplan.core.files import reason_of
from hrcplan.errors import UsageError
from hrcplan.web.app import PageApp
from hrcplan.web.banks import Banks
from hrcplan.web.board import Board
from hrcplan.web.safety import AccessRules
from hrcplan.web.sessions import Sessions

LOOPBACK, PORT, HTTP_PORT = "127.0.0.1", 8765, 80
_TOKEN_FILE = "serve-token"
_HEADER_BYTES = 16 << 10


@dataclass(frozen=True)
class ServerOptions:
    """How to serve.

    Attributes:
        folder: Holds journals, and the token, so that a page goes on after a restart.
        host: The address to listen at.
        port: The port; None for the usual one, or a free one if that is taken.
    """

    folder: Path
    host: str = LOOPBACK
    port: int | None = None


class PageServer(uvicorn.Server):
    """A server whose streams end when it is asked to stop."""

    def __init__(self, config: uvicorn.Config, board: Board) -> None:
        super().__init__(config)
        self.board = board

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """Let streams end, and then the server."""
        self.board.close()
        super().handle_exit(sig, frame)


def serve(options: ServerOptions, say_link: Callable[[str], None]) -> None:
    """Serve until a signal comes.

    Args:
        options: Where.
        say_link: Gets the link to open.

    Raises:
        UsageError: if the port is taken, or the folder cannot be written.
    """
    board = Board()
    sessions = Sessions(options.folder / "sessions", Banks(), board.notify)
    with _listening(options) as listener:
        port = listener.getsockname()[1]
        rules = AccessRules(_hosts(options.host, port), _token(options.folder), f"hrcplan-{port}")
        app = PageApp(sessions, board, rules).asgi()
        say_link(f"http://{_shown(options.host)}:{port}/?token={rules.token}")
        config = uvicorn.Config(
            app, log_level="critical", access_log=False, server_header=False, ws="none",
            timeout_graceful_shutdown=1, h11_max_incomplete_event_size=_HEADER_BYTES,
            lifespan="off", http="h11", loop="asyncio",
        )  # fmt: skip
        try:
            PageServer(config, board).run(sockets=[listener])
        finally:
            sessions.close()


def _shown(host: str) -> str:
    """Return an address as links have it."""
    name = socket.gethostname() if host in ("0.0.0.0", "::") else host
    return f"[{name}]" if ":" in name else name


def _hosts(host: str, port: int) -> frozenset[str]:
    names = {_shown(host), LOOPBACK, "localhost", "[::1]"}
    bare = names if port == HTTP_PORT else set()  # browsers leave this port out
    return frozenset({f"{name}:{port}" for name in names} | bare)


@contextlib.contextmanager
def _listening(options: ServerOptions) -> Iterator[socket.socket]:
    """Hold a socket that listens.

    Raises:
        UsageError: if the port is taken.
    """
    ports = [PORT, 0] if options.port is None else [options.port]
    family = socket.AF_INET6 if ":" in options.host else socket.AF_INET
    for port in ports:
        listener = socket.socket(family, socket.SOCK_STREAM)
        try:
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            listener.bind((options.host, port))
            listener.listen(128)
        except OSError as error:
            listener.close()
            if port == ports[-1]:
                message = f"cannot listen at {options.host}:{port}: {reason_of(error)}"
                raise UsageError(message, code="port", hint="another --port N") from None
            continue
        with listener:
            yield listener
        return


def _token(folder: Path) -> str:
    """Return the secret of a folder, made at its first use: a page goes on after a restart.

    Raises:
        UsageError: if it cannot be written.
    """
    path = folder / _TOKEN_FILE
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if path.is_file():
            return path.read_text(encoding="ascii").strip()
        token = secrets.token_urlsafe(24)
        handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with open(handle, "w", encoding="ascii") as file:
            file.write(f"{token}\n")
    except (OSError, ValueError) as error:
        raise UsageError(f"cannot use the folder: {reason_of(error)}", path=str(folder)) from None
    return token
