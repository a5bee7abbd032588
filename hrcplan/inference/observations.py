"""Observed words to steps: names that are declared twice, agents that are named or not."""

from __future__ import annotations

from dataclasses import dataclass

from hrcplan.bank import Goals, StepTable
from hrcplan.core.text import nearest
from hrcplan.pddl.conventions import robots


@dataclass(frozen=True, slots=True)
class Resolved:
    """A step, and whether the robot did it."""

    step: int
    robot: bool


class Resolver:
    """Finds the step that an observed action names.

    Args:
        table: The steps.
        goals: The goals; their aliases tell actions of one name apart.
    """

    def __init__(self, table: StepTable, goals: Goals) -> None:
        self.table, self.problem = table, goals.problem
        self.aliases = goals.aliases or {}
        self.robots = robots(goals.problem)
        self.agents = frozenset(goals.problem.agents)
        self._named: dict[tuple[str, ...], list[int]] = {}
        for step in range(len(table)):
            self._named.setdefault(table[step].name, []).append(step)

    def find(self, words: tuple[str, ...], world: int) -> Resolved | str:
        """Return the step and whether the robot did it, or why there is none.

        Where words fit several steps, it is the first that can be done in ``world``.
        """
        if not words:
            return "no action is named"
        by_robot = len(words) > 1 and words[1] in self.robots
        found: list[int] = []
        for name in self.aliases.get(words[0], (words[0],)):
            step = self.table.find((name, *words[1:]))
            found += [step] if step is not None else self._without_agent((name, *words[1:]))
        if not found:
            return self._why_not(words)
        can = (step for step in found if self.table.successor(world, step) is not None)
        return Resolved(next(can, found[0]), by_robot)

    def _without_agent(self, words: tuple[str, ...]) -> list[int]:
        """Return the steps of this name, those of the human first, where no agent is named."""
        if self.agents.intersection(words):
            return []
        steps = self._named.get(words, [])
        return sorted(steps, key=lambda step: not self.robots.isdisjoint(self.table[step].words))

    def _why_not(self, words: tuple[str, ...]) -> str:
        known = {action.name for action in self.problem.domain.actions} | self.aliases.keys()
        if words[0] not in known:
            hint = nearest(words[0], sorted(known))
            return f"there is no action '{words[0]}'" + (f" ({hint})" if hint else "")
        for word in words[1:]:
            if word not in self.problem.all_objects:
                return f"there is no object '{word}'"
        return "this can never be done, or changes nothing"
