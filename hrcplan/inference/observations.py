"""Observed actions to steps: as text, tuples or a plan; with or without the agent named."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence, Set
from dataclasses import dataclass
from pathlib import Path

from hrcplan.bank import Goals, StepTable
from hrcplan.bank.ramirez_geffner import read_actions
from hrcplan.core.text import cut, nearest, quote
from hrcplan.errors import InputError, UsageError
from hrcplan.inference.traces import is_trace, observed_in
from hrcplan.pddl.conventions import robots
from hrcplan.pddl.model import Problem
from hrcplan.pddl.source import read_text
from hrcplan.plans import Plan, PlannedAction
from hrcplan.task.conditions import Test

ObservedWords = tuple[str, ...]
"""An action's name and its objects, in lower case."""
ObservedAction = str | PlannedAction | Sequence[str]
"""An action as ``"(get human yogurt)"``, of a plan, or as ``("get", "human", "yogurt")``."""
Observations = str | Path | Plan | Iterable[ObservedAction]
"""Actions as text or a file's path (one a line), as a plan, or one after the other."""


def observed_words(
    actions: Observations, problem: Problem | None = None
) -> tuple[ObservedWords, ...]:
    r"""Return observed actions as words.

    Args:
        actions: Text has parentheses or is a trace (`hrcplan.inference.traces`), or it is the path
            of a file.
        problem: Its domain names the actions, so that a planner's log can be read; a trace has to
            be of this problem's world.

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
    path: str | None = None
    is_text = isinstance(actions, str) and ("(" in actions or is_trace(actions))
    if isinstance(actions, Path | str) and not is_text:
        path, actions = str(actions), read_text(actions)
    if isinstance(actions, str) and is_trace(actions):
        return observed_in(actions, problem, path)
    if isinstance(actions, str):
        return read_actions(actions, problem)
    if not isinstance(actions, Iterable):
        raise _no_action(actions, "a list of actions")
    return tuple(_words_of(action) for action in actions)


def _words_of(action: ObservedAction) -> ObservedWords:
    if isinstance(action, PlannedAction):
        return (action.name, *action.args)
    if isinstance(action, str):
        lines = read_actions(action)
        if len(lines) != 1:
            raise _no_action(action, "one action")
        return lines[0]
    if not isinstance(action, Sequence) or not all(isinstance(word, str) for word in action):
        raise _no_action(action, "an action")
    return tuple(word.lower() for word in action)


def _no_action(value: Hashable, what: str) -> UsageError:
    hint = "an action is '(get human yogurt)' or ('get', 'human', 'yogurt')"
    return UsageError(f"{value!r:.80} is not {what}", code="bad-action", hint=hint)


def check_observations(
    observations: Sequence[ObservedWords], goals: Goals, path: str | None = None, *,
    facts: bool = False,
) -> None:  # fmt: skip
    """Check that observations speak of the goals' domain at all.

    Args:
        observations: The observations.
        goals: The goals.
        path: The file they are from.
        facts: Whether facts are taken as observations, too.

    Raises:
        InputError: if none of them has the name of an action.
    """
    names = _action_names(goals)
    lines = [words for words in observations if words]
    if not lines or any(words[0] in names or (facts and _is_fact(words, goals)) for words in lines):
        return
    if _is_fact(lines[0], goals):
        what = cut(" ".join(lines[0]), 80)
        message = f"the observations are facts such as ({what}), which only method cost takes"
    else:
        message = f"no observation is an action of domain {quote(goals.problem.domain.name)}"
    hint = f"actions: {cut(', '.join(sorted(names)), 120)}"
    raise InputError(message, code="no-actions", path=path, hint=hint)


def _action_names(goals: Goals) -> Set[str]:
    aliases = goals.aliases or {}
    return {action.name for action in goals.problem.domain.actions} | aliases.keys()


def _is_fact(words: ObservedWords, goals: Goals) -> bool:
    name = words[1] if words[0] == "not" and len(words) > 1 else words[0]
    return name in goals.problem.domain.predicates and name not in _action_names(goals)


@dataclass(frozen=True, slots=True)
class ObservedStep:
    """A step, as its index, and whether the robot did it."""

    index: int
    robot: bool


class Resolver:
    """Finds the step that an observed action names.

    Args:
        table: The steps.
        goals: The goals; their aliases tell actions of one name apart.
    """

    def __init__(self, table: StepTable, goals: Goals) -> None:
        self.table, self.goals, self.problem = table, goals, goals.problem
        self.aliases = goals.aliases or {}
        self.robots = robots(goals.problem)
        self.agents = frozenset(goals.problem.agents)
        self._steps_by_name: dict[tuple[str, ...], list[int]] = {}
        for step in range(len(table)):
            self._steps_by_name.setdefault(table[step].name, []).append(step)

    @property
    def note(self) -> str | None:
        """Which actions are declared more than once; None if none is."""
        if not self.aliases:
            return None
        names = ", ".join(f"{name} ({len(steps)})" for name, steps in self.aliases.items())
        return f"actions are declared more than once, and the applicable one is meant: {names}"

    def find(self, words: tuple[str, ...], world: int) -> ObservedStep | str:
        """Return the step and whether the robot did it, or why there is none.

        Where words fit several steps, it is the first that can be done in ``world``.
        """
        if not words:
            return "no action is named"
        by_robot = len(words) > 1 and words[1] in self.robots
        steps: list[int] = []
        for name in self.aliases.get(words[0], (words[0],)):
            step = self.table.find((name, *words[1:]))
            steps += [step] if step is not None else self._without_agent((name, *words[1:]))
        if not steps:
            return self._why_not(words)
        can = (step for step in steps if self.table.successor(world, step) is not None)
        return ObservedStep(next(can, steps[0]), by_robot)

    def find_fact(self, words: ObservedWords) -> Test | str | None:
        """Return the test of an observed fact, such as ``("not", "at", "ann", "hall")``.

        It is None if the words name no fact, and a reason if no action changes it.
        """
        if not words or not _is_fact(words, self.goals):
            return None
        is_true = words[0] in self.problem.domain.predicates
        fact = words if is_true else words[1:]
        place = self.goals.task.bits.get(fact)
        if place is None:
            return "no action changes this fact"
        return 1 << place, int(is_true) << place

    def agent_in(self, words: tuple[str, ...]) -> str | None:
        """Return the agent that an observed action names; None if it names none."""
        return next((word for word in words[1:] if word in self.agents), None)

    def _without_agent(self, words: tuple[str, ...]) -> list[int]:
        """Return the steps of this name, those of the human first, where no agent is named."""
        if self.agents.intersection(words):
            return []
        steps = self._steps_by_name.get(words, [])
        return sorted(steps, key=lambda step: not self.robots.isdisjoint(self.table[step].words))

    def _why_not(self, words: tuple[str, ...]) -> str:
        names = _action_names(self.goals)
        if _is_fact(words, self.goals):
            return "this is a fact, not an action"
        if words[0] not in names:
            hint = nearest(words[0], sorted(names))
            return f"there is no action '{words[0]}'" + (f" ({hint})" if hint else "")
        for word in words[1:]:
            if word not in self.problem.all_objects:
                return f"there is no object '{word}'"
        return "this can never be done, or changes nothing"
