"""The text of one plan: IPC format, and the lists that people and planners make of it.

Parentheses separate actions, lines do not: ``(a) (b)`` on one line are two actions, and one action
may go over several lines (VAL reads plans in this way, too). ``1. (go a b)`` and ``- (go a b)`` are
lists, ``go(a, b)`` is an action in function style, ``[D:5.00; C:0.10]`` is a duration of LPG, and
``0,500`` has a decimal comma.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from hrcplan.core.numbers import Number, to_number
from hrcplan.core.text import quote
from hrcplan.errors import PlanFormatError
from hrcplan.plans.documents import plain_text
from hrcplan.plans.model import Plan, PlannedAction

HINT = "actions look like (move human wp1 wp2) or 0.000: (move human wp1 wp2) [50.000]"

_TOKEN = re.compile(
    r"""(?P<space>\s+|;[^\n]*|,)
      | (?P<action>\([^()]*\))
      | \[\s*+(?:d\s*+:)?\s*+(?P<duration>[^\s;\[\]]++)(?:\s*+;[^\[\]\n]*+)?\s*+\]\)?
      | (?P<start>\d+,\d+|[^\s:;,.()\[\]]+(?:\.[^\s:;,()\[\]]+)?)\s*:(?!:)
      | (?P<bullet>\d+[.)](?=\s*[a-z_(])|\d+(?=\s+\()|[-*•](?=\s))
      | (?P<name>[a-z_][^\s(),;:\[\]]*)(?P<args>\([^()]*\))
    """,
    re.VERBOSE,
)


_COMMA = re.compile(r"(\d+),(\d+)s?")


@dataclass(slots=True)
class _Entry:
    """One action of the text: its words, where it stands, and its times as they are written."""

    words: list[str]
    position: int
    start: str | None = None
    duration: str | None = None


def parse_plan(text: str, path: str = "<plan>") -> Plan:
    """Return the plan that a text describes; comments start with ``;``.

    Raises:
        PlanFormatError: with line and column of the first text that is no action, or of the first
            action that has a start time although others have none.

    >>> parse_plan("1. (go a b)  2. go(b, c)").actions[1].args
    ('b', 'c')
    """
    text = plain_text(text).lower()
    actions: list[PlannedAction] = []
    for entry in _entries(text, path):
        action = _action(entry)
        if action is None:
            raise _error(text, entry.position, path)
        if actions and (action.start_s is None) != (actions[0].start_s is None):
            message = "some actions have a start time and some have none"
            raise _fault(text, entry.position, path, message)
        actions.append(action)
    return Plan(tuple(sorted(actions, key=lambda a: a.start_s or 0)))


def _entries(text: str, path: str) -> Iterator[_Entry]:
    """Yield the actions of a text in lower case, each once its duration has been read."""
    position, start = 0, None
    last: _Entry | None = None
    while position < len(text):
        match = _TOKEN.match(text, position)
        if match is None:
            raise _error(text, position if start is None else start.start(), path)
        if match["duration"] is not None and last is not None and last.duration is None:
            last.duration = match["duration"]
        elif match["duration"] is not None or (match["start"] and start is not None):
            raise _error(text, match.start(), path)
        elif match["start"]:
            start = match
        elif match["action"] or match["name"]:
            if last is not None:
                yield last
            begin = match if start is None else start
            last = _Entry(_words(match), begin.start(), start["start"] if start else None)
            start = None
        position = match.end()
    if start is not None:
        raise _error(text, start.start(), path)
    if last is not None:
        yield last


def _words(match: re.Match[str]) -> list[str]:
    inner = (match["action"] or match["args"])[1:-1]
    return [match["name"], *inner.replace(",", " ").split()] if match["name"] else inner.split()


def _action(entry: _Entry) -> PlannedAction | None:
    """Return an entry as an action; None if a number in it is none, or cannot be."""
    start, duration = _seconds(entry.start), _seconds(entry.duration)
    unreadable = (entry.start and start is None) or (entry.duration and duration is None)
    if not entry.words or unreadable or (start or 0) < 0 or (duration or 0) < 0:
        return None
    if start is None and duration is not None:
        return None
    return PlannedAction(entry.words[0], tuple(entry.words[1:]), start, duration)


def _seconds(text: str | None) -> Number | None:
    """Return a time; ``5,25`` is read like ``5.25``, and ``5.25s`` too."""
    if text is None:
        return None
    comma = _COMMA.fullmatch(text)
    return to_number(".".join(comma.groups()) if comma else text.removesuffix("s"))


def _error(text: str, position: int, path: str) -> PlanFormatError:
    line = text[text.rfind("\n", 0, position) + 1 :].split("\n", 1)[0].strip()
    message = f"{quote(line)} is not an action of a plan"
    return _fault(text, position, path, message, HINT)


def _fault(
    text: str, position: int, path: str, message: str, hint: str | None = None
) -> PlanFormatError:
    """Return an error with line and column of a position, both from 1."""
    line = text.count("\n", 0, position) + 1
    column = position - text.rfind("\n", 0, position)
    return PlanFormatError(message, path=path, line=line, column=column, hint=hint)
