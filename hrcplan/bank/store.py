"""Banks in one file: a short prefix, a JSON header, arrays, and a hash over all of it.

::

    8 bytes  HRCPBANK
    4 bytes  version of the format
    4 bytes  zero
    8 bytes  length of the header
    8 bytes  length of the arrays
    32 bytes SHA-256 of the 32 bytes above, the header and the arrays
    header   JSON: sources with their hashes, the PDDL itself, recipe, goals, where arrays begin
    arrays   little-endian, each beginning at a multiple of 8

The PDDL travels along, so that a bank can be used where its sources are not. Where they are, they
must be as they were: a bank of a domain that has changed would answer wrongly.
"""

from __future__ import annotations

import hashlib
import json
import os
import struct
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hrcplan.bank.audit import fault
from hrcplan.bank.bank import Bank, Recipe
from hrcplan.bank.goals import SourceFile
from hrcplan.bank.graph import PlanGraph
from hrcplan.bank.rules import Packing
from hrcplan.bank.sources import goals_in
from hrcplan.bank.steps import StepTable
from hrcplan.errors import InputError, UsageError
from hrcplan.files import write_atomically
from hrcplan.pddl import library
from hrcplan.pddl.model import Number

MAGIC = b"HRCPBANK"
VERSION = 1
_PREFIX = struct.Struct("<8sIIQQ")
_HASH = hashlib.sha256().digest_size
_ALIGN = 8
_ARRAYS = {"rows": "<u8", "first": "<i8", "steps": "<i4", "targets": "<i4", "is_goal": "|b1"}


def dumps(bank: Bank, folder: Path = Path()) -> bytes:
    """Return a bank as bytes.

    Args:
        bank: The bank.
        folder: Where the file will be: sources are named relative to it.
    """
    arrays = _Arrays()
    graphs = [_graph_entry(graph, arrays) for graph in bank.graphs]
    header = {
        "domain": bank.goals.problem.domain.name,
        "agents": bank.agents,
        "recipe": _recipe_entry(bank.recipe),
        "build_s": bank.build_s,
        "n_steps": len(bank.table),
        "kind": bank.goals.kind,
        "sources": [_source_entry(file, folder) for file in bank.goals.files],
        "goals": graphs,
        "names": list(bank.names),
    }
    head = json.dumps(header, ensure_ascii=False, separators=(",", ":")).encode()
    head += b" " * (-len(head) % _ALIGN)
    body = b"".join(arrays.parts)
    prefix = _PREFIX.pack(MAGIC, VERSION, 0, len(head), len(body))
    return prefix + hashlib.sha256(prefix + head + body).digest() + head + body


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
    shown = str(path)
    header, body = _open(_read(path), shown)
    try:
        folder = Path(path).resolve().parent
        files = tuple(_source(entry, folder, shown) for entry in header["sources"])
        goals = goals_in(files, header["kind"]).only(header["names"])
        recipe = _recipe(header["recipe"])
        table = StepTable(goals.task, recipe.cost)
        if len(table) != header["n_steps"] or table.agents != header["agents"]:
            raise InputError(f"'{shown}' does not fit its PDDL", code="bad-bank", path=shown,
                             hint="it was made by another hrcplan: build it again")  # fmt: skip
        graphs = tuple(_graph(entry, body) for entry in header["goals"])
    except (KeyError, TypeError, ValueError, IndexError, UsageError) as error:
        raise InputError(f"'{shown}' has a header that makes no sense: {error!r}", code="bad-bank",
                         path=shown, hint="build it again") from None  # fmt: skip
    return Bank(goals, table, graphs, recipe, header["build_s"])


def verify(path: str | Path) -> str | None:
    """Return what is wrong with a bank, or None if all is well.

    Beyond what ``load`` looks at: every edge is a step that can be done in its node and leads to
    its target, goal nodes are goals, and no other node is without edges.

    Raises:
        InputError: if there is no such file, or it may not be read.
    """
    _read(path)
    try:
        bank = load(path)
    except InputError as error:
        return error.message
    return next((found for goal in range(len(bank.graphs)) if (found := fault(bank, goal))), None)


def _read(path: str | Path) -> bytes:
    shown = str(path)
    try:
        return Path(path).read_bytes()
    except OSError as error:
        message = f"cannot read '{shown}': {error.strerror or error}"
        raise InputError(message, code="no-file", path=shown) from None


def _open(data: bytes, shown: str) -> tuple[dict[str, Any], memoryview]:
    """Return header and arrays, once everything that can be checked without PDDL is."""

    def refuse(code: str, message: str) -> InputError:
        hint = "make it with: hrcplan bank build"
        return InputError(f"'{shown}' {message}", code=code, path=shown, hint=hint)

    if not data.startswith(MAGIC):
        raise refuse("not-a-bank", "is no policy bank")
    begin = _PREFIX.size + _HASH
    if len(data) < begin:
        raise refuse("bank-truncated", f"is cut short: {len(data)} bytes")
    _, version, _, n_head, n_body = _PREFIX.unpack_from(data)
    if version != VERSION:
        raise refuse("bank-version", f"is a bank of format {version}; this hrcplan reads {VERSION}")
    if len(data) != begin + n_head + n_body:
        raise refuse(
            "bank-truncated", f"has {len(data)} bytes instead of {begin + n_head + n_body}"
        )
    view = memoryview(data)
    digest = hashlib.sha256(view[: _PREFIX.size])
    digest.update(view[begin:])
    if digest.digest() != data[_PREFIX.size : begin]:
        raise refuse("bank-damaged", "is damaged: its checksum is wrong")
    header: dict[str, Any] = json.loads(data[begin : begin + n_head])
    return header, view[begin + n_head :]


# Sources.


def _source_entry(file: SourceFile, folder: Path) -> dict[str, str]:
    """Return a source with its text; files that are not shipped are named from ``folder``."""
    path, shipped = Path(file.path).resolve(), library.root().resolve()
    inside = path.is_relative_to(shipped)
    return {
        "place": "shipped" if inside else "beside",
        "path": str(path.relative_to(shipped)) if inside else os.path.relpath(path, folder),
        "sha256": file.sha256,
        "text": file.data.decode(),
    }


def _source(entry: Mapping[str, str], folder: Path, shown: str) -> SourceFile:
    """Return a stored source, after a look at the file it came from, if that is there.

    Raises:
        InputError: if the file has changed since.
    """
    origin = (library.root() if entry["place"] == "shipped" else folder) / entry["path"]
    stored = SourceFile(os.path.normpath(origin), entry["text"].encode())
    if origin.is_file() and SourceFile.read(origin).sha256 != stored.sha256:
        message = f"'{shown}' was made from another version of {stored.path}"
        hint = "build the bank again, or restore the file"
        raise InputError(message, code="bank-outdated", path=shown, hint=hint)
    return stored


# Recipe and graphs.


def _recipe_entry(recipe: Recipe) -> dict[str, Any]:
    alternatives = None if recipe.alternatives is None else str(recipe.alternatives)
    return {
        "cost": recipe.cost, "quality": str(recipe.quality), "alternatives": alternatives,
        "sample": recipe.sample,
    }  # fmt: skip


def _recipe(entry: Mapping[str, Any]) -> Recipe:
    alternatives = entry["alternatives"]
    return Recipe(
        entry["cost"], Fraction(entry["quality"]),
        None if alternatives is None else Fraction(alternatives), entry["sample"],
    )  # fmt: skip


class _Arrays:
    """Arrays one after the other, each beginning at a multiple of 8."""

    def __init__(self) -> None:
        self.parts: list[bytes] = []
        self.n_bytes = 0

    def add(self, array: NDArray[Any], kind: str) -> dict[str, Any]:
        """Take in an array and return where it is."""
        data = np.ascontiguousarray(array, dtype=kind).tobytes()
        entry = {"at": self.n_bytes, "shape": list(array.shape)}
        self.parts.append(data + b"\0" * (-len(data) % _ALIGN))
        self.n_bytes += len(self.parts[-1])
        return entry


def _graph_entry(graph: PlanGraph, arrays: _Arrays) -> dict[str, Any]:
    return {
        "name": graph.goal,
        "plans": str(graph.plans),
        "complete": graph.complete,
        "positions": list(graph.packing.positions),
        "layers": [[str(cost), first] for cost, first in graph.layers],
        "arrays": {name: arrays.add(getattr(graph, name), kind) for name, kind in _ARRAYS.items()},
    }


def _graph(entry: Mapping[str, Any], body: memoryview) -> PlanGraph:
    def array(name: str) -> NDArray[Any]:
        place = entry["arrays"][name]
        size = int(np.prod(place["shape"], dtype=np.int64))
        found = np.frombuffer(body, dtype=_ARRAYS[name], count=size, offset=place["at"])
        return found.reshape(place["shape"])

    return PlanGraph(
        entry["name"], Packing(tuple(entry["positions"])), array("rows"),
        tuple((_number(cost), first) for cost, first in entry["layers"]), array("first"),
        array("steps"), array("targets"), array("is_goal"), entry["complete"],
    )  # fmt: skip


def _number(text: str) -> Number:
    value = Fraction(text)
    return int(value) if value.denominator == 1 else value
