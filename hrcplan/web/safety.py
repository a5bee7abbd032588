"""Who may ask for what: every request passes these checks, and every answer gets these headers.

A page in another tab, or another machine, must not be able to reach a collaboration: the names in
``Host`` and ``Origin`` have to be those of this server, and a request needs the token of the
start-up link.
"""

from __future__ import annotations

import hmac
import time
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import cookie_parser
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

MAX_BODY = 64 << 10  # bytes
METHODS = ("GET", "HEAD", "POST", "DELETE")
RATE, BURST = 60.0, 240.0  # requests per second on average, and at once
MAX_CALLERS = 4096
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
    "img-src 'self' data: blob:; form-action 'self'; base-uri 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-store",
}


class RefusalError(Exception):
    """A request that is not answered: a status and the reason in words."""

    def __init__(self, status: int, why: str) -> None:
        super().__init__(why)
        self.status, self.why = status, why

    def answer(self) -> PlainTextResponse:
        """Return what is sent instead."""
        return PlainTextResponse(f"{self.why}\n", self.status)


@dataclass(frozen=True)
class AccessRules:
    """What the guard of one server lets through.

    Attributes:
        hosts: The names, with ports, by which this server may be addressed.
        token: The secret of the start-up link.
        cookie: The name of the cookie that holds it.
        open_paths: Beginnings of paths that need no token.
    """

    hosts: frozenset[str]
    token: str
    cookie: str
    open_paths: tuple[str, ...] = ("/static/", "/p/")

    def knows(self, token: str) -> bool:
        """Return whether a token is the secret."""
        return hmac.compare_digest(token.encode(), self.token.encode())


class RateLimit:
    """How many requests each caller has left; a caller is any text.

    Args:
        rate: Requests per second on average.
        burst: Requests at once.
        clock: Returns seconds.
    """

    def __init__(
        self, rate: float = RATE, burst: float = BURST,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:  # fmt: skip
        self.rate, self.burst, self._clock = rate, burst, clock
        self._left: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def take(self, caller: str) -> bool:
        """Return whether one more request of a caller is within the limit."""
        now = self._clock()
        left, since = self._left.pop(caller, (self.burst, now))
        left = min(self.burst, left + (now - since) * self.rate)
        self._left[caller] = (max(0.0, left - 1), now)
        if len(self._left) > MAX_CALLERS:
            self._left.popitem(last=False)
        return left >= 1


class Guard:
    """Checks requests before an application sees them.

    Args:
        app: The application.
        rules: What is let through.
        limit: How often.
    """

    def __init__(self, app: ASGIApp, rules: AccessRules, limit: RateLimit | None = None) -> None:
        self.app, self.rules, self.limit = app, rules, limit or RateLimit()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] == "lifespan":
            await self.app(scope, receive, send)
            return
        if scope["type"] != "http":
            return  # there are no web sockets here

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in HEADERS.items():
                    headers.setdefault(name, value)
            await send(message)

        try:
            self._check(scope)
            await self.app(scope, _bounded(receive), send_with_headers)
        except RefusalError as refusal:
            await refusal.answer()(scope, receive, send_with_headers)

    def _check(self, scope: Scope) -> None:
        headers = Headers(scope=scope)
        host = headers.get("host", "")
        if host not in self.rules.hosts:
            raise RefusalError(403, "this server is not addressed by this name")
        if scope["method"] not in METHODS:
            raise RefusalError(405, "this method is not known here")
        origin = headers.get("origin")
        if origin is not None and origin not in (f"http://{host}", f"https://{host}"):
            raise RefusalError(403, "requests of other pages are not answered")
        if headers.get("sec-fetch-site") == "cross-site" and scope["path"] != "/":
            raise RefusalError(403, "requests of other pages are not answered")
        length = headers.get("content-length", "0")
        if not length.isdecimal() or int(length[:18]) > MAX_BODY:
            raise RefusalError(413, f"a request has at most {MAX_BODY} bytes")
        token = self._token(scope, headers)
        if not self._is_open(scope["path"]) and not self.rules.knows(token):
            raise RefusalError(403, "open the link that 'hrcplan serve' has printed")
        caller = token if self.rules.knows(token) else "/".join(scope["path"].split("/")[:3])[:80]
        if not self.limit.take(caller):
            raise RefusalError(429, "too many requests at once")

    def _is_open(self, path: str) -> bool:
        return path.startswith(self.rules.open_paths)

    def _token(self, scope: Scope, headers: Headers) -> str:
        if scope["path"] == "/" and scope["query_string"].startswith(b"token="):
            return str(scope["query_string"], "latin-1").removeprefix("token=")
        cookies: dict[str, str] = cookie_parser(headers.get("cookie", ""))
        return cookies.get(self.rules.cookie, "")


def _bounded(receive: Receive) -> Receive:
    """Return a channel that refuses bodies that are too long, whatever their header says."""
    n_bytes = 0

    async def receive_some() -> Message:
        nonlocal n_bytes
        message = await receive()
        n_bytes += len(message.get("body", b""))
        if n_bytes > MAX_BODY:
            raise RefusalError(413, f"a request has at most {MAX_BODY} bytes")
        return message

    return receive_some
