"""``hrcplan execute``: carry a plan out in a world, replan when that is better, show it live."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from hrcplan.cli import options, output
from hrcplan.core.files import check_targets
from hrcplan.errors import UsageError

if TYPE_CHECKING:
    from hrcplan.agents import AgentModel

HELP = """Carry out DOMAIN PROBLEM with a simulated human, and replan before actions fail.

\b
--profile NAME
  replan-always       planners get sensed values; every sensed change replans
  hrcplan             planners get -10 ln(1 - p) of the failure probability p, failures are
                      remembered; replans only if a new plan is better
  estimated           as hrcplan, but a filter infers agent states from outcomes
  FILE.toml           a profile of your own (keys as in hrcplan/agents/profiles.toml)

\b
--human NAME[,WORD…], or module:Class
  steady              nothing changes by itself
  uncooperative       one element of the human's agent state rises to 10
  partly-cooperative  it rises to a value from 5 to 10
  random              the change comes before a random action of the human, else at 0 s
  attempt             each attempt of an action is drawn again, else once per run (once)
  before | during | after
                      the change is sensed before, during (default) or after the
                      human's first action under it

\b
--change WHAT@SECONDS, any number of times
  FUNCTION OBJECT…=NUMBER@SECONDS    "motivation human=9@0"     an agent state, 0 to 10,
                                                                or any other number
  PREDICATE OBJECT…@SECONDS          "box-at blue wp0@60"       a fact begins to hold
  not PREDICATE OBJECT…@SECONDS      "not box-at blue wp4@60"   a fact ceases to hold
"""


@click.command(
    "execute",
    cls=options.SettingsCommand,
    help=HELP,
    epilog=options.notes(options.NAMES, options.SETTING, options.PLANNER),
)
@click.argument("names", nargs=-1, required=True, metavar="DOMAIN PROBLEM")
@click.option(
    "--profile",
    "profile_name",
    default="hrcplan",
    show_default=True,
    metavar="NAME",
    help="When to replan, and which values planners get: see above.",
)
@click.option(
    "--human",
    default="steady",
    show_default=True,
    metavar="SPEC",
    help="How the human behaves: see above.",
)
@click.option(
    "--world",
    default="simulated",
    show_default=True,
    metavar="NAME",
    help="Where actions are carried out: simulated, an installed world, or module:Class.",
)
@click.option(
    "--robot",
    metavar="LINK",
    help="What carries out the robots' actions, in real time: 'cmd:PROGRAM' (speaks JSON lines), "
    "ros:MAPPING.toml, plansys2, simulated, an installed link, or module:Class.",
)
@options.ros_python
@options.planner("Which planner to ask first; if it fails, others are asked.")
@options.timeout("Seconds for each plan.", 20.0)
@click.option("--no-model", is_flag=True, help="Do not use sensed values.")
@click.option(
    "--change",
    "changes",
    multiple=True,
    metavar="CHANGE",
    help="A value or fact changes at a time, as in 'motivation human=9@0': see above.",
)
@options.settings
@click.option(
    "--replan-limit",
    type=click.IntRange(0),
    default=None,
    metavar="N",
    help="Replans per run, instead of the number in the profile.",
)
@options.seed("Random seed of the simulated human.", 1, least=None)
@click.option(
    "--journal",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write everything down, so that the run can be resumed and replayed.",
)
@click.option("--resume", is_flag=True, help="Continue the run in the journal.")
@options.picture("--gantt", "Draw what was done as a Gantt chart.")
@click.option(
    "--speed",
    type=options.FiniteNumber(0, min_open=True),
    default=None,
    metavar="X",
    help="Seconds of the run per second; if not given, as fast as possible, or 1 with --robot.",
)
@output.common_options
def command(
    names: tuple[str, ...],
    profile_name: str,
    human: str,
    world: str,
    robot: str | None,
    ros_python: str | None,
    planner: str,
    timeout: float,
    no_model: bool,
    changes: tuple[str, ...],
    settings: tuple[str, ...],
    replan_limit: int | None,
    seed: int,
    journal: Path | None,
    resume: bool,
    gantt: Path | None,
    speed: float | None,
) -> int:
    """Carry out a problem; ``HELP`` is what ``--help`` prints."""
    from hrcplan.cli.arguments import problem_of, split_names
    from hrcplan.cli.live import Live
    from hrcplan.execution.execute import carry_out, prepare_run
    from hrcplan.pddl.conventions import MARK_ROBOTS, robots

    options.check_picture(gantt, "--gantt")
    domain, name, _ = split_names(names, 0)
    problem = problem_of(domain, name, settings)
    check_targets((gantt, journal), problem.path, problem.domain.path, profile_name)
    prepared_run = prepare_run(
        problem, profile=profile_name, human=human, changes=changes, model=not no_model,
        planner=planner, seed=seed, replan_limit=replan_limit, timeout_s=timeout, world=world,
        robot=robot, speed=speed or 1.0, ros_python=ros_python,
    )  # fmt: skip
    if problem.agents and not robots(problem):
        output.warn(f"no agent is a robot, so every agent counts as human; {MARK_ROBOTS}")
    _check_initial(prepared_run.engine.model.agents, settings)
    live = Live(problem, None if robot else speed)
    watch = None if output.JSON else live.watch
    execution = carry_out(prepared_run, journal=journal, resume=resume, watch=watch)
    outcome = execution.outcome
    if gantt is not None:
        from hrcplan.plots.gantt import draw

        done, failed = execution.timeline.as_plan()
        form = options.picture_form(gantt)
        output.write_atomically(gantt, draw(problem, done, form, failed))
    if output.JSON:
        output.document({
            "success": outcome.success, "ending": outcome.ending, "why": execution.run.why or None,
            "row": outcome.to_json(), "measures": outcome.measures(),
            **execution.timeline.to_json(),
        })  # fmt: skip
    else:
        live.finish(execution.run, outcome)
    return 0 if outcome.success else 1


def _check_initial(agents: AgentModel, settings: tuple[str, ...]) -> None:
    """Refuse settings beyond the range of an agent state; warn of such values in the problem file.

    The file is carried out: what is the initial value counts as no reason to fail.
    """
    from hrcplan.pddl.settings import parse_setting

    keys = {parse_setting(text, agents.problem)[0] for text in settings}
    for key, value in agents.low.items():
        try:
            agents.check(key, value)
        except UsageError as error:
            message = f"({' '.join(key)}): {error.message}"
            if key in keys:
                raise UsageError(f"--set {message}", code=error.code, hint=error.hint) from None
            output.warn(f"initial {message}; {error.hint}")
