"""Changes of the world at given times: as text, as on the command line, or as objects.

"motivation human=9@0"    at 0 s an agent state changes to this value (0 to 10)
"fuel truck=3@60"         at 60 s any other number has this value
"box-at blue wp0@60"      at 60 s a fact begins to hold
"not box-at blue wp4@60"  at 60 s a fact ceases to hold
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from hrcplan.core.numbers import Number, exact
from hrcplan.core.text import type_text
from hrcplan.errors import UsageError
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.worlds.simulated import FactChange, StateChange
from hrcplan.pddl.conventions import CONTROLLABLE
from hrcplan.pddl.model import TOTAL_COST, FluentKey
from hrcplan.pddl.settings import check_fact, check_function, parse_fact, parse_setting

WorldChange = StateChange | FactChange
_CODE = "bad-change"
_APPEARS = "an object that may appear has to stand in :objects of the problem from the beginning"
_HINT = 'as in "motivation human=9@0", "box-at blue wp0@60" or "not box-at blue wp4@60"'


def checked_changes(
    changes: Iterable[str | WorldChange], model: ExecutionModel
) -> tuple[WorldChange, ...]:
    """Return changes as objects, each checked against the problem.

    Raises:
        UsageError: naming the change and the wrong piece of it.
        TypeError: if one is neither text nor a change.
    """
    if isinstance(changes, str):
        raise TypeError(f"changes is a list of changes, not one text: [{changes!r}]")
    return tuple(_check(_parse(change, model), model) for change in changes)


def _parse(change: str | WorldChange, model: ExecutionModel) -> WorldChange:
    if isinstance(change, str):
        return parse_change(change, model)
    if isinstance(change, StateChange | FactChange):
        return change
    raise TypeError(
        f"a change is a text, a StateChange or a FactChange, not {type_text(change)}; {_HINT}"
    )


def parse_change(text: str, model: ExecutionModel) -> WorldChange:
    """Return the change that a text describes; its words are lower case or not.

    Raises:
        UsageError: if there is no time after ``@``, or a word of it is unknown.
    """
    what, at, time = text.lower().rpartition("@")
    if not at or not what.strip():
        raise UsageError(f"change '{text}' does not end with @SECONDS", code=_CODE, hint=_HINT)
    try:
        t = float(time)
    except ValueError:
        message = f"change '{text}' does not end with @SECONDS: '{time}' is no number"
        raise UsageError(message, code=_CODE, hint=_HINT) from None
    with _about(text):
        if "=" in what:
            key, value = parse_setting(what, model.problem)
            return StateChange(t, {key: value})
        words = what.replace("(", " ").replace(")", " ").split()
        is_negated = words[:1] == ["not"]
        fact = parse_fact(" ".join(words[is_negated:]), model.problem)
    facts = frozenset({fact})
    return FactChange(t, deletes=facts) if is_negated else FactChange(t, adds=facts)


def _check(change: WorldChange, model: ExecutionModel) -> WorldChange:
    text = _text(change)
    if not 0 <= change.t < math.inf:
        raise UsageError(f"change '{text}': the time is not a number from 0 on", code=_CODE)
    with _about(text):
        if isinstance(change, StateChange):
            for key in change.values:
                check_function(key, model.problem)
            values = {key: _checked_value(key, v, model) for key, v in change.values.items()}
            return StateChange(change.t, values)
        for fact in change.adds | change.deletes:
            check_fact(fact, model.problem)
            if fact[0] == CONTROLLABLE:
                hint = "change it in the problem file"
                raise UsageError("which agents take commands is fixed during a run", hint=hint)
    return change


def _checked_value(key: FluentKey, value: float | Number, model: ExecutionModel) -> Number:
    """Return the value of an agent state, or of any other number, as an exact number.

    Raises:
        UsageError: if it is out of range, or the number is no part of the world.
    """
    if key in model.agents.low:
        return model.agents.check(key, value)
    if key[0] == TOTAL_COST:
        hint = "change what the cost depends on, such as an agent state"
        raise UsageError(f"({TOTAL_COST}) is what a plan costs, not a part of the world", hint=hint)
    if not math.isfinite(value):
        raise UsageError(f"{value} is no finite number")
    return exact(repr(value)) if isinstance(value, float) else value


@contextmanager
def _about(text: str) -> Iterator[None]:
    """Let errors say which change they are about."""
    try:
        yield
    except UsageError as error:
        message = f"change '{text}': {error.message}"
        hint = f"{error.hint}; {_APPEARS}" if "of the problem" in error.message else error.hint
        raise UsageError(message, code=_CODE, hint=hint) from None


def _text(change: WorldChange) -> str:
    """Return a change as it is written on the command line."""
    if isinstance(change, StateChange):
        words = ", ".join(f"{' '.join(key)}={value}" for key, value in change.values.items())
    else:
        facts = [" ".join(fact) for fact in sorted(change.adds)]
        facts += [f"not {' '.join(fact)}" for fact in sorted(change.deletes)]
        words = ", ".join(facts)
    return f"{words}@{change.t:g}"
