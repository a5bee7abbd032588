"""Parts of a problem with other names in them: of variables, objects, predicates, actions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from typing import TypeVar, cast

_NO_NAMES = frozenset(["kind", "op", "path", "requirements", "when"])

T = TypeVar("T")


def renamed(value: T, names: Mapping[str, str]) -> T:
    """Return a part of the model, or a whole problem, with other names wherever they stand in it.

    >>> from hrcplan.pddl.model import Atom, Not
    >>> print(renamed(Not(Atom("at", ("?x", "home"))), {"?x": "bob", "at": "is-at"}))
    (not (is-at bob home))
    """
    new: object = value
    match value:
        case str():
            new = names.get(value, value)
        case tuple() | frozenset():
            new = type(value)(renamed(part, names) for part in value)
        case dict():
            new = {renamed(key, names): renamed(part, names) for key, part in value.items()}
        case _ if is_dataclass(value) and not isinstance(value, type):
            parts = [field.name for field in fields(value) if field.name not in _NO_NAMES]
            new = replace(value, **{part: renamed(getattr(value, part), names) for part in parts})
    return cast("T", new)
