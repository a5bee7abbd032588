"""``hrcplan study``: run a study, and report on its rows."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any

import rich_click as click

from hrcplan.cli import output, play


@click.group("study", context_settings={"help_option_names": ["-h", "--help"]})
def command() -> None:
    """Run a study of one of the papers, and report on it."""


command.add_command(play.command)


@command.command("run")
@click.argument("name", metavar="NAME")
@click.option("--runs", type=click.IntRange(1), metavar="N",
              help="Runs per cell; by default 1000, or all pairs of goals thrice.")  # fmt: skip
@click.option("--seed", type=int, default=0, show_default=True, metavar="N",
              help="From which everything random is derived.")  # fmt: skip
@click.option("--jobs", type=click.IntRange(1), default=lambda: len(os.sched_getaffinity(0)),
              show_default="all processors", metavar="N", help="Worker processes.")  # fmt: skip
@click.option("--limit", type=click.IntRange(1), metavar="N",
              help="Only N episodes, spread evenly over cells.")  # fmt: skip
@click.option("--domain", metavar="DOMAIN", help="Another domain than the paper's.")
@click.option("--problem", metavar="PROBLEM",
              help="Another problem than the paper's (failure-anticipation).")  # fmt: skip
@click.option("--goals", metavar="GOALS", help="A folder of goals (changed-mind).")
@click.option("--method", "methods", multiple=True, metavar="NAME",
              help="Only this method, or also yours as module:Class (changed-mind).")  # fmt: skip
@click.option("--human", "humans", multiple=True, metavar="NAME",
              help="Only this human of the main table, or also yours as module:Class.")  # fmt: skip
@click.option("--chooser", metavar="NAME",
              help="How humans choose: frontier, cc-htn, plans (changed-mind).")  # fmt: skip
@click.option("--world", metavar="NAME", help="simulated or pddlgym (changed-mind).")
@click.option("-o", "--output", "folder", required=True, metavar="DIR",
              type=click.Path(file_okay=False, path_type=Path),
              help="Folder of the rows; what it has already is not run again.")  # fmt: skip
@output.common_options
def run(
    name: str, runs: int | None, seed: int, jobs: int, limit: int | None, folder: Path,
    methods: tuple[str, ...], humans: tuple[str, ...], **options: str | None,
) -> int:  # fmt: skip
    """Run the study NAME (failure-anticipation, changed-mind): one row per episode into DIR.

    A run that was stopped or killed goes on when it is called again; more runs extend it.
    """
    from hrcplan.studies import run_study

    options |= {"methods": ",".join(methods) or None, "humans": ",".join(humans) or None}
    with _bar() as progress:
        n_new = run_study(
            name, folder, runs=runs, seed=seed, jobs=jobs, limit=limit, options=options,
            progress=progress, say=output.note,
        )  # fmt: skip
    if output.JSON:
        output.document({"study": name, "folder": str(folder), "n_new": n_new})
    else:
        output.result(f"{n_new} new rows in {folder}; next: hrcplan study report {folder}")
    return 0


@command.command("report")
@click.argument("folder", metavar="DIR", type=click.Path(path_type=Path))
@click.option("--study", "name", metavar="NAME",
              help="The study of the rows; needed for your own, as module:NAME.")  # fmt: skip
@output.common_options
def report(folder: Path, name: str | None) -> int:
    """Write DIR/report.html and DIR/report.json from the rows in DIR."""
    from hrcplan.studies import report_study

    found = report_study(folder, name)
    if output.JSON:
        output.document(found)
    else:
        output.result(_text(found, folder))
    return 0


def _text(found: dict[str, Any], folder: Path) -> str:
    """Return means by cell and the claims, as plain lines."""
    names = list(found["rows"][0]["measures"]) if found["rows"] else []
    lines = ["".join([f"{'':22}", *(f"{name:>22}" for name in names)])]
    for row in found["rows"]:
        cell = " ".join(map(str, row["cell"].values()))
        means = (_mean(m["mean"], m["se"]) for m in row["measures"].values())
        lines.append("".join([f"{cell:22}", *(f"{text:>22}" for text in means)]))
    lines.append("")
    for claim in found["claims"]:
        lines.append(f"{'holds         ' if claim['holds'] else 'does not hold '} {claim['claim']}")
        lines.append(f"               {claim['evidence']}")
    lines += ["", f"{found['n_rows']} rows; wrote {folder}/report.html and report.json"]
    return "\n".join(lines)


def _mean(mean: float | None, se: float | None) -> str:
    return "-" if mean is None else f"{mean:.2f} ± {se:.2f}"


def _bar() -> AbstractContextManager[Callable[[int, int], None] | None]:
    """Return a progress bar on stderr, or nothing where nobody watches."""
    from rich.console import Console

    console = Console(stderr=True)
    return _Bar(console) if console.is_terminal else nullcontext()


class _Bar:
    """A progress bar that is made when the first rows come in."""

    def __init__(self, console: Any) -> None:
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TimeRemainingColumn

        self._progress = Progress(BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(),
                                  console=console, transient=True)  # fmt: skip
        self._task: Any = None

    def __enter__(self) -> Callable[[int, int], None]:
        self._progress.start()
        return self._show

    def __exit__(self, *error: object) -> None:
        self._progress.stop()

    def _show(self, done: int, wanted: int) -> None:
        if self._task is None:
            self._task = self._progress.add_task("", total=wanted)
        self._progress.update(self._task, completed=done)
