"""What is known about agents: their sensed state, and what the planner is told of it."""

from hrcplan.agents.profile import Profile, profile, profile_names
from hrcplan.agents.state import AgentModel

__all__ = ["AgentModel", "Profile", "profile", "profile_names"]
