"""The page of the study: what its rows show, section by section."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from hrcplan.studies.estimate import MeanEstimate
from hrcplan.studies.failure_anticipation import figures, scenario
from hrcplan.studies.failure_anticipation.claims import claims, is_far, of_cell
from hrcplan.studies.page import escape, picture, table
from hrcplan.studies.report import cells_of, estimates
from hrcplan.studies.study import Cell, Findings, Section, StudyOptions, StudyRow, StudyRows

_HEADS = {
    "success_pct": "success<small>%</small>",
    "replans": "replans<small>per run</small>",
    "failed_pct": "failed<small>% of actions</small>",
    "assigned_human_pct": "assigned<br>human<small>%</small>",
    "assigned_robot_pct": "assigned<br>robot<small>%</small>",
    "successful_human_pct": "successful<br>human<small>%</small>",
    "successful_robot_pct": "successful<br>robot<small>%</small>",
    "makespan_s": "makespan<small>s</small>",
}
_TITLES = {
    "success_pct": "success\n(%)",
    "replans": "replans\nper run",
    "failed_pct": "failed\n(% of actions)",
    "assigned_human_pct": "assigned\nhuman (%)",
    "successful_human_pct": "successful\nhuman (%)",
    "makespan_s": "makespan\n(s)",
}
_SHOWN = tuple(_TITLES)
_CASES = (
    "Case 1: the human does not contribute (an element of its state takes the value 10, where "
    "every action that it touches fails). Case 2: it contributes to a varying degree (5 to 10). "
    "a: without the model of the agents, b: with it."
)


def findings(options: StudyOptions, rows: StudyRows) -> Findings:
    """Return claims and sections; what has no rows is left out."""
    by_cell = cells_of(rows["rows"], ("case", "method"), scenario.cells("methods", options))
    variants = cells_of(rows["variants"], ("case", "method"), scenario.cells("variants", options))
    sections = [
        printed_table(by_cell) if scenario.is_own_task(options) else None,
        all_methods(by_cell, scenario.is_own_task(options)),
        replans(by_cell),
        figure_5(rows["allocation"]),
        example(rows["example"]),
        by_level(rows["rows"]),
        sweeps(cells_of(rows["sweeps"], ("parameter", "setting"), scenario.sweep_cells(options))),
        beside(variants),
        readings(),
    ]
    lead = (
        "A human and a robot share a task. When the human's state changes, the planner is told, "
        f"and plans anew before an action fails. {_CASES}"
    )
    return Findings(lead, claims(options, rows), [s for s in sections if s is not None])


def printed_table(by_cell: Mapping[Cell, Sequence[StudyRow]]) -> Section | None:
    """Return Table I: our means, and below them the figures of the paper."""
    printed, names = scenario.data()["printed"], scenario.data()["printed"]["columns"]
    lines = []
    for (case, method), rows in by_cell.items():
        if method == "paper" and rows:
            ours = estimates(rows, names)
            figures_ = dict(zip(names, printed[case], strict=True))
            cells = [_beside(ours[n], figures_[n], printed["runs"]) for n in names]
            lines.append([f"Case {case}<small>n = {len(rows)}</small>", *cells])
    if not lines:
        return None
    note = (
        '<p class="note">Each cell: our mean ± its standard error, and below it the printed mean '
        f"of {printed['runs']} simulations; green where the two differ by no more than chance "
        f"explains ({printed['runs']} runs like ours, 95 %), orange where by more.</p>"
    )
    html = table(["", *(_HEADS[n] for n in names)], lines) + note
    return Section("Table I beside the paper", html)


def _beside(ours: MeanEstimate, printed: float, runs: int) -> str:
    mark = "out" if is_far(ours, printed, runs) else "in"
    return f'{_mean(ours)}<small class="{mark}">paper {printed:.2f}</small>'


def _mean(e: MeanEstimate) -> str:
    return f'{e.mean:.2f} <span class="se">± {e.se:.2f}</span>'


def all_methods(by_cell: Mapping[Cell, Sequence[StudyRow]], own_task: bool) -> Section:
    """Return every case and method, as a plot and as a table."""
    printed = {}
    if own_task:
        data = scenario.data()["printed"]
        printed = {
            str(case): dict(zip(data["columns"], data[case], strict=True))
            for case, _ in by_cell if case in data
        }  # fmt: skip
    svg = figures.measures(by_cell, _TITLES, printed)
    caption = "Dots: means, with 95 % intervals. Diamonds: the figures that the paper prints."
    return Section("All methods", picture(svg, caption) + _table_of(by_cell))


def _table_of(by_cell: Mapping[Cell, Sequence[StudyRow]]) -> str:
    lines = []
    for (case, method), rows in by_cell.items():
        if rows:
            found = estimates(rows, _SHOWN)
            name = f"{escape(case)} &nbsp;{escape(method)}"
            lines.append([name, str(len(rows)), *(_mean(found[n]) for n in _SHOWN)])
    return table(["case and method", "runs", *(_HEADS[n] for n in _SHOWN)], lines)


def replans(by_cell: Mapping[Cell, Sequence[StudyRow]]) -> Section:
    """Return why plans were made anew."""
    caption = (
        "Mean number of replans per run. A replan with several reasons counts as a failure before "
        "a deviation before a change; a planner call that confirms the running plan is none."
    )
    return Section("Replans by reason", picture(figures.reasons(by_cell), caption))


def figure_5(rows: Sequence[StudyRow]) -> Section | None:
    """Return Figure 5: who does what after the first replan, against motivation."""
    if not rows:
        return None
    element = scenario.data()["allocation"]["element"]
    caption = (
        "Share of the actions in the plan made after the change, from the state in which the "
        "running actions have ended. The red line is the human's mean over all times of change. "
        "Values are sensed in 0 to 10; beyond, only the planner's cost grows."
    )
    return Section("Figure 5: who does what", picture(figures.allocation(rows, element), caption))


def example(rows: Sequence[StudyRow]) -> Section | None:
    """Return the illustrative example, as Gantt charts in the order of the scenario."""
    if not rows:
        return None
    order = [variant["name"] for variant in scenario.data()["example"]["variants"]]
    rows = sorted(rows, key=lambda row: order.index(row["variant"]))
    caption = (
        "The human gets distracted after its second action (its state takes the value 10, so that "
        "whatever it begins fails). Hatched: failed. Dashed lines: a new plan."
    )
    return Section("The illustrative example", picture(figures.lanes(rows), caption))


def by_level(rows: Sequence[StudyRow]) -> Section | None:
    """Return measures of case 2 against the value drawn."""
    lines = {
        "2a paper": of_cell(rows, "2a", "paper"),
        "2b paper": of_cell(rows, "2b", "paper"),
        "2b hrcplan": of_cell(rows, "2b", "hrcplan"),
    }
    lines = {name: found for name, found in lines.items() if found}
    if not lines:
        return None
    names = {"success_pct": "success (%)", "failed_pct": "failed actions (%)",
             "successful_human_pct": "successful human (%)"}  # fmt: skip
    caption = "Case 2 by the value that the element took; bands are 95 % intervals."
    return Section("How much the human contributes", picture(figures.levels(lines, names), caption))


def sweeps(by_cell: Mapping[Cell, Sequence[StudyRow]]) -> Section | None:
    """Return how the interactions depend on their invented numbers."""
    found = {cell: rows for cell, rows in by_cell.items() if rows}
    if not found:
        return None
    shown = ("successful_human_pct", "interactions", "replans", "makespan_s")
    names = {name: {**_TITLES, "interactions": "interactions\nper run"}[name] for name in shown}
    caption = (
        f"Method {scenario.data()['sweep']['method']} in case {scenario.data()['sweep']['case']}, "
        "one number changed at a time: the probability with which an interaction succeeds, its "
        "price, and the value to which it brings the element. These numbers are ours; the planner "
        f"chooses by cost alone. n = {min(map(len, found.values()))} runs each, 95 % intervals."
    )
    return Section("Interaction sweeps", picture(figures.sweeps(found, names), caption))


def beside(by_cell: Mapping[Cell, Sequence[StudyRow]]) -> Section | None:
    """Return the variants: readings that we did not take, and bounds."""
    if not any(by_cell.values()):
        return None
    words = (
        "<p>The same runs under readings of the paper that the table above does not take, and a "
        "bound: <em>floor</em> knows what is sensed and never asks the human for anything that the "
        "changed element touches; what fails there has failed before it could be sensed.</p>"
    )
    return Section("Variants and bounds", words + _table_of(by_cell))


def readings() -> Section:
    """Return where the readings are explained."""
    words = (
        "<p>Where the paper is silent a reading was taken: what fails and when, how causes "
        "combine, when a change is sensed, what counts as assigned. <code>docs/reproduce.md</code> "
        "lists all of them with their reasons. Every number here can be computed again from "
        "<code>rows.sqlite</code>, one row per simulated run.</p>"
    )
    return Section("Readings", words)
