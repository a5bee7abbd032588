"""One test per line of defence, against a real server on a free port."""

import asyncio
import contextlib
import socket

import pytest
from starlette.responses import PlainTextResponse
from starlette.types import Message, Receive, Scope, Send

from hrcplan.web.safety import MAX_BODY, AccessRules, Guard, RateLimit
from tests.web.conftest import COOKIE, TOKEN, Client, form

CLOSED = ["/", "/api/nothing", "/api/stream?sessions=", "/api/sessions/abcdef/why"]


@pytest.mark.parametrize("path", CLOSED)
@pytest.mark.parametrize("cookie", ["", f"{COOKIE}=wrong", f"other={TOKEN}"])
def test_nothing_is_said_without_the_token(client: Client, path: str, cookie: str) -> None:
    status, text, _ = client.ask_as("GET", path, None, {"Cookie": cookie})
    assert status == 403
    assert "hrcplan serve" in text


def test_a_wrong_token_in_the_link_is_refused(client: Client) -> None:
    assert client.ask_as("GET", "/?token=wrong", None, {})[0] == 403


def test_the_link_leaves_its_token_in_a_cookie_that_scripts_cannot_read(client: Client) -> None:
    status, _, headers = client.ask_as("GET", f"/?token={TOKEN}", None, {})
    assert (status, headers["location"]) == (303, "/")
    cookie = headers["set-cookie"].lower()
    assert "httponly" in cookie
    assert "samesite=strict" in cookie


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1", "127.0.0.1:1", ""])
def test_a_foreign_host_is_refused(client: Client, host: str) -> None:
    assert client.ask("GET", "/api/nothing", Host=host)[0] == 403


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:1"])
def test_a_foreign_origin_is_refused(client: Client, origin: str) -> None:
    assert client.ask("POST", "/begin", form(), Origin=origin)[0] == 403
    assert client.ask("GET", "/", Origin=origin)[0] == 403


def test_our_own_origin_is_served(client: Client) -> None:
    assert client.ask("GET", "/", Origin=f"http://{client.host}")[0] == 200


def test_requests_that_a_browser_marks_as_cross_site_are_refused(client: Client) -> None:
    assert client.ask("GET", "/api/nothing", **{"Sec-Fetch-Site": "cross-site"})[0] == 403


@pytest.mark.parametrize("path", ["/", "/static/page.css", "/api/nothing", "/nowhere"])
def test_every_answer_has_the_policy(client: Client, path: str) -> None:
    headers = client.ask("GET", path)[2]
    policy = headers["content-security-policy"]
    assert policy.startswith("default-src 'none'")
    assert "unsafe" not in policy
    assert "http" not in policy
    assert headers["x-content-type-options"] == "nosniff"
    assert headers["referrer-policy"] == "same-origin"


@pytest.mark.parametrize(
    "path",
    ["/static/../app.py", "/static/..%2fapp.py", "/static/%2e%2e/app.py", "/../../etc/passwd",
     "/static//etc/passwd", "/static/app.py", "/static/frontend.py"],
)  # fmt: skip
def test_no_file_but_those_of_the_front_end_is_read(client: Client, path: str) -> None:
    status, text, _ = client.ask("GET", path)
    assert status == 404
    assert "import" not in text


@pytest.mark.parametrize("name", ["../secret", "..", "a/b", "%2e%2e%2fsecret", "x" * 500])
def test_a_session_is_no_path(client: Client, name: str) -> None:
    client.sessions.folder.mkdir(parents=True, exist_ok=True)
    (client.sessions.folder.parent / "secret.json").write_text('{"domain": "kitchen"}')
    for method, rest in (("GET", "/why"), ("POST", "/events"), ("DELETE", "")):
        assert client.ask(method, f"/api/sessions/{name}{rest}", {})[0] in (404, 405)


@pytest.mark.parametrize("domain", ["/etc/passwd", "../x", "domains/kitchen.pddl", "nothing"])
def test_a_page_cannot_name_a_file_as_domain(client: Client, domain: str) -> None:
    assert client.ask("POST", "/begin", form(f"{domain} {domain}"))[0] == 404


@pytest.mark.parametrize("key", ["robot", "human"])
def test_a_page_cannot_choose_which_code_runs(client: Client, key: str) -> None:
    status, text, _ = client.ask("POST", "/begin", form(**{key: "os:system"}))
    assert (status, "unknown-name" in text) == (400, True)


@pytest.mark.parametrize("body", [b"", b"[]", b"{", b"nul", b"[" * 50_000, b"\xff{}"])
def test_a_body_that_is_no_object_is_refused(client: Client, body: bytes) -> None:
    assert client.ask("POST", f"/api/sessions/{client.begin()}/events", body)[0] == 400


def test_a_long_body_is_refused(client: Client) -> None:
    assert client.ask("POST", "/begin", b" " * (MAX_BODY + 1))[0] == 413


def test_a_body_without_a_length_is_counted(client: Client) -> None:
    with socket.create_connection(("127.0.0.1", client.port), timeout=30) as connection:
        head = (
            f"POST /begin HTTP/1.1\r\nHost: {client.host}\r\nCookie: {COOKIE}={TOKEN}\r\n"
            "Transfer-Encoding: chunked\r\n\r\n"
        )
        chunk = b"8000\r\n" + b" " * 0x8000 + b"\r\n"
        connection.sendall(head.encode() + chunk * 3 + b"0\r\n\r\n")
        assert connection.recv(100).startswith(b"HTTP/1.1 413")


def test_long_headers_are_refused(client: Client) -> None:
    with contextlib.suppress(ConnectionError):
        assert client.ask("GET", "/", **{"X-Long": "x" * 200_000})[0] in (400, 431)


@pytest.mark.parametrize("method", ["PUT", "PATCH", "OPTIONS", "TRACE"])
def test_other_methods_are_refused(client: Client, method: str) -> None:
    assert client.ask(method, "/api/nothing")[0] == 405


def test_callers_have_a_rate() -> None:
    now = [0.0]
    limit = RateLimit(rate=2, burst=3, clock=lambda: now[0])
    assert [limit.take("a") for _ in range(4)] == [True, True, True, False]
    assert limit.take("b")
    now[0] = 0.5
    assert [limit.take("a") for _ in range(2)] == [True, False]


def test_too_many_requests_are_refused() -> None:
    rules = AccessRules(frozenset(["here"]), TOKEN, COOKIE)
    statuses = []

    async def app(scope: Scope, receive: Receive, send: Send) -> None:
        await PlainTextResponse("served")(scope, receive, send)

    async def send(message: Message) -> None:
        if message["type"] == "http.response.start":
            statuses.append(message["status"])

    async def receive() -> Message:
        return {"type": "http.request", "body": b""}

    guard = Guard(app, rules, RateLimit(rate=0, burst=2))
    scope = {
        "type": "http", "method": "GET", "path": "/p/x", "query_string": b"",
        "headers": [(b"host", b"here")],
    }  # fmt: skip
    for _ in range(3):
        asyncio.run(guard(scope, receive, send))
    assert statuses == [200, 200, 429]
