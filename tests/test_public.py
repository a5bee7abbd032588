"""The promised names exist, take what they promise, and cost nothing until they are used."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import hrcplan
from hrcplan.pddl import library

DOMAIN = library.root() / "domains" / "transport.pddl"
PROBLEM = library.root() / "problems" / "transport" / "two-boxes.pddl"
PLAN = """
(move robot wp0 wp3) (grasp robot green wp3) (move robot wp3 wp2) (place robot green wp2)
(move human wp1 wp4) (grasp human blue wp4) (move human wp4 wp5) (place human blue wp5)
""".replace(") (", ")\n(")
# The functions that take a problem first, with what else they need.
TAKES_PROBLEM: list[Callable[..., Any]] = [
    hrcplan.read,
    hrcplan.ground,
    hrcplan.plan,
    lambda *words: hrcplan.validate(*words, PLAN),
]


def test_all_names_resolve() -> None:
    assert set(hrcplan.__all__) == set(hrcplan._PUBLIC)
    assert sorted(hrcplan.__all__) == hrcplan.__all__
    for name in hrcplan.__all__:
        assert getattr(hrcplan, name) is not None
    assert set(hrcplan.__all__) <= set(dir(hrcplan))


def test_types_and_functions_bear_their_public_names() -> None:
    renamed = {entry.split("=")[0] for entries in hrcplan._HOMES.values() for entry in entries
               if "=" in entry}  # fmt: skip
    for name in set(hrcplan.__all__) - renamed:
        assert getattr(hrcplan, name).__name__ == name


def test_every_error_class_is_public() -> None:
    from hrcplan import errors

    classes = {name for name, value in vars(errors).items()
               if isinstance(value, type) and issubclass(value, Exception)}  # fmt: skip
    assert classes <= set(hrcplan.__all__)


def test_the_root_holds_rooms_and_named_modules_only() -> None:
    modules = {path.stem for path in Path(hrcplan.__file__).parent.glob("*.py")}
    allowed = {"__init__", "__main__", "pytest_plugin", "errors"}
    assert modules == allowed


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = hrcplan.nonsense


def test_importing_the_package_imports_nothing_else() -> None:
    code = "import sys, hrcplan; print([m for m in sys.modules if m.startswith('hrcplan.')])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize("name", ["load", "lower"])
def test_old_names_work_and_warn(name: str) -> None:
    with pytest.warns(DeprecationWarning, match=f"hrcplan.{name} is deprecated; use hrcplan"):
        function = getattr(hrcplan, name)
    assert callable(function)


def test_the_old_load_returns_the_task() -> None:
    with pytest.warns(DeprecationWarning, match=r"use hrcplan\.ground"):
        assert hrcplan.load("transport", "two-boxes").problem.name == "two-boxes"


@pytest.mark.parametrize(
    "words",
    [
        ("transport", "two-boxes"),
        ("transport/two-boxes",),
        (DOMAIN, PROBLEM),
        (str(DOMAIN), str(PROBLEM)),
        (PROBLEM,),
        (str(PROBLEM),),
        ("transport", PROBLEM),
        (DOMAIN, "two-boxes"),
        (DOMAIN.read_text(), PROBLEM.read_text()),
        (DOMAIN.read_text(), "two-boxes"),
        (PROBLEM.read_text(),),
        (hrcplan.read(PROBLEM).domain, "two-boxes"),
        (hrcplan.read(PROBLEM),),
    ],
)
def test_every_way_to_give_a_problem(words: tuple[Any, ...]) -> None:
    expected = hrcplan.read("transport", "two-boxes")
    task = hrcplan.ground(*words)
    assert task.problem.facts == expected.facts
    assert hrcplan.plan(*words).report.cost == 24
    assert hrcplan.validate(*words, PLAN).valid


def test_a_problem_finds_its_domain_beside_it(tmp_path: Path) -> None:
    (tmp_path / "a.pddl").write_text("(define (domain d) (:predicates (p)))")
    (tmp_path / "b.pddl").write_text("(define (problem b) (:domain d) (:goal (p)))")
    assert hrcplan.read(tmp_path / "b.pddl").domain.name == "d"
    with pytest.raises(hrcplan.InputError, match="of domain 'd', and there is none among"):
        hrcplan.read((tmp_path / "b.pddl").read_text())


def test_a_file_wins_over_a_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("transport").mkdir()
    Path("transport/two-boxes").write_text(PROBLEM.read_text().replace("two-boxes", "mine"))
    assert hrcplan.read("transport/two-boxes").name == "mine"


def test_text_has_faults_with_their_places() -> None:
    with pytest.raises(hrcplan.PddlError) as raised:
        hrcplan.read("transport", ";\n(define (problem x) (:domain transport) (:gaol (p)))")
    assert raised.value.path == "<problem>"
    assert raised.value.line == 2


@pytest.mark.parametrize(
    "plan",
    [hrcplan.plans.parse_plan(PLAN), PLAN, "file", Path("file"), ""],
    ids=["object", "text", "name of a file", "path", "empty"],
)
def test_every_way_to_give_a_plan(
    plan: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("file").write_text(PLAN)
    problem = hrcplan.read("transport", "two-boxes")
    report = hrcplan.validate(problem, plan)
    assert report.valid == (plan != "")
    assert hrcplan.validate("transport", "two-boxes", plan) == report
    assert hrcplan.validate("transport", "two-boxes", plan=plan) == report
    assert hrcplan.validate(problem, plan=plan) == report


@pytest.mark.parametrize("wrong", [None, 3, 1.5, [], {}, ("transport", "two-boxes"), b"transport",
                                   dict, ModuleType("m")], ids=repr)  # fmt: skip
@pytest.mark.parametrize("function", TAKES_PROBLEM)
def test_what_is_no_problem_is_a_type_error(function: Callable[..., Any], wrong: Any) -> None:
    with pytest.raises(TypeError, match=r"a domain is a name, a path, PDDL text"):
        function(wrong)
    if wrong is not None:
        with pytest.raises(TypeError, match=r"a problem is a name, a path, PDDL text"):
            function("transport", wrong)


@pytest.mark.parametrize("wrong", [None, 3, [], {}, b"(a)", hrcplan.Report(True)], ids=repr)
def test_what_is_no_plan_is_a_type_error(wrong: Any) -> None:
    with pytest.raises(TypeError, match="a plan is a Plan, its text, or a file's path, not"):
        hrcplan.validate("transport", "two-boxes", wrong)
    with pytest.raises(TypeError, match="a plan is a Plan, its text, or a file's path, not"):
        hrcplan.validate(hrcplan.read(PROBLEM), wrong)


def test_swapped_arguments_say_what_is_wrong() -> None:
    problem, plan = hrcplan.read(PROBLEM), hrcplan.Plan()
    with pytest.raises(hrcplan.InputError, match="there is no domain 'two-boxes'"):
        hrcplan.read("two-boxes", "transport")
    with pytest.raises(hrcplan.PddlError, match="this is a problem file, not a domain"):
        hrcplan.read(PROBLEM, DOMAIN)
    with pytest.raises(hrcplan.PddlError, match="this is a domain file, not a problem"):
        hrcplan.read(DOMAIN)
    with pytest.raises(TypeError, match="or an object that hrcplan has read, not Plan"):
        hrcplan.validate(plan, problem)
    with pytest.raises(TypeError, match="the plan is the last argument"):
        hrcplan.validate("transport", plan, "two-boxes")
    with pytest.raises(TypeError, match="needs a problem and a plan"):
        hrcplan.validate(problem)


def test_a_problem_given_twice_is_wrong_use() -> None:
    problem = hrcplan.read(PROBLEM)
    for function in TAKES_PROBLEM[1:]:
        with pytest.raises(hrcplan.UsageError, match="'two-boxes' is given already, so 'exact'"):
            function(problem, "exact")


@pytest.mark.parametrize("domain", ["transport", hrcplan.read(PROBLEM).domain])
def test_a_domain_alone_is_wrong_use(domain: Any) -> None:
    with pytest.raises(hrcplan.UsageError, match=r"a problem .*is needed"):
        hrcplan.plan(domain)


@pytest.mark.parametrize("name", ["", "nonsense", "non/sense", "no/such/file.pddl", "a" * 5000,
                                  "x\0y", os.devnull])  # fmt: skip
def test_what_does_not_exist_is_an_input_error(name: str) -> None:
    with pytest.raises(hrcplan.InputError):
        hrcplan.read(name)
    with pytest.raises(hrcplan.InputError):
        hrcplan.read("transport", name)
    if name:
        with pytest.raises(hrcplan.InputError):
            hrcplan.validate("transport", "two-boxes", name if name != os.devnull else "no/plan")


def test_a_problem_added_a_second_ago_is_seen_and_planned() -> None:
    folder = library.root() / "problems" / "transport"
    added = folder / "added-just-now.pddl"
    text = (folder / "two-boxes.pddl").read_text(encoding="utf-8")
    added.write_text(text.replace("(problem two-boxes)", "(problem added-just-now)"), "utf-8")
    try:
        assert "added-just-now" in library.problem_names("transport")
        assert hrcplan.plan("transport", "added-just-now").report.cost == 24
    finally:
        added.unlink()
