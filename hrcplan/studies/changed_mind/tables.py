"""The tables of the study, as HTML: means, paired differences, and both in one."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from hrcplan.studies.changed_mind import figures
from hrcplan.studies.changed_mind.cells import Cells
from hrcplan.studies.changed_mind.episodes import ORACLE
from hrcplan.studies.changed_mind.measures import MEASURES
from hrcplan.studies.estimate import Interval, MeanEstimate
from hrcplan.studies.measure import ends, interval_text, mean_html, number, with_sign
from hrcplan.studies.page import escape, key, table

NOTHING = "\u2013"
_MARKS = {"better": "in", "worse": "out", "": ""}


def means(cells: Cells, human: str, measures: Sequence[str]) -> str:
    """Return a line per method: mean, standard error and 95 % interval of each measure."""
    lines = [
        [
            display_name(cells, method),
            *(_mean(cells.mean(human, method, name), name) for name in measures),
        ]
        for method in cells.methods_of(human)
    ]
    return table(["", *(MEASURES[name].head for name in measures)], lines)


def display_name(cells: Cells, method: str) -> str:
    """Return the name of a method, behind its color where each has one."""
    if not figures.have_colors(cells.methods):
        return escape(method)
    return f"{key(figures.color(method, cells.methods))}{escape(method)}"


def _mean(e: MeanEstimate | None, measure: str) -> str:
    if e is None:
        return NOTHING
    interval = ends(MEASURES[measure].interval(e)) if e.is_known else f"n = {e.n}"
    return f"{mean_html(e)}<small>{interval}</small>"


def ratios(cells: Cells, measure: str, parts: Mapping[str, float]) -> str:
    """Return a measure's means divided by a number per human; a line per human."""
    lines = []
    for human in cells.humans:
        means = [cells.mean(human, method, measure) for method in cells.methods]
        words = [NOTHING if e is None else number(e.mean / parts[human]) for e in means]
        lines.append([escape(human), *words])
    return table(["", *(display_name(cells, method) for method in cells.methods)], lines, "narrow")


def gaps(cells: Cells, human: str, measures: Sequence[str], beside: str) -> str:
    """Return a line per other method: its paired differences to one method."""
    lines = [
        [
            display_name(cells, method),
            *(_gap(name, cells.difference(human, method, beside, name)) for name in measures),
        ]
        for method in cells.methods_of(human)
        if method != beside
    ]
    return table(["", *(MEASURES[name].directed_head for name in measures)], lines, "tight")


def _gap(measure: str, gap: Interval | None, name: str = "") -> str:
    if gap is None:
        return NOTHING
    verdict = MEASURES[measure].verdict(gap)
    mark = f' class="{_MARKS[verdict]}"' if verdict else ""
    whom = f"<small>{escape(name)}</small>" if name else ""
    return f"<span{mark}>{with_sign(gap.mean)}</span><small>{ends(gap)}</small>{whom}"


def best(
    cells: Cells,
    humans: Iterable[str],
    measures: Sequence[str],
    ours: str,
    baselines: Sequence[str],
) -> str:
    """Return a line per human: our differences to the baseline with the best mean."""
    lines = []
    for human in humans:
        line = [escape(human)]
        for name in measures:
            other = _best(cells, human, name, baselines)
            line.append(_gap(name, cells.difference(human, ours, other, name), other))
        lines.append(line)
    return table(["", *(MEASURES[name].directed_head for name in measures)], lines, "tight")


def _best(cells: Cells, human: str, measure: str, baselines: Iterable[str]) -> str:
    """Return the baseline with the best mean, the first of equals; no name without any."""
    sign = -1 if MEASURES[measure].more_is_better else 1
    means = {name: cells.mean(human, name, measure) for name in baselines}
    scores = {name: sign * e.mean for name, e in means.items() if e is not None}
    return min(scores, key=lambda name: scores[name]) if scores else ""


def both(
    cells: Cells, human: str, measures: Sequence[str], beside: str, methods: Sequence[str]
) -> str:
    """Return a line per method: means, and below them paired differences to one method.

    The oracle is not compared.
    """
    lines = []
    for method in methods:
        line = [display_name(cells, method)]
        for name in measures:
            e = cells.mean(human, method, name)
            is_alone = method in (beside, ORACLE)
            gap = None if is_alone else cells.difference(human, method, beside, name)
            line.append(NOTHING if e is None else mean_html(e) + _below(name, gap))
        lines.append(line)
    return table(["", *(MEASURES[name].head for name in measures)], lines, "tight")


def by_human(cells: Cells, measure: str, beside: str) -> str:
    """Return a measure, a line per human: its means, and below them differences to one method.

    The oracle is not compared.
    """
    lines = []
    for human in cells.humans:
        line = [escape(human)]
        for method in cells.methods:
            e = cells.mean(human, method, measure)
            is_alone = method in (beside, ORACLE) or beside not in cells.methods_of(human)
            gap = None if is_alone else cells.difference(human, method, beside, measure)
            line.append(NOTHING if e is None else mean_html(e) + _below(measure, gap))
        lines.append(line)
    return table(["", *(display_name(cells, method) for method in cells.methods)], lines, "tight")


def _below(measure: str, gap: Interval | None) -> str:
    if gap is None:
        return ""
    verdict = MEASURES[measure].verdict(gap)
    return f'<small class="{_MARKS[verdict]}">{interval_text(gap)}</small>'
