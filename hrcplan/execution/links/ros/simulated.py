"""The simulated robot of ROS 2: what it serves follows from a mapping file and a problem."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

from hrcplan.errors import MissingPlannerError
from hrcplan.execution.links.ros.filling import FilledMapping
from hrcplan.execution.links.ros.link import ros_environment, ros_python
from hrcplan.execution.links.ros.mapping import RosMapping, read_mapping
from hrcplan.pddl.model import Problem

ROBOT = Path(__file__).with_name("robot.py")


def robot_options(problem: Problem, mapping: RosMapping | None) -> dict[str, Any]:
    """Return what a simulated robot serves: action servers, or performers without a mapping.

    Raises:
        InputError: if the mapping does not fit the problem.
    """
    if mapping is None:
        filled = FilledMapping(RosMapping(Path()), problem, are_actions_known=True)
        return {"performers": [a.name for a in problem.domain.actions if filled.is_served(a)]}
    orders = (order for _, order in FilledMapping(mapping, problem).samples())
    servers = sorted({(str(order["type"]), str(order["name"])) for order in orders})
    return {"servers": [list(server) for server in servers]}


def run_robot(
    problem: Problem, mapping: str | None, python: str | None = None, **behaviour: float | None
) -> int:
    """Run a simulated robot until it is ended, and return its exit code.

    Args:
        problem: The problem.
        mapping: The mapping file; None for performers of PlanSys2.
        python: The Python of ROS.
        behaviour: ``seconds``, ``fail``, ``deaf_after``, ``die_after`` and ``seed``.

    Raises:
        InputError: if the mapping file has a fault, or does not fit the problem.
        MissingPlannerError: if there is no such Python.
    """
    file = None if mapping is None else read_mapping(Path(mapping))
    options = {**robot_options(problem, file), **behaviour}
    argv = [python or ros_python(), str(ROBOT), json.dumps(options)]
    environment = ros_environment(file or RosMapping(Path()))
    try:
        return subprocess.run(argv, env=environment, check=False).returncode
    except OSError as error:
        hint = "--ros-python PATH names the Python that has ROS"
        raise MissingPlannerError(f"{argv[0]} cannot be started: {error}", hint=hint) from None
