"""Simulated humans by name: how they change, and what of what they do fails."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol, runtime_checkable

from hrcplan.core.registry import Registry
from hrcplan.core.text import nearest
from hrcplan.errors import UsageError
from hrcplan.execution.simulate import RANDOM, Engine, Spec, nature_of
from hrcplan.execution.worlds.simulated import (
    ATTEMPT,
    DRAWS,
    SENSED,
    FactChange,
    Nature,
    StateChange,
)
from hrcplan.pddl.model import Problem

STEADY = "steady"
CASES = {STEADY: 0, "case1": 1, "case2": 2}
OPTIONS = (*CASES, RANDOM, ATTEMPT, *SENSED)
WorldChange = StateChange | FactChange


def spec_of(text: str, spec: Spec) -> Spec:
    """Return a specification with what ``text`` says of the human, as in ``case2,random``.

    ``steady`` (nothing changes by chance), ``case1`` or ``case2``; ``random``: the change comes
    before a random action; ``attempt``: outcomes are drawn at every attempt; ``before``,
    ``during`` or ``after``: when the change is sensed.

    Raises:
        UsageError: if a word is none of these.
    """
    for word in text.split(","):
        if word in CASES:
            spec = replace(spec, case=CASES[word])
        elif word == RANDOM:
            spec = replace(spec, when=RANDOM)
        elif word in SENSED:
            spec = replace(spec, sensed=word)
        elif word in DRAWS:
            spec = replace(spec, draws=word)
        else:
            hint = nearest(word, OPTIONS) or f"words: {', '.join(OPTIONS)}"
            raise UsageError(f"there is no human '{word}'", code="unknown-human", hint=hint)
    return spec


@runtime_checkable
class NatureSource(Protocol):
    """A human defined by a class: it says how the world behaves with this human."""

    def nature(self, problem: Problem, seed: object) -> Nature:
        """Return how the world behaves with this human."""


NATURES: Registry[[], NatureSource] = Registry("human", {}, "hrcplan.natures", NatureSource)
"""Humans of other packages, or a user's own; the built-in ones are words (see `spec_of`)."""


def nature_for(
    text: str, spec: Spec, engine: Engine, changes: Sequence[WorldChange] = ()
) -> Nature:
    """Return the nature that a human brings along, with more changes at given times.

    A change of agent state is checked as a sensed value is.

    Raises:
        UsageError: if there is no such human, a changed element is unknown, or its value is not
            in [0, 10].
    """
    if ":" in text or text in NATURES.names():
        nature = NATURES.make(text).nature(engine.model.problem, spec.seed)
    else:
        nature = nature_of(spec_of(text, spec), engine)
    agents = engine.model.agents
    checked = tuple(
        StateChange(c.t, {key: agents.check(key, value) for key, value in c.values.items()})
        for c in changes
        if isinstance(c, StateChange)
    )
    accidents = tuple(c for c in changes if isinstance(c, FactChange))
    return replace(
        nature, changes=(*nature.changes, *checked), accidents=(*nature.accidents, *accidents)
    )
