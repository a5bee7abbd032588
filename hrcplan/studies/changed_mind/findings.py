"""The page of the study: what its rows show, section by section."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from hrcplan.episodes.episode import PATIENCE, REACHED
from hrcplan.studies.changed_mind import claims, figures, reach, scenario, tables
from hrcplan.studies.changed_mind.cells import Cells
from hrcplan.studies.changed_mind.episodes import SUCCESS
from hrcplan.studies.changed_mind.measures import MEASURES
from hrcplan.studies.measure import number
from hrcplan.studies.page import escape, panels, picture, readings, table
from hrcplan.studies.study import Claim, Findings, Section, StudyOptions, StudyRows

ENDINGS = (*SUCCESS, "unreachable_pct")
GUESSES = (*ENDINGS,
           "first_correct", "last_incorrect_step", "last_incorrect_pct", "correct_pct", "top3_pct",
           "detection_delay", "n_detected", "false_changes")  # fmt: skip
STEPS = (*ENDINGS,
         "wasted_robot_steps", "human_mistakes", "robot_waits", "total_steps", "extra_steps",
         "extra_vs_oracle")  # fmt: skip
COMPARED = ("reached_pct",
            "first_correct", "last_incorrect_step", "last_incorrect_pct", "correct_pct",
            "detection_delay", "false_changes", "wasted_robot_steps", "total_steps")  # fmt: skip
COMPACT = ("reached_pct", "first_correct", "last_incorrect_step", "correct_pct", "false_changes",
           "wasted_robot_steps", "total_steps")  # fmt: skip
BY_HUMAN = ("total_steps", "first_correct", "last_incorrect_step", "wasted_robot_steps",
            "reached_pct")  # fmt: skip
PLOTTED = {
    "correct_pct": "Right guesses",
    "wasted_robot_steps": "Wasted robot steps",
    "last_incorrect_step": "Last wrong guess",
    "extra_vs_oracle": "More steps than the oracle",
}
BESIDE = claims.RHP
BANKS = (BESIDE, f"{BESIDE}, in order", f"{BESIDE}, in order, sampled")
READINGS = (
    "the goals and their steps, what a sequence of the classifier is, which history counts as "
    "consistent, what the baselines' likelihoods are, what a mistake is and when the goal changes"
)
LEAD = (
    "A human and a robot take turns at one task. The robot does not know the human's goal, which "
    "may change on the way; it infers the goal from the human's actions and helps meanwhile. "
    "<em>rhp</em> is the method of the changed-mind paper, <em>recursive</em> is recursive Bayes "
    "as printed, <em>recursive-best</em> the same at its best setting, <em>cdp</em> and "
    "<em>infogain</em> are made for fixed goals, <em>hrcplan</em> is this package's method, and "
    "<em>oracle</em> knows the goal."
)
COLORED = (
    '<span class="in">Green</span>: better with 95 % confidence, '
    '<span class="out">orange</span>: worse; other intervals contain 0.'
)


def findings(options: StudyOptions, rows: StudyRows) -> Findings:
    """Return claims and sections; what has no rows is left out."""
    cells = {name: Cells(name, options, of_table) for name, of_table in rows.items()}
    main, beyond = cells[scenario.MAIN], cells["beyond"]
    sections = [
        guesses_and_steps(main, scenario.is_own_task(options)),
        other_choosers(cells["choosers"]),
        all_means(main), differences(main), decisions(main), more_changes(beyond),
        banks(cells["variants"]), exchanges(cells["variants"]), readings(READINGS),
    ]  # fmt: skip
    results = claims_of(options, main, cells)
    return Findings(LEAD, results, [section for section in sections if section is not None])


def claims_of(options: StudyOptions, main: Cells, cells: Mapping[str, Cells]) -> list[Claim]:
    """Return the paper's claims, and on the study's own task the aims for hrcplan."""
    results = claims.claims(options, main)
    return [*results, *(reach.claims(main, cells) if scenario.is_own_task(options) else ())]


def how_many(cells: Cells) -> str:
    """Return in words how many runs the cells have."""
    humans_by_text: dict[str, list[str]] = {}
    for human in cells.humans:
        method = max(cells.methods_of(human), key=lambda name: cells.n_runs(human, name))
        runs, pairs = cells.n_runs(human, method), cells.n_pairs(human, method)
        what = "pairs of goals" if scenario.human_data(human)["changes"] else "goals"
        humans_by_text.setdefault(f"{runs:,} runs of {pairs:,} {what}", []).append(escape(human))
    if len(humans_by_text) == 1:
        return f"n per human and method: {next(iter(humans_by_text))}."
    words = [f"{' and '.join(humans)} {what}" for what, humans in humans_by_text.items()]
    return f"n per method: {'; '.join(words)}."


def guesses_and_steps(cells: Cells, is_own_task: bool) -> Section | None:
    """Return guesses and steps by human and method, as in Figure 3 of the changed-mind paper."""
    if not cells.rows:
        return None
    changing = [human for human in cells.humans if scenario.human_data(human)["changes"]]
    panel_of = [
        ("first_correct", "a: First right guess after a change", changing),
        ("last_incorrect_pct", "b: Last wrong guess", cells.humans),
        ("last_incorrect_step", "b: the same, in timesteps", cells.humans),
        ("extra_steps", "c: Extra steps", cells.humans),
        ("correct_pct", "d: Right guesses", cells.humans),
        ("wasted_robot_steps", "Wasted robot steps", cells.humans),
    ]
    svgs = [figures.bars(cells, humans, name, title) for name, title, humans in panel_of if humans]
    caption = (
        "Lines: methods for fixed goals, and the oracle. Means over pairs of goals ± one standard "
        f"error. {how_many(cells)}"
    )
    if is_own_task:
        caption += (
            " Panels a to d are those of the paper's Figure 3; the paper prints no numbers for it, "
            "so none are compared here."
        )
    words = (
        "<p>Percentages of the episode flatter a robot that wastes steps: it makes the episode "
        "longer, so the same last wrong guess comes at a smaller percentage, and the human, who "
        "has to do more of the work, gives more evidence. So the timestep is reported too, and "
        "the wasted steps.</p>"
    )
    keys = figures.legend(cells.methods, lines=True)
    title = "Figure 3: guesses and steps" if is_own_task else "Guesses and steps"
    return Section(title, words + panels(svgs, caption, keys))


def all_means(cells: Cells) -> Section | None:
    """Return all measures of all cells."""
    if not cells.rows:
        return None
    parts = [
        "<p>Mean ± standard error over pairs of goals (for a fixed goal: over goals), and below it "
        "the 95 % interval. For a human whose goal is fixed the first right guess is counted from "
        "its first action. A dash: the method declares no changes, or none was to be found.</p>"
    ]
    for human in cells.humans:
        parts.append(f'<h3 class="part">{escape(human)}: guesses</h3>')
        parts.append(tables.means(cells, human, GUESSES))
        parts.append(f'<h3 class="part">{escape(human)}: steps</h3>')
        parts.append(tables.means(cells, human, STEPS))
    return Section(
        "All measures", "\n".join([*parts, _note(f"{how_many(cells)} {endings(cells)}")])
    )


def endings(cells: Cells) -> str:
    """Return whether all goals were reached, and if not how the other episodes are counted."""
    n_all = sum(map(len, cells.rows.values()))
    by_cell = {
        f"{human} {method}": failures
        for (human, method), rows in cells.rows.items()
        if (failures := [row for row in rows if row["ending"] != REACHED])
    }
    if not by_cell:
        return f"In all {n_all:,} episodes the last goal was reached."
    words = ", ".join(f"{escape(cell)} {len(failures)}" for cell, failures in by_cell.items())
    failed = [row for failures in by_cell.values() for row in failures]
    text = f"In {len(failed)} of {n_all:,} episodes the last goal was not reached: {words}. "
    if any(row["unreachable_pct"] is None for row in failed):
        return f"{text}These rows are of an earlier version: such an episode counts as short."
    n_lost = sum(bool(row["unreachable_pct"]) for row in failed)
    return (
        f"{text}In {n_lost} of them it had become unreachable. Such an episode costs as many "
        f"timesteps as it could have taken at most ({PATIENCE} times the steps that its goals "
        "need), however short it was."
    )


def _note(text: str) -> str:
    return f'<p class="note">{text}</p>'


def differences(cells: Cells) -> Section | None:
    """Return paired differences to rhp, and of hrcplan to the best baseline."""
    parts = []
    for human in cells.humans:
        methods = cells.methods_of(human)
        if BESIDE in methods and len(methods) > 1:
            parts.append(f'<h3 class="part">{escape(human)}</h3>')
            parts.append(tables.gaps(cells, human, COMPARED, BESIDE))
    data = scenario.data()["reach"]
    ours = [human for human in cells.humans if data["method"] in cells.methods_of(human)]
    if ours and any(name in cells.methods for name in data["baselines"]):
        parts.append(f'<h3 class="part">{data["method"]} and the best baseline</h3>')
        parts.append(tables.best(cells, ours, COMPARED, data["method"], data["baselines"]))
    if not parts:
        return None
    words = (
        f"<p>Differences to the method <em>{BESIDE}</em> in the same runs (same goals, time of "
        "change and seed), with 95 % intervals whose errors are cluster-robust by first and second "
        f"goal. {COLORED} The best baseline is the one with the best mean in that column.</p>"
    )
    return Section("Paired differences", words + "\n".join(parts))


def decisions(cells: Cells) -> Section | None:
    """Return how long a decision takes."""
    lines = []
    for method in cells.methods:
        means = [cells.mean(human, method, "decision_ms") for human in cells.humans]
        if any(e is not None for e in means):
            words = [tables.NOTHING if e is None else number(e.mean) for e in means]
            lines.append([tables.display_name(cells, method), *words])
    if not lines:
        return None
    low, high = scenario.data()["printed"]["decision_s"]
    note = (
        "Measured by the clock while the rows were made, with whatever else the machine did: the "
        "only figures here that the same seed does not give again. Mean over episodes of the mean "
        f"time of a decision. The changed-mind paper reports {low} to {high} s on an NVIDIA RTX "
        "4090."
    )
    html = table(
        ["", *(f"{escape(human)}<small>ms</small>" for human in cells.humans)], lines, "narrow"
    )
    return Section("Time of a decision", html + _note(note))


def other_choosers(cells: Cells) -> Section | None:
    """Return a table per measure: a line per human, a column per method."""
    if not cells.rows:
        return None
    ours = scenario.data()["reach"]["method"]
    words = (
        "<p>The main table has one kind of human. These choose otherwise: <em>frontier</em> any "
        "next step of a valid plan, all alike; <em>plans</em> any plan, all alike; <em>habit</em> "
        "the steps in an order of its own; <em>general-first</em> and <em>special-first</em> what "
        "most or fewest goals need; <em>inertia</em> goes on with its old goal for one to three "
        "turns; <em>noisy-rational</em> takes worse steps the more rarely, the more they lose. "
        "With <em>mistakes</em> every tenth action is one. <em>our steps</em>: the choice of steps "
        f"of <em>{ours}</em>, with another belief.</p>"
    )
    parts = [words]
    for name in BY_HUMAN:
        parts.append(f'<h3 class="part">{MEASURES[name].name} ({MEASURES[name].unit})</h3>')
        parts.append(tables.by_human(cells, name, ours))
    what = f"Below the means: paired differences to <em>{ours}</em>. {COLORED}"
    parts.append(_note(f"{what} {how_many(cells)}"))
    return Section("Whose human is it?", "\n".join(parts))


def more_changes(cells: Cells) -> Section | None:
    """Return humans who change their goal more often, wait, or have alternatives."""
    words = (
        "More changes than one, humans who wait, and goals that can be reached by different sets "
        "of steps. The first right guess is the mean over changes."
    )
    section = _beside("More changes, waits and alternatives", words, cells, "beyond")
    if section is None:
        return None
    parts = {human: reach.n_changes(human) for human in cells.humans}
    title = '<h3 class="part">wasted robot steps per change of goal</h3>'
    ratios = tables.ratios(cells, "wasted_robot_steps", parts)
    return Section(section.title, section.html + title + ratios)


def _beside(title: str, words: str, cells: Cells, name: str) -> Section | None:
    """Return plots of a table, and per human its means with differences to rhp."""
    if not cells.rows:
        return None
    plots = [figures.dots(cells, measure, text, name) for measure, text in PLOTTED.items()]
    caption = f"Means over pairs of goals with 95 % intervals. {how_many(cells)}"
    keys = figures.legend(figures.without_oracle(cells.methods))
    parts = [f"<p>{words}</p>", panels(plots, caption, keys, "wide")]
    for human in cells.humans:
        parts.append(f'<h3 class="part">{escape(human)}</h3>')
        methods = cells.methods_of(human)
        parts.append(tables.both(cells, human, COMPACT, BESIDE, methods))
    if BESIDE in cells.methods:
        parts.append(_note(f"Below the means: paired differences to <em>{BESIDE}</em>. {COLORED}"))
    return Section(title, "\n".join(parts))


def banks(cells: Cells) -> Section | None:
    """Return how bank and order of steps affect the detection of changes by rhp."""
    present = [method for method in BANKS if method in cells.methods]
    if len(present) < 2:
        return None
    names = ("reached_pct",
             "false_changes", "false_before", "n_detected", "detection_delay", "correct_pct",
             "wasted_robot_steps", "total_steps")  # fmt: skip
    parts = [
        "<p>The changed-mind paper calls a history consistent if a policy of the bank has its "
        "actions in any order (<em>rhp</em>, the reading chosen), and elsewhere if it is a "
        "subsequence of one (<em>in order</em>); its bank holds 10,000 sampled sequences per goal, "
        "not all plans (<em>sampled</em>). A false change is one that is declared though the goal "
        "stayed.</p>",
        _false_ones(cells, present),
    ]
    for human in cells.humans:
        methods = [method for method in present if method in cells.methods_of(human)]
        if methods:
            parts.append(f'<h3 class="part">{escape(human)}</h3>')
            parts.append(tables.both(cells, human, names, BESIDE, methods))
    return Section("Two banks, two kinds of consistency", "\n".join(parts))


def _false_ones(cells: Cells, methods: Sequence[str]) -> str:
    """Return a sentence: false changes with a human who makes no mistakes."""
    for human in cells.humans:
        if not scenario.human_data(human).get("mistake_rate"):
            means = {name: cells.mean(human, name, "false_changes") for name in methods}
            words = [f"<em>{escape(name)}</em> {number(e.mean)}" for name, e in means.items() if e]
            return (
                f"<p>The {escape(human)} human makes no mistakes, so each false change with it is "
                f"made by the bank or the rule alone. Per episode: {'; '.join(words)}.</p>"
            )
    return ""


def exchanges(cells: Cells) -> Section | None:
    """Return rhp with one part or number exchanged, and hrcplan too."""
    present = [method for method in cells.methods if method not in BANKS[1:]]
    if not present:
        return None
    dots = zip(("full", "hollow"), cells.humans, strict=False)
    legend = ", ".join(f"{dot} {escape(human)}" for dot, human in dots)
    caption = f"Means over pairs of goals, 95 % intervals; dots: {legend}. {how_many(cells)}"
    svg = figures.variants(cells, ("correct_pct", "wasted_robot_steps", "total_steps"))
    parts = [
        "<p><em>our belief</em>: the robot chooses steps as <em>rhp</em> does, but guesses by the "
        "filter of <em>hrcplan</em>; <em>our steps</em>: the other way round. <em>sequences</em>: "
        "the number of candidate sequences (3 in <em>rhp</em>). <em>exact belief</em>: counted in "
        "the bank, not learnt by a forest. <em>plausible 2-grams</em>: of the goals that the "
        "history fits. <em>the given goal</em>: a change is declared if the history does not fit "
        "the last guess. <em>odd steps aside</em>: a step that fits no goal is no change. "
        "<em>may wait</em>: a robot that otherwise never waits does so where its step is probably "
        "useless. <em>own steps too</em>: the robot's own steps are evidence. <em>clips</em>: one "
        "step of least expected cost, the human Boltzmann-rational with a fixed goal. <em>no "
        "price</em>: a useless step costs its time only. <em>looks ahead</em>: <em>hrcplan</em> "
        "also weighs what the human's next action would tell. <em>hrcplan-switching</em>: with the "
        "filter that it had first.</p>",
        picture(svg, caption),
    ]
    for human in cells.humans:
        methods = [method for method in present if method in cells.methods_of(human)]
        if methods:
            parts.append(f'<h3 class="part">{escape(human)}</h3>')
            parts.append(tables.both(cells, human, COMPACT, BESIDE, methods))
    parts.append(_note(f"Below the means: paired differences to <em>{BESIDE}</em>. {COLORED}"))
    return Section("Parts exchanged", "\n".join(parts))
