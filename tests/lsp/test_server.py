"""The language server as editors see it: real processes that speak the protocol."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from hrcplan.lsp.server import LONG

DOMAIN = """(define (domain boxes)
  (:requirements :typing)
  (:types box place)
  (:predicates (in ?b - box ?p - place) (clear ?p - place))
  ; ä😀 stands before an action
  (:action move :parameters (?b - box ?from ?to - place)
    :precondition (and (in ?b ?from) (cler ?to))
    :effect (and (not (in ?b ?from)) (in ?b ?to))))
"""
PROBLEM = """(define (problem one) (:domain boxes)
  (:objects a - box p q - place)
  (:init (in a p) (clear q)) (:goal (in a q)))
"""


class Editor:
    """A client that sends one message at a time and collects the faults that are published."""

    def __init__(self, folder: Path, encodings: list[str]) -> None:
        command = [sys.executable, "-m", "hrcplan", "lsp"]
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=folder
        )
        self.faults: dict[str, list[dict[str, object]]] = {}
        self.n_published = 0
        self.n_sent = 0
        general = {"general": {"positionEncodings": encodings}}
        self.capabilities = self.ask(
            "initialize", {"processId": None, "rootUri": None, "capabilities": general}
        )["capabilities"]
        self.tell("initialized", {})

    def _send(self, message: dict[str, object]) -> None:
        data = json.dumps({"jsonrpc": "2.0", **message}).encode()
        assert self.process.stdin is not None
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n" % len(data) + data)
        self.process.stdin.flush()

    def _receive(self) -> dict:
        assert self.process.stdout is not None
        length = 0
        while line := self.process.stdout.readline().strip():
            name, _, value = line.partition(b":")
            length = int(value) if name.lower() == b"content-length" else length
        message = json.loads(self.process.stdout.read(length))
        if message.get("method") == "textDocument/publishDiagnostics":
            params = message["params"]
            self.faults[Path(params["uri"]).name] = params["diagnostics"]
            self.n_published += 1
        return message

    def tell(self, method: str, params: object) -> None:
        self._send({"method": method, "params": params})

    def ask(self, method: str, params: object) -> dict:
        self.n_sent += 1
        self._send({"id": self.n_sent, "method": method, "params": params})
        while (message := self._receive()).get("id") != self.n_sent:
            pass
        assert "error" not in message, message
        return message["result"]

    def open(self, path: Path, text: str) -> None:
        document = {"uri": path.as_uri(), "languageId": "pddl", "version": 1, "text": text}
        self.tell("textDocument/didOpen", {"textDocument": document})

    def change(self, path: Path, text: str, version: int = 2) -> None:
        document = {"uri": path.as_uri(), "version": version}
        changes = [{"text": text}]
        self.tell("textDocument/didChange", {"textDocument": document, "contentChanges": changes})

    def at(self, path: Path, text: str, word: str, n_units: int | None = None) -> dict:
        """Return the place of a word in a text, as parameters of a question."""
        before = text[: text.index(word)]
        line = before.count("\n")
        column = len(before) - before.rfind("\n") - 1 if n_units is None else n_units
        return {
            "textDocument": {"uri": path.as_uri()},
            "position": {"line": line, "character": column},
        }

    def settle(self, path: Path) -> None:
        """Return when everything that was sent has been dealt with."""
        self.ask("textDocument/documentSymbol", {"textDocument": {"uri": path.as_uri()}})


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "domain.pddl").write_text(DOMAIN)
    (tmp_path / "one.pddl").write_text(PROBLEM)
    return tmp_path


@pytest.fixture
def editor(folder: Path) -> Iterator[Editor]:
    client = Editor(folder, ["utf-16"])
    yield client
    client.ask("shutdown", None)
    client.tell("exit", None)
    assert client.process.wait(20) == 0


def test_fault_is_shown_with_its_cure_and_goes_when_it_is_cured(
    editor: Editor, folder: Path
) -> None:
    domain = folder / "domain.pddl"
    editor.open(domain, DOMAIN)
    editor.settle(domain)
    (fault,) = editor.faults["domain.pddl"]
    assert fault["code"] == "unknown-predicate"
    assert fault["range"] == {
        "start": {"line": 6, "character": 38},
        "end": {"line": 6, "character": 42},
    }
    # A saved problem of the folder is checked, too, and its domain's fault is not its own.
    assert [f["code"] for f in editor.faults["one.pddl"]] in ([], ["faulty-domain"])
    actions = editor.ask(
        "textDocument/codeAction",
        {"textDocument": {"uri": domain.as_uri()}, "range": fault["range"],
         "context": {"diagnostics": [fault]}},
    )  # fmt: skip
    (edit,) = actions[0]["edit"]["changes"][domain.as_uri()]
    assert actions[0]["title"] == "change to 'clear'"
    assert (edit["newText"], edit["range"]) == ("clear", fault["range"])
    editor.change(domain, DOMAIN.replace("cler", "clear"))
    editor.settle(domain)
    assert editor.faults["domain.pddl"] == []


def test_problem_is_checked_against_the_open_text_of_its_domain(
    editor: Editor, folder: Path
) -> None:
    domain, problem = folder / "domain.pddl", folder / "one.pddl"
    editor.open(problem, PROBLEM)
    editor.open(domain, DOMAIN)
    renamed = DOMAIN.replace("cler", "clear").replace("clear", "empty")
    editor.change(domain, renamed)
    editor.settle(domain)
    assert [fault["code"] for fault in editor.faults["one.pddl"]] == ["unknown-predicate"]


def test_questions_about_names(editor: Editor, folder: Path) -> None:
    domain, problem = folder / "domain.pddl", folder / "one.pddl"
    editor.open(problem, PROBLEM)
    editor.open(domain, DOMAIN)
    asked = editor.at(problem, PROBLEM, "clear q")
    hover = editor.ask("textDocument/hover", asked)
    assert "(clear ?p - place)" in hover["contents"]["value"]
    (declared,) = editor.ask("textDocument/definition", asked)
    assert declared["uri"] == domain.as_uri()
    assert declared["range"]["start"] == {"line": 3, "character": 41}
    references = editor.ask(
        "textDocument/references", {**asked, "context": {"includeDeclaration": False}}
    )
    assert [Path(place["uri"]).name for place in references] == ["one.pddl"]
    action = editor.ask("textDocument/hover", editor.at(domain, DOMAIN, "move"))
    assert "(move ?b - box ?from ?to - place)" in action["contents"]["value"]
    symbols = editor.ask("textDocument/documentSymbol", {"textDocument": {"uri": domain.as_uri()}})
    assert [symbol["name"] for symbol in symbols][-1] == ":action move"


def test_rename_reaches_the_problems_but_a_variable_only_its_action(
    editor: Editor, folder: Path
) -> None:
    domain, problem = folder / "domain.pddl", folder / "one.pddl"
    editor.open(domain, DOMAIN)
    edit = editor.ask(
        "textDocument/rename", {**editor.at(domain, DOMAIN, "in ?b"), "newName": "inside"}
    )
    assert {Path(uri).name: len(edits) for uri, edits in edit["changes"].items()} == {
        "domain.pddl": 4,
        "one.pddl": 2,
    }
    (folder / "other.pddl").write_text(DOMAIN.replace("domain boxes", "domain others"))
    local = editor.ask(
        "textDocument/rename", {**editor.at(domain, DOMAIN, "?from"), "newName": "start"}
    )
    edits = local["changes"][domain.as_uri()]
    assert [edit["newText"] for edit in edits] == ["?start"] * 3
    assert list(local["changes"]) == [domain.as_uri()]
    assert problem.read_text() == PROBLEM


@pytest.mark.parametrize(("after", "offered", "not_offered"), [
    (" - ", "place", "clear"), ("(and (", "clear", "place"), ("(clear ", "q", "place"),
])  # fmt: skip
def test_completion_fits_the_place(
    editor: Editor, folder: Path, after: str, offered: str, not_offered: str
) -> None:
    problem = folder / "one.pddl"
    text = PROBLEM.replace("(:goal (in a q))", f"(:goal {after}")
    editor.open(problem, text)
    line = text[: text.index(":goal")].count("\n")
    column = text.splitlines()[line].index(after) + len(after)
    place = {"line": line, "character": column}
    document = {"uri": problem.as_uri()}
    items = editor.ask("textDocument/completion", {"textDocument": document, "position": place})
    labels = [item["label"] for item in items]
    assert offered in labels
    assert not_offered not in labels


def test_layout_replaces_the_whole_text(editor: Editor, folder: Path) -> None:
    domain = folder / "domain.pddl"
    editor.open(domain, DOMAIN.replace("    :effect", ":effect"))
    request = {
        "textDocument": {"uri": domain.as_uri()},
        "options": {"tabSize": 2, "insertSpaces": True},
    }
    (edit,) = editor.ask("textDocument/formatting", request)
    assert "\n    :effect (and" in edit["newText"]
    editor.change(domain, "(define (domain d)")
    assert editor.ask("textDocument/formatting", request) == []


@pytest.mark.parametrize(("encoding", "n_units"), [("utf-16", 4), ("utf-8", 7), ("utf-32", 3)])
def test_columns_count_as_the_editor_counts(folder: Path, encoding: str, n_units: int) -> None:
    client = Editor(folder, [encoding])
    assert client.capabilities["positionEncoding"] == encoding
    path = folder / "wide.pddl"
    client.open(path, "(define (domain d) (:predicates (p))\n(:action a :effect\n(ä😀 (p))))\n")
    client.settle(path)
    client.process.kill()
    client.process.wait()
    ends = [fault["range"]["end"] for fault in client.faults["wide.pddl"]]
    assert {"line": 2, "character": n_units} in ends


def test_a_closed_file_counts_as_it_is_on_disk(editor: Editor, folder: Path) -> None:
    domain, problem = folder / "domain.pddl", folder / "one.pddl"
    domain.write_text(DOMAIN.replace("cler", "clear"))
    editor.open(domain, DOMAIN)
    editor.open(problem, PROBLEM)
    editor.settle(problem)
    assert editor.faults["domain.pddl"]
    editor.tell("textDocument/didClose", {"textDocument": {"uri": domain.as_uri()}})
    editor.settle(problem)
    assert (editor.faults["domain.pddl"], editor.faults["one.pddl"]) == ([], [])


def test_a_renamed_file_leaves_no_faults_behind(editor: Editor, folder: Path) -> None:
    domain, problem = folder / "domain.pddl", folder / "one.pddl"
    editor.open(domain, DOMAIN)
    editor.open(problem, PROBLEM)
    domain.rename(folder / "domain.txt")
    editor.tell("textDocument/didClose", {"textDocument": {"uri": domain.as_uri()}})
    editor.settle(problem)
    assert editor.faults["domain.pddl"] == []
    assert "no domain 'boxes' given" in str(editor.faults["one.pddl"])


def test_a_long_file_is_checked_once_after_several_changes(editor: Editor, folder: Path) -> None:
    domain, n_changes = folder / "domain.pddl", 8
    long = DOMAIN.replace("cler", "clear") + ";" * LONG
    editor.open(domain, long)
    editor.settle(domain)
    n_before = editor.n_published
    for version in range(2, 2 + n_changes):
        editor.change(domain, long, version)
    editor.change(domain, DOMAIN + ";" * LONG, 2 + n_changes)
    while not editor.faults["domain.pddl"]:
        editor._receive()
    assert [fault["code"] for fault in editor.faults["domain.pddl"]] == ["unknown-predicate"]
    assert editor.n_published - n_before < n_changes


@pytest.mark.parametrize("uri", ["file:///no/such.pddl", "file://[", "untitled:1", "pipe"])
def test_a_question_about_a_file_that_cannot_be_read_has_an_answer(
    editor: Editor, folder: Path, uri: str
) -> None:
    if uri == "pipe":
        os.mkfifo(folder / "pipe.pddl")
        uri = (folder / "pipe.pddl").as_uri()
    document = {"textDocument": {"uri": uri}}
    place = {**document, "position": {"line": 3, "character": 5}}
    assert editor.ask("textDocument/hover", place) is None
    assert editor.ask("textDocument/documentSymbol", document) == []
    assert editor.ask("textDocument/definition", place) == []
