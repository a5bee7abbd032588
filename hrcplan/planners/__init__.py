"""Planners: adapters, searches of our own, a portfolio of them, and one checked result type.

**What a planner is.** An object with a ``card`` (`Capabilities`), ``missing()`` and
``solve(request)``; see `contract.Planner`. ``solve`` gets a `Request` (problem, deadline, memory,
whether the first plan is enough) and returns an `Answer` for whatever can happen to a search:
solved, unsolvable, out of time. It raises

* `UnsupportedError` for a task outside its card,
* `MissingPlannerError` if a program or package is not there,
* `PlannerError` if the program crashes.

**What is believed of it.** A plan counts after a replay in hrcplan's own semantics; the figures
are those of the replay. "Optimal" counts if the planner's figure is that of the replay, until a
better plan is seen. "Unsolvable" counts from a search of hrcplan's own (``card.own``), or from two
planners. A ``bound`` says what no plan can be better than; it comes from searches that count
exactly.

**How planners are asked.** `solve` with ``auto`` runs them side by side (`race`), the most
promising first (`choice`), each in a copy of this process that can be ended at any time
(`workers`), and puts together what they say (`portfolio`). ``execute`` asks them one after the
other in a fixed order. A planner object is asked in this process.

``names()`` lists the planners that have a name of their own, and ``make(name)`` returns one.
"""

from hrcplan.planners.contract import Answer, Capabilities, Planner, Request, Status
from hrcplan.planners.registry import make, names

__all__ = ["Answer", "Capabilities", "Planner", "Request", "Status", "make", "names"]
