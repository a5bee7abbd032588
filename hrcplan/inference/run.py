"""From observed actions to a posterior after each of them: what ``hrcplan infer`` does."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hrcplan.bank import Bank, Goals, StepTable, build
from hrcplan.bank.ramirez_geffner import OBSERVATIONS, is_folder, read_actions, read_instance
from hrcplan.core import svg
from hrcplan.core.text import cut, plural
from hrcplan.errors import InputError, LimitError
from hrcplan.inference.changes import GoalChange
from hrcplan.inference.observations import Resolver
from hrcplan.inference.registry import BANK_METHOD, GOALS_METHOD, METHODS, takes_goals
from hrcplan.pddl.source import read_text

BUILD_S = 20.0  # for plan graphs of a folder that is no bank
_TIMES = re.compile(r"^\s*[\d.]+\s*:|\[[\d.]+\]", re.MULTILINE)

ObservedWords = tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Ignored:
    """An observation that told nothing, and why."""

    at: int
    action: str
    reason: str


@dataclass(frozen=True)
class Inference:
    """What follows from observed actions.

    Attributes:
        goals: The goals' names, in order.
        actions: The observed actions, one a line.
        posterior: The probability of each goal, before any observation and after each.
        changes: Where the goal probably changed.
        ignored: The observations that told nothing; their row repeats the one before.
        method: The name of the method.
        note: What the method had to do more cheaply; None if nothing.
    """

    goals: tuple[str, ...]
    actions: tuple[str, ...]
    posterior: tuple[tuple[float, ...], ...]
    changes: tuple[GoalChange, ...]
    ignored: tuple[Ignored, ...]
    method: str
    note: str | None = None

    def __repr__(self) -> str:
        row = self.posterior[-1]
        best = max(range(len(row)), key=row.__getitem__)
        seen = f"{plural(len(self.actions), 'action')}, {plural(len(self.changes), 'change')}"
        goal = f"{row[best]:.0%} {cut(self.goals[best], 80)}"
        return f"<Inference by {cut(self.method, 40)}: {seen}, now {goal}>"

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
        return {
            "goals": list(self.goals),
            "posterior": [list(row) for row in self.posterior],
            "changes": [{"at": c.at, "probability": c.probability} for c in self.changes],
            "ignored": [{"at": i.at, "action": i.action, "reason": i.reason} for i in self.ignored],
            "method": self.method,
            "note": self.note,
        }


def infer(
    source: str | Path | Bank | Goals,
    actions: str | Path | Sequence[ObservedWords] | None = None,
    method: str | None = None,
    **options: Any,
) -> Inference:
    """Return the posterior of the goals after each observed action.

    Args:
        source: A bank (or its file), or goals (or a folder with ``template.pddl``, ``hyps.dat``).
        actions: Observed actions as ``(name, *objects)``, or a file with one a line; by default
            the folder's ``obs.dat``. Actions of the robot move the world, but are no evidence.
        method: ``exact``, ``switching``, ``forest``, ``recursive``, ``cost``, one that another
            package has registered, or ``module:Class``. Default: ``switching`` for a bank, else
            ``cost``.
        options: Passed on to the method.

    Raises:
        InputError: if a file is missing or has faults.
        UsageError: if there is no such method.
        LimitError: if a method needs plan graphs that do not fit.
    """
    loaded, beside = _load(source)
    observed = _observed(actions, beside)
    name = method or (BANK_METHOD if isinstance(loaded, Bank) else GOALS_METHOD)
    kind = METHODS.find(name)
    belief = kind(_as_needed(kind, loaded), **options)
    goals = loaded.goals if isinstance(loaded, Bank) else loaded
    return run(belief, Resolver(belief_table(belief, goals), goals), observed, name)


def belief_table(belief: Any, goals: Goals) -> StepTable:
    """Return the steps that a belief speaks of."""
    table = getattr(belief, "table", None)
    if isinstance(table, StepTable):
        return table
    tracker = getattr(belief, "tracker", None)
    return StepTable(goals.task) if tracker is None else tracker.bank.table


def run(
    belief: Any, resolver: Resolver, observed: Sequence[ObservedWords], method: str
) -> Inference:
    """Return what a belief makes of observed actions, one after the other."""
    states = [belief.start()]
    ignored: list[Ignored] = []
    for at, words in enumerate(observed):
        found = resolver.find(words, states[-1].world)
        shown = f"({' '.join(words)})"
        if isinstance(found, str):
            states.append(states[-1])
            ignored.append(Ignored(at, shown, found))
            continue
        states.append(belief.observe(states[-1], found.step, robot=found.robot))
        if states[-1].ignored is not None:
            ignored.append(Ignored(at, shown, states[-1].ignored))
    unresolved = {i.at for i in ignored}
    changes = getattr(belief, "changes", None)
    told = [(at, s) for at, s in enumerate(states[1:]) if at not in unresolved]
    found_changes = changes([s for _, s in told]) if changes is not None else ()
    return Inference(
        tuple(belief.names),
        tuple(f"({' '.join(words)})" for words in observed),
        tuple(tuple(belief.posterior(state).tolist()) for state in states),
        tuple(GoalChange(told[c.at][0], c.probability) for c in found_changes),
        tuple(ignored),
        method,
        getattr(states[-1], "note", None) or getattr(belief, "note", None),
    )


def _load(
    source: str | Path | Bank | Goals,
) -> tuple[Bank | Goals, tuple[ObservedWords, ...] | None]:
    """Return bank or goals, and the actions that are beside them."""
    if isinstance(source, (Bank, Goals)):
        return source, None
    path = Path(source)
    if path.is_dir():
        if not is_folder(path):
            message = f"'{source}' is a folder without template.pddl and hyps.dat"
            hint = "build a bank of problem files with `hrcplan bank build`"
            raise InputError(message, code="no-goals", path=str(source), hint=hint)
        instance = read_instance(path)
        return instance.goals, instance.observed if (path / OBSERVATIONS).is_file() else None
    from hrcplan.bank.store import load

    return load(path), None


def _observed(
    actions: str | Path | Sequence[ObservedWords] | None, beside: tuple[ObservedWords, ...] | None
) -> tuple[ObservedWords, ...]:
    if actions is None:
        if beside is None:
            hint = "a file with one action a line"
            raise InputError("no observed actions are given", code="no-actions", hint=hint)
        return beside
    if isinstance(actions, (str, Path)):
        return read_actions(_TIMES.sub(" ", read_text(actions)))
    return tuple(tuple(word.lower() for word in words) for words in actions)


def _as_needed(kind: Any, loaded: Bank | Goals) -> Bank | Goals:
    """Return goals for a method that does without plan graphs, else a bank."""
    if takes_goals(kind):
        return loaded.goals if isinstance(loaded, Bank) else loaded
    if isinstance(loaded, Bank):
        return loaded
    try:
        return build(loaded, timeout_s=BUILD_S)
    except LimitError as error:
        hint = f"--method {GOALS_METHOD} does without plan graphs"
        raise LimitError(error.message, code=error.code, hint=hint) from None
