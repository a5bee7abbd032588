"""The addresses that participants use: each begins with the secret of its participant."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, RedirectResponse, Response
from starlette.routing import Route

from hrcplan.errors import UsageError
from hrcplan.web.requests import Handler, document_of, form_of, reply_of
from hrcplan.web.streams import Streams
from hrcplan.web.trials import trial_pages as pages
from hrcplan.web.trials.participants import CONSENT, Participant
from hrcplan.web.trials.trial_desk import TrialDesk


class TrialRoutes:
    """Answers requests of participants.

    Args:
        desk: Leads them.
        streams: Sends them news.
    """

    def __init__(self, desk: TrialDesk, streams: Streams) -> None:
        self.desk, self.streams = desk, streams

    def routes(self, answered: Callable[[Handler], Handler]) -> list[Route]:
        """Return the routes; ``answered`` makes answers of errors."""
        return [
            Route("/p/{code}", answered(self._page)),
            Route("/p/{code}", answered(self._go_on), methods=["POST"]),
            Route("/p/{code}/delete", answered(self._ask_delete)),
            Route("/p/{code}/delete", answered(self._delete), methods=["POST"]),
            Route("/p/{code}/stream", answered(self._stream)),
            Route("/p/{code}/sessions/{name}/events", answered(self._event), methods=["POST"]),
        ]

    def _person(self, request: Request) -> Participant:
        person = self.desk.participants.get(request.path_params["code"])
        if person is None:
            raise UsageError("there is nothing behind this link", code="not-found")
        return person

    def _is_invitation(self, request: Request) -> bool:
        return bool(request.path_params["code"] == self.desk.invitation)

    async def _page(self, request: Request) -> Response:
        if self._is_invitation(request):
            return HTMLResponse(pages.arrival_page(self.desk.study))
        return HTMLResponse(await asyncio.to_thread(self.desk.page, self._person(request)))

    async def _go_on(self, request: Request) -> Response:
        form = await form_of(request)
        if self._is_invitation(request):
            if form.get("agree") != "yes":
                raise UsageError("your consent is needed to take part", code="no-answer")
            person = await asyncio.to_thread(self.desk.participants.arrive)
            assert person.stage == CONSENT
        else:
            person = await asyncio.to_thread(self.desk.go_on, self._person(request), form)
        return RedirectResponse(f"/p/{person.code}", 303)

    async def _ask_delete(self, request: Request) -> Response:
        return HTMLResponse(pages.delete_page(self.desk.study, self._person(request)))

    async def _delete(self, request: Request) -> Response:
        await asyncio.to_thread(self.desk.delete, self._person(request))
        return HTMLResponse(pages.deleted_page(self.desk.study))

    async def _stream(self, request: Request) -> Response:
        person = self._person(request)
        session = self.desk.own_session(person, request.query_params.get("sessions", ""))
        return self.streams.answer(
            request, [session], lambda message: self.desk.news(person, message)
        )

    async def _event(self, request: Request) -> Response:
        session = self.desk.own_session(self._person(request), request.path_params["name"])
        return JSONResponse({"n": await reply_of(session.send(await document_of(request)))})
