"""Agent state: its elements and sensed values, and the function values that planners get."""

from hrcplan.agents.profile import REPLAN_ALWAYS, Profile, load_profile, profile, profile_names
from hrcplan.agents.state import AgentModel

__all__ = [
    "REPLAN_ALWAYS",
    "AgentModel",
    "Profile",
    "load_profile",
    "profile",
    "profile_names",
]
