"""Events and commands as JSON objects, and back: the lines of journals."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import Field, fields
from fractions import Fraction
from typing import Any, ClassVar, Protocol

from hrcplan.core.json_values import DOCUMENT_FAULTS, JsonValue
from hrcplan.core.numbers import Number, exact, nearest_float
from hrcplan.errors import PlanFormatError
from hrcplan.execution import events as ev
from hrcplan.execution.events import Command, Event
from hrcplan.pddl.model import Fact, FluentKey
from hrcplan.plans import Plan, format_plan, parse_plan

_FieldValue = (
    Plan
    | frozenset[Fact]
    | Mapping[FluentKey, Number]
    | tuple[str | tuple[str | float, ...], ...]
    | float
    | Number
    | str
    | None
)


class Item(Protocol):
    """An event or a command of any machine: a data class with a time."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    @property
    def t(self) -> float:
        """Seconds on the world's clock."""


ABSENT = "absent"
LEFT_OUT = frozenset({ABSENT, "n_happened", "asks", "takes_over", "none_of_these", "composed"})
"""What is left out where it is empty, as in journals of earlier versions."""

KINDS: Mapping[str, type] = {
    kind.__name__.lower(): kind
    for kind in (ev.Ended, ev.Overdue, ev.Observed, ev.Sensed, ev.Happened, ev.Settled, ev.Planned,
                 ev.StopAsked, ev.Noticed, ev.AskPlan, ev.Dispatch, ev.Cancel, ev.Wake, ev.Adopt,
                 ev.Tell, ev.Finish)
}  # fmt: skip


def to_json(item: Event | Command | Item) -> dict[str, Any]:
    """Return an event or command as a JSON object; ``kind`` comes first.

    >>> from hrcplan.execution import events as ev
    >>> to_json(ev.Ended(50.0, 1, "done"))
    {'kind': 'ended', 't': 50.0, 'number': 1, 'outcome': 'done'}
    """
    document: dict[str, Any] = {"kind": type(item).__name__.lower()}
    for field in fields(item):
        value = getattr(item, field.name)
        if value or field.name not in LEFT_OUT:
            document[field.name] = _encode(value)
    return document


def from_json(document: Mapping[str, Any], kinds: Mapping[str, type] = KINDS) -> Any:
    """Return the event or command that ``to_json`` made a JSON object of.

    Args:
        document: The JSON object.
        kinds: The classes of events and commands by ``kind``.

    Raises:
        ValueError: if it is none.
    """
    try:
        kind = kinds[document["kind"]]
        item = kind(**{k: _DECODERS.get(k, _same)(v) for k, v in document.items() if k != "kind"})
        if math.isfinite(item.t) and item.t >= 0 and isinstance(getattr(item, "number", 0), int):
            return item
        raise ValueError(f"no event: {document}")
    except (*DOCUMENT_FAULTS, PlanFormatError) as error:
        raise ValueError(f"no event: {error}") from None


def _encode(value: _FieldValue) -> JsonValue:
    if isinstance(value, Plan):
        return format_plan(value).splitlines()
    if isinstance(value, frozenset):
        return sorted(" ".join(fact) for fact in value)
    if isinstance(value, Mapping):
        return {" ".join(key): _number(number) for key, number in value.items()}
    if isinstance(value, tuple):
        return [list(part) if isinstance(part, tuple) else part for part in value]
    return _number(value) if isinstance(value, Fraction) else value


def _number(value: float | Number) -> float | int | str:
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)  # JSON knows no such numbers
    return value if isinstance(value, (int, float)) else nearest_float(value)


def exact_number(number: float | str) -> float | Number:
    """Return a number of a journal as it was before: what was exact is exact again.

    >>> exact_number(58.00051), exact_number("nan")
    (Fraction(5800051, 100000), nan)
    """
    if isinstance(number, str):
        return float(number)
    if isinstance(number, int):
        return number
    return exact(repr(number))


def _facts(words: list[str]) -> frozenset[Fact]:
    return frozenset(tuple(word.split(" ")) for word in words)


def _numbers(table: Mapping[str, float] | None) -> dict[FluentKey, Any] | None:
    if table is None:
        return None
    return {tuple(key.split(" ")): exact_number(number) for key, number in table.items()}


def _plan(lines: list[str] | None) -> Plan | None:
    return None if lines is None else parse_plan("\n".join(lines))


def _metric(value: float | str | None) -> float | Number | None:
    return None if value is None else exact_number(value)


def _pairs(rows: list[list[Any]]) -> tuple[tuple[Any, ...], ...]:
    return tuple(map(tuple, rows))


def _same(value: JsonValue) -> JsonValue:
    """Return a value that JSON has a type for; a table is none of them.

    Raises:
        TypeError: if it is a table.
    """
    if isinstance(value, dict):
        raise TypeError(f"a table stands for a value: {value!r:.80}")
    return value


_DECODERS: Mapping[str, Callable[[Any], Any]] = {
    "facts": _facts, ABSENT: _facts, "numbers": _numbers, "values": _numbers, "plan": _plan,
    "args": tuple, "reasons": tuple, "metric": _metric, "agents": tuple, "options": tuple,
    "helps": tuple, "asks": tuple, "goals": _pairs,
}  # fmt: skip
"""How the fields that JSON has no type for are read; all others stay as they are."""
