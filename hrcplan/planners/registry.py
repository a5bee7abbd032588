"""Planner names to planners: ours, an installed package's, ``up:NAME``, ``cmd:…``, a class."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points

from hrcplan.core.text import nearest
from hrcplan.errors import MissingPlannerError, UsageError
from hrcplan.planners.contract import Planner

GROUP = "hrcplan.planners"
BUILT_IN = {
    "fast-downward": "hrcplan.planners.fast_downward:FastDownward",
    "exact": "hrcplan.planners.exact:ExactPlanner",
    "kairos": "hrcplan.planners.kairos:Kairos",
    "enhsp": "hrcplan.planners.enhsp:Enhsp",
}
_PREFIXES = {
    "up": "hrcplan.planners.up:UnifiedPlanning",
    "cmd": "hrcplan.planners.command:CommandPlanner",
}


def names() -> tuple[str, ...]:
    """Return the planners that have a name of their own: ours first, then installed ones."""
    return (*BUILT_IN, *sorted(entry.name for entry in _installed() if entry.name not in BUILT_IN))


def make(name: str) -> Planner:
    """Return the planner called ``name``.

    Raises:
        UsageError: if there is no such planner.
        MissingPlannerError: if the package that offers it cannot be imported.

    >>> make("kairos").card.name
    'kairos'
    """
    if name in BUILT_IN:
        return _load(name, BUILT_IN[name])
    prefix, _, rest = name.partition(":")
    if prefix in _PREFIXES and rest:
        return _load(name, _PREFIXES[prefix], rest)
    for entry in _installed():
        if entry.name == name:
            return _load(name, entry.value)
    if rest and prefix.replace(".", "").isidentifier() and rest.isidentifier():
        return _load(name, name)
    hint = nearest(name, names()) or f"known: {', '.join(names())}, up:NAME, cmd:PROGRAM …"
    raise UsageError(f"there is no planner '{name}'", code="unknown-planner", hint=hint)


def _installed() -> Iterator[EntryPoint]:
    yield from entry_points(group=GROUP)


def _load(name: str, place: str, *args: str) -> Planner:
    module, _, attribute = place.partition(":")
    try:
        kind = getattr(import_module(module), attribute)
    except (ImportError, AttributeError) as error:
        message = f"planner '{name}' cannot be loaded from {place}: {error}"
        raise MissingPlannerError(message, hint="is its package installed?") from error
    if not all(hasattr(kind, part) for part in ("missing", "solve")):
        hint = "it needs card, missing() and solve(request): see hrcplan/planners/contract.py"
        raise UsageError(f"{place} is no planner", code="not-a-planner", hint=hint)
    planner: Planner = kind(*args)
    return planner
