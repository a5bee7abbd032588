"""The routes of the server: pages, sessions, and one stream of news for each page."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Awaitable, Callable
from concurrent.futures import Future
from typing import Any
from urllib.parse import parse_qs, quote

from sse_starlette import EventSourceResponse, ServerSentEvent
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, RedirectResponse, Response
from starlette.routing import Route

from hrcplan.errors import HrcplanError, InputError, UsageError
from hrcplan.web.board import Board
from hrcplan.web.frontend import FRONTEND
from hrcplan.web.live_session import LiveSession
from hrcplan.web.pages import home_page, live_page
from hrcplan.web.safety import AccessRules, Guard, RateLimit, RefusalError
from hrcplan.web.sessions import Sessions, spec_of
from hrcplan.web.worlds import offers

MAX_STREAMS = 8  # sessions that one page follows
RETRY_MS = 500  # after which a page looks for a server that has gone
ANSWER_S = 30.0  # how long a page waits for an answer before it asks again
_STATUS = {"stale": 409, "over": 409, "too-many": 429, "not-found": 404}
Handler = Callable[[Request], Awaitable[Response]]


class PageApp:
    """What answers the requests of pages.

    Args:
        sessions: The collaborations.
        board: Says when one of them has something new.
        rules: Who may ask.
    """

    def __init__(self, sessions: Sessions, board: Board, rules: AccessRules) -> None:
        self.sessions, self.board, self.rules = sessions, board, rules

    def asgi(self, limit: RateLimit | None = None) -> Guard:
        """Return the application with its guard."""
        routes = [
            Route("/", self._index),
            Route("/static/{name}", self._static),
            Route("/begin", self._answered(self._begin), methods=["POST"]),
            Route("/c", self._side_by_side),
            Route("/c/{names}", self._answered(self._live)),
            Route("/api/sessions/{name}", self._answered(self._delete), methods=["DELETE"]),
            Route("/api/sessions/{name}/events", self._answered(self._event), methods=["POST"]),
            Route("/api/sessions/{name}/why", self._answered(self._why)),
            Route("/api/stream", self._answered(self._stream)),
        ]
        return Guard(
            Starlette(routes=routes, exception_handlers={RefusalError: _refused}), self.rules, limit
        )

    def _answered(self, handler: Handler) -> Handler:
        """Return a handler whose errors are answers."""

        async def handle(request: Request) -> Response:
            try:
                return await handler(request)
            except HrcplanError as error:
                status = _STATUS.get(error.code, 400)
                what = {"code": error.code, "message": error.message, "hint": error.hint}
                return JSONResponse({"error": what}, status)

        return handle

    # Files of the front end.

    async def _index(self, request: Request) -> Response:
        token = request.query_params.get("token")
        if token is None:
            rows = await asyncio.to_thread(self.sessions.overview)
            return HTMLResponse(home_page(await asyncio.to_thread(offers), rows))
        answer = RedirectResponse("/", 303)
        answer.set_cookie(self.rules.cookie, token, httponly=True, samesite="strict")
        return answer

    async def _static(self, request: Request) -> Response:
        name = request.path_params["name"]
        if name not in FRONTEND:
            return Response("there is no such file\n", 404)
        kind = "text/css" if name.endswith(".css") else "text/javascript"
        return Response(FRONTEND[name], media_type=kind)

    # Sessions.

    async def _side_by_side(self, request: Request) -> Response:
        names = "+".join(request.query_params.getlist("name")[:MAX_STREAMS])
        return RedirectResponse(f"/c/{quote(names)}" if names else "/", 303)

    async def _live(self, request: Request) -> Response:
        names = request.path_params["names"].split("+")[:MAX_STREAMS]
        for name in names:
            self._session(name)
        return HTMLResponse(live_page(names))

    async def _begin(self, request: Request) -> Response:
        form = {key: values[0] for key, values in parse_qs((await request.body()).decode()).items()}
        domain, _, goals = form.get("world", "").partition(" ")
        if (domain, goals) not in {(o["domain"], o["goals"]) for o in offers()}:
            raise UsageError("this is no domain with goals here", code="not-found")
        seed = form.get("seed", "")
        spec = spec_of({
            "domain": domain, "goals": goals, "pace": form.get("pace"),
            "method": form.get("robot"), "human": form.get("human"),
            "seed": int(seed[:9]) if seed.isdecimal() else 0,
        })  # fmt: skip
        session = await asyncio.to_thread(self.sessions.begin, spec)
        return RedirectResponse(f"/c/{session.name}", 303)

    async def _delete(self, request: Request) -> Response:
        self._session(request.path_params["name"])
        await asyncio.to_thread(self.sessions.delete, request.path_params["name"])
        return JSONResponse({})

    async def _event(self, request: Request) -> Response:
        document = await _document(request)
        session = self._session(request.path_params["name"])
        return JSONResponse({"n": await _reply(session.send(document))})

    async def _why(self, request: Request) -> Response:
        session = self._session(request.path_params["name"])
        return JSONResponse(await _reply(session.why()))

    def _session(self, name: str) -> LiveSession:
        session = self.sessions.get(name)
        if session is None:
            raise UsageError("there is no such collaboration", code="not-found")
        return session

    # News.

    async def _stream(self, request: Request) -> Response:
        names = request.query_params.get("sessions", "").split(",")[:MAX_STREAMS]
        sessions = [self._session(name) for name in names if name]
        last = _last_lines(request.headers.get("last-event-id", ""))
        return EventSourceResponse(self._news(sessions, last), ping=15)

    async def _news(
        self, sessions: list[LiveSession], last: dict[str, int]
    ) -> AsyncIterator[ServerSentEvent]:
        """Yield what is new in sessions, until the page or the server goes."""
        signal = self.board.watch()
        readers = [SessionReader(session, last.get(session.name, 0)) for session in sessions]
        try:
            while not self.board.is_closed:
                for reader in readers:
                    message = reader.news()
                    if message is not None:
                        number = ",".join(f"{r.session.name}:{r.line}" for r in readers)
                        text = json.dumps(message, ensure_ascii=False)
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


async def _refused(request: Request, error: Exception) -> Response:
    assert isinstance(error, RefusalError)
    return error.answer()


def _last_lines(text: str) -> dict[str, int]:
    """Return by session the last line that a page has seen, as its last event's number says.

    >>> _last_lines("ab12:14,cd34:2,x")
    {'ab12': 14, 'cd34': 2}
    """
    pairs = (part.partition(":") for part in text[:1000].split(","))
    return {name: int(n[:9]) for name, _, n in pairs if n.isdecimal()}


async def _document(request: Request) -> dict[str, Any]:
    """Return the JSON object of a request.

    Raises:
        InputError: if it has none.
    """
    try:
        document = json.loads(await request.body())
    except (ValueError, RecursionError):
        document = None
    if not isinstance(document, dict):
        raise InputError("a JSON object is needed", code="bad-request")
    return document


async def _reply(future: Future[Any]) -> Any:
    """Return what a session replies.

    Raises:
        UsageError: if it takes too long.
    """
    try:
        return await asyncio.wait_for(asyncio.wrap_future(future), ANSWER_S)
    except TimeoutError:
        raise UsageError("the robot still thinks", code="slow") from None
