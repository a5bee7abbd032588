"""``hrcplan collaborate``: a robot helps a person whose goal it does not know."""

from __future__ import annotations

from collections.abc import Hashable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hrcplan.cli import options, output
from hrcplan.core.text import plural
from hrcplan.errors import UsageError

if TYPE_CHECKING:
    from hrcplan.bank import Bank
    from hrcplan.cli.narrator import Narrator
    from hrcplan.collaboration.collaborate import Collaboration, CollaborationParts
    from hrcplan.collaboration.events import SharedCommand, SharedEvent
    from hrcplan.collaboration.run import CompanionRun
    from hrcplan.collaboration.setup import CollaborationSetup
    from hrcplan.core.json_values import JsonValue
    from hrcplan.execution.links import RobotLink

TURNS = "turns"
ME, LINK, SIMULATED = "me", "link", "simulated"
EXIT_NO = 1


@click.command(
    "collaborate",
    epilog=options.notes(
        options.GOALS,
        "HUMAN: me (you type what you do), link (the robot's program says it), simulated "
        "(frontier), cc-htn, plans, or module:Class.",
        "PACE: turns (first you, then the robot; a step lasts 1), or free (every agent begins at "
        "any time, and actions take their durations). With one goal the plan says who begins when.",
        options.ROBOTS,
        options.JOINT_ROBOTS,
        "At the prompt: what you do in the words of the PDDL, or its number; Enter to wait; help.",
        "With --json every event is one line, and so is the outcome at the end.",
    ),
)
@click.argument("domain", metavar="DOMAIN")
@click.argument("goals", required=False, metavar="[GOALS]")
@click.option(
    "--human", default=ME, show_default=True, metavar="HUMAN", help="Who acts for the people."
)
@click.option("--pace", default="turns", show_default=True, metavar="PACE",
              help="When agents begin: turns or free.")  # fmt: skip
@click.option("--method", default="joint", show_default=True, metavar="METHOD",
              help="Which robot helps.")  # fmt: skip
@click.option(
    "--robot", metavar="LINK",
    help="What carries out the robots' actions, in real time: 'cmd:PROGRAM' (speaks JSON lines), "
    "ros:MAPPING.toml, plansys2, simulated, an installed link, or module:Class.",
)  # fmt: skip
@options.ros_python
@click.option(
    "--speed", type=options.FiniteNumber(0, min_open=True), default=1.0, metavar="X",
    help="With --robot: seconds of the collaboration per second.",
)  # fmt: skip
@click.option("--journal", type=click.Path(path_type=Path), metavar="FILE",
              help="Write everything down, to go on later and to replay it.")  # fmt: skip
@click.option("--resume", is_flag=True, help="Go on with the collaboration in the journal.")
@options.seed("Random seed of a simulated human.")
@output.common_options
def command(
    domain: str, goals: str | None, human: str, pace: str, method: str, robot: str | None,
    ros_python: str | None, speed: float, journal: Path | None, resume: bool, seed: int,
) -> int:  # fmt: skip
    """Work together with a robot that does not know your goal.

    The robot knows the GOALS that you may have, infers yours from what you do, and helps; you may
    change your mind. It ends when a goal holds and you say that this was all. With one goal the
    robot follows the best plan, and tells you your part of it.
    """
    from hrcplan.bank.sources import goals_named
    from hrcplan.cli.lines import EndOfInputError
    from hrcplan.collaboration.collaborate import (
        WITH_ROBOT,
        bank_for,
        carry_out_collaboration,
        make_setup,
    )
    from hrcplan.execution.links import make_link

    output.LINES = output.JSON
    bank = bank_for(goals_named(domain, goals))
    for graph in bank.graphs:
        if not graph.n_nodes:
            output.warn(f"goal '{graph.goal}' has no plan")
    spec: dict[str, JsonValue] = {"name": "frontier" if human == SIMULATED else human}
    if robot is not None:
        spec[WITH_ROBOT] = True
    setup = make_setup(bank, pace=pace, method=method, seed=seed, human=spec)
    _check_method(setup, len(bank.names))
    if human == LINK and robot is None:
        raise UsageError("--human link needs a robot that says what people do", hint="--robot")
    link = None if robot is None else make_link(robot, setup.problem, ros_python)
    session = _Session(bank, journal if resume else None, link, speed)
    try:
        done = carry_out_collaboration(
            setup, session.make_parts, journal=journal, resume=resume, watch=session.watch
        )
    except (EndOfInputError, KeyboardInterrupt) as stop:
        hint = f"go on with: --journal {journal} --resume" if journal else None
        if isinstance(stop, KeyboardInterrupt):
            if hint:
                output.note(hint)
            raise
        output.fail("input-ended", "the input has ended before a goal was reached", hint=hint)
        return EXIT_NO
    _finish(done)
    return 0 if done.outcome.success else EXIT_NO


def _check_method(setup: CollaborationSetup, n_goals: int) -> None:
    """Refuse a robot that has to know the goal; say so if a classifier may be trained first.

    Raises:
        UsageError: if the goal of a live person would have to be known.
    """
    from hrcplan.assistance.assistant import KnowsGoal, needs_training
    from hrcplan.assistance.registry import ASSISTANTS
    from hrcplan.collaboration.robots import JOINT_ROBOTS

    robot = JOINT_ROBOTS.get(setup.method)
    kind: Hashable = ASSISTANTS.find(setup.method) if robot is None else None
    knows_goal = robot.knows_goal if robot is not None else isinstance(kind, KnowsGoal)
    if setup.human["name"] == ME and n_goals > 1 and knows_goal:
        message = f"the robot '{setup.method}' has to know your goal"
        hint = "it works with --human simulated"
        raise UsageError(message, code="goal-unknown", hint=hint)
    if n_goals > 1 and robot is None and needs_training(kind):
        output.note("the robot may first train a classifier, which takes a minute")


class _Session:
    """The parts of one collaboration, made for the setup that it has in the end."""

    def __init__(
        self, bank: Bank, past: Path | None, robot: RobotLink | None, speed: float
    ) -> None:
        self.bank, self.past, self.robot, self.speed = bank, past, robot, speed
        self.narrator: Narrator | None = None

    def make_parts(self, setup: CollaborationSetup) -> CollaborationParts:
        """Return the parts, with a person at the terminal or a simulated human."""
        from hrcplan.cli.lines import InputLines
        from hrcplan.cli.narrator import Narrator
        from hrcplan.cli.terminal import Terminal
        from hrcplan.collaboration import collaborate
        from hrcplan.collaboration.adviser import Adviser
        from hrcplan.collaboration.persons import ReportedPerson

        human = str(setup.human["name"])
        if human not in (ME, LINK):
            course = collaborate.course_of(self.bank, setup.seed)
            parts = collaborate.simulated(
                setup, self.bank, course, human, robot=self.robot, speed=self.speed
            )
            self.narrator = Narrator(setup, parts.adviser)
        else:
            adviser = Adviser(setup, self.bank, collaborate.assistant_of(setup))
            self.narrator = Narrator(setup, adviser)
            person = ReportedPerson() if human == LINK else Terminal(self.narrator, InputLines())
            parts = collaborate.parts_with(
                setup, self.bank, adviser, person, robot=self.robot, speed=self.speed
            )
        _begin(setup)
        if self.past is not None and not output.JSON:
            output.result(output.fold(f"· going on with {self.past}"))
        return parts

    def watch(
        self, run: CompanionRun, event: SharedEvent, commands: tuple[SharedCommand, ...]
    ) -> None:
        """Print one step of the machine."""
        if self.narrator is not None:
            self.narrator.watch(run, event, commands)


def _begin(setup: CollaborationSetup) -> None:
    """Print what the collaboration is about."""
    if output.JSON:
        output.document({
            "domain": setup.problem.domain.name, "goals": list(setup.goals), "pace": setup.pace,
            "method": setup.method, "people": list(setup.people),
            "robots": sorted(setup.robots), "pddl_sha256": setup.pddl_sha256,
        })  # fmt: skip
        return
    people, machines = ", ".join(setup.people), ", ".join(sorted(setup.robots))
    goals = plural(len(setup.goals), "goal")
    line = f"{setup.problem.domain.name}: {goals}, people {people}, robots {machines}"
    output.result(output.fold(line))


def _finish(done: Collaboration) -> None:
    """Print what the collaboration came to."""
    outcome = done.outcome
    if output.JSON:
        output.document({"outcome": outcome.to_json()})
        return
    why = f" ({outcome.why})" if outcome.why else ""
    unit = " s" if done.setup.pace != TURNS or done.setup.has_one_goal else " turns"
    line = (
        f"{outcome.ending}{why}: {outcome.done_human} human and {outcome.done_robot} robot "
        f"actions, {outcome.failed} failed, {outcome.duration_s:g}{unit}"
    )
    output.result(f"\n{output.fold(line)}")
