"""Claims about the rows: the hypotheses and Figure 5 of the paper, and the aims for hrcplan."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from hrcplan.agents.state import MOST
from hrcplan.studies.estimate import MeanEstimate, difference, t_quantile
from hrcplan.studies.failure_anticipation import scenario
from hrcplan.studies.failure_anticipation.measures import MEASURES
from hrcplan.studies.measure import difference_text, number
from hrcplan.studies.report import estimates
from hrcplan.studies.study import Claim, StudyOptions, StudyRow, StudyRows
from hrcplan.studies.verdict import BoundTest, judge

H1 = "H1: the model raises success and lowers failed actions and replans"
BASELINE = "replan-always"
"""The method of the failure-anticipation paper, and its profile."""
PAPER, AIMS = "Claims of the failure-anticipation paper", "Aims of hrcplan"
OTHER_TASK = "Claims on this task"
SENSING = "Sensing against remembering"
SENSING_MEASURES = (
    "success_pct", "replans", "failed_pct", "successful_human_pct", "makespan_s",
)  # fmt: skip
ROWS_OF = {"methods": "rows", "variants": "variants"}
H2 = "H2: with the model the human contributes more, and fails less"


def claims(options: StudyOptions, rows: StudyRows) -> list[Claim]:
    """Return all claims, each judged by the rows alone."""
    results = [hypothesis_1(rows), hypothesis_2(rows)]
    profiles = scenario.data()["allocation"]["profiles"]
    results += [switch(options, profile, rows["allocation"]) for profile in profiles]
    if scenario.is_own_task(options):
        results.append(switch(options, BASELINE, rows["allocation"], at_any_time=True))
        results += [printed(case, rows) for case in scenario.data()["printed"] if case[0] in "12"]
        results += [reach(aim, rows) for aim in aims(options)]
    else:
        results = [replace(claim, group=OTHER_TASK) for claim in results]
    return [*results, *sensing(rows)]


def of_cell(rows: Iterable[StudyRow], case: str, method: str) -> list[StudyRow]:
    """Return the rows of one cell."""
    return [row for row in rows if row["case"] == case and row["method"] == method]


def by_run(rows: Iterable[StudyRow], measure: str) -> dict[int, float]:
    """Return the values of a measure by the number of the run."""
    return {int(row["run"] or 0): float(row[measure] or 0) for row in rows}


def effect(rows: Sequence[StudyRow], case: str, measure: str) -> MeanEstimate:
    """Return the effect of the model in case 1 or 2: paired differences b - a of the baseline."""
    ours, theirs = (
        by_run(of_cell(rows, f"{case}{letter}", BASELINE), measure)
        for letter in (scenario.WITH_MODEL, scenario.WITHOUT_MODEL)
    )
    return difference(ours, theirs)


def hypothesis_1(rows: StudyRows) -> Claim:
    """Return H1: success up, failed actions and replans down, in both cases."""
    tests, words = [], []
    for case in "12":
        names = ("success_pct", "failed_pct", "replans")
        effects = {m: effect(rows["rows"], case, m) for m in names}
        tests += [MEASURES[name].beats(e.interval) for name, e in effects.items()]
        words.append(f"case {case}: {_changes(effects)}")
    return _hypothesis(H1, tests, words)


def hypothesis_2(rows: StudyRows) -> Claim:
    """Return H2: fewer failures, a larger human share, and more of it the more the human can do."""
    tests, words = [], []
    for case in "12":
        effects = {m: effect(rows["rows"], case, m) for m in ("failed_pct", "successful_human_pct")}
        tests += [MEASURES[name].beats(e.interval) for name, e in effects.items()]
        words.append(f"case {case}: {_changes(effects)}")
    able, unable = (
        by_run(of_cell(rows["rows"], case, BASELINE), "successful_human_pct")
        for case in ("2b", "1b")
    )
    more = difference(able, unable)
    tests.append(MEASURES["successful_human_pct"].beats(more.interval))
    words.append(f"the human's share is {difference_text(more)} points larger in 2b than in 1b")
    return _hypothesis(H2, tests, words)


def _hypothesis(claim: str, tests: Iterable[BoundTest], words: Iterable[str]) -> Claim:
    holds, telling = judge(tests)
    evidence = f"{'; '.join(words)}. Means of b minus a over pairs of runs, ± standard error."
    return Claim(claim, holds, evidence + telling, PAPER)


_UNITS = {"replans": "", "makespan_s": " s"}


def _changes(effects: Mapping[str, MeanEstimate]) -> str:
    texts = [
        f"{MEASURES[name].name} {difference_text(e)}{_UNITS.get(name, ' points')}"
        for name, e in effects.items()
    ]
    return f"{', '.join(texts)} (n = {min(e.n for e in effects.values())})"


def printed(case: str, rows: StudyRows) -> Claim:
    """Return that all printed means of a case are as probable here as chance explains."""
    reference = scenario.data()["printed"]
    own = of_cell(rows["rows"], case, BASELINE)
    means = estimates(own, reference["columns"]) if own else {}
    figures = dict(zip(reference["columns"], reference[case], strict=True))
    far = [n for n, e in means.items() if is_far(e, figures[n], reference["runs"])]
    words = [f"{MEASURES[n].name} {_text(n, means[n])}, printed {figures[n]:g}" for n in far]
    holds = not far if any(e.is_known for e in means.values()) else None
    evidence = f"{'; '.join(words) or 'none is farther off'} (n = {len(own)})."
    text = f"Table I, case {case}: every printed mean is within what chance explains (95 %)"
    return Claim(text, holds, evidence, PAPER)


def sensing(rows: StudyRows) -> Iterator[Claim]:
    """Yield that sensing is better than remembering, for each scenario and case."""
    for table in scenario.data()["sensing"]:
        name = table["name"]
        source = rows[ROWS_OF[table.get("kind", "variants")]]
        for case in "12":
            a, b = (of_cell(source, case + letter, table.get(letter, name)) for letter in "ab")
            effects = {m: difference(by_run(b, m), by_run(a, m)) for m in SENSING_MEASURES}
            if not min(e.n for e in effects.values()):
                continue
            lower = table.get("lower", ["failed_pct"])
            holds, telling = judge(MEASURES[m].beats(effects[m].interval) for m in lower)
            goals = " and ".join(MEASURES[m].name for m in lower)
            evidence = f"{_changes(effects)}. Means of sensing minus remembering.{telling}"
            yield Claim(f"Case {case}, {name}: sensing lowers {goals}", holds, evidence, SENSING)


def switch(
    options: StudyOptions, profile: str, rows: Iterable[StudyRow], *, at_any_time: bool = False
) -> Claim:
    """Return that above 10 everything goes to the robot in the plan after the change.

    Of the paper's profile the change before the first action is judged, as its Figure 5 changes
    "the same initial situation"; of others, and ``at_any_time``, the changes before any action.
    """
    points = [row for row in rows if row["profile"] == profile]
    changes = sorted({int(row["action"] or 0) for row in points})
    is_first = profile == BASELINE and not at_any_time
    actions = changes[:1] if is_first else changes
    thresholds = {at: last_with_human(points, at) for at in changes}
    when = "known before the first action" if is_first else "at any time"
    text = f"Above {MOST} all actions go to the robot ({profile} profile, change {when})"
    holds = all(_switches(thresholds[at], points, at) for at in actions) if actions else None
    words = [f"{_until(thresholds[at], points)} (before action {at + 1})" for at in changes]
    evidence = f"The human gets actions {', '.join(words)}." if words else "no rows"
    return Claim(text, holds, evidence, PAPER if profile == BASELINE else AIMS)


def last_with_human(points: Iterable[StudyRow], at: int) -> int | None:
    """Return the largest value at which the human still gets an action, None if there is none."""
    values = [int(r["value"] or 0) for r in points if r["action"] == at and r["n_human"]]
    return max(values, default=None)


def _switches(last: int | None, points: Iterable[StudyRow], at: int) -> bool:
    """Whether the human has actions at some value, none above 10, and such values were tried."""
    has_tried = any(row["action"] == at and int(row["value"] or 0) > MOST for row in points)
    return has_tried and last is not None and last <= MOST


def _until(last: int | None, points: Iterable[StudyRow]) -> str:
    most = max(int(row["value"] or 0) for row in points)
    if last is None:
        return "at no value"
    return f"at all values up to {most}" if last == most else f"up to {last}"


def aims(options: StudyOptions) -> Iterator[Mapping[str, Any]]:
    """Yield the aims for cells that the study has."""
    cells = set(scenario.cells("methods", options))
    yield from (aim for aim in scenario.data()["reach"] if tuple(aim["cell"]) in cells)


def reach(aim: Mapping[str, Any], rows: StudyRows) -> Claim:
    """Return the claim that the means of a cell lie in their bands."""
    case, method = aim["cell"]
    own = of_cell(rows["rows"], case, method)
    bands = {name: band for name, band in aim.items() if name in MEASURES}
    means = estimates(own, list(bands))
    tests = [BoundTest(means[m].interval, lo, hi) for m, (lo, hi) in bands.items()]
    goals = [f"{MEASURES[m].name} {_band(m, lo, hi)}" for m, (lo, hi) in bands.items()]
    words = [f"{MEASURES[m].name} {_text(m, e)}" for m, e in means.items()]
    if (bound := aim.get("above")) is not None:
        excess, variant = _above(bound, own, rows)
        name = MEASURES[bound["measure"]].name
        tests.append(BoundTest(excess.interval, most=bound["by"]))
        goals.append(f"{name} at most {bound['by']} points above {variant}")
        words.append(f"{name} {difference_text(excess)} points above (n = {excess.n})")
    holds, telling = judge(tests)
    evidence = f"{', '.join(words)}; n = {len(own)}.{telling}"
    return Claim(f"{case} {method}: {', '.join(goals)}", holds, evidence, AIMS)


def _above(
    bound: Mapping[str, Any], own: Iterable[StudyRow], rows: StudyRows
) -> tuple[MeanEstimate, str]:
    """Return by how much a cell is above a variant on the same runs, and the variant's name."""
    case, name = bound["variant"]
    others = by_run(of_cell(rows["variants"], case, name), bound["measure"])
    return difference(by_run(own, bound["measure"]), others), name


def _band(measure: str, low: float, high: float) -> str:
    amount = MEASURES[measure].amount
    if low == high:
        return amount(f"{low:g}")
    if low == 0:
        return f"at most {amount(f'{high:g}')}"
    return f"at least {amount(f'{low:g}')}" if high == 100 else amount(f"{low:g} to {high:g}")


def _text(measure: str, e: MeanEstimate) -> str:
    amount = MEASURES[measure].amount(number(e.mean))
    return f"{amount} ± {number(e.se)}" if e.is_known else amount


def is_far(ours: MeanEstimate, figure: float, runs: int) -> bool:
    """Whether a printed mean over ``runs`` simulations is unlikely, given the mean here."""
    return abs(ours.mean - figure) > t_quantile(runs - 1) * ours.se_of(runs)
