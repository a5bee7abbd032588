"""What a page has to know of a run before anything happens."""

from __future__ import annotations

from typing import Any

from hrcplan.agents.state import AgentModel
from hrcplan.collaboration.setup import TURNS, CollaborationSetup
from hrcplan.pddl.conventions import people, robots
from hrcplan.pddl.model import Problem
from hrcplan.web.scene import scene_of


def collaboration_head(setup: CollaborationSetup) -> dict[str, Any]:
    """Return the head of a collaboration, as a JSON object."""
    is_timed = setup.pace != TURNS or setup.has_one_goal
    return {
        **_head(setup.problem), "goals": list(setup.goals), "pace": setup.pace,
        "method": setup.method, "people": list(setup.people),
        "unit": "s" if is_timed and setup.problem.domain.is_temporal else "steps",
    }  # fmt: skip


def execution_head(problem: Problem) -> dict[str, Any]:
    """Return the head of a plan that is carried out, as a JSON object."""
    return {**_head(problem), "unit": "s" if problem.domain.is_temporal else "steps"}


def _head(problem: Problem) -> dict[str, Any]:
    agents = AgentModel(problem)
    states = {
        " ".join(key): {"value": float(low), "range": [float(v) for v in agents.value_range(key)]}
        for key, low in agents.low.items()
    }
    return {
        "domain": problem.domain.name, "problem": problem.name, "states": states,
        "people": sorted(people(problem)), "robots": sorted(robots(problem)),
        "scene": scene_of(problem),
    }  # fmt: skip
