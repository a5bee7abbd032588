"""What was done in a journal, as a trace that `hrcplan infer` reads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from hrcplan.inference.traces import ActionTrace, TraceAction, world_sha256
from hrcplan.pddl.model import Problem

UNKNOWN = "unknown"  # of an action that still runs


def trace_of(
    lines: Sequence[Mapping[str, Any]], problem: Problem,
    beliefs: Mapping[int, tuple[tuple[float, ...], int]] | None = None,
) -> ActionTrace:  # fmt: skip
    """Return what was done, in the order in which it began; what was taken back is left out.

    Args:
        lines: The lines of a journal, of whatever format.
        problem: The problem of its first line.
        beliefs: By the number of an action: the posterior of the goals after it, and how many
            changes of goal were declared.
    """
    beliefs = beliefs or {}
    actions: dict[int, TraceAction] = {}
    for line in lines[1:]:
        event = line.get("event", {})
        number = event.get("number")
        if event.get("kind") == "ended" and number in actions:
            actions[number] = replace(actions[number], outcome=event["outcome"])
        if event.get("kind") == "undone" and event.get("attempted") and number in actions:
            actions[number] = replace(actions[number], outcome="failed")
        elif event.get("kind") == "undone":
            actions.pop(number, None)
        for command in line.get("decided", []):
            if command["kind"] == "dispatch":
                posterior, declared = beliefs.get(command["number"], (None, None))
                actions[command["number"]] = TraceAction(
                    command["t"], command["agent"] or None, command["action"],
                    tuple(command["args"]), UNKNOWN, posterior, declared,
                )  # fmt: skip
    return ActionTrace(problem.domain.name, world_sha256(problem), tuple(actions.values()))
