"""Traces: what was done in one world, as JSON lines that other programs can read and write.

The first line names the PDDL by a hash, each other line is one action:

    {"trace": 1, "domain": "kitchen", "pddl_sha256": "..."}
    {"t": 0.0, "agent": "human", "action": "get", "args": ["human", "yogurt"], "outcome": "done"}

The trace of an episode of a study also says which episode that is, and after each action of the
human what the robot believes.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any

from hrcplan.core.json_values import DOCUMENT_FAULTS
from hrcplan.errors import InputError
from hrcplan.pddl.inlining import plain
from hrcplan.pddl.model import TRUE, Problem
from hrcplan.pddl.write import domain_text, problem_text

VERSION = 1
DONE = "done"
OUTCOMES = (DONE, "failed", "cancelled", "unknown")


@dataclass(frozen=True, slots=True)
class TraceAction:
    """One action of a trace; ``t`` is when it began, ``outcome`` is one of ``OUTCOMES``.

    ``posterior`` is the probability of each goal after an action of the human, and ``declared``
    how many changes of goal the robot has declared up to then; None where that was not noted.
    """

    t: float
    agent: str | None
    action: str
    args: tuple[str, ...]
    outcome: str = DONE
    posterior: tuple[float, ...] | None = None
    declared: int | None = None

    @property
    def words(self) -> tuple[str, ...]:
        """Name and objects."""
        return (self.action, *self.args)

    def as_json(self) -> dict[str, Any]:
        """Return the action as a line of a trace."""
        table = {**asdict(self), "args": list(self.args)}
        if self.posterior is not None:
            table["posterior"] = list(self.posterior)
        return {key: table[key] for key in table if key in _ALWAYS or table[key] is not None}


_ALWAYS = ("t", "agent", "action", "args", "outcome")


@dataclass(frozen=True, slots=True)
class TraceAnswer:
    """What a human wanted: the goals, and the human's turns in which the later ones began."""

    goals: tuple[str, ...]
    turns: tuple[int, ...]


ALL_HUMANS = "all"
"""Whose answer it is, where all humans share a goal."""


@dataclass(frozen=True, slots=True)
class TracedEpisode:
    """Which episode of a study a trace is of.

    Attributes:
        goals: The goals' names, in the order of the posteriors.
        timesteps: How many timesteps the episode has, waits included; None if agents act at any
            time. A timestep without an action is a wait.
        answers: What each human wanted; a method that infers the goal must not read it.
        study: The name of the study.
        version: The version of the benchmark, if the study is one.
        table: The name of its table.
        cell: The cell.
        run: The number of the run.
        seed: The seed of the study.
        options: Options of the study that are not its defaults.
    """

    goals: tuple[str, ...]
    timesteps: int | None
    answers: Mapping[str, TraceAnswer]
    study: str = ""
    table: str = ""
    cell: tuple[str, ...] = ()
    run: int = 0
    seed: int = 0
    options: Mapping[str, str] = field(default_factory=dict)
    version: str = ""

    def as_json(self) -> dict[str, Any]:
        """Return the episode as the first line of a trace has it."""
        return {
            "study": self.study, "version": self.version, "table": self.table,
            "cell": list(self.cell), "run": self.run, "seed": self.seed,
            "options": dict(self.options), "goals": list(self.goals), "timesteps": self.timesteps,
            "answers": {
                who: {"goals": list(one.goals), "turns": list(one.turns)}
                for who, one in self.answers.items()
            },
        }  # fmt: skip


@dataclass(frozen=True, slots=True)
class ActionTrace:
    """What was done in one world; ``pddl_sha256`` is the result of ``world_sha256``."""

    domain: str
    pddl_sha256: str
    actions: tuple[TraceAction, ...]
    episode: TracedEpisode | None = None

    def text(self) -> str:
        """Return the trace as JSON lines; that of an episode has a hash of its actions."""
        body = "".join(map(_line, (one.as_json() for one in self.actions)))
        head: dict[str, Any] = {
            "trace": VERSION, "domain": self.domain, "pddl_sha256": self.pddl_sha256
        }  # fmt: skip
        if self.episode is not None:
            head |= {"actions_sha256": text_sha256(body), "episode": self.episode.as_json()}
        return _line(head) + body


def _line(table: Mapping[str, Any]) -> str:
    return json.dumps(table, ensure_ascii=False) + "\n"


def text_sha256(text: str) -> str:
    """Return the SHA-256 of a text in UTF-8, in hexadecimal."""
    return hashlib.sha256(text.encode()).hexdigest()


def world_sha256(problem: Problem) -> str:
    """Return a hash of domain, objects and initial state, as this package writes them.

    The goal, and layout and comments of the files, make no difference.
    """
    world = replace(plain(problem), name="world", goal=TRUE, preferences=(), constraints=())
    text = domain_text(world.domain) + problem_text(world)
    return text_sha256(text)


def is_trace(text: str) -> bool:
    """Return whether a text is a trace.

    >>> is_trace('{"trace": 1, "domain": "d", "pddl_sha256": ""}'), is_trace("(get yogurt)")
    (True, False)
    """
    try:
        head = json.loads(text.partition("\n")[0])
    except (ValueError, RecursionError):
        return False
    return isinstance(head, dict) and "trace" in head


def read_trace(text: str, path: str | None = None) -> ActionTrace:
    """Return the trace that a text holds.

    Raises:
        InputError: if a line is damaged, the version is unknown, or the actions are not those that
            the first line has a hash of.
    """
    first, _, body = text.partition("\n")
    try:
        head = json.loads(first)
        if head["trace"] != VERSION:
            message = f"a trace of version {head['trace']}; this version reads {VERSION}"
            raise InputError(message, code="bad-trace", path=path, line=1)
        actions = tuple(_actions(body.splitlines(), path))
        if "actions_sha256" in head and head["actions_sha256"] != text_sha256(body):
            message = "the actions were changed after the trace was written: another SHA-256"
            raise InputError(message, code="bad-trace", path=path, line=1)
        episode = _episode(head["episode"]) if "episode" in head else None
        return ActionTrace(str(head["domain"]), str(head["pddl_sha256"]), actions, episode)
    except DOCUMENT_FAULTS as error:
        message = f"the first line is no beginning of a trace: {error!r}"
        raise InputError(message, code="bad-trace", path=path, line=1) from None


def _episode(table: Mapping[str, Any]) -> TracedEpisode:
    numbers = (table["run"], table["seed"], table["timesteps"] or 0)
    if any(type(number) is not int for number in numbers):
        raise ValueError("run, seed and timesteps are whole numbers")
    answers = {
        str(who): TraceAnswer(tuple(map(str, one["goals"])), tuple(map(int, one["turns"])))
        for who, one in table["answers"].items()
    }
    return TracedEpisode(
        tuple(map(str, table["goals"])), table["timesteps"], answers, str(table["study"]),
        str(table["table"]), tuple(map(str, table["cell"])), table["run"], table["seed"],
        {str(key): str(value) for key, value in table["options"].items()}, str(table["version"]),
    )  # fmt: skip


def _posterior(values: Sequence[Any] | None) -> tuple[float, ...] | None:
    if values is None:
        return None
    if any(type(value) not in (int, float) for value in values):
        raise ValueError("a posterior is a list of numbers")
    return tuple(map(float, values))


def _actions(lines: list[str], path: str | None) -> Iterator[TraceAction]:
    for number, line in enumerate(lines, start=2):
        try:
            table = json.loads(line)
            action = TraceAction(
                float(table["t"]), table.get("agent"), str(table["action"]).lower(),
                tuple(str(arg).lower() for arg in table["args"]), table.get("outcome", DONE),
                _posterior(table.get("posterior")), table.get("declared"),
            )  # fmt: skip
            if action.outcome not in OUTCOMES:
                raise ValueError(f"no outcome {action.outcome!r}")
            if action.declared is not None and type(action.declared) is not int:
                raise ValueError("declared is a whole number")
        except DOCUMENT_FAULTS as error:
            message = f"this line is no action of a trace: {error!r:.80}"
            raise InputError(message, code="bad-trace", path=path, line=number) from None
        yield action


def observed_in(
    text: str, problem: Problem | None, path: str | None = None
) -> tuple[tuple[str, ...], ...]:
    """Return the actions of a trace that succeeded, as words.

    Raises:
        InputError: if it is damaged, or of other PDDL than ``problem``.
    """
    trace = read_trace(text, path)
    if problem is not None and trace.pddl_sha256 != world_sha256(problem):
        message = f"the trace is of other PDDL (domain {trace.domain})"
        hint = "domain, objects and initial state must be those it was recorded with"
        raise InputError(message, code="other-pddl", path=path, line=1, hint=hint)
    return tuple((one.action, *one.args) for one in trace.actions if one.outcome == DONE)
