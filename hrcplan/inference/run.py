"""From observed actions to a posterior after each of them: what ``hrcplan infer`` does."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from statistics import fmean
from typing import Any, Protocol, runtime_checkable

from hrcplan.bank import Bank, Goals, StepTable, build
from hrcplan.bank.ramirez_geffner import OBSERVATIONS, is_folder, read_instance
from hrcplan.bank.team import humans_in
from hrcplan.core import svg
from hrcplan.core.deprecation import warn_old_name
from hrcplan.core.text import cut, plural
from hrcplan.errors import InputError, LimitError, UsageError
from hrcplan.inference.belief import (
    Belief,
    BeliefState,
    DetectsChanges,
    GoalChange,
    HasSteps,
    ObservesFacts,
    Remarks,
    S,
    WeighsChanges,
)
from hrcplan.inference.observations import (
    Observations,
    ObservedWords,
    Resolver,
    check_observations,
    observed_words,
)
from hrcplan.inference.registry import (
    BANK_METHOD,
    GOALS_METHOD,
    METHODS,
    takes_facts,
    takes_goals,
)
from hrcplan.inference.traces import is_trace

BUILD_S = 20.0  # for plan graphs of a folder that is no bank
HUMAN, TEAM = GOALS_PER = ("human", "team")
"""Whose goals are inferred: each human has a goal of its own, or all humans share one."""
UNKNOWN_HUMAN = "it is not said which human did this"


@dataclass(frozen=True, slots=True)
class Ignored:
    """An observation without effect, and why."""

    at: int
    action: str
    reason: str


@dataclass(frozen=True)
class Inference:
    """The posterior of the goals after each of several observed actions.

    Attributes:
        goals: The goals' names, in order.
        actions: The observed actions, one a line.
        posterior: The probability of each goal, before any observation and after each.
        changes: Where the goal probably changed.
        ignored: The observations without effect; their row repeats the one before.
        method: The name of the method.
        note: A remark of the method, such as that it used estimates; None if there is none.
        changed: The probability, given all observations, that the goal has changed at all; None if
            the method does not say.
        humans: Where each human has a goal of its own, what is inferred of each, by name. The
            posterior is then the mean over the humans, the changes are those of all, and
            ``changed`` is the probability that any goal has changed.
    """

    goals: tuple[str, ...]
    actions: tuple[str, ...]
    posterior: tuple[tuple[float, ...], ...]
    changes: tuple[GoalChange, ...]
    ignored: tuple[Ignored, ...]
    method: str
    note: str | None = None
    changed: float | None = None
    humans: Mapping[str, Inference] = field(default_factory=dict)

    def __repr__(self) -> str:
        row = self.posterior[-1]
        best = max(range(len(row)), key=row.__getitem__)
        size = f"{plural(len(self.actions), 'action')}, {plural(len(self.changes), 'change')}"
        goal = f"{row[best]:.0%} {cut(self.goals[best], 80)}"
        return f"<Inference by {cut(self.method, 40)}: {size}, now {goal}>"

    def _repr_html_(self) -> str:
        """Return the posterior as a picture: the goals that were likeliest over all steps."""
        columns = [list(column) for column in zip(*self.posterior, strict=True)]
        order = sorted(range(len(columns)), key=lambda goal: -sum(columns[goal]))[: len(svg.COLORS)]
        marks = [change.at + 0.5 for change in self.changes]
        return svg.lines([(self.goals[goal], columns[goal]) for goal in order], marks)

    def rows(self) -> list[dict[str, str | int | float | bool | None]]:
        """Return one row per observation and goal, the prior first, for ``pandas.DataFrame``.

        Keys: ``observation`` (0 is the prior), ``action`` (None for the prior), ``goal``,
        ``probability``, ``ignored``.
        """
        ignored = {i.at for i in self.ignored}
        actions = [None, *self.actions]
        return [
            {"observation": at, "action": actions[at], "goal": goal, "probability": p,
             "ignored": at - 1 in ignored}
            for at, row in enumerate(self.posterior)
            for goal, p in zip(self.goals, row, strict=True)
        ]  # fmt: skip

    def as_json(self) -> dict[str, Any]:
        """Return the JSON document of ``hrcplan infer``."""
        keys = ("posterior", "changed", "changes")
        humans = {who: one.as_json() for who, one in self.humans.items()}
        return {
            "goals": list(self.goals),
            "posterior": [list(row) for row in self.posterior],
            "changed": self.changed,
            "changes": [self._change(change) for change in self.changes],
            "ignored": [{"at": i.at, "action": i.action, "reason": i.reason} for i in self.ignored],
            "method": self.method,
            "note": self.note,
            "humans": {who: {key: one[key] for key in keys} for who, one in humans.items()},
        }

    def _change(self, change: GoalChange) -> dict[str, Any]:
        goals = [None if i is None else self.goals[i] for i in (change.before, change.after)]
        return {
            "at": change.at,
            "probability": change.probability,
            "first": change.at if change.first is None else change.first,
            "last": change.at if change.last is None else change.last,
            "from": goals[0],
            "to": goals[1],
        }


def infer(
    source: str | Path | Bank | Goals,
    actions: Observations | None = None,
    method: str | None = None,
    goals_per: str = TEAM,
    **options: Any,
) -> Inference:
    """Return the posterior of the goals after each observed action.

    Args:
        source: A bank (or its file), or goals (or a folder with ``template.pddl``, ``hyps.dat``).
        actions: Observed actions: a list whose elements are ``"(get human yogurt)"`` or
            ``("get", "human", "yogurt")``, a `Plan`, text with one action a line, or the path of
            such a file; by default the folder's ``obs.dat``. Actions of the robot change the world,
            but they are no evidence.
        method: ``exact``, ``switching``, ``forest``, ``recursive``, ``cost``, one that another
            package has registered, or ``module:Class``. Default: ``switching`` for a bank, else
            ``cost``.
        goals_per: ``team`` if all humans share a goal, or ``human`` if each has one of its own:
            then the actions of the others are no evidence of it.
        options: Passed on to the method.

    Raises:
        InputError: if a file is missing or has faults.
        UsageError: if there is no such method, or an argument is of a wrong type or value.
        LimitError: if a method needs plan graphs that do not fit.

    >>> from hrcplan.bank import build_bank
    >>> infer(build_bank("kitchen", only=["pasta-bean", "pasta-tomato"]), ["(get human beans)"])
    <Inference by switching: 1 action, 0 changes, now 98% pasta-bean>
    """
    if goals_per not in GOALS_PER:
        raise UsageError(f"goals are per {' or '.join(GOALS_PER)}, not per '{goals_per}'")
    bank_or_goals, observed_in_folder = _load(source)
    goals = bank_or_goals.goals if isinstance(bank_or_goals, Bank) else bank_or_goals
    words = observed_in_folder if actions is None else observed_words(actions, goals.problem)
    if words is None:
        hint = "a file with one action a line"
        raise InputError("no observed actions are given", code="no-actions", hint=hint)
    name = method or (BANK_METHOD if isinstance(bank_or_goals, Bank) else GOALS_METHOD)
    kind = METHODS.find(name)
    path = _path_of(source if actions is None else actions)
    check_observations(words, goals, path, facts=takes_facts(kind))
    if takes_goals(kind):
        belief = METHODS.make(name, goals, **options)
        resolver = Resolver(steps_of(belief, StepTable(goals.task)), goals)
        return _run_per_human(humans_in(goals.problem), goals_per, words, name,
                              lambda human: (belief, resolver))  # fmt: skip
    bank = bank_or_goals if isinstance(bank_or_goals, Bank) else _bank_of(bank_or_goals)

    def of_human(human: str | None) -> tuple[Belief[Any], Resolver]:
        own = bank if human is None else bank.for_human(human)
        belief = METHODS.make(name, own, **options)
        return belief, Resolver(steps_of(belief, bank.table), bank.goals)

    inference = _run_per_human(bank.humans, goals_per, words, name, of_human)
    notes = filter(None, [bank.note, inference.note])
    return replace(inference, note="; ".join(notes) or None)


def _run_per_human(
    humans: Sequence[str], goals_per: str, words: Sequence[ObservedWords], method: str,
    make: Callable[[str | None], tuple[Belief[Any], Resolver]],
) -> Inference:  # fmt: skip
    """Return what is inferred of all humans together, or of each by itself."""
    if goals_per == TEAM or len(humans) < 2:
        return run(*make(None), words, method)
    each = {human: run(*make(human), words, method, human) for human in humans}
    parts = list(each.values())
    chances = [part.changed for part in parts if part.changed is not None]
    ignored = {one.at: one for part in parts for one in part.ignored}
    return replace(
        parts[0],
        posterior=tuple(
            tuple(map(fmean, zip(*rows, strict=True)))
            for rows in zip(*(part.posterior for part in parts), strict=True)
        ),
        changes=tuple(sorted((c for part in parts for c in part.changes), key=lambda c: c.at)),
        ignored=tuple(ignored[at] for at in sorted(ignored)),
        changed=1 - math.prod(1 - chance for chance in chances) if chances else None,
        humans=each,
    )


def _path_of(actions: Observations | Bank | Goals) -> str | None:
    """Return the path that observations are read from; None if they are no file."""
    if isinstance(actions, Path):
        return str(actions / OBSERVATIONS if os.path.isdir(actions) else actions)
    is_path = isinstance(actions, str) and "(" not in actions and not is_trace(actions)
    return _path_of(Path(str(actions))) if is_path else None


def steps_of(belief: Belief[S], default: StepTable) -> StepTable:
    """Return the steps whose indices a belief observes: its own table if it has one."""
    if isinstance(belief, HasSteps) and isinstance(belief.steps, StepTable):
        return belief.steps
    if isinstance(belief, _HasTable) and isinstance(belief.table, StepTable):
        warn_old_name(f"attribute of {type(belief).__name__}", "table", "steps")
        return belief.table
    return default


@runtime_checkable
class _HasTable(Protocol):
    """`HasSteps` as it was called in earlier versions."""

    table: StepTable


def run(
    belief: Belief[S], resolver: Resolver, observations: Sequence[ObservedWords], method: str,
    human: str | None = None,
) -> Inference:  # fmt: skip
    """Return the posterior of a belief after each of several observed actions.

    Args:
        belief: The belief.
        resolver: Finds the step that an action names.
        observations: The actions.
        method: The name of the method.
        human: The only human whose actions are evidence; by default those of all humans are.
    """
    states = [belief.start()]
    ignored: list[Ignored] = []
    for at, words in enumerate(observations):
        state, reason = _observe(belief, resolver, states[-1], words, human)
        states.append(state)
        if reason is not None:
            ignored.append(Ignored(at, f"({' '.join(words)})", reason))
    without_effect = {i.at for i in ignored}
    places = [at for at in range(len(observations)) if at not in without_effect]
    effective = [states[at + 1] for at in places]
    changes = belief.changes(effective) if isinstance(belief, DetectsChanges) else ()
    return Inference(
        tuple(belief.names),
        tuple(f"({' '.join(words)})" for words in observations),
        tuple(tuple(belief.posterior(state).tolist()) for state in states),
        tuple(change.moved(places) for change in changes),
        tuple(ignored),
        method,
        "; ".join(filter(None, [_note(states[-1]) or _note(belief), resolver.note])) or None,
        belief.changed(effective) if isinstance(belief, WeighsChanges) else None,
    )


def _observe(
    belief: Belief[S], resolver: Resolver, state: S, words: ObservedWords, human: str | None
) -> tuple[S, str | None]:
    """Return the belief after one observation, and why that had no effect; None if it had one."""
    if isinstance(belief, ObservesFacts):
        test = resolver.find_fact(words)
        if isinstance(test, str):
            return state, test
        if test is not None:
            after_fact: S = belief.observe_fact(state, test)
            return after_fact, after_fact.ignored
    step = resolver.find(words, state.world)
    if isinstance(step, str):
        return state, step
    agent = resolver.agent_in(words)
    is_others = human is not None and agent != human
    after = belief.observe(state, step.index, robot=step.robot or is_others)
    is_unknown = human is not None and agent is None
    return after, after.ignored or (UNKNOWN_HUMAN if is_unknown else None)


def _note(part: Belief[S] | BeliefState) -> str | None:
    return part.note if isinstance(part, Remarks) else None


def _load(
    source: str | Path | Bank | Goals,
) -> tuple[Bank | Goals, tuple[ObservedWords, ...] | None]:
    """Return bank or goals, and the observed actions of a folder of goals."""
    if isinstance(source, (Bank, Goals)):
        return source, None
    try:
        path = Path(source)
    except TypeError:
        message = f"goals are inferred from a bank, goals, or a path, not from {source!r:.80}"
        raise UsageError(message) from None
    if os.path.isdir(path):
        if not is_folder(path):
            message = f"'{source}' is a folder without template.pddl and hyps.dat"
            hint = "build a bank of problem files with `hrcplan bank build`"
            raise InputError(message, code="no-goals", path=str(source), hint=hint)
        instance = read_instance(path)
        has_observations = os.path.isfile(path / OBSERVATIONS)
        return instance.goals, instance.observations if has_observations else None
    from hrcplan.bank.store import load

    return load(path), None


def _bank_of(goals: Goals) -> Bank:
    try:
        return build(goals, timeout_s=BUILD_S)
    except LimitError as error:
        hint = f"--method {GOALS_METHOD} does without plan graphs"
        raise LimitError(error.message, code=error.code, hint=hint) from None
