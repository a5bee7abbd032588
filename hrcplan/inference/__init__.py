"""Goal inference: beliefs about what someone is after, from one observed step after the other.

The short way: ``infer(bank, actions)``. Every belief keeps the protocol of `Belief`.
"""

from hrcplan.inference.belief import Belief, State, batch
from hrcplan.inference.changes import GoalChange
from hrcplan.inference.run import Ignored, Inference, infer

__all__ = ["Belief", "GoalChange", "Ignored", "Inference", "State", "batch", "infer"]
