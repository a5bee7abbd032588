"""``hrcplan plan``: ask planners for a plan and print it in lanes."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hrcplan.cli import options, output
from hrcplan.core.files import check_targets

if TYPE_CHECKING:
    from hrcplan.pddl.model import Problem
    from hrcplan.planners.result import Result

QUIET_S = 1.0
"""How long plans are improved before a line says so."""
PAUSE_S = 1.0
"""The least time between two lines about better plans: some metrics improve without end."""
STATUS_EXIT = {"solved-optimally": 0, "solved": 0, "unsolvable": 1, "unsolved": 4}


@click.command(
    "plan",
    cls=options.SettingsCommand,
    epilog=options.notes(options.NAMES, options.PLANNER, options.SETTING),
)
@click.argument("names", nargs=-1, required=True, metavar="DOMAIN PROBLEM")
@options.planner("Which planner to ask; auto asks all that can solve the problem.")
@options.timeout("Seconds for all planners together.", 60.0)
@options.settings
@click.option(
    "--memory",
    type=click.IntRange(min=64),
    default=4096,
    show_default=True,
    metavar="MIB",
    help="Memory limit of all planners together, in MiB.",
)
@click.option("--any", "any_plan", is_flag=True, help="Stop at the first valid plan, good or not.")
@click.option("--lanes", is_flag=True, help="Schedule a sequential plan: one lane per agent.")
@options.picture("--gantt", "Draw the plan as a Gantt chart.")
@click.option(
    "-o",
    "--output",
    "target",
    type=click.Path(path_type=Path),
    metavar="PLAN",
    help="Write the plan to this file.",
)
@click.option(
    "--format",
    "plan_form",
    type=click.Choice(["ipc", "plansys2"]),
    default="ipc",
    show_default=True,
    help="The format of the file: that of the IPC, or that of 'run plan-file' in PlanSys2.",
)
@output.common_options
def command(
    names: tuple[str, ...],
    planner: str,
    timeout: float,
    settings: tuple[str, ...],
    memory: int,
    any_plan: bool,
    lanes: bool,
    gantt: Path | None,
    target: Path | None,
    plan_form: str,
) -> int:
    """Find a plan for the PROBLEM of a DOMAIN.

    The plan is replayed in hrcplan's own semantics before it is printed.
    """
    from hrcplan.cli.arguments import problem_of, split_names
    from hrcplan.planners.solve import solve

    options.check_picture(gantt, "--gantt")
    check_targets((gantt, target))
    domain, name, _ = split_names(names, 0)
    problem = problem_of(domain, name, settings)
    check_targets((gantt, target), problem.path, problem.domain.path)
    result = solve(
        problem, planner, timeout_s=timeout, any_plan=any_plan, lanes=lanes or gantt is not None,
        memory_bytes=memory << 20, on_better=Improvements(),
    )  # fmt: skip
    for attempt in result.attempts:
        output.say(f"{attempt.planner}: {attempt.outcome} ({attempt.wall_s:.2f} s)")
    if result.plan is not None and target is not None:
        from hrcplan.plans import format_plan, format_plansys2

        form = format_plansys2 if plan_form == "plansys2" else format_plan
        output.write_atomically(target, form(result.plan))
    if result.plan is not None and gantt is not None:
        from hrcplan.plots.gantt import draw

        output.write_atomically(gantt, draw(problem, result.plan, options.picture_form(gantt)))
    _print(problem, result)
    if planner == "auto" and result.status.value in ("solved", "unsolved"):
        _name_missing()
    return STATUS_EXIT[result.status.value]


def _name_missing() -> None:
    """Say which built-in planners cannot run here: one of them might have proven the plan."""
    from hrcplan.core.extras import install_command
    from hrcplan.planners import registry

    names = [name for name in registry.BUILT_IN if registry.make(name).missing() is not None]
    if names:
        cure = install_command("up_fast_downward")
        output.note(f"unproven; {' and '.join(names)} might prove more, but cannot run: {cure}")


class Improvements:
    """Says on stderr which plan is the best so far, where the search takes more than a moment."""

    def __init__(self) -> None:
        self._start_s = time.monotonic()
        self._next_s = QUIET_S

    def __call__(self, result: Result) -> None:
        """Tell of a plan that is better than those before it."""
        from hrcplan.core.numbers import number_text

        elapsed_s = time.monotonic() - self._start_s
        if elapsed_s < self._next_s or result.objective is None:
            return
        self._next_s = elapsed_s + PAUSE_S
        value = number_text(result.objective)
        output.note(f"after {elapsed_s:.0f} s: {value} ({result.planner})")


def _print(problem: Problem, result: Result) -> None:
    from hrcplan.cli import lanes

    if output.JSON:
        output.document(lanes.as_json(problem, result))
    else:
        output.result(lanes.as_text(problem, result))
