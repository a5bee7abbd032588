"""``hrcplan study``: run a study, and report on its rows."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import click

from hrcplan.cli import options, output, play, trials
from hrcplan.cli.help import Group
from hrcplan.cli.study_progress import study_progress


@click.group("study", cls=Group, context_settings={"help_option_names": ["-h", "--help"]})
def command() -> None:
    """Run a study, and report on its rows."""


command.add_command(play.command)
command.add_command(trials.rehearse)
command.add_command(trials.collect_command)


@command.command(
    "run",
    epilog=options.notes(
        "Q: a factor of at least 1, as in 1.2.",
        "NAME: failure-anticipation, changed-mind, collaboration, switch (the benchmark "
        "hrcplan-switch), or module:NAME of your own study.",
        "DOMAIN, PROBLEM: paths, or the names of shipped files.",
        options.GOALS,
        options.ROBOTS,
        "HUMAN: fixed, optimal or suboptimal (changed-mind), or module:Class; changing, erring or "
        "steady (collaboration).",
        options.JOINT_ROBOTS,
    ),
)
@click.argument("name", metavar="NAME")
@click.option(
    "--runs",
    type=click.IntRange(1, 1_000_000),
    metavar="N",
    help="Runs per cell; by default 1000 (failure-anticipation), 3 per ordered pair of "
    "goals (changed-mind), 500 (collaboration), or 10 (switch).",
)
@options.seed("Random seed: everything random is derived from it.", least=None)
@click.option(
    "--jobs",
    type=click.IntRange(1, 4096),
    show_default="all processors",
    metavar="N",
    help="Number of worker processes; it does not change the rows.",
)
@click.option(
    "--cluster",
    metavar="ADDRESS",
    help="Run on the workers of the Dask scheduler at this address, such as tcp://node1:8786, or "
    "of its --scheduler-file, instead of on this machine; it does not change the rows.",
)
@click.option(
    "--limit",
    type=click.IntRange(1, 1_000_000_000),
    metavar="N",
    help="Run only N episodes of all tables together, spread evenly over cells; the main table "
    "comes first.",
)
@click.option("--domain", metavar="DOMAIN", help="The domain; by default those of the study.")
@click.option(
    "--problem",
    metavar="PROBLEM",
    help="The problem; by default that of the paper. Only failure-anticipation.",
)
@click.option("--goals", metavar="GOALS", help="The goals. Only changed-mind and collaboration.")
@click.option(
    "--quality",
    metavar="Q",
    help="Build banks of all sequences up to Q times optimal, as `bank build` does. Only "
    "changed-mind.",
)
@click.option(
    "--alternatives",
    metavar="Q",
    help="Build banks of plans up to Q times optimal in which each step is needed. Only "
    "changed-mind.",
)
@click.option(
    "--method",
    "methods",
    multiple=True,
    metavar="METHOD",
    help="Run this method only; repeatable. A module:Class alone is added to the "
    "methods of changed-mind. Not failure-anticipation.",
)
@click.option(
    "--human",
    "humans",
    multiple=True,
    metavar="HUMAN",
    help="Run this human only; repeatable. Only changed-mind and collaboration.",
)
@click.option(
    "--table",
    "tables",
    multiple=True,
    metavar="TABLE",
    help="Run this table only, such as rows (the main one) or choosers; repeatable.",
)
@click.option(
    "--chooser",
    metavar="NAME",
    help="How humans choose steps, such as frontier, habit or module:Class. "
    "Only changed-mind and collaboration.",
)
@click.option(
    "--pace",
    metavar="PACE",
    help="When agents begin: free (when they can) or turns. Only collaboration.",
)
@options.goals_per(None)
@click.option(
    "--world",
    metavar="NAME",
    help="The world: simulated, pddlgym or module:Class. Only changed-mind.",
)
@click.option(
    "--traces",
    metavar="FOLDER",
    type=click.Path(file_okay=False, path_type=Path),
    help="Also write a trace of every episode to this folder. Not failure-anticipation.",
)
@click.option(
    "-o",
    "--output",
    "folder",
    required=True,
    metavar="DIR",
    type=click.Path(file_okay=False, path_type=Path),
    help="Write rows to this folder; episodes that have rows there are not run again.",
)
@output.common_options
def run(
    name: str, runs: int | None, seed: int, jobs: int | None, cluster: str | None,
    limit: int | None, folder: Path, traces: Path | None, methods: tuple[str, ...],
    humans: tuple[str, ...], tables: tuple[str, ...], **choices: str | None,
) -> int:  # fmt: skip
    """Run the study NAME, and write one row per episode to DIR.

    Called again after an interruption, or with more runs, it adds the rows that are missing.
    """
    from hrcplan.studies import run_study

    if jobs is not None and cluster is not None:
        raise click.UsageError("--jobs is for this machine: give --jobs or --cluster, not both")
    jobs = jobs or (1 if cluster is not None else len(os.sched_getaffinity(0)))
    choices |= {"methods": ",".join(methods) or None, "humans": ",".join(humans) or None}
    with study_progress(folder) as progress:
        n_new = run_study(
            name, folder, runs=runs, seed=seed, jobs=jobs, limit=limit, options=choices,
            tables=tables, traces=traces, progress=progress, say=output.note,
            cluster=cluster,
        )  # fmt: skip
    if output.JSON:
        output.document({"study": name, "folder": str(folder), "n_new": n_new})
    else:
        own = f" --study {name}" if ":" in name else ""  # rows alone cannot load a user's code
        output.result(f"{n_new} new rows in {folder}; next: hrcplan study report {folder}{own}")
    return 0


@command.command("report")
@click.argument("folder", metavar="DIR", type=click.Path(path_type=Path))
@click.option(
    "--study",
    "name",
    metavar="NAME",
    help="The study that made the rows; needed only for your own study, as module:NAME.",
)
@click.option("--figures", type=click.Path(file_okay=False, path_type=Path), metavar="FOLDER",
              help="Also write plots (SVG, PDF, PNG) and rows (CSV) to this folder.")  # fmt: skip
@output.common_options
def report(folder: Path, name: str | None, figures: Path | None) -> int:
    """Write DIR/report.html and DIR/report.json from the rows in DIR, and print a summary."""
    from hrcplan.studies import report_study

    summary = report_study(folder, name, figures)
    if output.JSON:
        output.document(summary)
    else:
        output.result(_text(summary, folder))
    return 0


_VERDICTS = {"holds": "holds", "fails": "does not hold", "too-few": "too few runs"}


def _text(summary: dict[str, Any], folder: Path) -> str:
    """Return means by cell and the claims, as plain lines."""
    names = list(summary["rows"][0]["measures"]) if summary["rows"] else []
    table = [["", *names]]
    for row in summary["rows"]:
        cell = " ".join(map(str, row["cell"].values()))
        table.append([cell, *(_mean(m["mean"], m["se"]) for m in row["measures"].values())])
    lines = output.columns(table, right=range(1, len(names) + 1))
    lines.append("")
    for claim in summary["claims"]:
        lines.append(f"{_VERDICTS[claim['verdict']]:<14} {claim['claim']}")
        lines.append(f"               {claim['evidence']}")
    lines += ["", f"{summary['n_rows']} rows; wrote {folder}/report.html and report.json"]
    return "\n".join(lines)


def _mean(mean: float | None, se: float | None) -> str:
    if mean is None:
        return "-"
    return f"{mean:.2f}" if se is None else f"{mean:.2f} ± {se:.2f}"
