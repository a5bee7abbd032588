"""The instances of the benchmark: a human with goals and chances, in a task, by name.

``instances.json`` lists them, so that a machine on which anything came out differently would be
noticed. ``tools/make_switch.py`` writes it.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from hrcplan.episodes.humans import Course
from hrcplan.inference.traces import TraceAction, text_sha256
from hrcplan.studies.changed_mind import scenario
from hrcplan.studies.study import Seed
from hrcplan.studies.switch.tasks import HERE, bank_of, definition, task_names

LIST = HERE / "instances.json"


@dataclass(frozen=True, slots=True)
class SwitchInstance:
    """One human in one task; ``run`` is its number."""

    task: str
    human: str
    run: int
    seed: int = 0

    @property
    def name(self) -> str:
        """The name of the instance.

        >>> SwitchInstance("kitchen", "2 changes", 3).name
        'kitchen/2 changes/3'
        """
        return f"{self.task}/{self.human}/{self.run}"

    @property
    def course(self) -> Course:
        """What the human wants and when."""
        return scenario.course(self.human, bank_of(self.task), Seed(self.seed, self.run))


@dataclass(frozen=True, slots=True)
class ListedInstance:
    """An instance as ``instances.json`` has it.

    Attributes:
        goals: What the human wants, one goal after the other.
        turns: The turns of the human in which each goal but the first begins to be wanted.
        oracle_steps: Timesteps with a robot that knows the goal.
        recording_sha256: Hash of what is done with the recorder, by `actions_sha256`.
    """

    goals: tuple[str, ...]
    turns: tuple[int, ...]
    oracle_steps: int
    recording_sha256: str


def all_instances() -> list[SwitchInstance]:
    """Return the instances of the benchmark, in their order."""
    table = definition()
    return [
        SwitchInstance(task, human, run, table["seed"])
        for task in task_names()
        for human in table["humans"]
        for run in range(table["runs"])
    ]


@cache
def _list() -> Mapping[str, Any]:
    document: dict[str, Any] = json.loads(LIST.read_text("utf-8"))
    return document


def listed_hashes() -> Mapping[str, Mapping[str, str]]:
    """Return the hashes of each task's PDDL."""
    tasks: Mapping[str, Mapping[str, str]] = _list()["tasks"]
    return tasks


def listed(instance: SwitchInstance) -> ListedInstance | None:
    """Return what the list says of an instance; None for one of another seed or run."""
    if instance.seed != definition()["seed"] or instance.name not in _list()["instances"]:
        return None
    one = _list()["instances"][instance.name]
    return ListedInstance(
        tuple(one["goals"]), tuple(one["turns"]), one["oracle_steps"], one["recording_sha256"]
    )


def actions_sha256(actions: Iterable[TraceAction]) -> str:
    """Return a hash of what was done when, without what was believed."""
    lines = (f"{one.t:g} {' '.join(one.words)}\n" for one in actions)
    return text_sha256("".join(lines))
