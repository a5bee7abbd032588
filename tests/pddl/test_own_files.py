"""Files of a user's own project have short names like shipped ones, and win over these."""

from __future__ import annotations

from pathlib import Path

import pytest

from hrcplan.bank.sources import read_goals
from hrcplan.cli.arguments import split_names
from hrcplan.pddl.check import check
from hrcplan.pddl.inputs import read
from hrcplan.pddl.library import OwnFileWarning, find_domain, find_problem

DOMAIN = """; mine
(define (domain {name}) (:requirements :strips) (:predicates (p)) (:action a :effect (p)))"""
PROBLEM = "(define (problem {name}) (:domain {domain}) (:init) (:goal (p)))"


@pytest.mark.parametrize("where", ["firstaid.pddl", "domains/firstaid.pddl"])
@pytest.mark.parametrize("at", ["problems/firstaid/x.pddl", "problems/x.pddl", "x.pddl"])
def test_own_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, where: str, at: str) -> None:
    monkeypatch.chdir(tmp_path)
    for path in (where, at):
        Path(path).parent.mkdir(parents=True, exist_ok=True)
    Path(where).write_text(DOMAIN.format(name="firstaid"))
    Path(at).write_text(PROBLEM.format(name="x", domain="firstaid"))
    assert (find_domain("firstaid"), find_problem("firstaid", "x")) == (Path(where), Path(at))
    assert read("firstaid/x").name == "x"


def test_an_own_file_wins_over_a_shipped_one_with_a_warning(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("transport.pddl").write_text(DOMAIN.format(name="transport"))
    with pytest.warns(OwnFileWarning, match=r"./transport.pddl here"):
        assert find_domain("transport") == Path("transport.pddl")


def test_a_file_of_something_else_does_not_hide_a_shipped_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("transport.pddl").write_text(PROBLEM.format(name="transport", domain="other"))
    Path("two-boxes.pddl").write_text(PROBLEM.format(name="two-boxes", domain="other"))
    assert read("transport/two-boxes").domain.name == "transport"


@pytest.mark.parametrize("goals", [None, "firstaid"])
def test_the_goals_of_an_own_domain(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, goals: str | None
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("problems/firstaid").mkdir(parents=True)
    Path("firstaid.pddl").write_text(DOMAIN.format(name="firstaid"))
    for name in ("x", "y"):
        text = PROBLEM.format(name=name, domain="firstaid")
        Path(f"problems/firstaid/{name}.pddl").write_text(text)
    assert read_goals("firstaid", goals).names == ("x", "y")


def test_own_goals_win_over_shipped_ones_with_a_warning(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    own = Path("problems/kitchen")
    own.mkdir(parents=True)
    assert len(read_goals("kitchen").names) > 1
    (own / "mine.pddl").write_bytes(find_problem("kitchen", "pasta-bean").read_bytes())
    with pytest.warns(OwnFileWarning, match=r"the folder ./problems/kitchen here"):
        assert len(read_goals("kitchen").names) == 1


@pytest.mark.parametrize(
    "domain",
    ["problems/box/d.pddl", "problems/box.pddl", "problems/the-domain.pddl", "domains/box.pddl"],
)
def test_a_problem_alone_names_a_domain_near_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, domain: str
) -> None:
    problem = tmp_path / "problems/box/x.pddl"
    problem.parent.mkdir(parents=True)
    problem.write_text(PROBLEM.format(name="x", domain="box"))
    assert [d.code for d in check([problem]).diagnostics] == ["domain-mismatch"]
    (tmp_path / domain).parent.mkdir(exist_ok=True)
    (tmp_path / domain).write_text(DOMAIN.format(name="box"))
    assert check([problem]).diagnostics == ()
    monkeypatch.chdir(problem.parent)
    assert read("x.pddl").domain.name == "box"
    assert split_names(["x.pddl", "my.plan"], 1) == ("x.pddl", None, ["my.plan"])


def test_check_takes_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("box.pddl").write_text(DOMAIN.format(name="box"))
    assert check(["box", "transport/two-boxes"]).n_files == 3
    (fault,) = check(["transport/two-boxs"]).diagnostics
    assert (fault.code, fault.hint) == ("no-file", "did you mean 'two-boxes'?")
