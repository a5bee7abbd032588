"""The study of goals that change while agents' states drift: rows, pairs, costs and claims."""

from pathlib import Path

import pytest

from hrcplan.episodes.episode import PATIENCE
from hrcplan.studies import report_study, run_study
from hrcplan.studies.cells import PairedCells
from hrcplan.studies.collaboration import STUDY, claims, scenario
from hrcplan.studies.collaboration.episodes import UNIT
from hrcplan.studies.collaboration.measures import MEASURES
from hrcplan.studies.study import Seed, StudyOptions, StudyRow
from hrcplan.studies.verdict import FAILS, HOLDS, TOO_FEW

ROBOTS = ("goal-only", "state-only", "joint")
DOMAIN = """
(define (domain press) (:requirements :strips :typing :numeric-fluents :action-costs)
  (:types agent part - object)
  (:predicates (controllable ?a - agent) (raw ?p - part) (cut ?p - part) (bent ?p - part))
  (:functions (motivation ?a - agent) (capacity ?a - agent ?p - part) (total-cost))
  (:action cut :parameters (?a - agent ?p - part) :precondition (raw ?p)
    :effect (and (cut ?p) (not (raw ?p))
      (increase (total-cost) (+ (motivation ?a) (capacity ?a ?p)))))
  (:action bend :parameters (?a - agent ?p - part) :precondition (cut ?p)
    :effect (and (bent ?p) (not (cut ?p))
      (increase (total-cost) (+ (motivation ?a) (capacity ?a ?p))))))
"""
PROBLEM = """
(define (problem {name}) (:domain press)
  (:objects ann robo - agent a b c d - part)
  (:init (controllable robo) (raw a) (raw b) (raw c) (raw d) (= (total-cost) 0) {values})
  (:goal (and {goal})) (:metric minimize (total-cost)))
"""
GOALS = {"left": "(bent a) (bent b)", "right": "(bent c) (bent d)", "all-cut": "(cut a) (cut c)"}


@pytest.fixture(scope="module")
def options(tmp_path_factory: pytest.TempPathFactory) -> StudyOptions:
    folder = tmp_path_factory.mktemp("press")
    (folder / "domain.pddl").write_text(DOMAIN)
    (folder / "goals").mkdir()
    values = " ".join(
        f"(= (motivation {agent}) 1) " + " ".join(f"(= (capacity {agent} {p}) 1)" for p in "abcd")
        for agent in ("ann", "robo")
    )
    for name, goal in GOALS.items():
        text = PROBLEM.format(name=name, goal=goal, values=values)
        (folder / "goals" / f"{name}.pddl").write_text(text)
    own = {"domain": str(folder / "domain.pddl"), "goals": str(folder / "goals")}
    return STUDY.with_defaults(own)


def rows_of(options: StudyOptions, method: str, human: str = "", n: int = 6) -> list[StudyRow]:
    table = STUDY.tables[0]
    case = options["domain"] + (f", {human}" if human else "")
    return [table.episode(options, (case, method), Seed(0, run)) for run in range(n)]


def test_robots_meet_the_same_people(options: StudyOptions) -> None:
    drawn = [
        [(row["first"], row["second"], row["change"]) for row in rows_of(options, method)]
        for method in ROBOTS
    ]
    assert drawn[0] == drawn[1] == drawn[2]
    assert len({pair[:2] for pair in drawn[0]}) == 6  # all ordered pairs come in turn


def test_every_attempt_is_paid_and_so_is_a_question(options: StudyOptions) -> None:
    """A part that is bent is no longer cut: a goal may be lost, and then the episode is dear."""
    rows = [*rows_of(options, "joint"), *rows_of(options, "joint", "steady", 2)]
    assert {row["ending"] for row in rows} == {"reached", "stuck"}
    for row in rows:
        paid = 2 * (int(row["n_actions"] or 0) + int(row["questions"] or 0))
        least = 0 if row["ending"] == "reached" else PATIENCE * 2 * (2 + 4)
        assert row["team_cost"] == max(paid, least + 2 * int(row["questions"] or 0))


def test_actions_fail_only_where_the_state_of_people_drifts(options: StudyOptions) -> None:
    assert all(row["n_failed"] == 0 for row in rows_of(options, "goal-only", "steady"))
    assert any(row["n_failed"] for row in rows_of(options, "goal-only", n=12))


def test_a_drift_takes_one_function_and_ends_the_one_before(options: StudyOptions) -> None:
    task = scenario.task_of(*scenario.files_of(options, options["domain"]))
    setup = task.setup(options, "joint", Seed(0, 0))
    for run in range(12):
        nature = scenario.nature(setup, "changing", Seed(0, run), 10.0)
        first, second = nature.changes
        assert 0 <= first.t <= second.t <= 10
        assert {key[1] for key in first.values} == {"ann"}
        assert len({key[0] for key in first.values}) == 1
        assert set(first.values.values()) == {7}
        ended = first.values.keys() - {k for k, v in second.values.items() if v == 7}
        assert all(second.values[key] == 1 for key in ended)
    steady = scenario.nature(setup, "steady", Seed(0, 0), 10.0)
    assert steady.changes == ()


def test_a_report_names_the_task_and_judges_the_claim(
    options: StudyOptions, tmp_path: Path
) -> None:
    choice = {**options, "methods": ",".join(ROBOTS)}
    assert run_study("collaboration", tmp_path, limit=6, options=choice) == 6
    assert run_study("collaboration", tmp_path, limit=6, options=choice) == 0
    report = report_study(tmp_path)
    assert [row["cell"]["method"] for row in report["rows"]] == list(ROBOTS)
    assert len(report["claims"]) == 2
    page = (tmp_path / "report.html").read_text()
    assert "press" in page
    assert "kitchen" not in page


def cells_with(gain: float, makespan_s: float = 10.0) -> PairedCells:
    """Return rows in which the joint robot costs less by a gain, give or take."""
    rows: list[StudyRow] = []
    for run in range(40):
        for method in ROBOTS:
            mine = method == "joint"
            row: StudyRow = {"task": "here", "method": method, "run": run}
            row |= {"first": str(run % 7), "second": str(run % 6)}
            row |= dict.fromkeys(MEASURES, 10.0)
            row["team_cost"] = 10.0 - (gain + 0.5 * (run % 3 - 1) if mine else 0)
            row["makespan_s"] = makespan_s if mine else 10.0
            rows.append(row)
    return PairedCells(rows, [("here", method) for method in ROBOTS], scenario.KEYS, UNIT)


@pytest.mark.parametrize(("gain", "verdict"), [(2.0, HOLDS), (0.0, TOO_FEW), (-2.0, FAILS)])
def test_being_ahead_is_judged_by_intervals(gain: float, verdict: str) -> None:
    claim = claims.ahead(cells_with(gain))
    assert claim is not None
    assert claim.verdict == verdict


@pytest.mark.parametrize(("makespan_s", "verdict"), [(10.2, HOLDS), (10.5, FAILS)])
def test_another_measure_may_be_worse_by_less_than_its_margin(
    makespan_s: float, verdict: str
) -> None:
    claim = claims.no_worse(cells_with(1.0, makespan_s), "here")
    assert claim is not None
    assert claim.verdict == verdict


def test_a_claim_without_rows_of_a_rival_is_not_stated() -> None:
    full = cells_with(1.0)
    rows = [row for (_, method), own in full.rows.items() if method != "goal-only" for row in own]
    some = PairedCells(rows, [], scenario.KEYS, UNIT)
    assert claims.ahead(some) is None
