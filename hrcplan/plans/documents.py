"""Plans that stand in JSON, in a list of Python, or in one more pair of brackets."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence

from hrcplan.core.json_values import JsonValue

_LISTS = ("plan", "plans", "steps", "actions", "items", "solution", "result", "output")
_NAMES = ("action", "name", "operator")
_ARGUMENTS = ("args", "arguments", "parameters", "params", "objects")
_STARTS = ("start_s", "start", "start_time", "time", "at")
_DURATIONS = ("duration_s", "duration")
_WRAPPED = re.compile(r"\s*+(?:\((?=\s*+\()|\[(?=\s*+[a-z_(]))", re.IGNORECASE)


class _Digits(str):
    """A number of a document as it is written there: no name of an action."""

    __slots__ = ()


def plain_text(text: str) -> str:
    """Return a plan as a list of actions: what JSON holds, one a line, or without outer brackets.

    Any other text is returned as it is.

    >>> print(plain_text('{"plan": [{"action": "go", "args": ["a", "b"], "time": 0.5}]}'))
    0.5: (go a b)
    >>> plain_text("((go a b) (go b c))")
    ' (go a b) (go b c) '
    """
    start = text.lstrip("\ufeff \t\r\n")[:1]
    if start in ("[", "{"):
        for candidate in (text, text.replace("'", '"'), _with_lists(text)):
            lines = _lines_of(candidate)
            if lines is not None:
                return "\n".join(lines)
    wrapped, last = _WRAPPED.match(text), len(text.rstrip()) - 1
    if wrapped and text[last] in ")]" and start:
        first = wrapped.end() - 1
        return f"{text[:first]} {text[first + 1 : last]} {text[last + 1 :]}"
    return text.replace("\ufeff", " ", 1) if text.startswith("\ufeff") else text


def _with_lists(text: str) -> str:
    """Return a list of Python's tuples as lists of JSON."""
    return text.replace("'", '"').replace("(", "[").replace(")", "]")


def _lines_of(text: str) -> list[str] | None:
    try:
        value: JsonValue = json.loads(text.lstrip("\ufeff"), parse_float=_Digits, parse_int=_Digits)
    except (ValueError, RecursionError):
        return None
    return _steps(value)


def _steps(value: JsonValue) -> list[str] | None:
    """Return the actions that a document lists, as lines; None if it lists none."""
    if isinstance(value, Mapping):
        inner = (_steps(value[key]) for key in _LISTS if key in value)
        return next((lines for lines in inner if lines is not None), None)
    if isinstance(value, str):
        return value.splitlines() if "(" in value else None
    if not isinstance(value, Sequence):
        return None
    lines = [_line(step) for step in value]
    if lines and all(lines):
        return [line for line in lines if line]
    inner = (_steps(part) for part in reversed(value) if isinstance(part, Mapping))
    return next((steps for steps in inner if steps is not None), None)


def _line(step: JsonValue) -> str | None:
    """Return one action as a line of a plan; None if it is none."""
    if isinstance(step, _Digits):
        return None
    if isinstance(step, str):
        return step if "(" in step else f"({step})"
    if isinstance(step, Mapping):
        return _line_of_keys(step)
    if isinstance(step, Sequence):
        words = [word for word in step if isinstance(word, str)]
        return f"({' '.join(words)})" if words and len(words) == len(step) else None
    return None


def _line_of_keys(step: Mapping[str, JsonValue]) -> str | None:
    names = [name for key in _NAMES if isinstance(name := step.get(key), str)]
    if not names:
        return None
    name = next((name for name in names if ":" not in name), names[0])  # some add its PDDL
    arguments = next((step[key] for key in _ARGUMENTS if key in step), [])
    words = list(_words(arguments))
    text = name if "(" in name else f"({' '.join([name, *words])})"
    start = next((step[key] for key in _STARTS if step.get(key) is not None), None)
    duration = next((step[key] for key in _DURATIONS if step.get(key) is not None), None)
    ends = "" if duration is None or start is None else f" [{duration}]"
    return f"{text}{ends}" if start is None else f"{start}: {text}{ends}"


def _words(arguments: JsonValue) -> Iterator[str]:
    if isinstance(arguments, str):
        yield from arguments.replace(",", " ").split()
        return
    values: Sequence[JsonValue] = ()
    if isinstance(arguments, Mapping):
        values = list(arguments.values())
    elif isinstance(arguments, Sequence):
        values = arguments
    for value in values:
        yield str(value.get("name") if isinstance(value, Mapping) else value)
