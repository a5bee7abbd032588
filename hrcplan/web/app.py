"""The routes of the server: pages, sessions, and one stream of news for each page."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Sequence
from html import escape
from urllib.parse import quote

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, RedirectResponse, Response
from starlette.routing import Route

from hrcplan.errors import HrcplanError, UsageError
from hrcplan.web.frontend import FRONTEND
from hrcplan.web.live_session import LiveSession
from hrcplan.web.looks import STUDY, LookFile, look_page
from hrcplan.web.pages import card, document, home_page, live_page
from hrcplan.web.requests import Handler, document_of, form_of, reply_of
from hrcplan.web.safety import AccessRules, Guard, RateLimit, RefusalError
from hrcplan.web.sessions import Sessions, spec_of
from hrcplan.web.streams import Streams
from hrcplan.web.trials.trial_routes import TrialRoutes
from hrcplan.web.worlds import offers

REPORT_POLICY = (
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'"
)
MAX_STREAMS = 8  # sessions that one page follows
_STATUS = {"stale": 409, "over": 409, "too-many": 429, "not-found": 404, "slow": 504,
           "study-full": 409}  # fmt: skip


class PageApp:
    """What answers the requests of pages.

    Args:
        sessions: The collaborations.
        streams: Send pages what is new.
        rules: Who may ask.
        trials: The addresses of participants, if there is a study.
        files: Files to look at.
    """

    def __init__(
        self, sessions: Sessions, streams: Streams, rules: AccessRules,
        trials: TrialRoutes | None = None, files: Sequence[LookFile] = (),
    ) -> None:  # fmt: skip
        self.sessions, self.streams, self.rules, self.trials = sessions, streams, rules, trials
        self.files = files

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
            Route("/look/{number}", self._answered(self._look)),
            *(self.trials.routes(self._answered) if self.trials is not None else ()),
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
                if "text/html" in request.headers.get("accept", ""):
                    page = _error_page(error).encode("utf-8", "backslashreplace")
                    return HTMLResponse(page, status)
                what = {"code": error.code, "message": error.message, "hint": error.hint}
                text = json.dumps({"error": what})  # ASCII: half of a character has an escape, too
                return Response(text, status, media_type="application/json")

        return handle

    # Files of the front end.

    async def _index(self, request: Request) -> Response:
        token = request.query_params.get("token")
        if token is None:
            rows = await asyncio.to_thread(self.sessions.overview)
            return HTMLResponse(
                home_page(await asyncio.to_thread(offers), rows, [f.title for f in self.files])
            )
        answer = RedirectResponse("/", 303)
        answer.set_cookie(self.rules.cookie, token, httponly=True, samesite="strict")
        return answer

    async def _static(self, request: Request) -> Response:
        name = request.path_params["name"]
        if name not in FRONTEND:
            return Response("there is no such file\n", 404)
        kind = "text/css" if name.endswith(".css") else "text/javascript"
        return Response(FRONTEND[name], media_type=kind)

    async def _look(self, request: Request) -> Response:
        file = dict(zip(map(str, range(len(self.files))), self.files, strict=True)).get(
            request.path_params["number"]
        )
        if file is None:
            raise UsageError("there is no such file", code="not-found")
        page = await asyncio.to_thread(look_page, file, request.query_params.get("goal"))
        answer = HTMLResponse(page)
        if file.kind == STUDY:  # one file with its own style and pictures, and no script
            answer.headers["Content-Security-Policy"] = REPORT_POLICY
        return answer

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
        form = await form_of(request)
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
        document = await document_of(request)
        session = self._session(request.path_params["name"])
        return JSONResponse({"n": await reply_of(session.send(document))})

    async def _why(self, request: Request) -> Response:
        session = self._session(request.path_params["name"])
        return JSONResponse(await reply_of(session.why()))

    async def _stream(self, request: Request) -> Response:
        names = request.query_params.get("sessions", "").split(",")[:MAX_STREAMS]
        return self.streams.answer(request, [self._session(name) for name in names if name])

    def _session(self, name: str) -> LiveSession:
        session = self.sessions.get(name)
        if session is None:
            raise UsageError("there is no such collaboration", code="not-found")
        return session


def _error_page(error: HrcplanError) -> str:
    hint = f" ({error.hint})" if error.hint else ""
    body = f"<p>{escape(error.message + hint)}</p><p>Go back, and try again.</p>"
    return document("hrcplan", f"<main>{card('This does not work', body)}</main>")


async def _refused(request: Request, error: Exception) -> Response:
    assert isinstance(error, RefusalError)
    return error.answer()
