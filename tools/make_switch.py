#!/usr/bin/env python3
"""Write hrcplan/studies/switch/instances.json again: hashes, goals and recordings of the benchmark.

tools/make_switch.py          takes some minutes
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from hrcplan.episodes.traces import answer_of, trace_of_episode
from hrcplan.studies.switch import instances, methods, tasks
from hrcplan.studies.switch.episodes import play, played_oracle_steps
from hrcplan.studies.switch.instances import SwitchInstance, actions_sha256


def entry(instance: SwitchInstance) -> dict[str, Any]:
    """Return what is listed of an instance."""
    bank = tasks.bank_of(instance.task)
    recorder = methods.robot(instance.task, tasks.definition()["recorder"])
    trace = trace_of_episode(bank, play(instance, recorder)[0], {})
    answer = answer_of(bank, instance.course)
    return {
        "goals": list(answer.goals), "turns": list(answer.turns),
        "oracle_steps": played_oracle_steps(instance),
        "recording_sha256": actions_sha256(trace.actions),
    }  # fmt: skip


def document() -> dict[str, Any]:
    """Return the whole list."""
    return {
        "benchmark": tasks.NAME, "version": tasks.definition()["version"],
        "tasks": {task: tasks.hashes_of(task) for task in tasks.task_names()},
        "instances": {one.name: entry(one) for one in instances.all_instances()},
    }  # fmt: skip


def text_of(table: dict[str, Any]) -> str:
    """Return the list with one instance a line."""
    lines = [
        f"  {json.dumps(key)}: " + (
            "{\n" + ",\n".join(f"    {json.dumps(k)}: {json.dumps(v)}" for k, v in value.items())
            + "\n  }" if isinstance(value, dict) else json.dumps(value)
        )
        for key, value in table.items()
    ]  # fmt: skip
    return "{\n" + ",\n".join(lines) + "\n}\n"


if __name__ == "__main__":
    instances.LIST.write_text(text_of(document()), "utf-8")
