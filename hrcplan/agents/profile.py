"""Profiles: function values for the planner from sensed values, and when to replan.

A profile is data (``profiles.toml``, or a file of the user's); this module only reads it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import MISSING, asdict, dataclass, fields, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

from hrcplan.agents.estimate import AgentStateEstimate, Prior
from hrcplan.agents.memory import Memory
from hrcplan.agents.state import AgentModel, failure_probability
from hrcplan.core.deprecation import current_name, warn_old_name
from hrcplan.core.json_values import JsonValue
from hrcplan.core.numbers import Number, exact
from hrcplan.core.text import nearest, quote
from hrcplan.core.toml import read_toml
from hrcplan.errors import InputError, UsageError
from hrcplan.pddl.model import FluentKey, Problem
from hrcplan.pddl.settings import parse_setting

_SHIPPED = Path(__file__).with_name("profiles.toml")
REPLAN_ALWAYS = "replan-always"
OLD_NAMES = {"paper": REPLAN_ALWAYS}
_ALONE = 2  # the length of an element that depends on its agent alone
_SURE = 1e-9  # probabilities that differ by less are the same
_PLACES = 100  # function values are rounded to hundredths: planners scale costs to integers
Experience = Memory | AgentStateEstimate
_LARGEST = 1e9  # of scale and cap: far beyond any excess
_KINDS = {str: "a text", bool: "true or false", int: "a whole number", float: "a number"}
_CHOICES = {
    "values": ("sensed", "log"),
    "replan": ("change", "worse"),
    "while_draining": ("finish", "cancel"),
}


@dataclass(frozen=True, slots=True)
class Profile:
    """One profile; the keys are explained in ``profiles.toml``."""

    name: str
    values: str = "sensed"
    memory: bool = False
    estimate: bool = False
    replan: str = "change"
    while_draining: str = "finish"
    replan_limit: int = 5
    scale: float = 10.0
    cap: float = 60.0

    def __post_init__(self) -> None:
        """Check every key.

        Raises:
            InputError: naming the first key with a value that is not known.
        """
        for one in fields(self):
            value = getattr(self, one.name)
            kind = str if one.default is MISSING else type(one.default)
            if not _is_of(value, kind):
                message = f"profile '{self.name}': {one.name} is {_KINDS[kind]}, not {value!r}"
                raise InputError(message, code="bad-profile")
        for key, choices in _CHOICES.items():
            if getattr(self, key) not in choices:
                message = f"profile '{self.name}': {key} must be {' or '.join(choices)}"
                raise InputError(message, code="bad-profile")
        if self.replan_limit < 0 or self.scale <= 0 or self.cap <= 0:
            message = f"profile '{self.name}': limits, scale and cap are positive"
            raise InputError(message, code="bad-profile")

    def begin(self, model: AgentModel) -> Experience:
        """Return what is remembered, or believed, before anything has happened."""
        return AgentStateEstimate.begin(Prior.of(model)) if self.estimate else Memory()

    def planner_values(
        self, model: AgentModel, sensed: Mapping[FluentKey, Number], memory: Experience
    ) -> dict[FluentKey, Number]:
        """Return the function values that the planner gets for a belief about the agents.

        Every element has a value, also those at their low value, so that equal beliefs are equal.
        """
        blame = self._excesses(memory.blame()) if self.memory or self.estimate else {}
        elements = {
            key: self._value(sensed.get(key, low), low, blame.get(key, 0))
            for key, low in model.low.items()
        }
        initial = model.problem.values
        residuals = {k: self._value(initial[k], low, 0) for k, low in model.residuals.items()}
        return elements | residuals

    def _value(self, value: Number, low: Number, blame: Number) -> Number:
        p = failure_probability(value, low)
        if not p and not blame:
            return low if self.values == "log" else value
        if self.values == "sensed" and not blame:
            return value
        return low + max(self._excess(p) if self.values == "log" else value - low, blame)

    def _excesses(self, blame: Mapping[FluentKey, float]) -> dict[FluentKey, Number]:
        """Return the excess of each element that may make an action fail.

        Only one of them does, so probabilities add up: excesses are such that those of what depends
        on the agent alone (it touches all its actions) and of one element more give together the
        excess of the sum of their probabilities.
        """
        excesses: dict[FluentKey, Number] = {}
        always = {agent: 0.0 for _, agent, *_ in blame}
        for key, p in blame.items():
            always[key[1]] += p if len(key) == _ALONE else 0
        for key, p in blame.items():
            p_all = always[key[1]]
            if len(key) == _ALONE:
                share = Fraction(p) / Fraction(p_all)
                excesses[key] = _round(Fraction(self._excess(p_all)) * share)
            else:
                excesses[key] = self._excess(min(1.0, p_all + p)) - self._excess(p_all)
        return excesses

    def _excess(self, p: float) -> Number:
        """Return ``-scale * ln(1 - p)``, at most ``cap``, in hundredths."""
        loss = self.cap if p >= 1 - _SURE else min(self.cap, -self.scale * math.log1p(-p))
        return _round(Fraction(loss))

    def to_json(self) -> dict[str, Any]:
        """Return the profile as a JSON object."""
        return asdict(self)

    def limited_to(self, replan_limit: int | None) -> Profile:
        """Return this profile with another replan limit, if one is given."""
        return self if replan_limit is None else replace(self, replan_limit=replan_limit)


def _is_of(value: JsonValue, kind: type) -> bool:
    """Whether a value has the type of a key; a whole number stands for a float, too."""
    if kind is float:
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            return False
        return abs(value) < _LARGEST
    return type(value) is kind


def _round(value: Fraction) -> Number:
    return exact(Fraction(round(value * _PLACES), _PLACES))


def profile_names() -> tuple[str, ...]:
    """Return the names of the shipped profiles.

    >>> profile_names()
    ('replan-always', 'hrcplan', 'estimated')
    """
    return tuple(_read(_SHIPPED))


def load_profile(name: str) -> Profile:
    """Return a shipped profile, or the one (or first) in a ``.toml`` file.

    Raises:
        UsageError: if there is no profile of this name.
        InputError: if the file is missing, or a key or value in it is unknown.

    >>> load_profile("replan-always").replan_limit
    5
    """
    if name.endswith(".toml"):
        tables = {key: table for key, table in _read(Path(name)).items() if isinstance(table, dict)}
        if not tables:
            hint = "begin it with a name in brackets, such as [patient]"
            raise InputError("the file has no table", code="bad-profile", path=name, hint=hint)
        first = next(iter(tables))
        return profile_from_table({"name": first, **tables[first]}, name)
    name = current_name("profile", name, OLD_NAMES)
    profiles = _read(_SHIPPED)
    if name not in profiles:
        hint = nearest(name, profiles) or f"profiles: {', '.join(profiles)}; or a .toml file"
        raise UsageError(f"there is no profile '{name}'", code="unknown-profile", hint=hint)
    return profile_from_table({"name": name, **profiles[name]})


def profile(name: str) -> Profile:
    """Return a profile: the earlier name of `load_profile`, deprecated."""
    warn_old_name("function", "hrcplan.agents.profile", "hrcplan.agents.load_profile")
    return load_profile(name)


def agent_values(
    problem: Problem, settings: Sequence[str], profile: str | None = None
) -> dict[FluentKey, Number]:
    """Return the function values that planners get for settings such as ``motivation human=8``.

    Args:
        problem: The problem.
        settings: Values of functions, in place of those of the problem.
        profile: How agent state becomes costs, as in ``execute``; as it is by default.

    Raises:
        UsageError: if a setting is none of the problem, or there is no such profile.
    """
    values = dict(parse_setting(text, problem) for text in settings)
    if profile is not None:
        values |= load_profile(profile).planner_values(AgentModel(problem), values, Memory())
    return values


def profile_from_table(table: Mapping[str, Any], path: str | None = None) -> Profile:
    """Return the profile that a table describes.

    Raises:
        InputError: if a key is unknown or a value has the wrong kind.
    """
    names = [field.name for field in fields(Profile)]
    for key in table:
        if key not in names:
            hint = nearest(key, names) or f"keys: {', '.join(names[1:])}"
            raise InputError(f"a profile has no '{key}'", code="bad-profile", path=path, hint=hint)
    try:
        return Profile(**table)
    except TypeError as error:
        raise InputError(f"bad profile: {error}", code="bad-profile", path=path) from None


def _read(path: Path) -> dict[str, dict[str, Any]]:
    tables = read_toml(path, "bad-profile")
    for name, table in tables.items():
        if not isinstance(table, dict):
            message, hint = f"{quote(name)} is no profile", f"a profile is a table: [{name}]"
            raise InputError(message, code="bad-profile", path=str(path), hint=hint)
    return tables
