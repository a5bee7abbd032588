"""Problems as planners are given them: with guards, and with names that any planner can read.

Plans come back in the names of the task.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field, replace
from itertools import count

from hrcplan.pddl.guards import guarded
from hrcplan.pddl.memory_facts import with_memory_facts
from hrcplan.pddl.model import Problem
from hrcplan.pddl.renaming import renamed
from hrcplan.pddl.single_types import with_single_types
from hrcplan.pddl.write import domain_text, problem_text
from hrcplan.plans import Plan, PlannedAction, parse_plan

KEYWORDS = frozenset([
    "all", "always", "always-within", "and", "assign", "at-most-once", "decrease", "define",
    "domain", "either", "end", "exists", "forall", "hold-after", "hold-during", "imply",
    "increase", "is-violated", "maximize", "minimize", "not", "number", "oneof", "or", "over",
    "preference", "problem", "scale-down", "scale-up", "sometime", "sometime-after",
    "sometime-before", "start", "when", "within",
])  # fmt: skip
"""Words that the grammar of some planner knows wherever they stand."""
_PLAIN = re.compile(r"[a-z0-9_][a-z0-9_-]*")
_STRANGE = re.compile(r"[^a-z0-9_-]")
"""Characters that some planner takes for the end of a name, such as ``+`` and ``@``."""


@dataclass(frozen=True)
class Handover:
    """A problem as a planner is to read it, and the old names by the new ones.

    What may have no value is guarded, nothing is called like a keyword, and names are of plain
    characters.
    """

    problem: Problem
    names: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        problem: Problem,
        *,
        single_types: bool = False,
        memory_facts: bool = False,
        guards: bool = True,
        fills: bool = True,
    ) -> Handover:
        """Return the form of a problem for planners; most problems stay as they are.

        ``single_types`` is for planners that read no ``(either …)``, ``memory_facts`` for those
        whose effects at the end read no condition at the start. ``guards`` and ``fills`` say what
        is done about functions without a value, see `guarded`.

        >>> from hrcplan.pddl.inputs import read
        >>> problem = read("transport", "two-boxes")
        >>> Handover.of(problem).problem is problem
        True
        """
        problem = guarded(problem, fills=fills) if guards else problem
        problem = with_memory_facts(problem) if memory_facts else problem
        problem = with_single_types(problem) if single_types else problem
        words = set(_names(problem))
        unsafe = sorted(word for word in words if word in KEYWORDS or not _PLAIN.fullmatch(word))
        if not unsafe:
            return cls(problem)
        new = _new_names(unsafe, words)
        return cls(renamed(problem, new), {name: word for word, name in new.items()})

    @property
    def texts(self) -> tuple[str, str]:
        """The domain and the problem as PDDL."""
        return domain_text(self.problem.domain), problem_text(self.problem)

    def plan(self, text: str) -> Plan:
        """Return the plan of a text in the names of the task.

        The line with ``@``, which says when a plan of PDDL+ ends, is no action.
        """
        lines = (line for line in text.splitlines() if "@" not in line)
        return self.restored(parse_plan("\n".join(lines)))

    def restored(self, plan: Plan) -> Plan:
        """Return a plan of the planner in the names of the task."""
        return Plan(tuple(map(self._action, plan.actions))) if self.names else plan

    def _action(self, action: PlannedAction) -> PlannedAction:
        args = tuple(self.names.get(arg, arg) for arg in action.args)
        return replace(action, name=self.names.get(action.name, action.name), args=args)


def _names(problem: Problem) -> Iterator[str]:
    """Yield what a problem and its domain declare."""
    domain = problem.domain
    yield from (*domain.types, *problem.all_objects, *domain.predicates, *domain.functions)
    yield from (action.name for action in (*domain.actions, *domain.processes, *domain.events))
    yield from (domain.name, problem.name)


def _new_names(unsafe: Sequence[str], words: Set[str]) -> dict[str, str]:
    """Return names of plain letters, digits, hyphens and underscores that nothing else has."""
    numbers: dict[str, Iterator[int]] = defaultdict(lambda: count(1))
    names = {}
    for word in unsafe:
        plain = _STRANGE.sub("-", word)
        plain = plain if plain[:1].isalpha() else f"n{plain}"
        names[word] = next(
            name for i in numbers[plain] if (name := f"{plain}-{i}") not in words
        )  # fmt: skip
    return names
