"""The page of the study: what its rows show, section by section."""

from __future__ import annotations

from collections.abc import Sequence

from hrcplan.studies.cells import PairedCells
from hrcplan.studies.collaboration import scenario
from hrcplan.studies.collaboration.claims import claims
from hrcplan.studies.collaboration.episodes import UNIT
from hrcplan.studies.collaboration.figures import dots, legend
from hrcplan.studies.collaboration.measures import GUESSES, HELP, MEASURES, SHARES
from hrcplan.studies.estimate import Interval
from hrcplan.studies.measure import ends, mean_html, with_sign
from hrcplan.studies.page import escape, panels, table
from hrcplan.studies.study import Findings, Section, StudyOptions, StudyRows

NOTHING = "\u2013"
PLOTTED = ("team_cost", "makespan_s", "human_cost", "failed_pct")
MARKS = {"better": "in", "worse": "out", "": ""}
LEAD = (
    "People and a robot work together. The robot does not know what they want, which changes on "
    "the way; and it does not know how they are, which drifts: actions of people then fail. "
    "<em>goal-only</em> infers the goal and takes people as they were, <em>state-only</em> senses "
    "their state and takes every goal as equally likely, <em>joint</em> weighs both and may ask "
    "what they want, <em>joint-without-asking</em> may not, and <em>joint-oracle</em> knows it."
)


def findings(options: StudyOptions, rows: StudyRows) -> Findings:
    """Return claims and sections; what has no rows is left out."""
    cells = {
        name: PairedCells(of_table, scenario.cells(name, options), scenario.KEYS, UNIT)
        for name, of_table in rows.items()
    }
    main, others = cells[scenario.MAIN], cells[scenario.OTHERS]
    sections = [
        _plots(main), _means("Help", main, HELP), _differences(main),
        _means("Guesses", main, GUESSES), _means("Who does what", main, SHARES),
        _means("Other people", others, (*HELP, "correct_pct")), _readings(),
    ]  # fmt: skip
    return Findings(LEAD, claims(main), [one for one in sections if one is not None])


def _n_runs(cells: PairedCells) -> str:
    counts = {cells.n_runs(task, m) for task in cells.cases for m in cells.methods_of(task)}
    few, many = min(counts), max(counts)
    how_many = f"{few:,}" if few == many else f"{few:,} to {many:,}"
    return f"n = {how_many} runs per task and robot."


def _plots(cells: PairedCells) -> Section | None:
    """Return the main measures by task and robot."""
    if not cells.rows:
        return None
    svgs = [dots(cells, measure) for measure in PLOTTED]
    caption = f"Means over pairs of goals with 95 % intervals. {_n_runs(cells)}"
    return Section("Tasks and robots", panels(svgs, caption, legend(cells.methods), "wide"))


def _means(title: str, cells: PairedCells, measures: Sequence[str]) -> Section | None:
    """Return a table per task: a line per robot."""
    if not cells.rows:
        return None
    parts = []
    for task in cells.cases:
        lines = [
            [escape(method), *(_mean(cells, task, method, name) for name in measures)]
            for method in cells.methods_of(task)
        ]
        parts.append(f'<h3 class="part">{escape(task)}</h3>')
        parts.append(table(["", *(MEASURES[name].head for name in measures)], lines))
    note = f'<p class="note">Mean ± standard error over pairs of goals. {_n_runs(cells)}</p>'
    return Section(title, "\n".join([*parts, note]))


def _mean(cells: PairedCells, task: str, method: str, measure: str) -> str:
    mean = cells.mean(task, method, measure)
    return NOTHING if mean is None else mean_html(mean)


def _differences(cells: PairedCells) -> Section | None:
    """Return the paired differences of each other robot to the method of the study."""
    method = scenario.data()["reach"]["method"]
    parts = []
    for task in cells.cases:
        others = [name for name in cells.methods_of(task) if name != method]
        if not others or method not in cells.methods_of(task):
            continue
        lines = [
            [
                escape(other),
                *(_gap(name, cells.difference(task, other, method, name)) for name in HELP),
            ]
            for other in others
        ]
        parts.append(f'<h3 class="part">{escape(task)}</h3>')
        parts.append(table(["", *(MEASURES[n].directed_head for n in HELP)], lines, "tight"))
    if not parts:
        return None
    words = (
        f"<p>Differences to <em>{escape(method)}</em> in the same runs: the same goals, change, "
        "drifts and seed. 95 % intervals, cluster-robust by first and second goal. "
        '<span class="in">Green</span>: better than it with 95 % confidence, '
        '<span class="out">orange</span>: worse.</p>'
    )
    return Section("Paired differences", words + "\n".join(parts))


def _gap(measure: str, gap: Interval | None) -> str:
    if gap is None:
        return NOTHING
    mark = MARKS[MEASURES[measure].verdict(gap)]
    return f'<span class="{mark}">{with_sign(gap.mean)}</span><small>{ends(gap)}</small>'


def _readings() -> Section:
    study = scenario.data()["study"]
    low, high = study["levels"]
    level = f"{low}" if low == high else f"{low} to {high}"
    words = (
        "<p><em>Team cost</em> is the metric of the problem, of all attempts: an attempt costs "
        "what the action costs while every agent state is low, also if it fails, and a question as "
        f"much as {study['question_price']:g} average action. An episode that does not reach its "
        "last goal costs at least four times as many average actions as its goals need. "
        f"A drifted element has the value {level}: actions that it touches fail with a tenth of it "
        "as their probability, drawn at every attempt. Drifts are sensed during the first action "
        "under them. A guess is what a robot believes when an action of people has begun; "
        "timesteps are actions of all agents, attempts and waits of people included.</p>"
    )
    return Section("Readings", words)
