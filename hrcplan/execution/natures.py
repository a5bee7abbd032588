"""Simulated humans by name: how their agent state changes, and when their actions fail."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol, runtime_checkable

from hrcplan.core.deprecation import current_name
from hrcplan.core.registry import Registry
from hrcplan.core.text import nearest, type_text
from hrcplan.errors import UsageError
from hrcplan.execution.changes import WorldChange, checked_changes
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.simulate import RANDOM, Engine, Spec, nature_of
from hrcplan.execution.worlds.simulated import DRAWS, SENSED, FactChange, Nature, StateChange
from hrcplan.pddl.model import Problem

STEADY = "steady"
CASES = {STEADY: 0, "uncooperative": 1, "partly-cooperative": 2}
OLD_NAMES = {"case1": "uncooperative", "case2": "partly-cooperative"}
_CODE = "bad-nature"
WORDS = (*CASES, RANDOM, *DRAWS, *SENSED)


def parse_human(text: str, spec: Spec) -> Spec:
    """Return a specification of a run with the human that ``text`` describes.

    The text is one or several of these words, with commas, as in ``uncooperative,random``:

    * ``steady``: nothing changes by itself (the default). ``uncooperative``: one element of a
      human's agent state rises to 10. ``partly-cooperative``: it rises to a value from 5 to 10.
    * ``random``: the change comes just before one of the human's actions, instead of at 0 s.
    * ``once`` (the default) or ``attempt``: chance decides once per run whether the element makes
      actions fail, or at every attempt.
    * ``before``, ``during`` (the default) or ``after`` the first action under it: when the change
      is sensed.

    Raises:
        UsageError: if a word is none of these.
    """
    for part in text.split(","):
        word = current_name("human", part.strip().lower(), OLD_NAMES)
        if word in CASES:
            spec = replace(spec, case=CASES[word])
        elif word == RANDOM:
            spec = replace(spec, when=RANDOM)
        elif word in SENSED:
            spec = replace(spec, sensed=word)
        elif word in DRAWS:
            spec = replace(spec, draws=word)
        else:
            hint = nearest(word, WORDS) or f"words: {', '.join(WORDS)}; or module:Class"
            message = f"there is no human '{word}'"
            raise UsageError(message, code="unknown-human", hint=hint)
    return spec


@runtime_checkable
class NatureSource(Protocol):
    """A human defined by a class: it says how the world behaves with this human."""

    def nature(self, problem: Problem, seed: str | int) -> Nature:
        """Return how the world behaves with this human."""


NATURES: Registry[[], NatureSource] = Registry("human", {}, "hrcplan.natures", NatureSource)
"""Humans of other packages, or a user's own; the built-in ones are words (see `parse_human`)."""


def nature_for(
    human: str | NatureSource, spec: Spec, engine: Engine,
    changes: Sequence[str | WorldChange] = (),
) -> Nature:  # fmt: skip
    """Return the nature of a human, with more changes at given times.

    Args:
        human: Words as for `parse_human`, a registered name, ``module:Class``, or an object.
        spec: What the words change; its seed decides what is drawn.
        engine: Prepared for the problem; its first plan is asked for by ``random``.
        changes: More changes, as text or objects (see ``changes.py``).

    Raises:
        UsageError: if there is no such human, or a change or what a class returns is out of range.
        TypeError: if an argument is of a wrong type.
    """
    if isinstance(human, NatureSource):
        nature = checked_nature(human.nature(engine.model.problem, spec.seed), engine.model)
    elif not isinstance(human, str):
        raise TypeError(
            "human is a text, or an object with a method nature(problem, seed), "
            f"not {type_text(human)}"
        )
    elif ":" in human or human in NATURES.names():
        source = NATURES.make(human)
        nature = checked_nature(source.nature(engine.model.problem, spec.seed), engine.model)
    else:
        nature = nature_of(parse_human(human, spec), engine)
    states, accidents = _by_kind(checked_changes(changes, engine.model))
    return replace(
        nature, changes=(*nature.changes, *states), accidents=(*nature.accidents, *accidents)
    )


def checked_nature(nature: Nature, model: ExecutionModel) -> Nature:
    """Return a nature that a class has made, its values exact, if the problem can have it.

    Raises:
        UsageError: naming the first field that is unknown or out of range.
        TypeError: if it is no `Nature`, or a change of it is none.
    """
    if not isinstance(nature, Nature):
        raise TypeError(f"nature() returns a Nature, not {type_text(nature)}")
    for name, word, words in (
        ("sensed", nature.sensed, SENSED),
        ("draws", nature.draws, DRAWS),
        *(("can_fail", action, model.problem.domain.schemas) for action in nature.can_fail or ()),
    ):
        if word not in words:
            message = f"{name} of a nature is one of {', '.join(words)}, not {word!r}"
            raise UsageError(message, code=_CODE)
    stretch = tuple(nature.stretch)
    if len(stretch) != 2 or not 0 < stretch[0] <= stretch[1] < math.inf:
        message = f"stretch of a nature is two factors above 0, not {nature.stretch}"
        raise UsageError(message, code=_CODE)
    states, accidents = _by_kind(checked_changes((*nature.changes, *nature.accidents), model))
    return replace(nature, changes=states, accidents=accidents)


def _by_kind(
    changes: Sequence[WorldChange],
) -> tuple[tuple[StateChange, ...], tuple[FactChange, ...]]:
    states = tuple(c for c in changes if isinstance(c, StateChange))
    return states, tuple(c for c in changes if isinstance(c, FactChange))
