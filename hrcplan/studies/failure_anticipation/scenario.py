"""What the study compares, read from ``scenario.toml``: tasks are never named in Python."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from hrcplan.errors import UsageError
from hrcplan.execution import Spec
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import FluentKey
from hrcplan.studies.scenario import Scenario
from hrcplan.studies.study import Cell, StudyOptions

HERE = Path(__file__).parent
SCENARIO = Scenario(HERE)
data, defaults, is_own_task = SCENARIO.data, SCENARIO.defaults, SCENARIO.is_own_task
WITH_MODEL, WITHOUT_MODEL = "b", "a"


@dataclass(frozen=True, slots=True)
class Method:
    """What a method changes in a simulated run, and the cases that it is run in."""

    name: str
    cases: tuple[str, ...]
    changes: Mapping[str, Any]


def inputs(options: StudyOptions) -> str:
    """Return what rows depend on: the file's tables, problems of all methods, and profiles."""
    keys = ("methods", "variants", "allocation", "example", "sweep")
    profiles = [path.read_text("utf-8") for path in sorted(HERE.glob("*.toml"))
                if path.name != "scenario.toml"]  # fmt: skip
    tasks = [
        {**options, **{k: v for k, v in method.changes.items() if k in options}}
        for method in methods("methods", options).values()
    ]
    names = sorted({(task["domain"], task["problem"]) for task in tasks})
    return SCENARIO.inputs(keys, [read(*name) for name in names], profiles)


def methods(kind: str, options: StudyOptions) -> dict[str, Method]:
    """Return the ``methods`` or ``variants``; on another task, those that do not name this one."""
    by_name = {}
    for name, table in data()[kind].items():
        changes = {key: value for key, value in table.items() if key != "cases"}
        if not is_own_task(options):
            if changes.keys() & {*options, "without"}:
                continue
            changes.pop("can_fail", None)  # names of this task's actions
        by_name[name] = Method(name, tuple(table["cases"]), changes)
    return by_name


def sweep_cells(options: StudyOptions) -> list[Cell]:
    """Return parameter and value of every cell of the sweeps; none without their method."""
    settings = data()["sweep"]
    if settings["method"] not in methods("methods", options):
        return []
    return [
        (name, value)
        for name, parameter in settings["parameters"].items()
        for value in parameter["values"]
    ]


def swept(options: StudyOptions, cell: Cell, seed: str) -> Spec:
    """Return the simulated run of one cell of the sweeps."""
    settings = data()["sweep"]
    method = methods("methods", options)[settings["method"]]
    plain = spec(method, settings["case"], options, seed)
    parameter, value = settings["parameters"][cell[0]], cell[1]
    if "field" in parameter:
        return with_changes(plain, {parameter["field"]: value})
    return with_changes(plain, {"values": (((parameter["function"],), value),)})


def cells(kind: str, options: StudyOptions) -> list[Cell]:
    """Return case and method of every cell: case by case, in the order of the file."""
    selection = methods(kind, options).values()
    cases = sorted({case for method in selection for case in method.cases})
    return [(case, method.name) for case in cases for method in selection if case in method.cases]


def spec(method: Method, case: str, options: StudyOptions, seed: str) -> Spec:
    """Return the simulated run of a method in a case."""
    plain = Spec(
        domain=options["domain"], problem=options["problem"], case=int(case[0]),
        model=case[1] == WITH_MODEL, seed=seed,
    )  # fmt: skip
    return with_changes(plain, method.changes)


def with_changes(plain: Spec, changes: Mapping[str, Any]) -> Spec:
    """Return a run with some of its fields changed; its profiles are files in this folder."""
    fields: dict[str, Any] = {k: tuple(v) if isinstance(v, list) else v for k, v in changes.items()}
    if str(fields.get("profile", "")).endswith(".toml"):
        fields["profile"] = str(HERE / fields["profile"])
    return replace(plain, **fields)


def element(kind: str, options: StudyOptions, elements: Sequence[FluentKey]) -> FluentKey:
    """Return the element of a human's state that ``allocation`` or ``example`` changes.

    On another task: the first that belongs to the human as a whole, else the first.

    Raises:
        UsageError: if there is none.
    """
    if is_own_task(options):
        return tuple(data()[kind]["element"].split())
    if not elements:
        raise UsageError("no human of this problem has a state that could change", code="no-human")
    return next((key for key in elements if len(key) == 2), elements[0])


def element_name(kind: str, options: StudyOptions) -> str:
    """Return how texts call that element; which one it is on another task is left to the rows."""
    return str(data()[kind]["element"]) if is_own_task(options) else "the human's state"
