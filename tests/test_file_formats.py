"""Every key and column of the files that hrcplan writes is in ``docs/reference/files.md``."""

from __future__ import annotations

import hashlib
import html
import json
import re
import sqlite3
import tomllib
from collections.abc import Mapping
from contextlib import closing
from dataclasses import fields, replace
from fractions import Fraction
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hrcplan
from hrcplan.agents import Profile
from hrcplan.bank import Bank, build
from hrcplan.bank.bank import BuildOptions
from hrcplan.bank.store import save
from hrcplan.collaboration import events as shared
from hrcplan.collaboration.collaborate import collaborate
from hrcplan.collaboration.events import KINDS as COLLABORATION_KINDS
from hrcplan.collaboration.setup import setup_in
from hrcplan.errors import LimitError
from hrcplan.execution import FactChange, Nature, StateChange
from hrcplan.execution import events as ev
from hrcplan.execution.codec import KINDS, to_json
from hrcplan.inference.traces import ActionTrace, TraceAction, TraceAnswer, TracedEpisode
from hrcplan.pddl.model import Problem
from hrcplan.studies.changed_mind import script
from hrcplan.studies.quarantine import end_with_quarantine
from hrcplan.studies.study import Episode, find
from tests import schema

PAGE = "files.md"
SECTIONS = schema.sections(PAGE)
TEXT = (schema.REFERENCE / PAGE).read_text("utf-8")
STUDIES = Path(__file__).parent / "studies"
PROBLEM = hrcplan.read("transport", "two-boxes")
FACT = ("reach", "human", "wp5")
# What does not happen in the runs below, in particular in simulated ones.
RARE: list[ev.Event | ev.Command] = [
    ev.Overdue(1.0, 2),
    ev.StopAsked(1.0, "a user asked for it"),
    ev.Noticed(1.0, "no-answer", "the robot does not answer"),
    ev.Wake(1.0, 2.5),
    ev.Cancel(1.0, 2),
    ev.Observed(0.0, frozenset({FACT}), {("load", "robot"): 3}, frozenset({FACT})),
    ev.Observed(0.0, frozenset()),
    ev.AskPlan(0.0, frozenset({FACT}), {("load", "robot"): 3}, {}, absent=frozenset({FACT})),
    ev.AskPlan(6.0, frozenset({FACT}), {}, {}, n_happened=1),
    ev.Happened(5.0, 0, "(not (open quay))"),
    ev.Planned(0.0, None, note="no plan in time"),
    ev.Finish(0.0, ev.STOPPED, "a user asked for it"),
]

RARE_IN_COLLABORATIONS = [
    shared.Chosen(
        1.0,
        "get",
        ("robot", "pan"),
        (("soup", 1.0),),
        0,
        ("soup",),
        ("soup", "stew"),
        "get would fail with human (90 %)",
        0.1,
        ("in oats pan + served",),
    ),
    shared.Idle(0.0, 30.0),
    shared.Begun(0.0, "human", "get", ("human", "milk")),
    shared.Passed(0.0, "human"),
    shared.Said(0.0, "human", "the milk, please"),
    shared.Read(0.0, shared.ACT, ("(get human milk)",)),
    shared.Answered(0.0, shared.YES),
    shared.Undone(0.0, 3, attempted=True),
    shared.StateTold(0.0, {("motivation", "human"): 8}),
    shared.Wanted(0.0, "parfait-nut"),
    shared.Paused(0.0),
    shared.Stopped(0.0),
    shared.Continued(0.0),
    shared.AskReading(0.0, ("human",), "the milk, please"),
    shared.Ask(0.0, shared.DONE, ("parfait-nut",)),
    shared.Correct(0.0, frozenset({FACT}), {("load", "robot"): 3}, frozenset({FACT})),
]


class Eventful:
    def nature(self, problem: Problem, seed: str | int) -> Nature:
        change = StateChange(60.0, {("motivation", "human"): 8})
        accident = FactChange(70.0, frozenset({("box-at", "blue", "wp0")}), frozenset({FACT}))
        can_fail = frozenset({"grasp", "move", "place"})
        return Nature(seed, (change,), (accident,), "before", "attempt", can_fail, (1.0, 1.5))


@pytest.fixture(scope="module")
def journals(tmp_path_factory: pytest.TempPathFactory) -> list[list[dict[str, Any]]]:
    """Return the lines of journals, one after the other."""
    folder = tmp_path_factory.mktemp("journals")
    hrcplan.execute(PROBLEM, human="uncooperative", seed=5, journal=folder / "1", planner="exact")
    hrcplan.execute(PROBLEM, human=Eventful(), journal=folder / "2", profile="estimated")
    rounded = PROBLEM.with_values({("motivation", "human"): Fraction(1, 3)})
    hrcplan.execute(rounded, changes=["motivation human=2@0"], journal=folder / "3")
    return [
        [json.loads(line) for line in path.read_text("utf-8").splitlines()]
        for path in sorted(folder.iterdir())
    ]


def test_quarantine(tmp_path: Path) -> None:
    failures = {Episode("rows", ("optimal", 2), 7): "ZeroDivisionError"}
    with pytest.raises(LimitError):
        end_with_quarantine(tmp_path, failures)
    document = json.loads((tmp_path / "quarantine.json").read_text("utf-8"))
    schema.check([document], SECTIONS["Quarantine"])


def test_the_first_line_of_a_journal(journals: list[list[dict[str, Any]]]) -> None:
    schema.check([lines[0] for lines in journals], SECTIONS["Journal: first line"])


def test_the_other_lines_of_a_journal(journals: list[list[dict[str, Any]]]) -> None:
    kinds = ("event", "row")
    others = [
        {key: None if key in kinds else [] if key == "decided" else value
         for key, value in line.items()}
        for lines in journals for line in lines[1:]
    ]  # fmt: skip
    assert all(set(line) & {"event", "decided", "row"} for line in others)
    keys = [replace(key, meaning="null") for key in SECTIONS["Journal: other lines"]]
    schema.check(others, keys)
    row = {key.path.removeprefix("row.") for key in schema.sections("json.md")["execute"]
           if key.path.startswith("row.")}  # fmt: skip
    assert [set(lines[-1]["row"]) for lines in journals] == [row] * len(journals)


def by_kind(item: Mapping[str, Any]) -> dict[str, Any]:
    """Return an event or a command as the page has it: its keys by its kind."""
    return {item["kind"]: {key: value for key, value in item.items() if key != "kind"}}


def test_events_and_decisions_of_journals(journals: list[list[dict[str, Any]]]) -> None:
    rare = [json.loads(json.dumps(to_json(item))) for item in RARE]
    events = [line["event"] for lines in journals for line in lines if "event" in line]
    decisions = [item for lines in journals for line in lines for item in line.get("decided", [])]
    is_event = {kind: issubclass(cls, ev.Event.__args__) for kind, cls in KINDS.items()}
    for title, items in (("Journal: events", events), ("Journal: decisions", decisions)):
        more = [one for one in rare if is_event[one["kind"]] == (title == "Journal: events")]
        schema.check(map(by_kind, [*items, *more]), SECTIONS[title])


def test_every_kind_of_event_and_decision_is_on_the_page() -> None:
    keys = [*SECTIONS["Journal: events"], *SECTIONS["Journal: decisions"]]
    named = {tuple(re.split(r"[.\[]", key.path)[:2]) for key in keys}
    assert named == {(kind, field.name) for kind, cls in KINDS.items() for field in fields(cls)}


@pytest.fixture(scope="module")
def collaboration(tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, Any]]:
    """Return the lines of the journal of a collaboration with a simulated human."""
    bank = hrcplan.build_bank("kitchen", only=["parfait-nut", "smoothie-berry"])
    path = tmp_path_factory.mktemp("collaboration") / "run.jsonl"
    collaborate(bank, seed=1, journal=path)
    return [json.loads(line) for line in path.read_text("utf-8").splitlines()]


def test_the_journal_of_a_collaboration(collaboration: list[dict[str, Any]]) -> None:
    first, *others = collaboration
    setup = setup_in(first, "")
    values = {("motivation", "human"): Fraction(1, 3)}
    rounded = replace(setup, problem=setup.problem.with_values(values)).to_json()
    schema.check([first, {**first, **rounded}], SECTIONS["Collaboration: first line"])
    assert setup_in(rounded, "").to_json() == rounded
    items = [item for line in others for item in line.get("decided", [line.get("event")]) if item]
    own = [item for item in items if item["kind"] not in KINDS]
    assert own
    more = [json.loads(json.dumps(to_json(item))) for item in RARE_IN_COLLABORATIONS]
    schema.check(map(by_kind, [*own, *more]), SECTIONS["Collaboration events"])
    paths = (key.path for key in schema.sections("json.md")["collaborate"])
    outcome = {match[1] for path in paths if (match := re.fullmatch(r"outcome\.(\w+)", path))}
    assert set(others[-1]["row"]) == outcome


def test_every_kind_of_collaborations_is_on_the_page() -> None:
    named = {tuple(re.split(r"[.\[]", key.path)[:2]) for key in SECTIONS["Collaboration events"]}
    own = {kind: cls for kind, cls in COLLABORATION_KINDS.items() if kind not in KINDS}
    assert named == {(kind, field.name) for kind, cls in own.items() for field in fields(cls)}


@pytest.fixture(scope="module")
def banks(tmp_path_factory: pytest.TempPathFactory, workshop: Bank, hall: Bank) -> list[bytes]:
    """Return bank files: one of sequences, one of team plans, one of alternatives, one of files."""
    folder = tmp_path_factory.mktemp("banks")
    wide = build(workshop.goals, BuildOptions(alternatives=Fraction(1)))
    shipped = hrcplan.build_bank("kitchen", only=["smoothie-berry"])
    for n, bank in enumerate((workshop, hall, wide, shipped)):
        save(bank, folder / str(n))
    return [path.read_bytes() for path in sorted(folder.iterdir())]


def header_of(data: bytes) -> dict[str, Any]:
    """Return the header of a bank, read as the page says."""
    length = int.from_bytes(data[16:24], "little")
    header: dict[str, Any] = json.loads(data[64 : 64 + length])
    return header


def test_the_prefix_of_banks(banks: list[bytes]) -> None:
    versions = set()
    for data in banks:
        assert data[:8] == b"HRCPBANK"
        versions.add(int.from_bytes(data[8:12], "little"))
        assert data[12:16] == bytes(4)
        lengths = [int.from_bytes(data[at : at + 8], "little") for at in (16, 24)]
        assert len(data) == 64 + sum(lengths)
        assert hashlib.sha256(data[:32] + data[64:]).digest() == data[32:64]
    assert versions == {1, 2}


def test_the_header_of_banks(banks: list[bytes]) -> None:
    schema.check(map(header_of, banks), SECTIONS["Bank: header"])


def test_the_arrays_of_banks(banks: list[bytes], workshop: Bank) -> None:
    """Arrays that are read as the page says are those of the graphs."""
    kinds = dict(
        re.findall(r"^\| `(\w+)` \| (?:`|<code>)(\S+?)(?:`|</code>) \|", TEXT, re.MULTILINE)
    )
    data, header = banks[0], header_of(banks[0])
    begin = 64 + int.from_bytes(data[16:24], "little")
    for entry, graph in zip(header["goals"], workshop.graphs, strict=True):
        assert set(entry["arrays"]) == set(kinds)
        for name, kind in kinds.items():
            at, shape = (entry["arrays"][name][key] for key in ("at", "shape"))
            array = np.frombuffer(
                data, html.unescape(kind), int(np.prod(shape)), begin + at
            ).reshape(shape)
            assert np.array_equal(array, getattr(graph, name))


FETCH, WORKSHOP = STUDIES / "fetch", STUDIES / "workshop"
ROWS = {
    "failure-anticipation": {"domain": str(FETCH / "domain.pddl"),
                             "problem": str(FETCH / "four-items.pddl")},
    "changed-mind": {"domain": str(WORKSHOP / "domain.pddl"), "goals": str(WORKSHOP),
                     "methods": "oracle,hrcplan"},
}  # fmt: skip


@pytest.mark.parametrize("name", ROWS)
def test_the_rows_of_studies(name: str, tmp_path: Path) -> None:
    hrcplan.run_study(name, tmp_path, options=ROWS[name], runs=1)
    keys, documents = SECTIONS[f"Rows: {name}"], []
    with closing(sqlite3.connect(tmp_path / "rows.sqlite")) as file:
        file.row_factory = sqlite3.Row
        file.execute("attach ? as clock", [str(tmp_path / "clock.sqlite")])
        for table in find(name).tables:
            places = ["main"] + ["clock"] * bool(table.clocked)
            rows = [
                row
                for place in places
                for row in file.execute(f"select * from {place}.{table.name}")
            ]
            documents += [document(table.name, dict(row), keys) for row in rows]
            if table.name == "sweeps":  # the small task has none
                cells = table.cells(find(name).options)
                documents += [
                    {"sweeps": dict(zip(table.keys, cell, strict=True))} for cell in cells
                ]
        about = {key: json.loads(value) for key, value in file.execute("select * from about")}
    schema.check(documents, keys)
    schema.check([about], SECTIONS["Rows: what they depend on"])


def document(table: str, row: dict[str, Any], keys: list[schema.Key]) -> dict[str, dict[str, Any]]:
    """Return a row by the names of the page: columns of their own, or those of the main table."""
    own = {name: value for name, value in row.items()
           if any(key.path == f"{table}.{name}" for key in keys)}  # fmt: skip
    return {table: own, "rows": {name: row[name] for name in row if name not in own}}


@pytest.mark.parametrize("name", ROWS)
def test_every_column_of_a_study_is_on_the_page(name: str) -> None:
    paths = {key.path for key in SECTIONS[f"Rows: {name}"]}
    for table in find(name).tables:
        for column in (*table.keys, "run", *table.columns, *table.clocked):
            assert {f"{table.name}.{column}", f"rows.{column}"} & paths, (table.name, column)


def test_the_keys_of_profiles() -> None:
    keys = SECTIONS["Profile"]
    assert {key.path for key in keys} == {field.name for field in fields(Profile)} - {"name"}
    shipped = files("hrcplan.agents").joinpath("profiles.toml").read_text("utf-8")
    schema.check([*tomllib.loads(shipped).values()], keys)


def test_the_keys_of_scripts() -> None:
    schema.check([script.read("golden")], SECTIONS["Script"])


def test_every_section_is_looked_at() -> None:
    looked_at = set(re.findall(r'SECTIONS\["([^"]+)"\]', Path(__file__).read_text("utf-8")))
    looked_at |= {"Journal: events", "Journal: decisions", *(f"Rows: {name}" for name in ROWS)}
    assert set(SECTIONS) == looked_at


def test_traces() -> None:
    """The trace of an episode has the keys of every trace, and more."""
    plain = TraceAction(1.0, None, "ring", ())
    noted = TraceAction(0.0, "ann", "cut", ("ann", "pipe"), "done", (0.25, 0.75), 1)
    answers = {"all": TraceAnswer(("g", "h"), (3,))}
    episode = TracedEpisode(("g", "h"), 7, answers, "s", "rows", ("a",), 2, 0, {"world": "w"})
    traces = [ActionTrace("d", "0", (plain,)), ActionTrace("d", "0", (noted, plain), episode)]
    files_of = [[json.loads(line) for line in trace.text().splitlines()] for trace in traces]
    schema.check([files_of[0][0]], SECTIONS["Trace: first line"])
    schema.check([files_of[1][0]], SECTIONS["Trace: first line of an episode"])
    schema.check(files_of[0][1:] + files_of[1][1:], SECTIONS["Trace: other lines"])
    assert files_of[0][0].items() <= files_of[1][0].items()
