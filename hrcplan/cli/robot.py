"""``hrcplan robot``: a simulated robot that speaks the protocol of robot links."""

from __future__ import annotations

import click

from hrcplan.cli import options
from hrcplan.errors import UsageError

HELP = """Simulate a robot, to try robot links with.

\b
hrcplan robot --simulated
    speaks JSON lines, and carries every action out by waiting for its duration:
    hrcplan execute DOMAIN PROBLEM --robot "cmd:hrcplan robot --simulated"
hrcplan robot --ros MAPPING.toml DOMAIN PROBLEM
    has the ROS 2 action servers of a mapping file:
    hrcplan execute DOMAIN PROBLEM --robot ros:MAPPING.toml
hrcplan robot --plansys2 DOMAIN PROBLEM
    has a performer of PlanSys2 for every action of a robot:
    hrcplan execute DOMAIN PROBLEM --robot plansys2

The options make it as slow and unreliable as real robots are.
"""


@click.command("robot", help=HELP)
@click.argument("names", nargs=-1, metavar="[DOMAIN PROBLEM]")
@click.option("--simulated", is_flag=True, help="Speak JSON lines.")
@click.option("--ros", metavar="MAPPING", help="Have the action servers of this mapping file.")
@click.option("--plansys2", is_flag=True, help="Have performers of PlanSys2.")
@options.ros_python
@click.option(
    "--seconds", type=options.FiniteNumber(0), default=2.0, show_default=True, metavar="S",
    help="How long an action lasts, with --ros or --plansys2.",
)  # fmt: skip
@click.option(
    "--speed", type=options.FiniteNumber(0, min_open=True), default=1.0, show_default=True,
    metavar="X", help="It does in one second what takes X seconds.",
)  # fmt: skip
@click.option(
    "--agent",
    "agents",
    multiple=True,
    metavar="NAME",
    help="An agent whose actions it takes; repeatable. By default every robot.",
)
@click.option("--slow", type=options.FiniteNumber(0), default=1.0, metavar="FACTOR",
              help="Actions last this many times their duration.")  # fmt: skip
@click.option("--fail", type=click.FloatRange(0, 1), default=0.0, metavar="P",
              help="Probability that an action fails.")  # fmt: skip
@click.option("--lost", type=click.FloatRange(0, 1), default=0.0, metavar="P",
              help="Probability that a message of the robot is lost.")  # fmt: skip
@click.option("--deaf-after", type=click.IntRange(0), default=None, metavar="N",
              help="Answer nothing after N actions.")  # fmt: skip
@click.option("--die-after", type=click.IntRange(1), default=None, metavar="N",
              help="End in the middle of the Nth action.")  # fmt: skip
@options.seed("Random seed of what fails and what is lost.", 1, least=None)
def command(
    names: tuple[str, ...], simulated: bool, ros: str | None, plansys2: bool,
    ros_python: str | None, seconds: float, speed: float, agents: tuple[str, ...], slow: float,
    fail: float, lost: float, deaf_after: int | None, die_after: int | None, seed: int,
) -> int:  # fmt: skip
    """Simulate a robot; ``HELP`` is what ``--help`` prints."""
    if [simulated, ros is not None, plansys2].count(True) != 1:
        hint = "hrcplan robot --simulated"
        raise UsageError("one of --simulated, --ros and --plansys2 is needed", hint=hint)
    if simulated:
        from hrcplan.execution.links.simulated_robot import RobotFaults, SimulatedRobotProgram

        faults = RobotFaults(slow, deaf_after, lost, die_after, fail, seed)
        SimulatedRobotProgram(speed, faults, agents).run()
        return 0
    from hrcplan.cli.arguments import problem_of, split_names
    from hrcplan.execution.links.ros.simulated import run_robot

    domain, name, _ = split_names(names, 0)
    problem = problem_of(domain, name, ())
    return run_robot(
        problem, ros, ros_python, seconds=seconds * slow, fail=fail, deaf_after=deaf_after,
        die_after=die_after, seed=seed,
    )  # fmt: skip
