"""What the joint robot should reach, judged by the rows; the targets are in ``scenario.toml``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from hrcplan.studies.cells import PairedCells
from hrcplan.studies.collaboration import scenario
from hrcplan.studies.collaboration.measures import MEASURES
from hrcplan.studies.estimate import Interval
from hrcplan.studies.measure import interval_text, number
from hrcplan.studies.study import Claim
from hrcplan.studies.verdict import judge

GROUP = "What weighing goal and agent state gains"
JUDGED = "Means of paired differences, 95 % intervals, cluster-robust by first and second goal"


def claims(cells: PairedCells) -> list[Claim]:
    """Return the claims of the study; one that lacks rows is not stated."""
    results = [ahead(cells), *(no_worse(cells, task) for task in cells.cases)]
    return [claim for claim in results if claim is not None]


def gaps(cells: PairedCells, task: str, measure: str) -> dict[str, Interval]:
    """Return the paired differences of the method to each of its rivals that has rows."""
    reach = scenario.data()["reach"]
    intervals = {
        rival: cells.difference(task, reach["method"], rival, measure) for rival in reach["rivals"]
    }
    return {rival: one for rival, one in intervals.items() if one is not None}


def ahead(cells: PairedCells) -> Claim | None:
    """Return that the method costs less than each rival, in enough tasks."""
    reach = scenario.data()["reach"]
    measure = MEASURES[reach["measure"]]
    by_task = {task: gaps(cells, task, reach["measure"]) for task in cells.cases}
    complete = {task: one for task, one in by_task.items() if len(one) == len(reach["rivals"])}
    least = min(int(reach["least_tasks"]), len(scenario.data()["tasks"]))
    if not complete or len(complete) < min(least, len(cells.cases)):
        return None
    verdicts = {
        task: judge(measure.beats(gap) for gap in one.values()) for task, one in complete.items()
    }
    n_holding = sum(holds is True for holds, _ in verdicts.values())
    n_open = sum(holds is None for holds, _ in verdicts.values())
    least = min(least, len(complete))
    holds = True if n_holding >= least else None if n_holding + n_open >= least else False
    words = "; ".join(f"{task}: {_against(one)}" for task, one in complete.items())
    n = min(gap.n for one in complete.values() for gap in one.values())
    return Claim(
        f"The robot {reach['method']} costs the team less than {' and '.join(reach['rivals'])}, "
        f"in at least {least} of {len(complete)} tasks",
        holds,
        f"{measure.name.capitalize()} less that of the other. {words}. It holds in {n_holding}. "
        f"{JUDGED}; n = {n:,} or more runs.",
        GROUP,
    )


def _against(gaps_by_rival: Mapping[str, Interval]) -> str:
    return ", ".join(
        f"{interval_text(gap)} against {rival}" for rival, gap in gaps_by_rival.items()
    )


def no_worse(cells: PairedCells, task: str) -> Claim | None:
    """Return that in a task no other measure is worse than a rival's by its margin."""
    tests, worse, n = [], [], []
    for measure, rival, gap, margin in _margins(cells, task):
        test = MEASURES[measure].beats(gap, margin)
        tests.append(test)
        n.append(gap.n)
        if test.holds is not True:
            worse.append(
                f"{MEASURES[measure].name} {interval_text(gap)} against {rival} "
                f"(margin {number(margin)})"
            )
    if not tests:
        return None
    holds, telling = judge(tests)
    words = f"{len(tests) - len(worse)} of {len(tests)} comparisons show it"
    if worse:
        words += f"; not these: {'; '.join(worse)}"
    method = scenario.data()["reach"]["method"]
    return Claim(
        f"In the task {task} no other measure of {method} is worse by its margin or more",
        holds,
        f"{words}. {JUDGED}; n = {min(n):,} or more runs.{telling}",
        GROUP,
    )


def _margins(cells: PairedCells, task: str) -> Iterator[tuple[str, str, Interval, float]]:
    """Yield measure, rival, paired difference and margin of every comparison."""
    reach = scenario.data()["reach"]
    for measure, margin in (*reach["margins"].items(), *reach["shares"].items()):
        for rival, gap in gaps(cells, task, measure).items():
            if measure in reach["margins"]:
                yield measure, rival, gap, float(margin)
                continue
            mean = cells.mean(task, rival, measure)
            assert mean is not None
            yield measure, rival, gap, float(margin) * abs(mean.mean)
