"""``hrcplan execute`` and ``replay`` as users see them."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from hrcplan.execution.execute import execute
from hrcplan.pddl.library import root


def hrcplan(*args: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "hrcplan", *args], capture_output=True, text=True,
                          check=False, timeout=120)  # fmt: skip


def test_a_run_is_shown_in_two_lanes_with_its_replans(tmp_path: Path) -> None:
    journal = tmp_path / "run.jsonl"
    run = hrcplan("execute", "transport/two-boxes", "--change", "motivation human=9@0",
                  "--seed", "3", "--journal", str(journal))  # fmt: skip
    assert run.returncode == 0, run.stderr
    head, *lines = run.stdout.splitlines()
    assert head.split() == ["robot", "human", "done"]
    assert any("▶ move wp0 wp3" in line and "▶ move wp1 wp4" in line for line in lines)
    assert any("replanning, change: (motivation human) 1 → 9" in line for line in lines)
    assert lines[-1].startswith("goal reached: ")
    again = hrcplan("replay", str(journal))
    assert again.returncode == 0
    assert "all of them follow" in again.stdout


def test_json_is_one_document() -> None:
    run = hrcplan("execute", "transport", "two-boxes", "--profile", "replan-always", "--no-model",
                  "--change", "motivation human=10@0", "--json")  # fmt: skip
    assert run.returncode == 1  # the goal was not reached
    found = json.loads(run.stdout)
    assert found["ending"] == "replan limit"
    assert found["row"]["failed_human"] == 6
    assert found["measures"]["failed_pct"] == 60.0
    assert [a["outcome"] for a in found["actions"] if a["agent"] == "human"] == ["failed"] * 6
    assert len(found["plans"]) == 6


def test_the_name_of_an_earlier_version_gives_a_note_on_stderr() -> None:
    old = hrcplan("execute", "transport/two-boxes", "--profile", "paper", "--json")
    new = hrcplan("execute", "transport/two-boxes", "--profile", "replan-always", "--json")
    assert old.stderr == "warning: profile 'paper' is deprecated; its name is 'replan-always'\n"
    assert (old.returncode, old.stdout) == (new.returncode, new.stdout)
    assert new.stderr == ""


def test_replay_names_the_first_difference(tmp_path: Path) -> None:
    journal = tmp_path / "run.jsonl"
    execute("transport", "two-boxes", journal=journal)
    text = journal.read_text().replace('"outcome":"done"', '"outcome":"failed"', 1)
    journal.write_text(text)
    run = hrcplan("replay", str(journal), "--json")
    assert run.returncode == 1
    found = json.loads(run.stdout)
    assert found["ok"] is False
    assert "failed" in found["difference"]["expected"]


@pytest.mark.parametrize(
    ("args", "code", "words"),
    [
        (["--profile", "nature"], 2, "there is no profile"),
        (["--human", "alien"], 2, "there is no human"),
        (["--human", "nowhere:Human"], 2, "no module 'nowhere'"),
        (["--change", "motivation human=9"], 2, "@SECONDS"),
        (["--change", "motivation human=11@0"], 2, "[0, 10]"),
        (["--change", "motivation human=11@0"], 2, ";; hrcplan: range motivation 0 11"),
        (["--set", "motivation human=12"], 2, ";; hrcplan: range motivation 0 12"),
        (["--change", "mood human=3@0"], 2, "no function 'mood'"),
        (["--change", "motivation human=high@0"], 2, "'high' is no number"),
        (["--change", "motivation human=9@soon"], 2, "'soon' is no number"),
        (["--change", "motivation human=9@nan"], 2, "not a number from 0 on"),
        (["--change", "motivation humn=9@0"], 2, "'humn' is no agent of the problem"),
        (["--change", "total-cost=3@0"], 2, "(total-cost) is what a plan costs"),
        (["--change", "box-att blue wp0@0"], 2, "did you mean 'box-at'?"),
        (["--change", "box-at blue@0"], 2, "'box-at' takes 2 objects, not 1"),
        (["--change", "not box-at blue wp9@0"], 2, "'wp9' is no wp of the problem"),
        (["--change", "not controllable robot@5"], 2, "fixed during a run"),
        (["--human", "uncoperative"], 2, "did you mean 'uncooperative'?"),
        (["--world", "moon"], 2, "there is no event-world 'moon'"),
        (["--resume"], 2, "journal"),
        (["--planner", "nobody"], 2, "there is no planner 'nobody'"),
    ],
)
def test_wrong_use(args: list[str], code: int, words: str) -> None:
    run = hrcplan("execute", "transport/two-boxes", *args)
    assert run.returncode == code
    assert words in run.stdout + run.stderr


def test_an_initial_value_beyond_the_range_is_a_warning(tmp_path: Path) -> None:
    text = root().joinpath("problems/transport/two-boxes.pddl").read_text()
    problem = tmp_path / "tired.pddl"
    problem.write_text(text.replace("(= (motivation human) 1)", "(= (motivation human) 15)"))
    run = hrcplan("execute", "transport", str(problem), "--json")
    assert run.returncode == 0
    assert "initial (motivation human): 15 is no value in [0, 10]" in run.stderr
    assert json.loads(run.stdout)["success"]


def test_replay_of_no_journal(tmp_path: Path) -> None:
    assert hrcplan("replay", str(tmp_path / "none.jsonl")).returncode == 3


class Lazy:
    """A human of a researcher's own."""

    def nature(self, problem: object, seed: object) -> object:
        from hrcplan.execution.worlds.simulated import Nature, StateChange

        return Nature(seed, (StateChange(0.0, {("knowledge", "human"): 10}),))


def test_a_human_of_ones_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "laboratory", sys.modules[__name__])
    done = execute("transport", "two-boxes", human="laboratory:Lazy")
    assert done.outcome.failed_human == 1
    assert done.outcome.success


def test_the_same_loop_runs_in_the_kitchen() -> None:
    done = execute("kitchen", "smoothie-mango", human="uncooperative,random", seed=2)
    assert done.outcome.ending == "goal reached"
    assert done.outcome.executed_human + done.outcome.executed_robot >= 5


NEW_DOMAIN = """
(define (domain garden)
  (:requirements :strips :typing :durative-actions :numeric-fluents :negative-preconditions)
  (:types agent bed)
  (:predicates (controllable ?a - agent) (dug ?b - bed) (sown ?b - bed) (busy ?b - bed))
  (:functions (fatigue ?a - agent) (total-cost))
  (:durative-action dig :parameters (?a - agent ?b - bed) :duration (= ?duration 7)
    :condition (and (at start (not (dug ?b))) (at start (not (busy ?b))))
    :effect (and (at start (busy ?b)) (at end (not (busy ?b))) (at end (dug ?b))
      (at start (increase (total-cost) (* 2 (fatigue ?a))))))
  (:durative-action sow :parameters (?a - agent ?b - bed) :duration (= ?duration 3)
    :condition (and (at start (dug ?b)) (at start (not (busy ?b))))
    :effect (and (at start (busy ?b)) (at end (not (busy ?b))) (at end (sown ?b))
      (at start (increase (total-cost) (fatigue ?a))))))
"""
NEW_PROBLEM = """
(define (problem spring) (:domain garden)
  (:objects ann rover - agent b1 b2 b3 - bed)
  (:init (controllable rover) (= (fatigue ann) 1) (= (fatigue rover) 2) (= (total-cost) 0))
  (:goal (and (sown b1) (sown b2) (sown b3)))
  (:metric minimize (+ (total-cost) (total-time))))
"""


def test_the_same_loop_runs_on_a_domain_that_nobody_has_seen(tmp_path: Path) -> None:
    domain, problem = tmp_path / "garden.pddl", tmp_path / "spring.pddl"
    domain.write_text(NEW_DOMAIN)
    problem.write_text(NEW_PROBLEM)
    rows = [
        execute(str(domain), str(problem), human=human, seed=seed).outcome
        for human in ("steady", "uncooperative", "partly-cooperative,attempt")
        for seed in (1, 2)
    ]
    assert all(row.success for row in rows), rows
    assert any(row.failed_human for row in rows)


def test_executing_loads_nothing_heavy() -> None:
    code = (
        "import sys; from hrcplan import execute; execute('transport', 'two-boxes');"
        "print({'unified_planning', 'sklearn', 'matplotlib', 'scipy'} & set(sys.modules))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "set()"


CLASSICAL = """
(define (domain blocks) (:requirements :strips)
  (:predicates (on ?x ?y) (clear ?x) (table ?x))
  (:action stack :parameters (?x ?y)
    :precondition (and (clear ?x) (clear ?y) (table ?x))
    :effect (and (on ?x ?y) (not (table ?x)) (not (clear ?y)))))
"""
CLASSICAL_PROBLEM = """
(define (problem three) (:domain blocks) (:objects a b c)
  (:init (clear a) (clear b) (clear c) (table a) (table b) (table c))
  (:goal (and (on b c) (on a b))))
"""


def test_a_domain_without_agents_is_executed_too(tmp_path: Path) -> None:
    domain, problem = tmp_path / "blocks.pddl", tmp_path / "three.pddl"
    domain.write_text(CLASSICAL)
    problem.write_text(CLASSICAL_PROBLEM)
    run = hrcplan("execute", str(domain), str(problem))
    assert run.returncode == 0, run.stderr
    assert "goal reached: 2 steps" in run.stdout
    nobody = hrcplan("execute", str(domain), str(problem), "--human", "uncooperative")
    assert nobody.returncode == 2
    assert "no human" in nobody.stderr


def test_without_a_robot_the_actions_of_people_and_robots_are_not_told_apart(
    tmp_path: Path,
) -> None:
    """A type called robot makes no robot; the message says what does."""
    domain, problem = tmp_path / "lamps.pddl", tmp_path / "one.pddl"
    domain.write_text("""(define (domain lamps) (:requirements :strips :typing)
      (:types agent lamp - object robot - agent) (:predicates (lit ?l - lamp))
      (:action light :parameters (?a - robot ?l - lamp) :effect (lit ?l)))""")
    problem.write_text("""(define (problem one) (:domain lamps) (:objects r1 - robot l - lamp)
      (:init) (:goal (lit l)))""")
    run = hrcplan("execute", str(domain), str(problem))
    assert run.returncode == 0, run.stderr
    assert "no agent is a robot" in run.stderr
    assert "(controllable AGENT)" in run.stderr
    assert ", 1 action, 0 failed" in run.stdout
