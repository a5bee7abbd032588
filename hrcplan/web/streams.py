"""Streams of news: what pages have not seen of sessions, as soon as it happens."""

from __future__ import annotations

import json
from collections.abc import AsyncIterator, Callable, Sequence
from typing import Any

from sse_starlette import EventSourceResponse, ServerSentEvent
from starlette.requests import Request
from starlette.responses import Response

from hrcplan.web.board import Board
from hrcplan.web.live_session import LiveSession

RETRY_MS = 500  # after which a page looks for a server that has gone
PING_S = 15
Sieve = Callable[[dict[str, Any]], dict[str, Any]]
"""Returns of news what a page may see."""


class Streams:
    """Sends news to pages.

    Args:
        board: Says when there is something new.
    """

    def __init__(self, board: Board) -> None:
        self.board = board

    def answer(
        self, request: Request, sessions: Sequence[LiveSession], sieve: Sieve = lambda news: news
    ) -> Response:
        """Return a stream of what is new in sessions, which goes on where a page has left off."""
        last = last_lines(request.headers.get("last-event-id", ""))
        readers = [SessionReader(session, last.get(session.name, 0)) for session in sessions]
        return EventSourceResponse(self._news(readers, sieve), ping=PING_S)

    async def _news(
        self, readers: Sequence[SessionReader], sieve: Sieve
    ) -> AsyncIterator[ServerSentEvent]:
        """Yield what is new, until the page or the server goes."""
        signal = self.board.watch()
        try:
            while not self.board.is_closed:
                for reader in readers:
                    message = reader.news()
                    if message is not None:
                        number = ",".join(f"{r.session.name}:{r.line}" for r in readers)
                        text = json.dumps(sieve(message), ensure_ascii=False)
                        yield ServerSentEvent(text, event="news", id=number, retry=RETRY_MS)
                await signal.wait()
                signal.clear()
        finally:
            self.board.leave(signal)


class SessionReader:
    """What one page has seen of a session.

    Args:
        session: The session.
        line: The last line of its journal that the page has seen.
    """

    def __init__(self, session: LiveSession, line: int) -> None:
        self.session, self.line = session, line
        self._version = -1
        self._has_head = False

    def news(self) -> dict[str, Any] | None:
        """Return what is new for the page; None if nothing is."""
        version = self.session.version
        if version == self._version:
            return None
        self._version = version
        now, entries = self.session.now, self.session.entries(self.line)
        self.line = max([self.line, *(entry["n"] for entry in entries)])
        message = {"session": self.session.name, "entries": entries, "now": now}
        if self.session.head and not self._has_head:
            self._has_head = True
            message["head"] = self.session.head
        return message


def last_lines(text: str) -> dict[str, int]:
    """Return by session the last line that a page has seen, as its last event's number says.

    >>> last_lines("ab12:14,cd34:2,x")
    {'ab12': 14, 'cd34': 2}
    """
    pairs = (part.partition(":") for part in text[:1000].split(","))
    return {name: int(n[:9]) for name, _, n in pairs if n.isdecimal()}
