"""Our own proving planner for schedules of several agents, with a weighted metric of cost and time.

A* over left-shifted schedules in which an instant may hold several starts one after the other
and no gaps are needed (*epsilon-free*); gaps are added on output. ``frame.py`` says which tasks it
takes and why, ``search.py`` what it searches, ``estimates.py`` what bounds the search from below,
``symmetry.py`` what it leaves out, ``proof.py`` in which order all this is done.
"""

from hrcplan.planners.exact.planner import ExactPlanner

__all__ = ["ExactPlanner"]
