"""What a run depends on: the first line of its journal."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from hrcplan.agents import Profile
from hrcplan.agents.profile import profile_from_table
from hrcplan.core.json_values import DOCUMENT_FAULTS, JsonValue
from hrcplan.errors import InputError
from hrcplan.execution import events as ev
from hrcplan.execution.codec import from_json, to_json
from hrcplan.execution.worlds.simulated import FactChange, Nature, StateChange
from hrcplan.pddl import check
from hrcplan.pddl.model import Fact, Problem
from hrcplan.pddl.write import (
    domain_text,
    problem_text,
    rounded_values,
    with_rounded_values,
)


@dataclass(frozen=True)
class RunSetup:
    """What a run depends on besides what happens in it."""

    problem: Problem
    profile: Profile
    sensing: bool
    nature: Nature
    planners: tuple[str, ...] = ()
    world: str = "simulated"

    def to_json(self) -> dict[str, Any]:
        """Return the setup as a JSON object, complete in itself."""
        return {
            "domain": domain_text(self.problem.domain),
            "problem": problem_text(self.problem),
            **({"values": values} if (values := rounded_values(self.problem)) else {}),
            "profile": self.profile.to_json(),
            "sensing": self.sensing,
            "nature": _nature_to_json(self.nature),
            "planners": list(self.planners),
            "world": self.world,
        }


def setup_from_json(table: Mapping[str, Any], path: str) -> RunSetup:
    """Return the setup that the first line of a journal describes.

    Raises:
        InputError: if the line does not hold one.
    """
    try:
        return RunSetup(
            with_rounded_values(
                _problem(table["domain"], table["problem"]), table.get("values", {})
            ),
            profile_from_table(table["profile"], path),
            bool(table["sensing"]),
            _nature(table["nature"]),
            tuple(map(_text, table["planners"])),
            str(table.get("world", "simulated")),
        )
    except DOCUMENT_FAULTS as error:
        message = f"the first line of the journal is no beginning: {error!r}"
        raise InputError(message, code="bad-journal", path=path, line=1) from None


def _problem(domain: str, problem: str) -> Problem:
    with tempfile.TemporaryDirectory() as folder:
        paths = Path(folder, "domain.pddl"), Path(folder, "problem.pddl")
        for path, text in zip(paths, (domain, problem), strict=True):
            path.write_text(text, encoding="utf-8")
        task_problem = check.load_problem(check.load_domain(paths[0]), paths[1])
    return replace(task_problem, path="", domain=replace(task_problem.domain, path=""))


def _nature_to_json(nature: Nature) -> dict[str, Any]:
    changes = [to_json(ev.Sensed(c.t, c.values)) for c in nature.changes]
    accidents = [
        {"t": a.t, "adds": _words(a.adds), "deletes": _words(a.deletes)} for a in nature.accidents
    ]
    return {
        "seed": nature.seed, "changes": changes, "accidents": accidents, "sensed": nature.sensed,
        "draws": nature.draws,
        "can_fail": None if nature.can_fail is None else sorted(nature.can_fail),
        "stretch": list(nature.stretch),
    }  # fmt: skip


def _nature(table: Mapping[str, Any]) -> Nature:
    changes = [from_json(change) for change in table["changes"]]
    can_fail = table["can_fail"]
    least, most = map(float, table["stretch"])
    return Nature(
        table["seed"],
        tuple(StateChange(c.t, c.values) for c in changes),
        tuple(
            FactChange(a["t"], _fact_set(a["adds"]), _fact_set(a["deletes"]))
            for a in table["accidents"]
        ),
        table["sensed"], table["draws"], None if can_fail is None else frozenset(can_fail),
        (least, most),
    )  # fmt: skip


def _text(value: JsonValue) -> str:
    if isinstance(value, str):
        return value
    raise TypeError(f"{value!r} is no text")


def _words(facts: frozenset[Fact]) -> list[str]:
    return sorted(" ".join(fact) for fact in facts)


def _fact_set(words: Sequence[str]) -> frozenset[Fact]:
    return frozenset(tuple(word.split(" ")) for word in words)
