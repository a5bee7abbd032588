"""Requirement flags: which there are, which include others, and which a file uses unsaid."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from hrcplan.core.text import nearest, quote
from hrcplan.pddl.reader import GroupNode, WordNode
from hrcplan.pddl.source import SourceText

_QUANTIFIED = (":existential-preconditions", ":universal-preconditions")
_ADL = (":negative-preconditions", ":disjunctive-preconditions", ":equality", *_QUANTIFIED)
_INCLUDES = {
    ":adl": (":strips", ":typing", ":conditional-effects", *_ADL),
    ":quantified-preconditions": _QUANTIFIED,
    ":fluents": (":numeric-fluents",),
    ":domain-axioms": (":derived-predicates",),
    ":durative-inequalities": (":duration-inequalities",),
}
REQUIREMENTS = frozenset(
    [
        *_INCLUDES,
        *(flag for flags in _INCLUDES.values() for flag in flags),
        ":action-costs",
        ":durative-actions",
        ":duration-inequalities",
        ":durative-inequalities",
        ":object-fluents",
        ":continuous-effects",
        ":derived-predicates",
        ":domain-axioms",
        ":timed-initial-literals",
        ":preferences",
        ":constraints",
        ":goal-utilities",
        ":time",
    ]
)


def read_requirements(section: GroupNode | None, source: SourceText) -> tuple[str, ...]:
    """Return the flags of a ``:requirements`` section; an unknown one is a warning."""
    flags: list[str] = []
    for node in section[1:] if section else ():
        if not isinstance(node, WordNode):
            source.error(
                node.at, "not-a-name", "a requirement flag is expected here", "write :strips"
            )
            continue
        if node not in REQUIREMENTS:
            message = f"requirement {quote(node)} is unknown"
            hint = nearest(node, REQUIREMENTS) or "remove it"
            source.warn(node.at, "unknown-requirement", message, hint)
        flags.append(str(node))
    return tuple(flags)


def check_requirements(flags: Sequence[str], source: SourceText) -> None:
    """Warn about every requirement that the file uses and ``flags`` do not name.

    Without any flag nothing is said: then the file leaves it to the planner.
    """
    all_flags = _closure(flags)
    for flag, at in source.uses.items():
        if flags and flag not in all_flags:
            message = f"this needs the requirement {flag}"
            source.warn(at, "missing-requirement", message, f"add {flag} to (:requirements …)")


def _closure(flags: Iterable[str]) -> frozenset[str]:
    return frozenset(f for flag in flags for f in (flag, *_INCLUDES.get(flag, ())))
