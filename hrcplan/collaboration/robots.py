"""The robots of collaborations by name: those that weigh goal and agent state, and all assistants.

Each of the first leaves a part out, so that a study can say what the part is worth.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from hrcplan.assistance.assistant import Assistant
from hrcplan.assistance.joint_help import JointHelp, JointOracle, UniformBelief
from hrcplan.assistance.registry import ASSISTANTS
from hrcplan.bank import Bank
from hrcplan.core.text import nearest
from hrcplan.errors import UsageError

JOINT = "joint"
ESTIMATED = "estimated"


@dataclass(frozen=True, slots=True)
class JointRobot:
    """A robot that weighs goal and agent state.

    Attributes:
        make: Makes its assistant from a bank.
        weighs_agents: Whether it looks at agent states; if not, all are low for it.
        knows_goal: Whether people have to say what they want.
        weighs_goal: Whether it infers what they want.
    """

    make: Callable[[Bank], JointHelp]
    weighs_agents: bool = True
    knows_goal: bool = False
    weighs_goal: bool = True


JOINT_ROBOTS: Mapping[str, JointRobot] = {
    JOINT: JointRobot(JointHelp),
    "joint-without-asking": JointRobot(lambda bank: JointHelp(bank, asks=False)),
    "goal-only": JointRobot(JointHelp, weighs_agents=False),
    "state-only": JointRobot(
        lambda bank: JointHelp(bank, UniformBelief(bank), asks=False), weighs_goal=False
    ),
    "joint-oracle": JointRobot(lambda bank: JointOracle(bank, asks=False), knows_goal=True),
}
"""``goal-only`` infers the goal and takes agents as they are at first, ``state-only`` the other way
round; ``joint-oracle`` knows the goal, and the agent state where that is sensed."""


def check_robot(name: str, *, is_typed: bool = True) -> None:
    """Check that there is a robot of this name.

    Args:
        name: The name.
        is_typed: Whether a user has named it, and may load code with ``module:Class``.

    Raises:
        UsageError: if there is none.
    """
    if name in JOINT_ROBOTS:
        return
    try:
        ASSISTANTS.find(name) if is_typed else ASSISTANTS.find_listed(name)
    except UsageError as error:
        if ":" not in name and error.code == "unknown-method":
            error.hint = nearest(name, [*JOINT_ROBOTS, *ASSISTANTS.names()]) or error.hint
        raise


def assistant_maker(name: str) -> Callable[[Bank], Assistant[Any]]:
    """Return what makes the assistant of a robot from a bank."""
    robot = JOINT_ROBOTS.get(name)
    return (lambda bank: ASSISTANTS.make(name, bank)) if robot is None else robot.make
