"""What is drawn of a world is read off the PDDL; notes override it."""

import itertools

import pytest

from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.pddl.source import SourceText
from hrcplan.web.scene import scene_of

BLOCKS = """(define (domain blocks) (:requirements :strips :typing)
  (:types agent block - object)
  (:predicates (on ?x ?y - block) (ontable ?x - block) (clear ?x - block) (empty ?a - agent)
    (holding ?a - agent ?x - block))
  (:action pick-up :parameters (?a - agent ?x - block)
    :precondition (and (clear ?x) (ontable ?x) (empty ?a))
    :effect (and (not (ontable ?x)) (not (clear ?x)) (not (empty ?a)) (holding ?a ?x)))
  (:action put-down :parameters (?a - agent ?x - block) :precondition (holding ?a ?x)
    :effect (and (not (holding ?a ?x)) (clear ?x) (empty ?a) (ontable ?x)))
  (:action stack :parameters (?a - agent ?x ?y - block)
    :precondition (and (holding ?a ?x) (clear ?y))
    :effect (and (not (holding ?a ?x)) (not (clear ?y)) (clear ?x) (empty ?a) (on ?x ?y)))
  (:action unstack :parameters (?a - agent ?x ?y - block)
    :precondition (and (on ?x ?y) (clear ?x) (empty ?a))
    :effect (and (holding ?a ?x) (clear ?y) (not (clear ?x)) (not (empty ?a)) (not (on ?x ?y)))))
"""
TOWER = """(define (problem tower) (:domain blocks) (:objects robot human - agent a b - block)
  (:init (ontable a) (on b a) (clear b) (empty robot) (empty human)) (:goal (on a b)))"""


def problem(notes: str = "") -> Problem:
    domain = domain_in(SourceText("domain", notes + BLOCKS))
    return problem_in(domain, SourceText("problem", TOWER))


def shows(problem: Problem) -> dict[str, str]:
    return {name: view["show"] for name, view in scene_of(problem)["views"].items()}


def test_blocks_without_a_note() -> None:
    views = scene_of(problem())["views"]
    assert shows(problem()) == {
        "on": "place", "ontable": "zone", "clear": "badge", "empty": "badge", "holding": "hold",
    }  # fmt: skip
    assert views["holding"] == {"show": "hold", "of": 1, "at": 0}


@pytest.mark.parametrize(
    ("name", "places"),
    [("transport/two-boxes", {"at": "place", "box-at": "place", "holding": "hold"}),
     ("household/departure", {"at": "place", "lies": "place", "holding": "hold"}),
     ("kitchen/stew-bean", {"in": "place", "stored": "zone", "available": "zone",
                            "mixed": "badge", "on": "badge"})],
)  # fmt: skip
def test_shipped_domains(name: str, places: dict[str, str]) -> None:
    assert places.items() <= shows(read(name)).items()


def test_notes_override_what_is_read_off() -> None:
    notes = (
        ";; hrcplan: show clear hide\n;; hrcplan: show on badge\n;; hrcplan: show block B, red\n"
    )
    scene = scene_of(problem(f"{notes};; hrcplan: show a green\n"))
    assert (scene["views"]["clear"]["show"], scene["views"]["on"]["show"]) == ("hide", "badge")
    assert scene["objects"]["b"] == {"type": "block", "icon": "b", "color": "red"}
    assert scene["objects"]["a"] == {"type": "block", "icon": "b", "color": "green"}


@pytest.mark.parametrize(
    "note", ["show", "show on", "show on place, badge", "show a red, green", "show a x, y",
             "show a " + "x" * 9],
)  # fmt: skip
def test_a_note_that_makes_no_sense_is_a_warning(note: str) -> None:
    source = SourceText("domain", f";; hrcplan: {note}\n{BLOCKS}")
    domain_in(source)
    assert [d.code for d in source.diagnostics] == ["bad-note"]


def test_places_of_a_map_stand_apart() -> None:
    for name in ("household/departure", "transport/two-boxes"):
        places = scene_of(read(name))["map"]["places"].values()
        for (x, y), (u, v) in itertools.combinations(places, 2):
            assert abs(x - u) + abs(y - v) > 0.1


def test_neighbors_are_nearer() -> None:
    scene = scene_of(read("household/departure"))["map"]
    ways = {frozenset(way) for way in scene["ways"]}
    near, far = [], []
    for (a, (x, y)), (b, (u, v)) in itertools.combinations(scene["places"].items(), 2):
        (near if frozenset((a, b)) in ways else far).append((x - u) ** 2 + (y - v) ** 2)
    assert sum(near) / len(near) < sum(far) / len(far)


def test_worlds_without_agents_that_move_have_no_map() -> None:
    assert scene_of(read("kitchen/stew-bean"))["map"] is None
