"""``hrcplan robot``: a simulated robot that speaks the protocol of robot links."""

from __future__ import annotations

import rich_click as click

from hrcplan.cli import options

HELP = """Simulate a robot that speaks JSON lines, to try robot links with.

It reads commands on standard input and writes events on standard output, and carries every action
out by waiting for its duration. 'hrcplan execute DOMAIN PROBLEM --robot "cmd:hrcplan robot
--simulated"' runs it; the options make it as slow and unreliable as real robots are.
"""


@click.command("robot", help=HELP)
@click.option("--simulated", is_flag=True, required=True, help="Simulate it: there is no other.")
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
    simulated: bool, speed: float, agents: tuple[str, ...], slow: float, fail: float, lost: float,
    deaf_after: int | None, die_after: int | None, seed: int,
) -> int:  # fmt: skip
    """Simulate a robot; ``HELP`` is what ``--help`` prints."""
    from hrcplan.execution.links.simulated_robot import RobotFaults, SimulatedRobotProgram

    faults = RobotFaults(slow, deaf_after, lost, die_after, fail, seed)
    SimulatedRobotProgram(speed, faults, agents).run()
    return 0
