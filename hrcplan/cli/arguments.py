"""Arguments that several commands share: DOMAIN PROBLEM, and ``--set``."""

from __future__ import annotations

import re
from collections.abc import Sequence

from hrcplan.core.numbers import Number, to_number
from hrcplan.core.text import nearest
from hrcplan.errors import UsageError
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import FluentKey, Problem


def split_names(words: Sequence[str], n_more: int) -> tuple[str, str, list[str]]:
    """Return domain, problem and the remaining words of ``DOMAIN PROBLEM …``.

    ``transport/two-boxes`` is both in one word, unless it is a path that exists.

    Raises:
        UsageError: if the number of words does not fit.
    """
    if len(words) == n_more + 2:
        return words[0], words[1], list(words[2:])
    if len(words) == n_more + 1 and words[0].count("/") == 1 and not words[0].endswith(".pddl"):
        domain, problem = words[0].split("/")
        return domain, problem, list(words[1:])
    needed = "a domain, a problem and a plan file" if n_more else "a domain and a problem"
    message = f"{needed} are needed, as in 'transport two-boxes{' my.plan' if n_more else ''}'"
    raise UsageError(message, hint="in one word: transport/two-boxes; or paths")


def problem_of(domain: str, problem: str, settings: Sequence[str]) -> Problem:
    """Return a problem with the values of ``--set`` options put into its initial state.

    Raises:
        UsageError: if a setting does not name a function of the problem, or no number.
        InputError: if a file is missing or has faults.
    """
    loaded = read(domain, problem)
    return loaded.with_values(dict(setting(text, loaded) for text in settings))


def setting(text: str, problem: Problem) -> tuple[FluentKey, Number]:
    """Return function and value of a setting such as ``motivation human=8``.

    Raises:
        UsageError: if the function or an object is unknown, or the value is no number.
    """
    words, equals, spelled = text.lower().partition("=")
    key = _words(words)
    value = to_number(spelled.strip())
    if not equals or not key or value is None:
        message = f"'{text}' is not FUNCTION OBJECT…=NUMBER"
        raise UsageError(message, code="bad-setting", hint='as in --set "motivation human=8"')
    _check_key(key, problem)
    return key, value


def function(text: str, problem: Problem) -> FluentKey:
    """Return the function that a text such as ``motivation human`` names.

    Raises:
        UsageError: if the function or an object is unknown.
    """
    key = _words(text.lower())
    if not key:
        raise UsageError("a function is needed, as in 'motivation human'", code="bad-setting")
    _check_key(key, problem)
    return key


def _words(text: str) -> FluentKey:
    return tuple(re.sub(r"[()]", " ", text).split())


def _check_key(key: FluentKey, problem: Problem) -> None:
    functions = problem.domain.functions
    if key[0] not in functions:
        hint = nearest(key[0], functions) or f"functions: {', '.join(functions)}"
        raise UsageError(f"there is no function '{key[0]}'", code="bad-setting", hint=hint)
    params = functions[key[0]].params
    if len(params) != len(key) - 1:
        message = f"'{key[0]}' takes {len(params)} objects, not {len(key) - 1}"
        raise UsageError(message, code="bad-setting", hint=f"declared as {functions[key[0]]}")
    for name, param in zip(key[1:], params, strict=True):
        known = problem.objects_of(param.types)
        if name not in known:
            hint = nearest(name, known) or f"one of: {', '.join(known)}"
            message = f"'{name}' is no {' or '.join(param.types)} of the problem"
            raise UsageError(message, code="bad-setting", hint=hint)
