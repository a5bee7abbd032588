"""Ground functions, settings and facts as users type them, such as ``motivation human=8``."""

from __future__ import annotations

import re
from collections.abc import Sequence

from hrcplan.core.numbers import Number, to_number
from hrcplan.core.text import nearest
from hrcplan.errors import UsageError
from hrcplan.pddl.model import Fact, FluentKey, Param, Problem

FORM = "FUNCTION OBJECT…=NUMBER"


def parse_setting(text: str, problem: Problem) -> tuple[FluentKey, Number]:
    """Return function and value of a setting such as ``motivation human=8``.

    Raises:
        UsageError: if the function or an object is unknown, or the value is no number.

    >>> from hrcplan.pddl.inputs import read
    >>> parse_setting("motivation human=8", read("transport/two-boxes"))
    (('motivation', 'human'), 8)
    """
    name, equals, digits = text.lower().partition("=")
    key, value = _words(name), to_number(digits.strip())
    if not equals or not key or value is None:
        piece = f": '{digits.strip()}' is no number" if equals and key else ""
        message = f"'{text}' is not {FORM}{piece}"
        raise UsageError(message, code="bad-setting", hint='as in "motivation human=8"')
    check_function(key, problem)
    return key, value


def parse_function(text: str, problem: Problem) -> FluentKey:
    """Return the function that a text such as ``motivation human`` names.

    Raises:
        UsageError: if the function or an object is unknown.
    """
    key = _words(text.lower())
    if not key:
        raise UsageError("a function is needed, as in 'motivation human'", code="bad-setting")
    check_function(key, problem)
    return key


def parse_fact(text: str, problem: Problem) -> Fact:
    """Return the fact that a text such as ``box-at blue wp4`` names.

    Raises:
        UsageError: if the predicate or an object is unknown.
    """
    fact = _words(text.lower())
    check_fact(fact, problem)
    return fact


def check_function(key: FluentKey, problem: Problem) -> None:
    """Check that a problem has a function of these objects.

    Raises:
        UsageError: naming the unknown word, with the nearest known one.
    """
    functions = problem.domain.functions
    if key[0] not in functions:
        hint = nearest(key[0], functions) or f"functions: {', '.join(functions)}"
        raise UsageError(f"there is no function '{key[0]}'", code="bad-setting", hint=hint)
    _check_objects(key, functions[key[0]].params, f"{functions[key[0]]}", problem, "bad-setting")


def check_fact(fact: Fact, problem: Problem) -> None:
    """Check that a problem can have a fact.

    Raises:
        UsageError: naming the unknown word, with the nearest known one.
    """
    predicates = problem.domain.predicates
    name = fact[0] if fact else ""
    if name not in predicates:
        names = ", ".join(map(str, predicates.values()))
        hint = nearest(name, predicates) or f"predicates: {names}"
        raise UsageError(f"there is no predicate '{name}'", code="bad-fact", hint=hint)
    _check_objects(fact, predicates[name].params, f"{predicates[name]}", problem, "bad-fact")


def _check_objects(
    words: Sequence[str], params: Sequence[Param], declaration: str, problem: Problem, code: str
) -> None:
    if len(params) != len(words) - 1:
        message = f"'{words[0]}' takes {len(params)} objects, not {len(words) - 1}"
        raise UsageError(message, code=code, hint=f"declared as {declaration}")
    for name, param in zip(words[1:], params, strict=True):
        objects = problem.objects_of(param.types)
        if name not in objects:
            hint = nearest(name, objects) or f"one of: {', '.join(objects) or 'none'}"
            message = f"'{name}' is no {' or '.join(param.types)} of the problem"
            raise UsageError(message, code=code, hint=hint)


def _words(text: str) -> tuple[str, ...]:
    return tuple(re.sub(r"[()]", " ", text).split())
