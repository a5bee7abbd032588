"""The aims for hrcplan, with the numbers of ``scenario.toml``; judged on its own task only."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from hrcplan.studies.changed_mind import scenario
from hrcplan.studies.changed_mind.cells import Cells
from hrcplan.studies.changed_mind.measures import MEASURES
from hrcplan.studies.estimate import Interval, MeanEstimate
from hrcplan.studies.measure import interval_text, mean_text, number
from hrcplan.studies.study import Claim

GROUP = "Aims of hrcplan"


def claims(main: Cells, beyond: Cells) -> list[Claim]:
    """Return what is wanted, without what lacks rows."""
    data = scenario.data()["reach"]
    found = [wanted(one, data["method"], main) for one in data["wanted"]]
    found += [as_good(human, data, main) for human in main.humans]
    found.append(waste(data, beyond))
    return [claim for claim in found if claim is not None]


def wanted(one: Mapping[str, Any], method: str, cells: Cells) -> Claim | None:
    """Return that a mean is low or high enough, by itself or beside another method's."""
    human, measure = one["human"], one["measure"]
    ours = cells.mean(human, method, measure)
    if ours is None:
        return None
    name, unit = MEASURES[measure].name, MEASURES[measure].unit
    start = f"{human}: {name} ({unit})"
    if "most" in one:
        evidence = f"{mean_text(ours)}; n = {cells.n_runs(human, method):,}"
        return Claim(f"{start} at most {one['most']:g}", ours.mean <= one["most"], evidence, GROUP)
    theirs = cells.mean(human, one["beside"], measure)
    gap = cells.difference(human, method, one["beside"], measure)
    if theirs is None or gap is None:
        return None
    goal, holds = _judged(one, ours, theirs, gap)
    evidence = (
        f"{mean_text(ours)} beside {mean_text(theirs)} ({_share(ours, theirs)}); paired difference "
        f"{interval_text(gap)}, n = {gap.n:,}"
    )
    return Claim(f"{start} {goal}", holds, evidence, GROUP)


def _judged(
    one: Mapping[str, Any], ours: MeanEstimate, theirs: MeanEstimate, gap: Interval
) -> tuple[str, bool]:
    """Return the goal in words, and whether it is reached."""
    whose = f"{one['beside']}'s"
    if "share" in one:
        return f"at most {100 * one['share']:g} % of {whose}", ours.mean <= one[
            "share"
        ] * theirs.mean
    if "above" in one:
        return f"at most {one['above']:g} above {whose}", gap.mean <= one["above"]
    if "below" in one:
        return f"at least {one['below']:g} below {whose}", gap.mean <= -one["below"]
    if "over" in one:
        return f"at least {one['over']:g} above {whose}", gap.mean >= one["over"]
    is_worse = MEASURES[one["measure"]].verdict(gap) == "worse"
    return f"no worse than {whose}", gap.is_known and not is_worse


def _share(ours: MeanEstimate, theirs: MeanEstimate) -> str:
    return f"{100 * ours.mean / theirs.mean:.0f} %" if theirs.mean else "of 0"


def as_good(human: str, data: Mapping[str, Any], cells: Cells) -> Claim | None:
    """Return that no baseline is better in any measure that is counted in timesteps."""
    ours, verdicts, worse, n_unknown = data["method"], [], [], 0
    if not all(cells.n_runs(human, method) for method in (ours, *data["baselines"])):
        return None
    changes = scenario.human_data(human)["changes"]
    measures = [m for m in data["timesteps"] if changes or m not in data["after_a_change"]]
    for measure in measures:
        for other in data["baselines"]:
            gap = cells.difference(human, ours, other, measure)
            if gap is not None:
                n_unknown += not gap.is_known
                verdicts.append(MEASURES[measure].verdict(gap))
                if verdicts[-1] == "worse":
                    worse.append(_worse(measure, other, gap, human, data, cells))
    claim = f"{human}: at least as good as every baseline in every measure counted in steps"
    n_better = verdicts.count("better")
    evidence = f"Better in {n_better} of {len(verdicts)} paired comparisons (95 %), worse in "
    evidence += f"{len(worse)}{': ' if worse else ''}{'; '.join(worse)}. "
    names = ", ".join(MEASURES[measure].name for measure in measures)
    evidence += f"Measures: {names}; baselines: {', '.join(data['baselines'])}."
    return Claim(claim, not worse and not n_unknown, evidence, GROUP)


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


def waste(data: Mapping[str, Any], beyond: Cells) -> Claim | None:
    """Return that little is wasted per change, however often goals change and humans wait."""
    found = {human: beyond.mean(human, data["method"], "wasted_robot_steps")
             for human in beyond.humans}  # fmt: skip
    had = {human: e for human, e in found.items() if e is not None}
    if not had:
        return None
    most, per_change = data["waste_per_change"], {h: e.mean / n_changes(h) for h, e in had.items()}
    n = [e.n for e in had.values()]
    words = "; ".join(f"{human}: {number(mean)}" for human, mean in per_change.items())
    many = f"{min(n):,}" if min(n) == max(n) else f"{min(n):,} to {max(n):,}"
    claim = f"More changes than one: at most {most:g} wasted robot step per change of goal"
    evidence = f"{words}. Means over {many} pairs of goals each."
    return Claim(claim, all(mean <= most for mean in per_change.values()), evidence, GROUP)


def n_changes(human: str) -> int:
    """Return how often a human's goal changes, at least 1."""
    return max(1, int(scenario.human_data(human)["changes"]))
