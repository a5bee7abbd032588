"""Observed actions to steps: as text, tuples or a plan; with or without the agent named."""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from hrcplan.bank import Goals, StepTable
from hrcplan.bank.ramirez_geffner import read_actions
from hrcplan.core.text import nearest
from hrcplan.errors import PlanFormatError, UsageError
from hrcplan.pddl.conventions import robots
from hrcplan.pddl.source import read_text
from hrcplan.plans import Plan, PlannedAction, parse_plan

_TIMES = re.compile(r"^[^\S\n]*+[\d.]++[^\S\n]*+:|\[[\d.]++\]", re.MULTILINE)

ObservedWords = tuple[str, ...]
"""An action's name and its objects, in lower case."""
ObservedAction = str | PlannedAction | Sequence[str]
"""An action as ``"(get human yogurt)"``, of a plan, or as ``("get", "human", "yogurt")``."""
Observations = str | Path | Plan | Iterable[ObservedAction]
"""Actions as text or a file's path (one a line), as a plan, or one after the other."""


def observed_words(actions: Observations) -> tuple[ObservedWords, ...]:
    r"""Return observed actions as words.

    Args:
        actions: Text has parentheses, or it is the path of a file.

    Raises:
        InputError: if a file cannot be read.
        UsageError: if an element is no action.

    >>> observed_words("(get yogurt)\n0.5: (GET glass) [1.0]")
    (('get', 'yogurt'), ('get', 'glass'))
    >>> observed_words(["(get yogurt)", ("get", "glass")])
    (('get', 'yogurt'), ('get', 'glass'))
    """
    if isinstance(actions, Plan):
        actions = actions.actions
    if isinstance(actions, Path) or (isinstance(actions, str) and "(" not in actions):
        actions = read_text(actions)
    if isinstance(actions, str):
        return _words_in(actions)
    if not isinstance(actions, Iterable):
        raise _no_action(actions, "a list of actions")
    return tuple(_words_of(action) for action in actions)


def _words_of(action: ObservedAction) -> ObservedWords:
    if isinstance(action, PlannedAction):
        return (action.name, *action.args)
    if isinstance(action, str):
        lines = _words_in(action)
        if len(lines) != 1:
            raise _no_action(action, "one action")
        return lines[0]
    if not isinstance(action, Sequence) or not all(isinstance(word, str) for word in action):
        raise _no_action(action, "an action")
    return tuple(word.lower() for word in action)


def _words_in(text: str) -> tuple[ObservedWords, ...]:
    """Return the actions of a plan in any form that ``validate`` reads, or one a line."""
    try:
        return tuple((action.name, *action.args) for action in parse_plan(text).actions)
    except PlanFormatError:
        return read_actions(_TIMES.sub(" ", text))


def _no_action(value: Hashable, what: str) -> UsageError:
    hint = "an action is '(get human yogurt)' or ('get', 'human', 'yogurt')"
    return UsageError(f"{value!r:.80} is not {what}", code="bad-action", hint=hint)


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
