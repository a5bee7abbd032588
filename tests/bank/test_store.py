"""Banks in files: what goes in comes out, and every kind of damage is noticed."""

import hashlib
import json
import os
import shutil
import struct
from fractions import Fraction
from pathlib import Path

import pytest
from click.testing import CliRunner

import hrcplan
from hrcplan.bank import BuildOptions, build, build_bank, find_fault, load, save
from hrcplan.bank.audit import fault
from hrcplan.bank.goals import from_problems
from hrcplan.bank.store import MAGIC, digest, dumps
from hrcplan.bank.walk import plans
from hrcplan.errors import InputError, UsageError

ROOT = Path(__file__).parents[2]
RECIPES = [
    BuildOptions(),
    BuildOptions(quality=Fraction(3, 2)),
    BuildOptions(cost="task", alternatives=Fraction(5, 4)),
]


@pytest.fixture
def world(tmp_path):
    """Return a domain and problems outside the package, and a bank made of them."""
    shutil.copy(ROOT / "domains" / "kitchen.pddl", tmp_path / "kitchen.pddl")
    goals = tmp_path / "goals"
    goals.mkdir()
    for name in ("parfait-nut", "smoothie-oat"):
        shutil.copy(ROOT / "problems" / "kitchen" / f"{name}.pddl", goals)
    bank = build_bank(str(tmp_path / "kitchen.pddl"), str(goals))
    save(bank, tmp_path / "two.bank")
    return tmp_path


@pytest.mark.parametrize("recipe", RECIPES, ids=str)
def test_what_goes_in_comes_out(recipe, tmp_path, instances):
    folder = instances / "block-words_p01_hyp-0_full"
    bank = build_bank(str(folder / "domain.pddl"), str(folder), recipe, only=HYPOTHESES)
    save(bank, tmp_path / "b.bank")
    again = load(tmp_path / "b.bank")
    assert (again.names, again.recipe, again.build_s) == (bank.names, bank.recipe, bank.build_s)
    assert again.initial == bank.initial
    for old, new in zip(bank.graphs, again.graphs, strict=True):
        assert list(plans(old)) == list(plans(new)) != []
        facts = old.relevant_facts, new.relevant_facts
        assert (old.layers, facts[0], old.plans) == (new.layers, facts[1], new.plans)
    assert find_fault(tmp_path / "b.bank") is None
    assert dumps(again, tmp_path) == (tmp_path / "b.bank").read_bytes()


HYPOTHESES = ["(CLEAR R),(ONTABLE W),(ON R O),(ON O W)", "(CLEAR P),(ONTABLE W),(ON P A),(ON A W)"]


def test_every_flipped_byte_is_noticed(world):
    data = (world / "two.bank").read_bytes()
    n_head = struct.unpack_from("<Q", data, 16)[0]
    places = {*range(64), 64, 64 + n_head // 2, 64 + n_head, len(data) // 2, len(data) - 1}
    for place in sorted(places):
        damaged = bytearray(data)
        damaged[place] ^= 0x20
        (world / "bad.bank").write_bytes(damaged)
        with pytest.raises(InputError) as caught:
            load(world / "bad.bank")
        assert caught.value.code in ("not-a-bank", "bank-version", "bank-truncated", "bank-damaged")
        assert find_fault(world / "bad.bank") is not None


@pytest.mark.parametrize("keep", [0, 7, 8, 31, 63, 64, 1000, -8, -1])
def test_a_cut_file_is_noticed(world, keep):
    data = (world / "two.bank").read_bytes()
    (world / "bad.bank").write_bytes(data[:keep])
    with pytest.raises(InputError) as caught:
        load(world / "bad.bank")
    assert caught.value.code == ("not-a-bank" if 0 <= keep < len(MAGIC) else "bank-truncated")


def test_what_is_no_bank_and_a_foreign_version(world):
    data = (world / "two.bank").read_bytes()
    (world / "bad.bank").write_bytes(data + b"\0")
    with pytest.raises(InputError, match="bytes instead of"):
        load(world / "bad.bank")
    (world / "bad.bank").write_bytes(data[:8] + struct.pack("<I", 3) + data[12:])
    with pytest.raises(InputError, match="format 3; this hrcplan reads 1 and 2"):
        load(world / "bad.bank")
    (world / "bad.bank").write_text("(define (problem p))")
    with pytest.raises(InputError, match="is no policy bank"):
        load(world / "bad.bank")
    with pytest.raises(InputError, match="is a folder"):
        load(world)


@pytest.mark.parametrize("name", ["kitchen.pddl", "goals/parfait-nut.pddl"])
def test_changed_pddl_is_noticed_and_missing_pddl_is_not_needed(world, name):
    source = world / name
    text = source.read_text()
    source.write_text(text + "; changed\n")
    with pytest.raises(InputError) as caught:
        load(world / "two.bank")
    assert caught.value.code == "bank-outdated"
    assert name.rpartition("/")[2] in caught.value.message
    assert "another version" in str(find_fault(world / "two.bank"))
    source.unlink()
    assert load(world / "two.bank").graphs[0].plans == 6647155200
    source.write_text(text)
    assert find_fault(world / "two.bank") is None


def test_a_folder_can_be_moved_with_its_bank(world, tmp_path_factory):
    target = tmp_path_factory.mktemp("moved") / "here"
    shutil.move(world, target)
    assert find_fault(target / "two.bank") is None
    with (target / "kitchen.pddl").open("a") as file:
        file.write("\n")
    assert find_fault(target / "two.bank") is not None


def test_verify_looks_at_every_node_and_edge(world):
    bank = load(world / "two.bank")
    graph = bank.graphs[0]
    assert fault(bank, 0) is None

    def spoilt(**changes):
        from dataclasses import replace

        other = replace(graph, **changes)
        return fault(replace(bank, graphs=(other, *bank.graphs[1:])), 0)

    targets, steps, rows = graph.targets.copy(), graph.steps.copy(), graph.rows.copy()
    targets[[0, 1]] = targets[[1, 0]]
    assert spoilt(targets=targets) == "'parfait-nut': 2 edges are not what the steps do"
    steps[5] = len(bank.table)
    assert "is no step" in spoilt(steps=steps)
    rows[-1] ^= 1
    assert spoilt(rows=rows) is not None
    assert "dead end" in spoilt(is_goal=~graph.is_goal)
    targets = graph.targets.copy()
    targets[-1] = 0
    assert "raise the cost" in spoilt(targets=targets)
    targets[-1] = graph.n_nodes
    assert "leads to no node" in spoilt(targets=targets)
    assert "says that it is of" in spoilt(goal="other")


def test_nothing_is_left_when_writing_fails(world):
    bank = load(world / "two.bank")
    (world / "folder").mkdir()
    before = sorted(world.iterdir())
    with pytest.raises(UsageError, match="cannot write"):
        save(bank, world / "folder")
    with pytest.raises(UsageError, match="cannot write"):
        save(bank, world / "none" / "x.bank")
    assert sorted(world.iterdir()) == before


def run(*args):
    from hrcplan.cli import main

    return CliRunner().invoke(main, list(map(str, args)), standalone_mode=False)


def test_no_path_of_this_machine_is_in_the_file(world):
    data = (world / "two.bank").read_bytes()
    assert os.fsencode(world) not in data
    head = json.loads(data[64 : 64 + struct.unpack_from("<Q", data, 16)[0]])
    assert [source["path"] for source in head["sources"]] == [
        "kitchen.pddl", "goals/parfait-nut.pddl", "goals/smoothie-oat.pddl"
    ]  # fmt: skip


def repacked(data, change):
    """Return a bank with another header and the right checksum."""
    n_head = struct.unpack_from("<Q", data, 16)[0]
    head, body = data[64 : 64 + n_head], data[64 + n_head :]
    head = change(json.loads(head)) if callable(change) else change
    if not isinstance(head, bytes):
        head = json.dumps(head).encode()
    prefix = struct.pack("<8sIIQQ", MAGIC, 1, 0, len(head), len(body))
    return prefix + hashlib.sha256(prefix + head + body).digest() + head + body


def changed(path, value):
    """Return a change of a header: the entry at a path gets another value."""

    def change(head):
        entry = head
        for key in path[:-1]:
            entry = entry[key]
        entry[path[-1]] = value
        return head

    return change


GRAPH = ("goals", 0)
WRONG = [
    *([b"[" * 200_000, b"{", b'"\xff"', b"[]", b"7", b'{"names": ' + b"9" * 10_000 + b"}"]),
    *(changed(("names",), value) for value in ([], ["nosuch"], 3, [[]], None)),
    *(changed(("goals",), value) for value in ([], {}, [3], None)),
    *(changed(("kind",), value) for value in (None, [], "other")),
    *(changed(("build_s",), value) for value in ("x", float("nan"), float("inf"), -1, [])),
    *(changed(("recipe", "quality"), v) for v in ("1e999999999", "1/0", 1, None, "x", "0.5")),
    *(changed(("recipe", "cost"), value) for value in ("other", [], None)),
    *(changed(("recipe", "sample"), value) for value in ("3", -1, True, 1.5)),
    *(changed(("sources", 0, "path"), value) for value in (3, None, [])),
    *(changed(("sources", 0, "text"), value) for value in ("", "(", 3, "\udcff")),
    *(changed(("sources",), value) for value in ([], {}, 3)),
    *(changed((*GRAPH, "positions"), v) for v in ([-1], [10**30], [0, 0], "x", [0.5])),
    *(changed((*GRAPH, "layers"), v) for v in ([], [["0", 1]], [["x", 0]], [[0]], [["0", 10**9]])),
    *(changed((*GRAPH, "name"), value) for value in ("other", 3, [])),
    *(
        changed((*GRAPH, "arrays", name, key), value)
        for name in ("rows", "first", "steps", "targets", "is_goal")
        for key, values in (
            ("shape", ([0], [], [2**70], [-1], [2**31, 2**31], "x", [1.5], [1], [1, 1])),
            ("at", (-8, 2**70, 1, "0", None)),
        )
        for value in values
    ),
]


def test_a_right_checksum_over_wrong_content_is_no_bank(world):
    data, path = (world / "two.bank").read_bytes(), world / "bad.bank"
    for number, change in enumerate(WRONG):
        path.write_bytes(repacked(data, change))
        try:
            load(path)
        except InputError:
            continue
        pytest.fail(f"change {number} makes a bank: {path.read_bytes()[64:3000]!r}")


def test_the_same_content_packed_again_is_a_bank(world):
    data = repacked((world / "two.bank").read_bytes(), lambda head: head)
    (world / "again.bank").write_bytes(data)
    assert find_fault(world / "again.bank") is None


def test_a_source_with_an_impossible_path_is_one_that_is_not_there(world):
    change = changed(("sources", 0, "path"), "x" * 300)
    (world / "far.bank").write_bytes(repacked((world / "two.bank").read_bytes(), change))
    assert find_fault(world / "far.bank") is None


def test_the_old_name_of_find_fault_still_works() -> None:
    with pytest.deprecated_call(match="find_fault"):
        from hrcplan.bank import verify
    assert verify is find_fault


def test_goals_out_of_texts_are_kept_as_texts(tmp_path: Path) -> None:
    domain = """(define (domain lamp) (:requirements :strips) (:predicates (on) (warm))
      (:action press :parameters () :precondition (and) :effect (on))
      (:action wait :parameters () :precondition (on) :effect (warm)))"""
    goals = {"light": "(on)", "heat": "(warm)"}
    problems = [
        hrcplan.read(domain, f"(define (problem {name}) (:domain lamp) (:init) (:goal {goal}))")
        for name, goal in goals.items()
    ]
    bank = build(from_problems(problems))
    (tmp_path / "domain.pddl").write_text("(define (domain another))")
    save(bank, tmp_path / "lamp.bank")
    again = load(tmp_path / "lamp.bank")
    assert again.names == ("light", "heat")
    assert digest(again) == digest(bank)
