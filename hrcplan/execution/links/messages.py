"""What a robot's program says, as values: one line of JSON is one message.

To the program: ``{"do": "begin"}``, ``dispatch``, ``cancel``, ``observe``, ``end``. From it, with
the number ``n`` of the dispatch where one is meant::

    {"event": "ready", "agents": ["robot"]}
    {"event": "accepted", "n": 7}                   {"event": "rejected", "n": 7, "why": "…"}
    {"event": "feedback", "n": 7, "text": "50 %"}
    {"event": "ended", "n": 7, "outcome": "done"}   (failed, cancelled, unknown; "why")
    {"event": "observed", "facts": ["at robot wp3"], "absent": ["at robot wp1"]}
    {"event": "sensed", "values": {"motivation human": 8}}
    {"event": "said", "agent": "human", "text": "I take the blue box"}
    {"event": "begun", "agent": "human", "action": "move", "args": ["human", "wp1", "wp4"]}
    {"event": "stop", "why": "…"}                   {"event": "release"}
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from hrcplan.core.json_values import DOCUMENT_FAULTS, JsonValue, json_of
from hrcplan.core.text import cut, harmless
from hrcplan.execution import events as ev
from hrcplan.pddl.model import Fact, FluentKey

_SHOWN = 120  # characters of a line that is quoted
_SAID = 2000  # characters of what a person says


@dataclass(frozen=True, slots=True)
class LinkReady:
    """The program can take actions of these agents; none means every robot."""

    agents: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Accepted:
    """The robot will carry an action out."""

    number: int


@dataclass(frozen=True, slots=True)
class Rejected:
    """The robot will not carry an action out."""

    number: int
    why: str = ""


@dataclass(frozen=True, slots=True)
class Feedback:
    """How far an action is."""

    number: int
    text: str = ""


@dataclass(frozen=True, slots=True)
class ActionEnded:
    """An action has ended, with one of ``events.OUTCOMES``."""

    number: int
    outcome: str
    why: str = ""


@dataclass(frozen=True, slots=True)
class FactsObserved:
    """These facts hold, and those do not; of all others nothing is said."""

    facts: frozenset[Fact]
    absent: frozenset[Fact] = frozenset()


@dataclass(frozen=True, slots=True)
class ValuesSensed:
    """Function values: agent state, or numbers that actions change."""

    values: Mapping[FluentKey, float | int]


@dataclass(frozen=True, slots=True)
class PersonSaid:
    """A person said something; "" is the agent if it is not clear who."""

    agent: str
    text: str


@dataclass(frozen=True, slots=True)
class PersonBegun:
    """A person has begun an action."""

    agent: str
    action: str
    args: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class StopPressed:
    """An emergency stop: everything is cancelled, and nothing begins until it is released."""

    why: str = ""


@dataclass(frozen=True, slots=True)
class StopReleased:
    """Actions may begin again."""


@dataclass(frozen=True, slots=True)
class BadLine:
    """A line that is no message; ``reason`` quotes its beginning."""

    reason: str


@dataclass(frozen=True, slots=True)
class LinkEnded:
    """The program has ended, or cannot be spoken to any more."""

    why: str


LinkMessage = (
    LinkReady | Accepted | Rejected | Feedback | ActionEnded | FactsObserved | ValuesSensed
    | PersonSaid | PersonBegun | StopPressed | StopReleased | BadLine | LinkEnded
)  # fmt: skip


def message_of(line: str | None) -> LinkMessage:
    """Return what a line says; None stands for a line that is too long.

    >>> message_of('{"event": "ended", "n": 7, "outcome": "done"}')
    ActionEnded(number=7, outcome='done', why='')
    >>> message_of("hello")
    BadLine(reason="no JSON: 'hello'")
    """
    if line is None:
        return BadLine("a line is too long")
    quoted = repr(cut(harmless(line), _SHOWN))
    try:
        document = json_of(line)
    except ValueError:
        return BadLine(f"no JSON: {quoted}")
    if not isinstance(document, dict):
        return BadLine(f"no JSON object: {quoted}")
    read = _READERS.get(str(document.get("event")))
    if read is None:
        return BadLine(f"no event of a link: {quoted}")
    try:
        return read(document)
    except DOCUMENT_FAULTS as error:
        return BadLine(f"{_fault(error)}: {quoted}")


def _fault(error: Exception) -> str:
    return f"no {error}" if isinstance(error, KeyError) else str(error)


def _number(document: Mapping[str, Any]) -> int:
    number = document["n"]
    if isinstance(number, int) and not isinstance(number, bool):
        return number
    raise TypeError("'n' is no number of a dispatch")


def _text(document: Mapping[str, Any], key: str) -> str:
    return cut(harmless(str(document.get(key, ""))), _SHOWN)


def _ended(document: Mapping[str, Any]) -> ActionEnded:
    outcome = document["outcome"]
    if outcome not in ev.OUTCOMES:
        raise ValueError(f"'outcome' is one of {', '.join(ev.OUTCOMES)}")
    return ActionEnded(_number(document), outcome, _text(document, "why"))


def _words(text: JsonValue) -> tuple[str, ...]:
    """Return the words of a fact or function, with parentheses around it or without."""
    if not isinstance(text, str) or not (words := text.strip().strip("()").lower().split()):
        raise TypeError("a fact is a text such as 'at robot wp1'")
    return tuple(words)


def _facts(document: Mapping[str, Any], key: str) -> frozenset[Fact]:
    return frozenset(map(_words, document.get(key, ())))


def _values(document: Mapping[str, Any]) -> ValuesSensed:
    values: dict[FluentKey, float | int] = {}
    if not isinstance(document["values"], dict):
        raise TypeError("'values' is no JSON object")
    for text, value in document["values"].items():
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise TypeError(f"the value of '{text}' is no number")
        if not math.isfinite(value):
            raise TypeError(f"the value of '{text}' is not finite")
        values[_words(text)] = value
    return ValuesSensed(values)


def _begun(document: Mapping[str, Any]) -> PersonBegun:
    action, *args = _words(" ".join([document["action"], *document.get("args", ())]))
    return PersonBegun(_text(document, "agent").lower(), action, tuple(args))


_READERS: Mapping[str, Callable[[Mapping[str, Any]], LinkMessage]] = {
    "ready": lambda d: LinkReady(tuple(cut(harmless(str(a)), _SHOWN) for a in d.get("agents", ()))),
    "accepted": lambda d: Accepted(_number(d)),
    "rejected": lambda d: Rejected(_number(d), _text(d, "why")),
    "feedback": lambda d: Feedback(_number(d), _text(d, "text")),
    "ended": _ended,
    "observed": lambda d: FactsObserved(_facts(d, "facts"), _facts(d, "absent")),
    "sensed": _values,
    "said": lambda d: PersonSaid(_text(d, "agent").lower(), cut(harmless(str(d["text"])), _SAID)),
    "begun": _begun,
    "stop": lambda d: StopPressed(_text(d, "why")),
    "release": lambda d: StopReleased(),
}
