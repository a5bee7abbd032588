"""Claims can fail: each follows from the rows, here made up so that all of them hold, then bent."""

import copy
import json
import random
import re
from collections.abc import Callable
from itertools import permutations
from pathlib import Path
from typing import Any

import pytest

from hrcplan.episodes.episode import REACHED
from hrcplan.studies import report_study
from hrcplan.studies.changed_mind import claims, figures, reach, scenario
from hrcplan.studies.changed_mind.cells import Cells
from hrcplan.studies.changed_mind.findings import all_means, endings, findings
from hrcplan.studies.changed_mind.findings import claims_of as all_claims
from hrcplan.studies.changed_mind.measures import MEASURES
from hrcplan.studies.estimate import Interval
from hrcplan.studies.measure import ends, number, with_sign
from hrcplan.studies.store import Store
from hrcplan.studies.study import Claim, Episode, StudyRow, find

STUDY = find("changed-mind")
OPTIONS = scenario.defaults()
PAIRS = list(permutations([f"goal-{i}" for i in range(5)], 2))
RANKS = ("oracle", "hrcplan", "rhp", "recursive-best", "recursive", "cdp", "infogain")
"""Methods from the best to the worst; variants of rhp are like it."""
Made = dict[str, list[StudyRow]]


def row(human: str, method: str, run: int) -> StudyRow:
    """Return an invented row in which methods are as good as their rank, with little noise."""
    first, second = PAIRS[run % len(PAIRS)]
    said = scenario.human_data(human)
    changes, errs = said["changes"], bool(said.get("mistake_rate"))
    q = RANKS.index(method) if method in RANKS else 2
    noise = 0.02 * random.Random(f"{human} {method} {run}").uniform(-1, 1)
    declares = method not in ("recursive", "recursive-best", "cdp", "infogain", "oracle")
    extra = (0.0, 0.05, 0.5)[q] if q < 3 else 0.5 + q
    total = 28.7 + run % 3 - 1 + extra + noise
    pct = (0.0, 40.0)[q] if q < 2 else (46 if changes == 0 else 60) + q
    made: StudyRow = dict.fromkeys((*STUDY.tables[0].columns, "decision_ms"), 0)
    made |= {
        "human": human, "method": method, "run": run, "ending": REACHED,
        "first": first, "second": second if changes else None,
        "first_correct": q + noise, "last_incorrect_pct": pct + noise,
        "last_incorrect_step": pct * total / 100,
        "correct_pct": 100 - 15 * min(q, 2) - q + noise, "top3_pct": 99.0,
        "wasted_robot_steps": (0.0, 0.25, 1.0)[q] if q < 3 else 1.0 + q,
        "human_mistakes": int(errs and run % 3 == 0), "total_steps": total, "extra_steps": extra,
        "extra_vs_oracle": extra, "detection_delay": q + noise if declares and changes else None,
        "n_detected": int(declares and changes > 0),
        "reached_pct": 100.0, "false_changes": (0.2 * q + noise) * declares, "decision_ms": 1.5 * q,
    }  # fmt: skip
    return made


def made_up(n_runs: int = 40) -> Made:
    """Return rows of all tables."""
    return {
        table.name: [
            row(str(human), str(method), run)
            for human, method in table.cells(OPTIONS)
            for run in range(n_runs if table is STUDY.tables[0] else n_runs // 2)
        ]
        for table in STUDY.tables
    }


GOOD = made_up()


def judged(rows: Made, **options: str) -> dict[str, Claim]:
    chosen = {**OPTIONS, **options}
    cells = {name: Cells(name, chosen, of_table) for name, of_table in rows.items()}
    found = all_claims(chosen, cells["rows"], cells)
    assert len({claim.claim for claim in found}) == len(found)
    return {claim.claim: claim for claim in found}


def bent(change: Callable[[StudyRow], Any], table: str = "rows", **where: str) -> dict[str, Claim]:
    """Return the claims after a change to the rows of some cells."""
    rows = copy.deepcopy(GOOD)
    some = [r for r in rows[table] if all(r[key] == value for key, value in where.items())]
    assert some
    for one in some:
        change(one)
    return judged(rows)


def without(table: str, **where: str) -> Made:
    rows = copy.deepcopy(GOOD)
    gone = [r for r in rows[table] if all(r[key] == value for key, value in where.items())]
    assert gone
    rows[table] = [r for r in rows[table] if r not in gone]
    return rows


def adding(measure: str, amount: float) -> Callable[[StudyRow], Any]:
    def change(one: StudyRow) -> None:
        one[measure] = float(one[measure] or 0) + amount

    return change


def test_one_run_shows_nothing_to_be_as_good() -> None:
    """Of one pair of goals no interval is known: that nothing is worse is no evidence."""
    found = judged(made_up(2) | {"rows": [row for row in GOOD["rows"] if row["run"] == 0]})
    absent = [c for text, c in found.items() if "no worse" in text or "as good" in text]
    assert len(absent) == 4 + 14 + 2
    assert {(claim.holds, claim.verdict) for claim in absent} == {(None, "too-few")}


def test_made_up_rows_make_all_claims_hold() -> None:
    found = judged(GOOD)
    assert [claim.claim for claim in found.values() if not claim.holds] == []
    groups = [claim.group for claim in found.values()]
    assert groups.count(claims.GROUP) == 11
    assert groups.count(reach.GROUP) == 8 + 3 + 1 + 14 + 2
    assert all(claim.evidence for claim in found.values())


SUB, OPT, FIX = ({"human": human} for human in ("suboptimal", "optimal", "fixed"))
BENT = [
    ("first_correct", 2.5, {**SUB, "method": "rhp"}, "After a change the first right guess"),
    ("first_correct", -9, {**OPT, "method": "cdp"}, "After a change the first right guess"),
    ("last_incorrect_pct", 9, {**SUB, "method": "rhp"}, "When the goal changes, the last wrong "
     "guess comes earlier than with any baseline (suboptimal human)"),
    ("last_incorrect_pct", -9, {**OPT, "method": "infogain"}, "When the goal changes, the last "
     "wrong guess comes earlier than with any baseline (optimal human)"),
    ("last_incorrect_pct", -5, {**FIX, "method": "cdp"}, "When the goal is fixed, the last wrong "
     "guess of the method and of recursive Bayes comes earlier"),
    ("last_incorrect_pct", -4, {**FIX, "method": "rhp"}, "When the goal is fixed, the last wrong "
     "guess of the method and of recursive Bayes is about"),
    ("last_incorrect_pct", 6, {**FIX, "method": "recursive"}, "When the goal is fixed, the last "
     "wrong guess of the method and of recursive Bayes is about"),
    ("correct_pct", 3, {**SUB, "method": "recursive"}, "When the goal changes, more guesses are "
     "right than with any baseline (suboptimal human)"),
    ("correct_pct", -9, {**OPT, "method": "rhp"}, "When the goal changes, more guesses are right "
     "than with any baseline (optimal human)"),
    ("extra_steps", 9, {**FIX, "method": "rhp"}, "Fewer extra steps"),
    ("correct_pct", 9, {**SUB, "method": "infogain"}, "When the goal changes, CDP"),
    ("extra_steps", 0.6, {**SUB, "method": "rhp"}, "The number of extra steps is minimal"),
    ("total_steps", 0.6, {**OPT, "method": "oracle"}, "Combinations of two goals take 28.7"),
    ("total_steps", -0.6, {**OPT, "method": "oracle"}, "Combinations of two goals take 28.7"),
    ("wasted_robot_steps", 0.06, {**FIX, "method": "hrcplan"}, "fixed: wasted robot steps"),
    ("wasted_robot_steps", 0.21, {**OPT, "method": "hrcplan"}, "optimal: wasted robot steps"),
    ("first_correct", 1.4, {**OPT, "method": "hrcplan"}, "optimal: first right guess"),
    ("total_steps", 0.1, {**OPT, "method": "hrcplan"}, "optimal: total steps"),
    ("last_incorrect_pct", 11, {**SUB, "method": "hrcplan"}, "suboptimal: last wrong guess"),
    ("correct_pct", -12, {**SUB, "method": "hrcplan"}, "suboptimal: right guesses"),
    ("wasted_robot_steps", 0.3, {**SUB, "method": "hrcplan"}, "suboptimal: wasted robot steps"),
    ("false_changes", 0.15, {**SUB, "method": "hrcplan"}, "suboptimal: false changes"),
    ("last_incorrect_step", -30, {**FIX, "method": "cdp"}, "fixed: no worse than any"),
    ("total_steps", -6, {**OPT, "method": "recursive"}, "optimal: no worse than any"),
    ("detection_delay", 2, {**SUB, "method": "hrcplan"}, "suboptimal: no worse than any"),
]  # fmt: skip


@pytest.mark.parametrize(("measure", "amount", "where", "claim"), BENT)
def test_bent_rows_make_a_claim_fail(
    measure: str, amount: float, where: dict[str, str], claim: str
) -> None:
    found = bent(adding(measure, amount), **where)
    failed = [text for text in found if text.startswith(claim)]
    assert len(failed) == 1
    assert not found[failed[0]].holds


def test_waste_with_more_changes_is_counted_per_change() -> None:
    claim = "More changes than one: at most 1 wasted robot step per change of goal"
    where = {"table": "beyond", "human": "3 changes", "method": "hrcplan"}
    assert bent(adding("wasted_robot_steps", 2.7), **where)[claim].holds
    assert not bent(adding("wasted_robot_steps", 2.8), **where)[claim].holds


ROBUST = [human for name in ("choosers", "variants") for human in scenario.humans(name, OPTIONS)]


@pytest.mark.parametrize("human", ["habit, mistakes", "suboptimal"])
@pytest.mark.parametrize(
    ("measure", "margin"),
    [("total_steps", 0.1), ("first_correct", 0.25), ("last_incorrect_step", 0.25)],
)
def test_another_belief_may_be_better_by_the_margin_at_most(
    human: str, measure: str, margin: float
) -> None:
    """Each rival counts, also one that shares hrcplan's choice of steps."""
    table = "variants" if human == "suboptimal" else "choosers"
    rival = "recursive-next, our steps"

    def behind(by: float) -> Claim:
        rows = copy.deepcopy(GOOD)
        ours = [r for r in rows[table] if r["human"] == human and r["method"] == "hrcplan"]
        theirs = [r for r in rows[table] if r["human"] == human and r["method"] == rival]
        for one, other in zip(ours, theirs, strict=True):
            other[measure] = float(str(one[measure])) - by
        return next(c for text, c in judged(rows).items() if text.startswith(f"{human}: as good"))

    assert behind(margin - 0.01).holds
    assert behind(margin + 0.01).holds is False
    assert f"against {rival}" in behind(margin + 0.01).evidence


def test_few_wasted_steps_count_only_at_no_more_time() -> None:
    """A robot that always waits wastes nothing."""

    def idle(row: StudyRow) -> None:
        row["wasted_robot_steps"], row["total_steps"] = 0.0, float(row["total_steps"] or 0) + 2

    found = bent(idle, **OPT, method="hrcplan")
    (claim,) = (c for text, c in found.items() if text.startswith("optimal: wasted robot steps"))
    assert claim.holds is False
    assert "Total steps: +" in claim.evidence


def test_every_bent_claim_is_bent_by_some_case() -> None:
    starts = [claim for *_, claim in BENT] + ["More changes than one"]
    starts += [f"{human}: as good" for human in ROBUST]
    for claim in judged(GOOD):
        assert any(claim.startswith(start) for start in starts), claim


def test_the_best_setting_of_a_baseline_stands_beside_the_claim_and_decides_nothing() -> None:
    found = bent(adding("first_correct", -9), method="recursive-best", human="optimal")
    claim = found[claims.AHEAD[0].claim]
    assert claim.holds
    assert re.search(r"with the claim: \+\d\.\d\d \(.*\) against recursive-best", claim.evidence)


NO_WORSE = (
    "optimal: no worse than any baseline in any measure counted in steps (non-inferior by a margin "
    "of 0.25 steps)"
)


def test_where_we_are_behind_is_listed_with_its_reason() -> None:
    found = bent(adding("last_incorrect_step", -30), method="recursive", human="optimal")
    claim = found[NO_WORSE]
    assert "not shown in 1: last wrong guess +" in claim.evidence
    assert "against recursive (a likely reason: a robot that does useless steps" in claim.evidence
    found = bent(adding("detection_delay", 2), method="hrcplan", human="optimal")
    claim = found[NO_WORSE]
    assert "and pays in false changes, +" in claim.evidence
    found = bent(adding("first_correct", -30), method="recursive", human="optimal")
    claim = found[NO_WORSE]
    assert "not shown in 1: first right guess +" in claim.evidence
    assert "reason" not in claim.evidence


def test_one_run_shows_nothing() -> None:
    rows = {name: [r for r in had if r["run"] == 0] for name, had in GOOD.items()}
    found = judged(rows)
    assert not any(found[wanted.claim].holds for wanted in claims.AHEAD)
    assert "unknown" in found[claims.AHEAD[0].claim].evidence


@pytest.mark.parametrize("method", RANKS)
def test_what_lacks_a_method_is_left_out(method: str) -> None:
    rows = without("rows", method=method)
    found = judged(rows)
    assert all(claim.holds for claim in found.values())
    assert 0 < len(found) < len(judged(GOOD))
    section = all_means(Cells("rows", OPTIONS, rows["rows"]))
    assert section is not None
    assert f"</i>{method}</th>" not in section.html


@pytest.mark.parametrize("human", claims.HUMANS)
def test_what_lacks_a_human_is_left_out(human: str) -> None:
    rows = without("rows", human=human)
    rows["variants"] = [row for row in rows["variants"] if row["human"] != human]
    found = judged(rows)
    assert not any(claim.startswith(f"{human}:") for claim in found)
    assert claims.AHEAD[-1].claim not in found


def test_without_rows_there_is_hardly_a_page() -> None:
    empty: Made = {table.name: [] for table in STUDY.tables}
    found = findings(OPTIONS, empty)
    assert list(found.claims) == []
    assert [section.title for section in found.sections] == ["Readings"]


def test_a_page_of_one_method_and_one_human_compares_nothing() -> None:
    rows: Made = {table.name: [] for table in STUDY.tables}
    rows["rows"] = [row("fixed", "hrcplan", run) for run in range(3)]
    found = findings(OPTIONS, rows)
    titles = [section.title for section in found.sections]
    assert titles == ["Figure 3: guesses and steps", "All measures", "Time of a decision",
                      "Readings"]  # fmt: skip
    assert found.sections[0].html.count("<svg ") == 5  # nothing changes: no panel a


def test_on_another_task_nothing_printed_is_judged() -> None:
    found = judged({**GOOD, "beyond": []}, domain="transport")
    assert {claim.group for claim in found.values()} == {claims.OTHER_TASK}
    assert not any("28.7" in claim or "midpoint" in claim or "minimal" in claim for claim in found)
    assert len(found) == len(claims.AHEAD) + 1


def test_strangers_have_a_place() -> None:
    rows = copy.deepcopy(GOOD)
    rows["rows"] += [{**row("optimal", "rhp", run), "method": "mine:Robot"} for run in range(20)]
    rows["rows"] += [
        {**row("optimal", method, run), "human": "mine:Human"}
        for run in range(20)
        for method in ("rhp", "hrcplan")
    ]
    cells = Cells("rows", OPTIONS, rows["rows"])
    section = all_means(cells)
    assert section is not None
    assert "</i>mine:Robot</th>" in section.html
    assert "mine:Human 20 runs of 20 pairs of goals" in section.html
    assert figures.color("mine:Robot", cells.methods) not in figures.COLORS.values()


def test_differences_are_paired_by_run_and_by_goals() -> None:
    rows = [
        {**row("optimal", method, run), "first_correct": run + (method == "cdp") * (1 + run % 2)}
        for method in ("rhp", "cdp")
        for run in range(20)
    ]
    cells = Cells(
        "rows", OPTIONS, [r for r in rows if not (r["method"] == "cdp" and r["run"] == 0)]
    )
    gap = cells.difference("optimal", "rhp", "cdp", "first_correct")
    assert gap is not None
    assert gap.n == 19
    assert gap.mean == pytest.approx(-sum(1 + run % 2 for run in range(1, 20)) / 19)
    assert -2 <= gap.low < gap.mean < gap.high <= -1
    assert cells.difference("fixed", "rhp", "cdp", "first_correct") is None
    assert cells.difference("optimal", "rhp", "cdp", "detection_delay") is None


def test_a_method_that_declares_no_changes_has_no_false_ones() -> None:
    cells = Cells("rows", OPTIONS, GOOD["rows"])
    assert cells.mean("optimal", "cdp", "false_changes") is None
    declared = cells.mean("fixed", "hrcplan", "n_detected")
    assert declared is not None
    assert declared.mean == 0


def test_verdicts_know_which_way_is_better() -> None:
    up, down, both = Interval(1, 0.5, 2, 9), Interval(-1, -2, -0.5, 9), Interval(0, -1, 1, 9)
    assert MEASURES["total_steps"].verdict(up) == MEASURES["top3_pct"].verdict(down) == "worse"
    assert MEASURES["total_steps"].verdict(down) == MEASURES["top3_pct"].verdict(up) == "better"
    assert MEASURES["human_mistakes"].verdict(up) == MEASURES["total_steps"].verdict(both) == ""


def test_numbers_in_words() -> None:
    assert (number(-0.0), number(-2.5)) == ("0.00", "\u22122.50")
    assert (with_sign(0.0), with_sign(0.004), with_sign(-0.004)) == ("0.00",) * 3
    assert ends(Interval(0, -float("inf"), float("inf"), 1)) == "unknown"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("made-up")
    about = {"study": STUDY.name, "version": "x", "seed": 0, "options": OPTIONS}
    with Store.to_write(path, about, STUDY.tables) as store:
        for table in STUDY.tables:
            made = [
                (Episode(table.name, (str(r["human"]), str(r["method"])), int(r["run"] or 0)), r)
                for r in GOOD[table.name]
            ]
            store.add(table, made)
    report_study(path)
    return path


def test_the_page_needs_nothing_but_itself_and_its_names_are_unique(folder: Path) -> None:
    page = (folder / "report.html").read_text()
    assert page.count("<svg ") == 6 + 4 + 1
    for outside in ("<script", "src=", "@import", "<link", 'href="http'):
        assert outside not in page, outside
    names = re.findall(r' id="([^"]+)"', page)
    assert len(names) == len(set(names))
    titles = re.findall("<h2>(.*?)</h2>", page)
    assert titles == [
        claims.GROUP, reach.GROUP, "Figure 3: guesses and steps", "Whose human is it?",
        "All measures", "Paired differences", "Time of a decision",
        "More changes, waits and alternatives", "Two banks, two kinds of consistency",
        "Parts exchanged", "Readings", "How to read these figures",
    ]  # fmt: skip


def test_the_report_keeps_its_keys(folder: Path) -> None:
    document = json.loads((folder / "report.json").read_text())
    assert {"study", "n_rows", "rows", "claims"} <= set(document)
    assert len(document["rows"]) == 21
    for one in document["rows"]:
        assert set(one["cell"]) == {"human", "method"}
        assert set(one["measures"]) == set(STUDY.measures)
        assert all(set(figure) == {"mean", "se"} for figure in one["measures"].values())
    assert all(
        set(claim) == {"claim", "verdict", "holds", "evidence"} for claim in document["claims"]
    )


def test_the_same_rows_give_the_same_plots() -> None:
    once, again = (
        figures.bars(Cells("rows", OPTIONS, GOOD["rows"]), ["optimal"], "correct_pct", "x")
        for _ in range(2)
    )
    assert once == again


def test_episodes_that_did_not_reach_their_goal_are_told() -> None:
    rows = copy.deepcopy(GOOD["rows"])
    assert "all" in endings(Cells("rows", OPTIONS, rows))
    rows[0]["ending"] = "stuck"
    text = endings(Cells("rows", OPTIONS, rows))
    assert f"In 1 of {len(rows):,} episodes" in text
    assert f"{rows[0]['human']} {rows[0]['method']} 1" in text
    assert "In 0 of them it had become unreachable" in text
    rows[0]["unreachable_pct"] = 100.0
    assert "In 1 of them it had become unreachable" in endings(Cells("rows", OPTIONS, rows))
    rows[0]["unreachable_pct"] = None
    assert "earlier version" in endings(Cells("rows", OPTIONS, rows))
