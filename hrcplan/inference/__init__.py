"""Goal inference: beliefs about the human's goal, updated with each observed step.

The short way: ``infer(bank, actions)``. Every belief keeps the protocol of `Belief`.
"""

from hrcplan.inference.belief import Belief, BeliefState, GoalChange, batch
from hrcplan.inference.belief import BeliefState as State  # its name in version 0.1
from hrcplan.inference.run import Ignored, Inference, infer

__all__ = ["Belief", "BeliefState", "GoalChange", "Ignored", "Inference", "State", "batch", "infer"]
