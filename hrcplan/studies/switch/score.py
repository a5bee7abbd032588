"""Scores of traces: every trace is checked and played again, and no figure in it is believed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from hrcplan.core.files import read_bytes
from hrcplan.core.text import harmless, plural
from hrcplan.errors import InputError
from hrcplan.inference.traces import ActionTrace, TracedEpisode, is_trace, read_trace
from hrcplan.studies.study import StudyRow
from hrcplan.studies.switch.episodes import row_of
from hrcplan.studies.switch.instances import (
    SwitchInstance,
    actions_sha256,
    all_instances,
    listed,
    listed_hashes,
)
from hrcplan.studies.switch.methods import INFERENCE
from hrcplan.studies.switch.replay import replay
from hrcplan.studies.switch.standings import MEASURES, Standing, by_task_and_human, standings
from hrcplan.studies.switch.tasks import NAME, bank_of, definition, options_of
from hrcplan.studies.trace_files import SUFFIX

STUDY_NAME = "switch"
N_NAMED = 3  # instances that a message names


@dataclass(frozen=True, slots=True)
class TraceFault:
    """Why a trace, or a set of traces, is refused; ``line`` counts from 1."""

    path: str
    line: int | None
    code: str
    message: str


@dataclass(frozen=True)
class ScoredTraces:
    """What came of some traces.

    Attributes:
        n_traces: How many there are.
        faults: Why traces are refused; then there are no rows.
        rows: A row for each trace, by table, as the study ``switch`` has them.
    """

    n_traces: int
    faults: tuple[TraceFault, ...]
    rows: Mapping[str, Sequence[StudyRow]]

    def as_json(self) -> dict[str, Any]:
        """Return the JSON document of ``hrcplan score``."""
        return {
            "benchmark": NAME, "version": definition()["version"], "n_traces": self.n_traces,
            "tables": [
                {
                    "table": table,
                    "methods": [_standing(one) for one in standings(table, rows)],
                    "cells": [
                        {**cell, **_standing(one)} for cell, one in by_task_and_human(table, rows)
                    ],
                }
                for table, rows in self.rows.items()
            ],
            "faults": [
                {"path": one.path, "line": one.line, "code": one.code, "message": one.message}
                for one in self.faults
            ],
        }  # fmt: skip


def _standing(one: Standing) -> dict[str, Any]:
    """Return a standing as JSON; an end of an interval is None where it is not known."""
    measures: dict[str, dict[str, float | None]] = {}
    for name, mean in one.means.items():
        interval = None
        if mean is not None and mean.is_known:
            interval = MEASURES[name].interval(mean)
        measures[name] = {
            "mean": None if mean is None else mean.mean,
            "low": None if interval is None else interval.low,
            "high": None if interval is None else interval.high,
        }
    return {"method": one.method, "n": one.n, "measures": measures}


@dataclass(frozen=True, slots=True)
class _Entry:
    """A trace of the benchmark whose first line fits; not yet played again."""

    path: str
    trace: ActionTrace
    table: str
    method: str
    instance: SwitchInstance


def score(traces: str | Path) -> ScoredTraces:
    """Return what traces reach in the benchmark.

    Args:
        traces: A folder with traces at any depth, or one file.

    Raises:
        InputError: if there is no trace at all, or a file cannot be read.
    """
    paths = trace_paths(Path(traces))
    entries: list[_Entry] = []
    faults: list[TraceFault] = []
    for path in paths:
        try:
            entries.append(_entry(str(path)))
        except InputError as error:
            faults.append(_fault(str(path), error))
    faults += _incomplete(entries, str(traces), bool(faults))
    rows: dict[str, list[StudyRow]] = {}
    for entry in _in_order(entries) if not faults else ():
        try:
            rows.setdefault(entry.table, []).append(_row(entry))
        except InputError as error:
            faults.append(_fault(entry.path, error))
    tables = {name: rows[name] for name in definition()["tables"] if name in rows}
    return ScoredTraces(len(paths), tuple(faults), {} if faults else tables)


def _in_order(entries: Sequence[_Entry]) -> list[_Entry]:
    """Return entries by instance and then by method, wherever their files are."""
    places = {one: place for place, one in enumerate(all_instances())}
    return sorted(entries, key=lambda one: (places[one.instance], one.table, one.method))


def trace_paths(place: Path) -> list[Path]:
    """Return the traces at a place, in order.

    Raises:
        InputError: if there are none.
    """
    if place.is_dir():
        paths = sorted(path for path in place.rglob(f"*{SUFFIX}") if not path.is_fifo())
        if not paths:
            message = f"no traces in {harmless(str(place))}"
            hint = "hrcplan study run switch -o DIR --traces FOLDER writes some"
            raise InputError(message, code="no-traces", path=str(place), hint=hint)
        return paths
    read_bytes(place)
    return [place]


def _fault(path: str, error: InputError) -> TraceFault:
    return TraceFault(error.path or path, error.line, error.code, error.message)


def _entry(path: str) -> _Entry:
    """Return a trace whose first line fits the benchmark.

    Raises:
        InputError: if it is damaged, or of something else.
    """
    try:
        text = read_bytes(path).decode()
    except UnicodeDecodeError:
        _refuse("bad-trace", "this is no UTF-8", path)
    if not is_trace(text):
        _refuse("bad-trace", "the first line is no beginning of a trace", path)
    trace = read_trace(text, path)
    episode = trace.episode
    if episode is None or episode.study != STUDY_NAME:
        what = "no episode of a study" if episode is None else f"the study '{episode.study}'"
        _refuse("foreign-trace", f"this trace is of {what}, not of {NAME}", path)
    instance, method = _instance(episode, path)
    _check_head(trace, episode, instance, path)
    return _Entry(path, trace, episode.table, method, instance)


def _instance(episode: TracedEpisode, path: str) -> tuple[SwitchInstance, str]:
    """Return the instance and the method of an episode, which the benchmark must have."""
    table = definition()
    if episode.version != table["version"]:
        message = f"this trace is of version '{episode.version}' of {NAME}, not {table['version']}"
        _refuse("other-version", message, path)
    if episode.seed != table["seed"]:
        message = f"this trace is of seed {episode.seed}; that of {NAME} is {table['seed']}"
        _refuse("other-seed", message, path)
    if episode.table not in table["tables"] or len(episode.cell) != 3 or episode.options:
        _refuse("foreign-trace", f"{NAME} has no such episode", path)
    task, human, method = episode.cell
    instance = SwitchInstance(task, human, episode.run, episode.seed)
    if listed(instance) is None:
        _refuse("foreign-trace", f"{NAME} has no instance '{instance.name}'", path)
    return instance, method


def _check_head(
    trace: ActionTrace, episode: TracedEpisode, instance: SwitchInstance, path: str
) -> None:
    """Compare the first line of a trace with the list of instances."""
    known = listed(instance)
    assert known is not None
    if trace.pddl_sha256 != listed_hashes()[instance.task]["pddl_sha256"]:
        message = f"the trace is of other PDDL than the task '{instance.task}'"
        _refuse("other-pddl", message, path)
    answers = [(one.goals, one.turns) for one in episode.answers.values()]
    if answers != [(known.goals, known.turns)]:
        message = f"the answers are not those of the instance '{instance.name}'"
        _refuse("other-answers", message, path)
    if episode.goals != bank_of(instance.task).names:
        _refuse("other-pddl", f"the goals are not those of the task '{instance.task}'", path)
    if episode.table == INFERENCE and actions_sha256(trace.actions) != known.recording_sha256:
        message = f"the actions are not those recorded of '{instance.name}'"
        _refuse("other-recording", message, path)


def _refuse(code: str, message: str, path: str) -> NoReturn:
    raise InputError(message, code=code, path=path, line=1)


def _incomplete(entries: Sequence[_Entry], place: str, has_faults: bool) -> Iterator[TraceFault]:
    """Yield instances that are there twice, and methods that lack some."""
    by_method: dict[tuple[str, str], dict[SwitchInstance, _Entry]] = {}
    for entry in entries:
        own = by_method.setdefault((entry.table, entry.method), {})
        if (other := own.setdefault(entry.instance, entry)) is not entry:
            message = f"this is the same instance with the same method as {other.path}"
            yield TraceFault(entry.path, 1, "same-instance", message)
    wanted = all_instances()
    for (table, method), own in by_method.items() if not has_faults else ():
        if missing := [one.name for one in wanted if one not in own]:
            yield TraceFault(place, None, "incomplete", _missing_text(table, method, missing))


def _missing_text(table: str, method: str, missing: Sequence[str]) -> str:
    names = ", ".join(missing[:N_NAMED])
    more = f" and {len(missing) - N_NAMED} more" if len(missing) > N_NAMED else ""
    return f"{table}, {method}: {plural(len(missing), 'instance')} missing: {names}{more}"


def _row(entry: _Entry) -> StudyRow:
    """Return the row of a trace, from the episode that is played again.

    Raises:
        InputError: if the episode is another one.
    """
    instance = entry.instance
    record, beliefs = replay(
        bank_of(instance.task), entry.trace, options_of(instance.task), instance.human,
        instance.course, entry.path,
    )  # fmt: skip
    keys = {"task": instance.task, "human": instance.human, "method": entry.method}
    return {**keys, "run": instance.run, **row_of(entry.table, instance, record, beliefs)}
