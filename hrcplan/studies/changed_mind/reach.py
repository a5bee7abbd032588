"""The aims for hrcplan, with the numbers of ``scenario.toml``; judged on its own task only."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from hrcplan.studies.changed_mind import scenario
from hrcplan.studies.changed_mind.cells import Cells
from hrcplan.studies.changed_mind.episodes import ORACLE
from hrcplan.studies.changed_mind.measures import MEASURES
from hrcplan.studies.estimate import Interval, MeanEstimate
from hrcplan.studies.measure import interval_text, mean_text, number, with_sign
from hrcplan.studies.study import Claim
from hrcplan.studies.verdict import BoundTest, judge

GROUP = "Aims of hrcplan"
WASTED, TOTAL = "wasted_robot_steps", "total_steps"


def claims(main: Cells, cells: Mapping[str, Cells]) -> list[Claim]:
    """Return what is wanted, without what lacks rows.

    Args:
        main: The main table.
        cells: All tables by name.
    """
    data = scenario.data()["reach"]
    results = [superiority(one, data, main) for one in data["wanted"]]
    results += [as_good(human, data, main) for human in main.humans]
    for name in data["robust"]["tables"]:
        results += [robustness(human, data, cells[name]) for human in cells[name].humans]
    results.append(waste(data, cells["beyond"]))
    return [claim for claim in results if claim is not None]


def superiority(one: Mapping[str, Any], data: Mapping[str, Any], cells: Cells) -> Claim | None:
    """Return that a mean is low or high enough, by itself or compared with another method's.

    Few wasted steps are worth nothing by themselves: a robot that always waits wastes none. So they
    are judged together with the total steps.
    """
    human, measure, method = one["human"], one["measure"], data["method"]
    ours = cells.mean(human, method, measure)
    if ours is None:
        return None
    name, unit = MEASURES[measure].name, MEASURES[measure].unit
    start = f"{human}: {name} ({unit})"
    if "most" in one:
        test = BoundTest(ours.interval, most=one["most"])
        evidence = f"{mean_text(ours)}; n = {cells.n_runs(human, method):,}."
        return _claim_of(f"{start} at most {one['most']:g}", [test], evidence)
    theirs = cells.mean(human, one["beside"], measure)
    gap = cells.difference(human, method, one["beside"], measure)
    if theirs is None or gap is None:
        return None
    share = cells.difference(human, method, one["beside"], measure, one.get("share", 1.0))
    goal, test = _goal(one, share or gap)
    evidence = (
        f"{mean_text(ours)} against {mean_text(theirs)} ({_share(ours, theirs)}); paired "
        f"difference {interval_text(gap)}, n = {gap.n:,}."
    )
    tests = [test]
    total = cells.difference(human, method, one["beside"], TOTAL)
    if measure == WASTED and total is not None:
        margin = data["no_more_time"]
        goal += f", at no more {MEASURES[TOTAL].name} (non-inferior by a margin of {margin:g})"
        tests.append(MEASURES[TOTAL].beats(total, margin))
        evidence += f" Total steps: {interval_text(total)}."
    return _claim_of(f"{start} {goal}", tests, evidence)


def _claim_of(claim: str, tests: Sequence[BoundTest], evidence: str) -> Claim:
    """Return a claim judged by intervals; where they do not tell, what the means say."""
    holds, telling = judge(tests)
    if holds is None:
        is_met = all(test.least <= test.interval.mean <= test.most for test in tests)
        telling = f" {'Met' if is_met else 'Not met'} on average.{telling}"
    return Claim(claim, holds, evidence + telling, GROUP)


def _goal(one: Mapping[str, Any], gap: Interval) -> tuple[str, BoundTest]:
    """Return the goal in words, and its test."""
    whose = f"{one['beside']}'s"
    if "share" in one:
        return f"at most {100 * one['share']:g} % of {whose}", BoundTest(gap, most=0.0)
    if "above" in one:
        return f"at most {one['above']:g} above {whose}", BoundTest(gap, most=one["above"])
    if "below" in one:
        return f"at least {one['below']:g} below {whose}", BoundTest(gap, most=-one["below"])
    if "over" in one:
        return f"at least {one['over']:g} above {whose}", BoundTest(gap, least=one["over"])
    margin, unit = one["no_worse"], MEASURES[one["measure"]].unit
    words = f"no worse than {whose} (non-inferior by a margin of {margin:g} {unit})"
    return words, MEASURES[one["measure"]].beats(gap, margin)


def _share(ours: MeanEstimate, theirs: MeanEstimate) -> str:
    return f"{100 * ours.mean / theirs.mean:.0f} %" if theirs.mean else "of 0"


def as_good(human: str, data: Mapping[str, Any], cells: Cells) -> Claim | None:
    """Return that no baseline is better by a margin in any measure counted in timesteps."""
    ours, margin, verdicts, worse, tests = data["method"], data["margin"], [], [], []
    if not all(cells.n_runs(human, method) for method in (ours, *data["baselines"])):
        return None
    changes = scenario.human_data(human)["changes"]
    measures = [m for m in data["timesteps"] if changes or m not in data["after_a_change"]]
    for measure in measures:
        for other in data["baselines"]:
            gap = cells.difference(human, ours, other, measure)
            if gap is not None:
                tests.append(MEASURES[measure].beats(gap, margin))
                verdicts.append(MEASURES[measure].verdict(gap))
                if not tests[-1].holds:
                    worse.append(_worse(measure, other, gap, human, data, cells))
    claim = (
        f"{human}: no worse than any baseline in any measure counted in steps (non-inferior by a "
        f"margin of {margin:g} steps)"
    )
    holds, telling = judge(tests)
    evidence = (
        f"Better in {verdicts.count('better')} of {len(verdicts)} paired comparisons (95 %), "
    )
    evidence += f"not shown in {len(worse)}{': ' if worse else ''}{'; '.join(worse)}. "
    names = ", ".join(MEASURES[measure].name for measure in measures)
    evidence += f"Measures: {names}; baselines: {', '.join(data['baselines'])}."
    return Claim(claim, holds, evidence + telling, GROUP)


def _worse(
    measure: str, other: str, gap: Interval, human: str, data: Mapping[str, Any], cells: Cells
) -> str:
    """Return where a baseline is better, and why if a reason is known and the rows bear it out."""
    text = f"{MEASURES[measure].name} {interval_text(gap)} against {other}"
    for reason in data["reasons"]:
        if reason["measure"] == measure and other in reason["beside"]:
            price = cells.difference(human, other, data["method"], reason["pays"])
            if price is not None and MEASURES[reason["pays"]].verdict(price) == "worse":
                text += f" (a likely reason: {reason['why']}, {interval_text(price)})"
    return text


def robustness(human: str, data: Mapping[str, Any], cells: Cells) -> Claim | None:
    """Return that no other belief and no other choice of steps is better by a margin."""
    ours, margins = data["method"], data["robust"]["margins"]
    methods = cells.methods_of(human)
    rivals = [name for name in data["robust"]["rivals"] if name in methods]
    if ours not in methods or not rivals:
        return None
    tests, closest, n_better = [], [], 0
    for measure, margin in margins.items():
        pairs = [(other, cells.difference(human, ours, other, measure)) for other in rivals]
        gaps = {other: gap for other, gap in pairs if gap is not None}
        tests += [MEASURES[measure].beats(gap, margin) for gap in gaps.values()]
        n_better += sum(MEASURES[measure].verdict(gap) == "better" for gap in gaps.values())
        if gaps:
            other = max(gaps, key=lambda name: gaps[name].mean)
            closest.append(f"{MEASURES[measure].name} {interval_text(gaps[other])} against {other}")
    bounds = ", ".join(f"{MEASURES[name].name} {margin:g}" for name, margin in margins.items())
    claim = f"{human}: as good as every other belief and choice of steps (non-inferior: {bounds})"
    evidence = (
        f"The closest: {'; '.join(closest)}. Better in {n_better} of {len(tests)} paired "
        f"comparisons (95 %). Methods: {'; '.join(rivals)}."
    )
    return _claim_of(claim, tests, evidence) if tests else None


def waste(data: Mapping[str, Any], beyond: Cells) -> Claim | None:
    """Return that little is wasted per change, however often goals change and humans wait."""
    means = {human: beyond.mean(human, data["method"], "wasted_robot_steps")
             for human in beyond.humans}  # fmt: skip
    estimates = {human: e for human, e in means.items() if e is not None}
    if not estimates:
        return None
    most, per_change = (
        data["waste_per_change"],
        {h: e.mean / n_changes(h) for h, e in estimates.items()},
    )
    n = [e.n for e in estimates.values()]
    words = "; ".join(
        f"{human}: {number(mean)}{_more_time(beyond, human, data)}"
        for human, mean in per_change.items()
    )
    many = f"{min(n):,}" if min(n) == max(n) else f"{min(n):,} to {max(n):,}"
    claim = f"More changes than one: at most {most:g} wasted robot step per change of goal"
    evidence = f"{words}. Means over {many} pairs of goals each."
    holds, telling = judge(
        BoundTest(e.interval, most=most * n_changes(human)) for human, e in estimates.items()
    )
    return Claim(claim, holds, evidence + telling, GROUP)


def _more_time(cells: Cells, human: str, data: Mapping[str, Any]) -> str:
    """Return how many more total steps than the oracle there are, if that is known."""
    gap = cells.difference(human, data["method"], ORACLE, TOTAL)
    return "" if gap is None else f" (total steps {with_sign(gap.mean)} against the oracle)"


def n_changes(human: str) -> int:
    """Return how often a human's goal changes, at least 1."""
    return max(1, int(scenario.human_data(human)["changes"]))
