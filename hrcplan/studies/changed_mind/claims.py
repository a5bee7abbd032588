"""The claims of the changed-mind paper, judged by the rows alone; our aims are in ``reach.py``.

A claim that lacks the rows of one of its methods or humans is not stated.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from hrcplan.studies.changed_mind import scenario
from hrcplan.studies.changed_mind.cells import Cells
from hrcplan.studies.changed_mind.episodes import ORACLE
from hrcplan.studies.changed_mind.measures import MEASURES
from hrcplan.studies.estimate import Interval
from hrcplan.studies.measure import interval_text, mean_text, number
from hrcplan.studies.study import Claim, StudyOptions
from hrcplan.studies.verdict import BoundTest, judge

GROUP = "Claims of the changed-mind paper"
OTHER_TASK = "Claims on this task"
FIXED, OPTIMAL, SUBOPTIMAL = HUMANS = ("fixed", "optimal", "suboptimal")
CHANGING = (OPTIMAL, SUBOPTIMAL)
RHP, RECURSIVE, BEST = "rhp", "recursive", "recursive-best"
BOUNDS = ("cdp", "infogain")
BASELINES = (RECURSIVE, *BOUNDS)
JUDGED = "Means of paired differences, 95 % intervals"


@dataclass(frozen=True, slots=True)
class Superiority:
    """The claim that a method beats each of ``others`` in a measure, for each of ``humans``.

    The measures ``also`` are shown too, and do not decide.
    """

    claim: str
    measure: str
    humans: tuple[str, ...]
    note: str = ""
    also: tuple[str, ...] = ()
    ours: tuple[str, ...] = (RHP,)
    others: tuple[str, ...] = BASELINES


_STOCHASTIC = (
    "The changed-mind paper says “when the human switches goals stochastically”: one or both of "
    "the humans whose goal changes, so each is judged by itself."
)
AHEAD = (
    Superiority(
        "After a change the first right guess comes sooner than with any baseline, for both "
        "humans whose goal changes",
        "first_correct",
        CHANGING,
    ),
    *(
        Superiority(
            "When the goal changes, the last wrong guess comes earlier than with any baseline "
            f"({human} human)",
            "last_incorrect_pct",
            (human,),
            _STOCHASTIC,
            ("last_incorrect_step",),
        )
        for human in CHANGING
    ),
    Superiority(
        "When the goal is fixed, the last wrong guess of the method and of recursive Bayes comes "
        "earlier than that of CDP and information gain",
        "last_incorrect_pct",
        (FIXED,),
        ours=(RHP, RECURSIVE),
        others=BOUNDS,
    ),
    *(
        Superiority(
            f"When the goal changes, more guesses are right than with any baseline ({human} human)",
            "correct_pct",
            (human,),
            _STOCHASTIC,
        )
        for human in CHANGING
    ),
    Superiority(
        "Fewer extra steps than with any baseline, for all three humans",
        "extra_steps",
        HUMANS,
        "Differences in total steps are the same: a run has one mistake-free length.",
    ),
)


def claims(options: StudyOptions, cells: Cells) -> list[Claim]:
    """Return the paper's claims; those about printed numbers on the study's own task only."""
    if not scenario.is_own_task(options):
        results = [*(ahead(replace(one, note=""), cells) for one in AHEAD), bounds(cells)]
        return [replace(claim, group=OTHER_TASK) for claim in results if claim is not None]
    results = [*(ahead(one, cells) for one in AHEAD), bounds(cells)]
    figures = scenario.data()["printed"]
    results += [midpoint(figures, cells), minimal(figures, cells), length(figures, cells)]
    return [claim for claim in results if claim is not None]


def ahead(hypothesis: Superiority, cells: Cells) -> Claim | None:
    """Return that a method is better than each of the others, by paired differences."""
    words, n, tests = [], [], []
    for human in hypothesis.humans:
        for ours in hypothesis.ours:
            gaps = differences(cells, human, ours, hypothesis.others, hypothesis.measure)
            if gaps is None:
                return None
            tests += [MEASURES[hypothesis.measure].beats(one) for one in gaps.values()]
            n += [one.n for one in gaps.values()]
            words.append(f"{human}, {ours}: {_means_text(cells, human, ours, hypothesis, gaps)}")
    holds, telling = judge(tests)
    evidence = f"{'; '.join(words)}. {JUDGED}; {_runs(n)}.{telling}"
    return Claim(hypothesis.claim, holds, f"{evidence} {hypothesis.note}".strip(), GROUP)


def differences(
    cells: Cells, human: str, ours: str, others: Iterable[str], measure: str
) -> dict[str, Interval] | None:
    """Return paired differences to each of the others; None if one has no rows."""
    intervals = {other: cells.difference(human, ours, other, measure) for other in others}
    complete = {other: one for other, one in intervals.items() if one is not None}
    return complete if len(complete) == len(intervals) else None


def _means_text(
    cells: Cells, human: str, ours: str, hypothesis: Superiority, gaps: Mapping[str, Interval]
) -> str:
    """Return a mean, its differences to others, and those that are reported with the claim."""
    mean = cells.mean(human, ours, hypothesis.measure)
    text = (
        f"{number(mean.mean if mean else 0)} {MEASURES[hypothesis.measure].unit}, {against(gaps)}"
    )
    if RECURSIVE not in hypothesis.others:
        return text
    beside = [
        (hypothesis.measure, (BEST,)),
        *((name, (*hypothesis.others, BEST)) for name in hypothesis.also),
    ]
    for measure, others in beside:
        if more := differences(cells, human, ours, others, measure):
            unit = "" if measure == hypothesis.measure else f" in {MEASURES[measure].unit}"
            text += f" [reported with the claim{unit}: {against(more)}]"
    return text


def against(gaps: Mapping[str, Interval]) -> str:
    """Return differences in words."""
    return ", ".join(f"{interval_text(one)} against {other}" for other, one in gaps.items())


def _runs(n: Sequence[int]) -> str:
    few, many = min(n), max(n)
    return f"n = {few:,} runs" if few == many else f"n = {few:,} to {many:,} runs"


def bounds(cells: Cells) -> Claim | None:
    """Return that the methods for fixed goals guess worse than both others when goals change."""
    names = ("first_correct", "last_incorrect_pct", "correct_pct")
    n, behind, tests = [], [], []
    for human in CHANGING:
        for measure in names:
            for bound in BOUNDS:
                gaps = differences(cells, human, bound, (RHP, RECURSIVE), measure)
                if gaps is None:
                    return None
                n += [one.n for one in gaps.values()]
                tests += [MEASURES[measure].beats(one.negative) for one in gaps.values()]
                behind += [
                    f"{human}, {MEASURES[measure].name}: {bound} {interval_text(one)} "
                    f"against {other}"
                    for other, one in gaps.items()
                    if MEASURES[measure].verdict(one) != "worse"
                ]
    claim = (
        "When the goal changes, CDP and information gain guess worse than the method and than "
        "recursive Bayes"
    )
    words = (
        f"{len(n) - len(behind)} of {len(n)} comparisons show it: both humans, first right guess, "
        "last wrong guess (%), right guesses"
    )
    if behind:
        words += f"; not these: {'; '.join(behind)}"
    holds, telling = judge(tests)
    return Claim(claim, holds, f"{words}. {JUDGED}; {_runs(n)}.{telling}", GROUP)


def midpoint(figures: Mapping[str, Any], cells: Cells) -> Claim | None:
    """Return that with a fixed goal the last wrong guess is about the middle of the episode."""
    low, high = figures["midpoint_pct"]
    means = {name: cells.mean(FIXED, name, "last_incorrect_pct") for name in (RHP, RECURSIVE)}
    complete = {name: e for name, e in means.items() if e is not None}
    if len(complete) < len(means):
        return None
    words = ", ".join(f"{name} {mean_text(e)} %" for name, e in complete.items())
    claim = (
        "When the goal is fixed, the last wrong guess of the method and of recursive Bayes is "
        "about the midpoint"
    )
    evidence = (
        f"{words} of the episode. “Around the midpoint” is read as {low} to {high} %; how soon a "
        "fixed goal shows depends on how much the goals have in common."
    )
    holds, telling = judge(BoundTest(e.interval, low, high) for e in complete.values())
    return Claim(claim, holds, evidence + telling, GROUP)


def minimal(figures: Mapping[str, Any], cells: Cells) -> Claim | None:
    """Return that the method's extra steps are few, for every human."""
    means = {human: cells.mean(human, RHP, "extra_steps") for human in HUMANS}
    complete = {human: e for human, e in means.items() if e is not None}
    if len(complete) < len(means):
        return None
    most = figures["minimal_steps"]
    words = ", ".join(f"{human} {mean_text(e)}" for human, e in complete.items())
    evidence = (
        f"{words}. “Minimal” is read as less than {most:g} step. Extra steps count the human's own "
        "mistakes too, as in the changed-mind paper."
    )
    claim = "The number of extra steps is minimal for all three humans"
    holds, telling = judge(
        BoundTest(e.interval, most=most, is_strict=True) for e in complete.values()
    )
    return Claim(claim, holds, evidence + telling, GROUP)


def length(figures: Mapping[str, Any], cells: Cells) -> Claim | None:
    """Return that combinations of two goals are as long as in the paper."""
    duration = cells.mean(OPTIMAL, ORACLE, "total_steps")
    if duration is None:
        return None
    mean, within = figures["combined_length"], figures["combined_within"]
    evidence = (
        f"{mean_text(duration)} timesteps with a robot that knows the goal "
        f"and a human without mistakes; read as within {within:g} of the printed mean. The goals "
        "are those of hrcplan: the paper does not list its own."
    )
    claim = f"Combinations of two goals take {mean:g} steps on average"
    holds, telling = judge([BoundTest(duration.interval, mean - within, mean + within)])
    return Claim(claim, holds, evidence + telling, GROUP)
