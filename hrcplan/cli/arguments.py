"""Arguments that several commands share: DOMAIN PROBLEM, and ``--set``."""

from __future__ import annotations

from collections.abc import Sequence

from hrcplan.errors import UsageError
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.pddl.settings import parse_setting


def split_names(words: Sequence[str], n_more: int) -> tuple[str, str | None, list[str]]:
    """Return domain, problem and the remaining words of ``DOMAIN PROBLEM …``.

    ``transport/two-boxes`` is both in one word, unless it is a path that exists. A problem file
    may stand alone: it names its domain.

    Raises:
        UsageError: if the number of words does not fit.
    """
    if len(words) == n_more + 2:
        return words[0], words[1], list(words[2:])
    if len(words) == n_more + 1:
        if _is_file(words[0]) and not any(map(_is_file, words[1:])):
            return words[0], None, list(words[1:])
        if words[0].count("/") == 1 and not _is_file(words[0]):
            domain, problem = words[0].split("/")
            return domain, problem, list(words[1:])
    expectation = "a domain, a problem and a plan file" if n_more else "a domain and a problem"
    message = f"{expectation} are needed, as in 'transport two-boxes{' my.plan' if n_more else ''}'"
    raise UsageError(message, hint="in one word: transport/two-boxes; or paths")


def _is_file(word: str) -> bool:
    return word.endswith(".pddl")


def problem_of(domain: str, problem: str | None, settings: Sequence[str]) -> Problem:
    """Return a problem with the values of ``--set`` options put into its initial state.

    Raises:
        UsageError: if a setting does not name a function of the problem, or no number.
        InputError: if a file is missing or has faults.
    """
    base = read(domain, problem)
    return base.with_values(dict(parse_setting(text, base) for text in settings))
