"""Files to look at: runs and plans over time, banks, allocation diagrams, reports of studies."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

from hrcplan.bank import Bank, load
from hrcplan.bank.htn import decompose
from hrcplan.bank.htn_view import as_text
from hrcplan.core.files import read_bytes
from hrcplan.core.json_values import json_of
from hrcplan.core.numbers import int_text, number_text
from hrcplan.errors import HrcplanError, InputError, UsageError
from hrcplan.execution.journal import read_journal
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.plans import Plan
from hrcplan.plans.logs import read_plan
from hrcplan.validation import Report, validate
from hrcplan.web.allocation_page import diagram_page, is_diagram, read_diagram
from hrcplan.web.pages import card, document, save_data
from hrcplan.web.plan_story import plan_run
from hrcplan.web.replay_page import run_of
from hrcplan.web.worlds import offers

JOURNAL, PLAN, BANK, STUDY = "journal", "plan", "bank", "study"
ALLOCATION = "allocation"
REPORT = "report.html"
MAX_FILES = 200
_SCRIPT = '<script type="module" src="/static/replay.js"></script>'


@dataclass(frozen=True, slots=True)
class LookFile:
    """A file that pages can show, and what it is."""

    path: Path
    kind: str

    @property
    def title(self) -> str:
        """What the list of files says."""
        return f"{self.kind} {self.path.name}"


def look_files(paths: Sequence[Path]) -> list[LookFile]:
    """Return the files that pages can show: those named, and those in folders that are named.

    Raises:
        InputError: if a file that is named is missing.
    """
    files: list[LookFile] = []
    for path in paths:
        if not path.is_dir():
            files.append(LookFile(path, _kind(path)))
        elif (path / REPORT).is_file():
            files.append(LookFile(path / REPORT, STUDY))
        else:
            inside = (p for p in sorted(path.iterdir()) if p.is_file() and not p.is_symlink())
            known = (LookFile(p, _kind(p)) for p in inside if p.suffix != ".pddl")
            files += [file for file in known if file.kind != PLAN or file.path.suffix == ".plan"]
    return files[:MAX_FILES]


def _kind(path: Path) -> str:
    data = read_bytes(path, limit=None)
    if path.name == REPORT:
        return STUDY
    try:
        head = json_of(data.partition(b"\n")[0])
        if isinstance(head, dict) and "journal" in head:
            return JOURNAL
    except ValueError:
        pass
    if is_diagram(data):
        return ALLOCATION
    try:
        data.decode()
    except UnicodeDecodeError:
        return BANK
    return PLAN


def look_page(file: LookFile, goal: str | None = None) -> str:
    """Return the page of a file.

    Args:
        file: The file.
        goal: Of a bank, the goal whose chains and cliques are to be shown.

    Raises:
        InputError: if the file is damaged, or no problem is known that a plan is of.
        UsageError: if the bank has no such goal.
    """
    match file.kind:
        case "journal":
            return run_page(file.title, run_of(read_journal(file.path)), "")
        case "bank":
            return bank_page(file, load(file.path), goal)
        case "allocation":
            return diagram_page(file.title, read_diagram(file.path))
        case "study":
            return read_bytes(file.path).decode("utf-8", "replace")
    return plan_page(file)


def run_page(title: str, run: dict[str, Any], above: str) -> str:
    """Return the page of a run or a plan; ``above`` is markup already."""
    data = json.dumps({**run, "title": title}, ensure_ascii=False).replace("<", "\\u003c")
    body = (
        f'<nav><a href="/">← all</a></nav>{above}<main id="page"></main>'
        f'<script type="application/json" id="run">{data}</script>'
    )
    return document(title, body, _SCRIPT)


def plan_page(file: LookFile) -> str:
    """Return the page of a plan: whether it is valid, what it costs, and its lanes.

    Raises:
        InputError: if it is a plan of no problem that is known here.
    """
    text = read_bytes(file.path).decode("utf-8", "replace")
    problem, plan, report = _problem_of(text, file.path)
    words = (
        f"valid: cost {number_text(report.cost or 0)}" if report.valid
        else f"not valid: {report.reason}"
    )  # fmt: skip
    if report.metric is not None:
        words += f", metric {number_text(report.metric)}"
    if report.makespan_s is not None:
        words += f", makespan {number_text(report.makespan_s)}"
    costs = [number_text(cost) for cost in report.step_costs]
    costs += ["-"] * (len(plan.actions) - len(costs))
    rows = "".join(
        f'<tr><td>{escape(str(action))}</td><td class="n">{cost}</td></tr>'
        for action, cost in zip(plan.actions, costs, strict=True)
    )
    name = f"{problem.domain.name}/{problem.name}"
    table = f'<table><tr><th>action</th><th class="n">cost</th></tr>{rows}</table>'
    details = f"<details><summary>costs</summary>{table}</details>"
    above = f"<main>{card(name, f'<p>{escape(words)}</p>{details}')}</main>"
    return run_page(file.title, plan_run(problem, plan), above)


def _problem_of(text: str, path: Path) -> tuple[Problem, Plan, Report]:
    """Return the problem that a plan is of: in its folder, or among those that are known here.

    Raises:
        InputError: if there is none.
    """
    best: tuple[Problem, Plan, Report] | None = None
    near = [str(p) for p in sorted(path.parent.glob("*.pddl")) if p.stem != "domain"]
    for name in (*near, *(offer["domain"] for offer in offers() if offer["single"])):
        try:
            problem = read(name)
            plan, _ = read_plan(text, problem, str(path))
            report = validate(problem, plan)
        except HrcplanError:
            continue
        if report.valid:
            return problem, plan, report
        if best is None and report.failed_step not in (0,):
            best = problem, plan, report
    if best is None:
        message = f"{path.name} is a plan of no problem that is known here"
        raise InputError(message, code="no-problem", hint="put its problem into the same folder")
    return best


def bank_page(file: LookFile, bank: Bank, goal: str | None) -> str:
    """Return the page of a bank: its goals, and the chains and cliques of one of them.

    Raises:
        UsageError: if it has no such goal.
    """
    head = ("goal", "steps", "cost", "plans", "nodes", "edges")
    rows = "".join(
        f'<tr><td><a href="?goal={escape(g.goal)}">{escape(g.goal)}</a></td>'
        + "".join(
            f'<td class="n">{text}</td>'
            for text in (str(g.n_steps), number_text(g.optimal_cost or 0),
                         int_text(g.plans, ","), f"{g.n_nodes:,}", f"{g.n_edges:,}")
        )
        + "</tr>"
        for g in bank.graphs
    )  # fmt: skip
    names = "".join(f'<th class="n">{name}</th>' for name in head[1:])
    table = f'<div class="scroll"><table><tr><th>goal</th>{names}</tr>{rows}</table></div>'
    cards = card(f"{bank.goals.problem.domain.name}: {len(bank.graphs)} goals", table)
    if goal is not None:
        if goal not in bank.names:
            raise UsageError(f"there is no goal '{goal}'", code="not-found")
        cards += card(f"Plans of {goal}", _shape(bank, bank.goal_index(goal)))
    body = f'<nav><a href="/">← all</a></nav><main><div class="cards">{cards}</div></main>'
    return document(file.title, body, pictures=True)


def _shape(bank: Bank, goal: int) -> str:
    """Return how wide the plan graph is after each step, and its chains and cliques."""
    graph = bank.graphs[goal]
    if not graph.n_nodes:
        return "<p>It has no plan.</p>"
    starts = [first for _, first in graph.layers]
    widths = [b - a for a, b in zip(starts, [*starts[1:], graph.n_nodes], strict=True)]
    most = max(widths)
    bars = "".join(
        f'<rect x="{i * 16}" y="{80 - 76 * n / most:.1f}" width="14" height="{76 * n / most:.1f}" '
        f'fill="#56b4e9"><title>{n} states</title></rect>'
        for i, n in enumerate(widths)
    )
    rows = [["steps", "states"], *([str(i), str(n)] for i, n in enumerate(widths))]
    picture = (
        f'<div class="scroll"><svg width="{16 * len(widths)}" height="80" '
        f'viewBox="0 0 {16 * len(widths)} 80" role="img" '
        f'aria-label="states after each step" {save_data("states", rows)}>{bars}</svg></div>'
    )
    try:
        text = as_text(graph, decompose(graph), bank.table)
    except HrcplanError as error:
        text = error.message
    return (
        f'<p class="soft">states after each step, {most} at most</p>{picture}'
        f'<pre class="scroll">{escape(text)}</pre>'
    )
