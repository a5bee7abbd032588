"""Traces: what was done in one world, as JSON lines that other programs can read and write.

The first line names the PDDL by a hash, each other line is one action:

    {"trace": 1, "domain": "kitchen", "pddl_sha256": "..."}
    {"t": 0.0, "agent": "human", "action": "get", "args": ["human", "yogurt"], "outcome": "done"}
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace

from hrcplan.errors import InputError
from hrcplan.pddl.inlining import plain
from hrcplan.pddl.model import TRUE, Problem
from hrcplan.pddl.write import domain_text, problem_text

VERSION = 1
DONE = "done"
OUTCOMES = (DONE, "failed", "cancelled", "unknown")


@dataclass(frozen=True, slots=True)
class TraceAction:
    """One action of a trace; ``t`` is when it began, ``outcome`` is one of ``OUTCOMES``."""

    t: float
    agent: str | None
    action: str
    args: tuple[str, ...]
    outcome: str = DONE


@dataclass(frozen=True, slots=True)
class ActionTrace:
    """What was done in one world; ``pddl_sha256`` is the result of ``world_sha256``."""

    domain: str
    pddl_sha256: str
    actions: tuple[TraceAction, ...]

    def text(self) -> str:
        """Return the trace as JSON lines."""
        head = {"trace": VERSION, "domain": self.domain, "pddl_sha256": self.pddl_sha256}
        lines = (head, *({**asdict(one), "args": list(one.args)} for one in self.actions))
        return "".join(json.dumps(line, ensure_ascii=False) + "\n" for line in lines)


def world_sha256(problem: Problem) -> str:
    """Return a hash of domain, objects and initial state, as this package writes them.

    The goal, and layout and comments of the files, make no difference.
    """
    world = replace(plain(problem), name="world", goal=TRUE, preferences=(), constraints=())
    text = domain_text(world.domain) + problem_text(world)
    return hashlib.sha256(text.encode()).hexdigest()


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
        InputError: if a line is damaged, or the version is unknown.
    """
    lines = text.splitlines()
    try:
        head = json.loads(lines[0])
        if head["trace"] != VERSION:
            message = f"a trace of version {head['trace']}; this version reads {VERSION}"
            raise InputError(message, code="bad-trace", path=path, line=1)
        actions = tuple(_actions(lines[1:], path))
        return ActionTrace(str(head["domain"]), str(head["pddl_sha256"]), actions)
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        message = f"the first line is no beginning of a trace: {error!r}"
        raise InputError(message, code="bad-trace", path=path, line=1) from None


def _actions(lines: list[str], path: str | None) -> Iterator[TraceAction]:
    for number, line in enumerate(lines, start=2):
        try:
            table = json.loads(line)
            action = TraceAction(
                float(table["t"]), table.get("agent"), str(table["action"]).lower(),
                tuple(str(arg).lower() for arg in table["args"]), table.get("outcome", DONE),
            )  # fmt: skip
            if action.outcome not in OUTCOMES:
                raise ValueError(f"no outcome {action.outcome!r}")
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
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
