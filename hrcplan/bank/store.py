"""Banks in one file, of the format in ``hrcplan.core.array_file``.

The header holds the sources with their hashes, the PDDL itself, the recipe and the goals.

The PDDL travels along, so that a bank can be used where its sources are not. Where they are, they
must be as they were: a bank of a domain that has changed would answer wrongly.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from hrcplan.bank.audit import fault, structure_fault
from hrcplan.bank.bank import AUTO, Bank, BuildOptions
from hrcplan.bank.goals import SourceFile
from hrcplan.bank.graph import PlanGraph, Team
from hrcplan.bank.sources import goals_in
from hrcplan.bank.team import turn_order
from hrcplan.core.array_file import Arrays, Format, array
from hrcplan.core.files import read_bytes, write_atomically
from hrcplan.core.json_values import DOCUMENT_FAULTS, JsonValue
from hrcplan.core.numbers import exact, fraction_of, int_text
from hrcplan.errors import InputError, UsageError
from hrcplan.pddl import library
from hrcplan.pddl.write import domain_text, problem_text
from hrcplan.search.packed_states import FactPacking
from hrcplan.task.steps import COSTS, StepTable

MAGIC = b"HRCPBANK"
VERSION = 1
TEAM_VERSION = 2  # of banks of team plans, which earlier versions cannot read
_FORMAT = Format(MAGIC, VERSION, "bank", "policy bank", "make it with: hrcplan bank build",
                 also_reads=(TEAM_VERSION,))  # fmt: skip
_TEXT = "(text)"  # the folder of sources that are no files
_ARRAYS = {"rows": "<u8", "first": "<i8", "steps": "<i4", "targets": "<i4", "is_goal": "|b1"}


def dumps(bank: Bank, folder: Path = Path()) -> bytes:
    """Return a bank as bytes.

    Args:
        bank: The bank.
        folder: Where the file will be: sources are named relative to it.
    """
    arrays = Arrays()
    graphs = [_graph_entry(graph, arrays) for graph in bank.graphs]
    header = {
        "domain": bank.goals.problem.domain.name,
        "agents": bank.agents,
        "recipe": _recipe_entry(bank.recipe),
        "build_s": bank.build_s,
        "n_steps": len(bank.table),
        "kind": bank.goals.kind,
        "sources": [_source_entry(file, folder) for file in bank.goals.files or _texts(bank)],
        "goals": graphs,
        "names": list(bank.names),
    }
    file_format = replace(_FORMAT, version=TEAM_VERSION) if bank.team else _FORMAT
    return file_format.encode(header, arrays)


def digest(bank: Bank) -> str:
    """Return a hash, in hex, of what a bank holds: its goals, steps and plans.

    Where the bank came from and how long it took makes no difference.
    """
    steps = [[bank.table[i].words, bank.table[i].name] for i in range(len(bank.table))]
    sha = hashlib.sha256(json.dumps([bank.agents, bank.names, steps]).encode())
    for graph in bank.graphs:
        arrays = [
            np.ascontiguousarray(getattr(graph, name), kind) for name, kind in _ARRAYS.items()
        ]
        layers = [[str(cost), first] for cost, first in graph.layers]
        shapes = [one.shape for one in arrays]
        sha.update(json.dumps([graph.packing.positions, layers, shapes]).encode())
        if graph.team is not None:
            sha.update(json.dumps(graph.team.agents).encode())
        for one in arrays:
            sha.update(one.data)
    return sha.hexdigest()


def save(bank: Bank, path: str | Path) -> None:
    """Write a bank to a file, by rename: it is there completely or not at all.

    Raises:
        UsageError: if the folder is missing or may not be written.
    """
    target = Path(path)
    write_atomically(target, dumps(bank, target.resolve().parent))


def load(path: str | Path) -> Bank:
    """Return the bank in a file.

    Raises:
        InputError: if the file is missing or no bank, is damaged or of another version, or the
            PDDL it was made from has changed.
    """
    name = str(path)
    header, body = _FORMAT.decode(read_bytes(path, limit=None), name)
    try:
        folder = Path(os.path.realpath(path)).parent
        files = tuple(_source(entry, folder, name) for entry in header["sources"])
        goals = goals_in(files, header["kind"]).only(header["names"])
        recipe = _recipe(header["recipe"])
        table = StepTable(goals.task, recipe.cost)
        if len(table) != header["n_steps"] or table.agents != header["agents"]:
            raise InputError(f"'{name}' does not fit its PDDL", code="bad-bank", path=name,
                             hint="it was made by another hrcplan: build it again")  # fmt: skip
        graphs = tuple(_graph(entry, body) for entry in header["goals"])
        build_s = _seconds(header["build_s"])
    except (*DOCUMENT_FAULTS, UsageError) as error:
        raise InputError(f"'{name}' has a header that makes no sense: {error!r}", code="bad-bank",
                         path=name, hint="build it again") from None  # fmt: skip
    bank = Bank(goals, table, graphs, recipe, build_s)
    if fault := _structure_fault(bank):
        message = f"'{name}' is no bank of its goals: {fault}"
        raise InputError(message, code="bad-bank", path=name, hint="build it again")
    return bank


def _structure_fault(bank: Bank) -> str | None:
    """Return why the graphs do not fit goals, steps and facts; the states are not looked at."""
    names = tuple(graph.goal for graph in bank.graphs)
    if names != bank.names:
        return f"its graphs are of {', '.join(map(str, names)) or 'no goal'}"
    teams = {graph.team for graph in bank.graphs}
    if not teams <= {None} and teams != {Team(turn_order(bank.goals.problem))}:
        return "its agents do not take turns as their problem says"
    n_steps, n_facts = len(bank.table), len(bank.goals.task.facts)
    faults = ((g.goal, structure_fault(g, n_steps, n_facts)) for g in bank.graphs)
    return next((f"'{name}': {fault}" for name, fault in faults if fault), None)


def _seconds(value: JsonValue) -> float:
    if not isinstance(value, (int, float)) or isinstance(value, bool) or not 0 <= value < math.inf:
        raise ValueError(f"build_s is {value!r}")
    return float(value)


def find_fault(path: str | Path) -> str | None:
    """Return what is wrong with a bank, or None if all is well.

    Beyond what ``load`` looks at: every edge is a step that can be done in its node and leads to
    its target, goal nodes are goals, and no other node is without edges.

    Raises:
        InputError: if there is no such file, or it may not be read.
    """
    read_bytes(path, limit=None)
    try:
        bank = load(path)
    except InputError as error:
        return error.message
    return next(filter(None, (fault(bank, goal) for goal in range(len(bank.graphs)))), None)


# Sources.


def _texts(bank: Bank) -> Iterator[SourceFile]:
    """Yield the domain and the problems of goals that were read from texts, as files."""
    first, goals = bank.goals.problem, bank.goals
    yield SourceFile(f"{_TEXT}/domain.pddl", domain_text(first.domain).encode())
    for name, formula in zip(goals.names, goals.formulas, strict=True):
        text = problem_text(replace(first, name=name, goal=formula))
        yield SourceFile(f"{_TEXT}/{name}.pddl", text.encode())


def _source_entry(file: SourceFile, folder: Path) -> dict[str, str]:
    """Return a source with its text; files that are not shipped are named from ``folder``."""
    path, library_folder = Path(file.path).resolve(), library.root().resolve()
    inside = path.is_relative_to(library_folder)
    return {
        "place": "shipped" if inside else "beside",
        "path": str(path.relative_to(library_folder)) if inside else os.path.relpath(path, folder),
        "sha256": file.sha256,
        "text": file.data.decode(),
    }


def _source(entry: Mapping[str, str], folder: Path, bank_name: str) -> SourceFile:
    """Return a stored source, after a look at the file it came from, if that is there.

    Raises:
        InputError: if the file has changed since.
    """
    origin = (library.root() if entry["place"] == "shipped" else folder) / entry["path"]
    source = SourceFile(os.path.normpath(origin), entry["text"].encode())
    if os.path.isfile(origin) and SourceFile.read(origin).sha256 != source.sha256:
        message = f"'{bank_name}' was made from another version of {source.path}"
        hint = "build the bank again, or restore the file"
        raise InputError(message, code="bank-outdated", path=bank_name, hint=hint)
    return source


# Recipe and graphs.


def _recipe_entry(recipe: BuildOptions) -> dict[str, Any]:
    alternatives = None if recipe.alternatives is None else str(recipe.alternatives)
    turns = {} if recipe.turns == AUTO else {"turns": recipe.turns}
    return {
        "cost": recipe.cost, "quality": str(recipe.quality), "alternatives": alternatives,
        "sample": recipe.sample, **turns,
    }  # fmt: skip


def _recipe(entry: Mapping[str, Any]) -> BuildOptions:
    alternatives = entry["alternatives"]
    if entry["cost"] not in COSTS or type(entry["sample"]) not in (int, type(None)):
        raise ValueError(f"the recipe is {entry!r}")
    return BuildOptions(
        entry["cost"], _fraction(entry["quality"]),
        None if alternatives is None else _fraction(alternatives), entry["sample"],
        entry.get("turns", AUTO),
    )  # fmt: skip


def _graph_entry(graph: PlanGraph, arrays: Arrays) -> dict[str, Any]:
    team = {} if graph.team is None else {"team": list(graph.team.agents)}
    return {
        **team,
        "name": graph.goal,
        "plans": int_text(graph.plans),
        "complete": graph.complete,
        "positions": list(graph.packing.positions),
        "layers": [[str(cost), first] for cost, first in graph.layers],
        "arrays": {name: arrays.add(getattr(graph, name), kind) for name, kind in _ARRAYS.items()},
    }


def _graph(entry: Mapping[str, Any], body: memoryview) -> PlanGraph:
    arrays = {name: array(body, entry["arrays"][name], kind) for name, kind in _ARRAYS.items()}
    return PlanGraph(
        goal=entry["name"], packing=FactPacking(tuple(map(_whole, entry["positions"]))),
        layers=tuple((exact(_fraction(cost)), _whole(first)) for cost, first in entry["layers"]),
        complete=bool(entry["complete"]), team=_team(entry), **arrays,
    )  # fmt: skip


def _team(entry: Mapping[str, Any]) -> Team | None:
    if "team" not in entry:
        return None
    agents = tuple(map(str, entry["team"]))
    if not agents:
        raise ValueError("a team has agents")
    return Team(agents)


def _whole(value: JsonValue) -> int:
    if not isinstance(value, int) or isinstance(value, bool):
        raise TypeError(f"{value!r} is no whole number")
    return value


def _fraction(text: JsonValue) -> Fraction:
    value = fraction_of(text)
    if value is None:
        raise ValueError(f"{text!r} is no number")
    return value
