"""The page of the study: what its rows show, section by section."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from hrcplan.studies.estimate import MeanEstimate
from hrcplan.studies.failure_anticipation import figures, scenario
from hrcplan.studies.failure_anticipation.claims import BASELINE, claims, is_far, of_cell
from hrcplan.studies.failure_anticipation.measures import MAIN, MEASURES
from hrcplan.studies.measure import mean_html, number
from hrcplan.studies.page import escape, picture, readings, table
from hrcplan.studies.report import cells_of, estimates
from hrcplan.studies.study import Cell, Findings, Section, StudyOptions, StudyRow, StudyRows

_CASES = (
    "Case 1: the human does not contribute (an element of its state takes the value 10, where "
    "every action that it touches fails). Case 2: it contributes to a varying degree (5 to 10). "
    "a: without the model of the agents, b: with it."
)


READINGS = (
    "what fails and when, how causes combine, when a change is sensed, what counts as assigned"
)


def findings(options: StudyOptions, rows: StudyRows) -> Findings:
    """Return claims and sections; what has no rows is left out."""
    by_cell = cells_of(rows["rows"], ("case", "method"), scenario.cells("methods", options))
    variants = cells_of(rows["variants"], ("case", "method"), scenario.cells("variants", options))
    sections = [
        printed_table(by_cell) if scenario.is_own_task(options) else None,
        all_methods(by_cell, scenario.is_own_task(options)),
        replans(by_cell),
        figure_5(rows["allocation"], options),
        example(rows["example"], options),
        by_level(rows["rows"]),
        sweeps(cells_of(rows["sweeps"], ("parameter", "setting"), scenario.sweep_cells(options))),
        beside(variants),
        readings(READINGS),
    ]
    lead = (
        "A human and a robot share a task. When the human's state changes, the planner gets the "
        f"new state and replans before an action fails. {_CASES}"
    )
    return Findings(lead, claims(options, rows), [s for s in sections if s is not None])


def printed_table(by_cell: Mapping[Cell, Sequence[StudyRow]]) -> Section | None:
    """Return Table I of the paper: our means, and below them the printed figures."""
    reference, names = scenario.data()["printed"], scenario.data()["printed"]["columns"]
    lines = []
    for (case, method), rows in by_cell.items():
        if method == BASELINE and rows:
            means = estimates(rows, names)
            printed_row = dict(zip(names, reference[case], strict=True))
            cells = [_beside(means[n], printed_row[n], reference["runs"]) for n in names]
            lines.append([f"Case {case}<small>n = {len(rows)}</small>", *cells])
    if not lines:
        return None
    note = (
        '<p class="note">Each cell: our mean ± its standard error, and below it the printed mean '
        f"of {reference['runs']} simulations; green where the two differ by no more than chance "
        f"explains ({reference['runs']} runs like these, 95 %), orange where by more.</p>"
    )
    html = table(["", *(MEASURES[n].head for n in names)], lines) + note
    return Section("Table I and the printed one", html)


def _beside(ours: MeanEstimate, figure: float, runs: int) -> str:
    mark = "out" if is_far(ours, figure, runs) else "in"
    return f'{mean_html(ours)}<small class="{mark}">printed {number(figure)}</small>'


def all_methods(by_cell: Mapping[Cell, Sequence[StudyRow]], own_task: bool) -> Section:
    """Return every case and method, as a plot and as a table."""
    printed = {}
    if own_task:
        data = scenario.data()["printed"]
        printed = {
            str(case): dict(zip(data["columns"], data[case], strict=True))
            for case, _ in by_cell if case in data
        }  # fmt: skip
    svg = figures.measures(by_cell, MAIN, printed)
    caption = "Dots: means, with 95 % intervals."
    if printed:
        caption += " Diamonds: the figures that the failure-anticipation paper prints."
    return Section("All methods", picture(svg, caption) + _table_of(by_cell))


def _table_of(by_cell: Mapping[Cell, Sequence[StudyRow]]) -> str:
    lines = []
    for (case, method), rows in by_cell.items():
        if rows:
            means = estimates(rows, MAIN)
            name = f"{escape(case)} &nbsp;{escape(method)}"
            lines.append([name, str(len(rows)), *(mean_html(means[n]) for n in MAIN)])
    return table(["case and method", "runs", *(MEASURES[n].head for n in MAIN)], lines)


def replans(by_cell: Mapping[Cell, Sequence[StudyRow]]) -> Section:
    """Return how often it was replanned, and for which reasons."""
    caption = (
        "Mean number of replans per run. A replan with several reasons counts as a failure before "
        "a deviation before a change; a planner call that confirms the running plan is none."
    )
    return Section("Replans by reason", picture(figures.reasons(by_cell), caption))


def figure_5(rows: Sequence[StudyRow], options: StudyOptions) -> Section | None:
    """Return who does what after the first replan, against an element of the human's state.

    On the study's own task this is Figure 5 of the paper.
    """
    if not rows:
        return None
    caption = (
        "Share of the actions in the plan made after the change, from the state in which the "
        "running actions have ended. The red line is the human's mean over all times of change. "
        "Values are sensed in 0 to 10; beyond, only the planner's cost grows."
    )
    title = "Figure 5: who does what" if scenario.is_own_task(options) else "Who does what"
    element = scenario.element_name("allocation", options)
    return Section(title, picture(figures.allocation(rows, element), caption))


def example(rows: Sequence[StudyRow], options: StudyOptions) -> Section | None:
    """Return one change of the human's state, as Gantt charts in the order of the scenario."""
    if not rows:
        return None
    data = scenario.data()["example"]
    order = [variant["name"] for variant in data["variants"]]
    rows = sorted(rows, key=lambda row: order.index(str(row["variant"])))
    caption = (
        f"Before action {data['action']} of the human (or its last one, if it has fewer) "
        f"{scenario.element_name('example', options)} takes the value {data['value']}, at which "
        "every action that it touches fails. Hatched: failed. Dashed lines: a new plan."
    )
    return Section("One change, step by step", picture(figures.lanes(rows), caption))


def by_level(rows: Sequence[StudyRow]) -> Section | None:
    """Return measures of case 2 against the value drawn."""
    lines = {
        f"{case} {method}": of_cell(rows, case, method)
        for case, method in (("2a", BASELINE), ("2b", BASELINE), ("2b", "hrcplan"))
    }
    lines = {name: of_line for name, of_line in lines.items() if of_line}
    if not lines:
        return None
    names = ("success_pct", "failed_pct", "successful_human_pct")
    caption = "Case 2 by the value that the element took; bands are 95 % intervals."
    return Section("How much the human contributes", picture(figures.levels(lines, names), caption))


def sweeps(by_cell: Mapping[Cell, Sequence[StudyRow]]) -> Section | None:
    """Return how the interactions depend on their invented numbers."""
    cells = {cell: rows for cell, rows in by_cell.items() if rows}
    if not cells:
        return None
    names = ("successful_human_pct", "interactions", "replans", "makespan_s")
    caption = (
        f"Method {scenario.data()['sweep']['method']} in case {scenario.data()['sweep']['case']}, "
        "one number changed at a time: the probability with which an interaction succeeds, its "
        "price, and the value to which it brings the element. These numbers are our own; the "
        f"planner chooses by cost; n = {min(map(len, cells.values()))} runs each, 95 % intervals."
    )
    return Section("Interaction sweeps", picture(figures.sweeps(cells, names), caption))


def beside(by_cell: Mapping[Cell, Sequence[StudyRow]]) -> Section | None:
    """Return the variants: readings that we did not take, and bounds."""
    if not any(by_cell.values()):
        return None
    words = (
        "<p>The same runs under readings of the failure-anticipation paper that the table above "
        "does not take, and a bound: <em>floor</em> knows what is sensed and never asks the human "
        "for anything that the changed element touches; what fails there has failed before it "
        "could be sensed.</p>"
    )
    return Section("Variants and bounds", words + _table_of(by_cell))
