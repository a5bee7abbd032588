"""The page in a real browser: clicks, words, keys, a lost connection, small and dark screens."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = pytest.mark.xdist_group("browser")
WAIT_MS = 60_000


class ServerProcess:
    """``hrcplan serve`` as users start it."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.port = folder, 0
        self.start()

    def start(self) -> None:
        port = ["--port", str(self.port)] if self.port else []
        self.process = subprocess.Popen(
            [sys.executable, "-m", "hrcplan", "serve", "--folder", str(self.folder), *port],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        assert self.process.stdout is not None
        self.link = self.process.stdout.readline().strip()
        self.port = int(re.search(r":(\d+)/", self.link)[1])  # type: ignore[index]

    def stop(self, number: int = signal.SIGINT) -> tuple[float, int, str]:
        """Return how long the end took, the exit code, and what was said on stderr."""
        since = time.monotonic()
        self.process.send_signal(number)
        _, errors = self.process.communicate(timeout=60)
        return time.monotonic() - since, self.process.returncode, errors


@pytest.fixture(scope="module")
def browser() -> Iterator["Browser"]:
    from playwright.sync_api import sync_playwright

    path = os.environ.get("HRCPLAN_CHROMIUM") or None
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ServerProcess]:
    server = ServerProcess(tmp_path_factory.mktemp("served"))
    yield server
    if server.process.poll() is None:
        server.stop()


@pytest.fixture
def open_page(browser: "Browser", server: ServerProcess) -> Iterator[Callable[..., "Page"]]:
    """Return a function that opens a page; a fault in a script fails the test."""
    faults: list[str] = []
    contexts = []

    def open_page(**options: object) -> "Page":
        context = browser.new_context(**options)  # type: ignore[arg-type]
        contexts.append(context)
        page = context.new_page()
        page.set_default_timeout(WAIT_MS)
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.on("request", lambda request: _own(request.url, faults))
        page.goto(server.link)
        return page

    yield open_page
    for context in contexts:
        context.close()
    assert faults == []


def _own(url: str, faults: list[str]) -> None:
    if not url.startswith(("http://127.0.0.1:", "data:", "blob:")):
        faults.append(f"a request to {url}")


def begin(page: "Page", world: str, pace: str = "turns") -> None:
    page.select_option("select[name=world]", label=world)
    page.select_option("select[name=pace]", pace)
    page.click("button.main")
    page.locator(".groups button").first.wait_for()


def line(page: "Page") -> str:
    """Return the line of the journal that the page has seen last."""
    return page.locator("article").first.get_attribute("data-n") or ""


def wait_for_news(page: "Page", before: str) -> None:
    page.locator(f"article:not([data-n='{before}'])").first.wait_for()


def say(page: "Page", text: str) -> None:
    before = line(page)
    page.fill("form input[type=text]", text)
    page.keyboard.press("Enter")
    wait_for_news(page, before)


def click_step(page: "Page", text: str) -> None:
    before = line(page)
    page.get_by_role("button", name=text, exact=True).click()
    wait_for_news(page, before)


def overflow(page: "Page") -> int:
    return int(page.evaluate("document.documentElement.scrollWidth - window.innerWidth"))


def finish_by_clicks(page: "Page") -> None:
    """Click the first step that is offered until a goal holds, and say that this was all."""
    for _ in range(60):
        page.bring_to_front()
        page.locator(".ask button, .groups button:enabled").first.wait_for()
        yes = page.locator(".ask button", has_text="yes")
        before = line(page)
        if yes.count():
            yes.first.click()
            page.locator("section[role=status] h2").wait_for()
            return
        page.locator(".groups button").first.click()
        wait_for_news(page, before)
    raise AssertionError("no goal was reached")


def test_an_episode_by_clicks_reaches_a_goal(open_page: Callable[..., "Page"]) -> None:
    page = open_page()
    begin(page, "transport/two-boxes (one goal: a plan is followed)")
    finish_by_clicks(page)
    assert page.locator("section[role=status] h2").inner_text() == "goal reached"


def test_an_episode_by_words_with_a_change_of_mind(open_page: Callable[..., "Page"]) -> None:
    page = open_page()
    begin(page, "kitchen")
    for text in ("get oats", "get pan", "I add water to the pan", "pour the oats into the pan"):
        say(page, text)
    for text in ("get lettuce", "get cucumber", "get tomato", "get salt", "get onion"):
        if page.locator(".log .change").count():
            break
        say(page, text)
    assert "seems to be" in page.locator(".log .change").first.inner_text()
    assert page.locator("svg line[stroke-dasharray='5 3']").count() >= 1


def test_a_collaboration_by_keyboard_only(open_page: Callable[..., "Page"]) -> None:
    page = open_page()
    page.locator("select[name=world]").focus()
    page.keyboard.type("transport-goals")
    for _ in range(10):
        page.keyboard.press("Tab")
        if page.evaluate("document.activeElement.tagName") == "BUTTON":
            break
    page.keyboard.press("Enter")
    page.locator(".groups button").first.wait_for()
    assert page.evaluate("document.activeElement.getAttribute('aria-label')") == "say what you do"
    before = line(page)
    page.keyboard.type("1")
    page.keyboard.press("Enter")
    wait_for_news(page, before)
    for _ in range(40):
        page.keyboard.press("Tab")
        if page.evaluate("document.activeElement.closest('.groups') !== null"):
            break
    before = line(page)
    page.keyboard.press("Space")
    wait_for_news(page, before)


def test_undo_why_pause_and_states(open_page: Callable[..., "Page"]) -> None:
    page = open_page()
    begin(page, "transport-goals")
    say(page, "go to wp4")
    page.get_by_role("button", name="why?").click()
    page.get_by_text("the robot could").wait_for()
    page.get_by_role("button", name="undo").click()
    page.get_by_text("is taken back").wait_for()
    page.get_by_role("button", name="pause").click()
    page.get_by_text("the robot waits").first.wait_for()
    page.get_by_role("button", name="go", exact=True).click()
    page.get_by_text("the robot goes on").wait_for()
    page.locator("summary", has_text="How the agents are").click()
    slider = page.get_by_label("motivation human")
    slider.fill("8")
    page.get_by_text("motivation human is 8").first.wait_for()


def test_a_second_window_follows_and_a_reload_shows_all(open_page: Callable[..., "Page"]) -> None:
    page = open_page()
    begin(page, "transport-goals")
    second = page.context.new_page()
    second.goto(page.url)
    second.locator(".groups button").first.wait_for()
    say(page, "go to wp4")
    second.locator(".log li").nth(1).wait_for()
    page.reload()
    page.locator(".log li").nth(1).wait_for()
    assert page.locator(".log").inner_text() == second.locator(".log").inner_text()


@pytest.mark.parametrize("world", ["kitchen", "transport-goals"])
def test_a_phone_has_no_overflow_in_the_dark(open_page: Callable[..., "Page"], world: str) -> None:
    page = open_page(viewport={"width": 375, "height": 700}, color_scheme="dark")
    assert overflow(page) <= 0
    begin(page, world)
    click_step(page, page.locator(".groups button").first.inner_text())
    assert overflow(page) <= 0
    ground = page.evaluate("getComputedStyle(document.body).backgroundColor")
    assert max(map(int, re.findall(r"\d+", ground)[:3])) < 64


def test_several_stand_side_by_side(open_page: Callable[..., "Page"]) -> None:
    page = open_page(viewport={"width": 1300, "height": 800})
    names = []
    for _ in range(2):
        page.goto(page.url.split("/c/")[0])
        begin(page, "transport-goals")
        names.append(page.url.rpartition("/")[2])
    page.goto(page.url.replace(names[1], "+".join(names)))
    page.locator("article").nth(1).locator(".groups button").first.wait_for()
    page.locator("article").first.locator(".groups button").first.click()
    page.locator("article").first.locator(".log li").first.wait_for()
    assert page.locator("article").nth(1).locator(".log li").count() <= 1


@pytest.mark.parametrize("kind", ["SVG", "PNG", "CSV"])
def test_pictures_are_saved(open_page: Callable[..., "Page"], tmp_path: Path, kind: str) -> None:
    page = open_page(accept_downloads=True)
    begin(page, "transport-goals")
    for button in page.get_by_role("button", name=kind).all()[:2]:
        with page.expect_download() as download:
            button.click()
        path = tmp_path / download.value.suggested_filename
        download.value.save_as(path)
        start = {"SVG": b"<svg", "PNG": b"\x89PNG"}.get(kind, b"")
        assert path.read_bytes().startswith(start)
        assert path.stat().st_size > 20


def test_a_replay_is_one_page_that_asks_for_nothing(browser: "Browser", tmp_path: Path) -> None:
    journal, html = tmp_path / "j.jsonl", tmp_path / "j.html"
    run = [sys.executable, "-m", "hrcplan"]
    subprocess.run([*run, "execute", "transport/two-boxes", "--journal", str(journal), "--change",
                    "motivation human=9@60"], check=True, capture_output=True)  # fmt: skip
    subprocess.run([*run, "replay", str(journal), "--html", str(html)], check=True,
                   capture_output=True)  # fmt: skip
    page = browser.new_page(viewport={"width": 375, "height": 700})
    faults: list[str] = []
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("console", lambda message: faults.append(message.text))
    requests: list[str] = []
    page.on("request", lambda request: requests.append(request.url))
    page.goto(f"file://{html}")
    assert page.locator(".log .plan").count() >= 2
    page.locator("input[type=range]").fill("0")
    assert page.locator(".log li").count() == 0
    assert overflow(page) <= 0
    assert [url for url in requests if not url.startswith(("file:", "data:"))] == []
    assert faults == []
    page.close()


def test_names_of_pddl_are_never_markup(browser: "Browser", tmp_path: Path) -> None:
    from hrcplan.web.replay_page import one_file

    name = "<img/src=x/onerror=alert(1)></script><b>"
    scene = {"agents": [{"name": name, "robot": True}], "objects": {name: {"type": name}},
             "views": {}, "facts": [f"at {name}"], "map": None}  # fmt: skip
    head = {"domain": name, "unit": "s", "states": {}, "scene": scene, "goals": [name]}
    entry = {"n": 2, "t": 0, "notes": [{"kind": "note", "text": name}], "belief": [[name, 1]],
             "bars": [{"number": 1, "agent": name, "action": name, "args": [name], "start": 0,
                       "end": 1, "outcome": "done"}]}  # fmt: skip
    path = tmp_path / "page.html"
    path.write_text(one_file(name, {"head": head, "entries": [entry], "title": name}))
    page = browser.new_page()
    page.goto(f"file://{path}")
    assert page.locator("h1").inner_text() == name
    assert page.locator("img, b").count() == 0
    page.close()


def test_a_killed_server_goes_on_with_the_open_page(browser: "Browser", tmp_path: Path) -> None:
    server = ServerProcess(tmp_path)
    page = browser.new_page()
    page.set_default_timeout(WAIT_MS)
    page.goto(server.link)
    begin(page, "transport-goals")
    say(page, "go to wp4")
    before = page.locator(".log").inner_text()
    server.stop(signal.SIGKILL)
    page.get_by_text("No connection").wait_for()
    server.start()
    page.get_by_text("No connection").wait_for(state="hidden")
    say(page, "grasp blue wp4")
    assert page.locator(".log").inner_text().startswith(before)
    page.close()
    server.stop()


def test_ctrl_c_with_three_open_pages_ends_without_a_traceback(
    browser: "Browser", tmp_path: Path
) -> None:
    server = ServerProcess(tmp_path)
    context = browser.new_context()
    pages = [context.new_page() for _ in range(3)]
    pages[0].goto(server.link)
    begin(pages[0], "transport-goals")
    for page in pages[1:]:
        page.goto(pages[0].url)
        page.locator(".groups button").first.wait_for()
    seconds, code, errors = server.stop()
    context.close()
    assert code == 130
    assert "Traceback" not in errors
    assert seconds < 10


def test_the_journals_of_pages_are_derived_again(server: ServerProcess) -> None:
    journals = sorted((server.folder / "sessions").glob("*.jsonl"))
    assert journals
    for journal in journals:
        done = subprocess.run([sys.executable, "-m", "hrcplan", "replay", str(journal), "--json"],
                              check=True, capture_output=True)  # fmt: skip
        assert json.loads(done.stdout)["ok"]
