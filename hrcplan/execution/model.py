"""What does not change during a run: the problem, its actions, and its agent state."""

from __future__ import annotations

from hrcplan.agents import AgentModel
from hrcplan.execution.action_model import ActionModel
from hrcplan.execution.timed import TimedEvents
from hrcplan.pddl.model import Problem
from hrcplan.planners.expected_price import expected_retries


class ExecutionModel:
    """One problem, prepared for execution; monitor, planner and simulated world share it.

    Attributes:
        problem: The problem as it was read.
        priced_problem: The problem that planners get: interactions cost their expected retries.
        actions: How actions begin, end and fail.
        timed: The timed initial literals.
        agents: The elements of agent state, and which actions they touch.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.priced_problem = expected_retries(problem)
        self.actions = ActionModel(problem)
        self.timed = TimedEvents(problem)
        self.agents = AgentModel(problem)

    def __repr__(self) -> str:
        return f"ExecutionModel({self.problem.domain.name}/{self.problem.name})"

    def is_human(self, agent: str) -> bool:
        """Return whether an agent takes no commands; "" (no agent) is not a human."""
        return bool(agent) and agent not in self.agents.robots
