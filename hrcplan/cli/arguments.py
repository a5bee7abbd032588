"""Arguments that several commands share: DOMAIN PROBLEM, and ``--set``."""

from __future__ import annotations

from collections.abc import Sequence

from hrcplan.errors import UsageError
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.pddl.settings import parse_setting


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
    expectation = "a domain, a problem and a plan file" if n_more else "a domain and a problem"
    message = f"{expectation} are needed, as in 'transport two-boxes{' my.plan' if n_more else ''}'"
    raise UsageError(message, hint="in one word: transport/two-boxes; or paths")


def problem_of(domain: str, problem: str, settings: Sequence[str]) -> Problem:
    """Return a problem with the values of ``--set`` options put into its initial state.

    Raises:
        UsageError: if a setting does not name a function of the problem, or no number.
        InputError: if a file is missing or has faults.
    """
    base = read(domain, problem)
    return base.with_values(dict(parse_setting(text, base) for text in settings))
