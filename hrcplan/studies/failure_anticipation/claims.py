"""What the rows show to hold: the paper's hypotheses, its Figure 5, and what we want to reach."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from hrcplan.agents.state import MOST
from hrcplan.studies.estimate import CONFIDENT, MeanEstimate, difference
from hrcplan.studies.failure_anticipation import scenario
from hrcplan.studies.report import estimates
from hrcplan.studies.study import Claim, StudyOptions, StudyRow, StudyRows

NAMES = {
    "success_pct": "success",
    "replans": "replans",
    "failed_pct": "failed",
    "assigned_human_pct": "assigned to the human",
    "assigned_robot_pct": "assigned to the robot",
    "successful_human_pct": "human's successful share",
    "successful_robot_pct": "robot's successful share",
    "makespan_s": "makespan",
}
UNITS = {"makespan_s": " s", "replans": ""}
H1 = "H1: the model raises success and lowers failed actions and replans"
PAPER, OURS = "Claims of the paper", "What we want to reach"
H2 = "H2: with the model the human contributes more, and fails less"


def claims(options: StudyOptions, rows: StudyRows) -> list[Claim]:
    """Return all claims, each judged by the rows alone."""
    found = [hypothesis_1(rows), hypothesis_2(rows)]
    found += [
        switch(options, profile, rows["allocation"])
        for profile in scenario.data()["allocation"]["profiles"]
    ]
    if scenario.is_own_task(options):
        found += [reach(wanted, rows) for wanted in reaches(options)]
    return found


def of_cell(rows: Iterable[StudyRow], case: str, method: str) -> list[StudyRow]:
    """Return the rows of one cell."""
    return [row for row in rows if row["case"] == case and row["method"] == method]


def by_run(rows: Iterable[StudyRow], measure: str) -> dict[int, float]:
    """Return a measure by the number of the run."""
    return {int(row["run"] or 0): float(row[measure] or 0) for row in rows}


def effect(rows: Sequence[StudyRow], case: str, measure: str) -> MeanEstimate:
    """Return what the model changes in case 1 or 2: paired runs of the paper's profile, b - a."""
    ours, theirs = (
        by_run(of_cell(rows, f"{case}{letter}", "paper"), measure)
        for letter in (scenario.WITH_MODEL, scenario.WITHOUT_MODEL)
    )
    return difference(ours, theirs)


def hypothesis_1(rows: StudyRows) -> Claim:
    """Return H1: success up, failed actions and replans down, in both cases."""
    holds, words = True, []
    for case in "12":
        found = {m: effect(rows["rows"], case, m) for m in ("success_pct", "failed_pct", "replans")}
        holds &= found["success_pct"].is_above_zero
        holds &= found["failed_pct"].is_below_zero and found["replans"].is_below_zero
        words.append(f"case {case}: {_changes(found)}")
    evidence = f"{'; '.join(words)}. Means of b minus a over pairs of runs, ± standard error."
    return Claim(H1, holds, evidence, PAPER)


def hypothesis_2(rows: StudyRows) -> Claim:
    """Return H2: fewer failures, a larger human share, and more of it the more the human can do."""
    holds, words = True, []
    for case in "12":
        found = {m: effect(rows["rows"], case, m) for m in ("failed_pct", "successful_human_pct")}
        holds &= found["failed_pct"].is_below_zero
        holds &= found["successful_human_pct"].is_above_zero
        words.append(f"case {case}: {_changes(found)}")
    able, unable = (
        by_run(of_cell(rows["rows"], case, "paper"), "successful_human_pct")
        for case in ("2b", "1b")
    )
    more = difference(able, unable)
    holds &= more.is_above_zero
    words.append(f"the human's share is {_signed(more)} points larger in 2b than in 1b")
    evidence = f"{'; '.join(words)}. Means of b minus a over pairs of runs, ± standard error."
    return Claim(H2, holds, evidence, PAPER)


def _changes(found: Mapping[str, MeanEstimate]) -> str:
    texts = [
        f"{NAMES[name]} {_signed(e)}{'' if name == 'replans' else ' points'}"
        for name, e in found.items()
    ]
    return f"{', '.join(texts)} (n = {min(e.n for e in found.values())})"


def _signed(e: MeanEstimate) -> str:
    return f"{e.mean:+.2f} ± {e.se:.2f}".replace("-", "\u2212")


def switch(options: StudyOptions, profile: str, rows: Iterable[StudyRow]) -> Claim:
    """Return that above 10 everything goes to the robot in the plan after the change.

    Of the paper's profile only the change before the first action is judged, as its Figure 5
    changes "the same initial situation"; of others, the changes before any action.
    """
    points = [row for row in rows if row["profile"] == profile]
    changes = sorted({int(row["action"] or 0) for row in points})
    judged = changes[:1] if profile == "paper" else changes
    thresholds = {at: last_with_human(points, at) for at in changes}
    when = "known before the first action" if profile == "paper" else "at any time"
    text = f"Above {MOST} all actions go to the robot ({profile} profile, change {when})"
    holds = bool(judged) and all(_switches(thresholds[at], points, at) for at in judged)
    words = [f"{_until(thresholds[at], points)} (before action {at + 1})" for at in changes]
    evidence = f"The human gets actions {', '.join(words)}." if words else "no rows"
    return Claim(text, holds, evidence, PAPER if profile == "paper" else OURS)


def last_with_human(points: Iterable[StudyRow], at: int) -> int | None:
    """Return the largest value at which the human still gets an action, None if there is none."""
    values = [int(r["value"] or 0) for r in points if r["action"] == at and r["n_human"]]
    return max(values, default=None)


def _switches(last: int | None, points: Iterable[StudyRow], at: int) -> bool:
    """Whether the human has actions at some value, none above 10, and such values were tried."""
    tried = any(row["action"] == at and int(row["value"] or 0) > MOST for row in points)
    return tried and last is not None and last <= MOST


def _until(last: int | None, points: Iterable[StudyRow]) -> str:
    most = max(int(row["value"] or 0) for row in points)
    if last is None:
        return "at no value"
    return f"at all values up to {most}" if last == most else f"up to {last}"


def reaches(options: StudyOptions) -> Iterator[Mapping[str, Any]]:
    """Yield what is wanted of cells that the study has."""
    known = set(scenario.cells("methods", options))
    yield from (w for w in scenario.data()["reach"] if tuple(w["cell"]) in known)


def reach(wanted: Mapping[str, Any], rows: StudyRows) -> Claim:
    """Return that the means of a cell lie in their bands."""
    case, method = wanted["cell"]
    found = of_cell(rows["rows"], case, method)
    bands = {name: band for name, band in wanted.items() if name in NAMES}
    got = estimates(found, list(bands))
    holds = bool(found) and all(lo <= got[m].mean <= hi for m, (lo, hi) in bands.items())
    goals = [f"{NAMES[m]} {_band(m, lo, hi)}" for m, (lo, hi) in bands.items()]
    words = [f"{NAMES[m]} {_shown(m, e)}" for m, e in got.items()]
    if (bound := wanted.get("above")) is not None:
        more, least = _above(bound, found, rows)
        holds &= more.n > 0 and more.mean <= bound["by"]
        goals.append(f"{NAMES[bound['measure']]} at most {bound['by']} points above {least}")
        words.append(f"{NAMES[bound['measure']]} {_signed(more)} points above (n = {more.n})")
    return Claim(
        f"{case} {method}: {', '.join(goals)}", holds, f"{', '.join(words)}; n = {len(found)}", OURS
    )


def _above(
    bound: Mapping[str, Any], found: Iterable[StudyRow], rows: StudyRows
) -> tuple[MeanEstimate, str]:
    """Return how far a cell is above a variant on the same runs, and the variant's name."""
    case, name = bound["variant"]
    theirs = by_run(of_cell(rows["variants"], case, name), bound["measure"])
    return difference(by_run(found, bound["measure"]), theirs), name


def _band(measure: str, low: float, high: float) -> str:
    unit = UNITS.get(measure, " %")
    if low == high:
        return f"{low:g}{unit}"
    if low == 0:
        return f"at most {high:g}{unit}"
    return f"at least {low:g}{unit}" if high == 100 else f"{low:g} to {high:g}{unit}"


def _shown(measure: str, e: MeanEstimate) -> str:
    return f"{e.mean:.2f}{UNITS.get(measure, ' %')} ± {e.se:.2f}"


def is_far(ours: MeanEstimate, printed: float, runs: int) -> bool:
    """Whether a printed mean over ``runs`` simulations is unlikely to be one of ours."""
    return abs(ours.mean - printed) > CONFIDENT * ours.se_of(runs)
