"""What a study compares, as data: ``scenario.toml`` in the study's folder. Python names no task."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterable, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

from hrcplan.pddl.model import Problem
from hrcplan.pddl.write import domain_text, problem_text
from hrcplan.studies.study import StudyOptions


class Scenario:
    """The file ``scenario.toml`` of a study; its table ``task`` names the task of the study.

    Args:
        folder: Where the file is.
        lists: Options of the study that name more than one part, with commas between.
    """

    def __init__(self, folder: Path, lists: Iterable[str] = ()) -> None:
        self.folder = folder
        self._lists = tuple(lists)

    @cached_property
    def _data(self) -> Mapping[str, Any]:
        return tomllib.loads((self.folder / "scenario.toml").read_text(encoding="utf-8"))

    def data(self) -> Mapping[str, Any]:
        """Return the whole file."""
        return self._data

    def defaults(self) -> dict[str, str]:
        """Return the study's options: its own task, and empty lists (which stand for all)."""
        return {**self._data["task"], **dict.fromkeys(self._lists, "")}

    def is_own_task(self, options: StudyOptions) -> bool:
        """Whether the options name the task that the file was written for.

        What is printed in a paper, and what is expected of methods, holds for that task only.
        """
        return all(options[key] == value for key, value in self._data["task"].items())

    def inputs(self, keys: Iterable[str], problems: Iterable[Problem], more: Iterable[str]) -> str:
        """Return what rows depend on: tables of the file, domains and problems, and other texts."""
        tables = {key: self._data[key] for key in keys}
        texts = [text for p in problems for text in (domain_text(p.domain), problem_text(p))]
        return json.dumps([tables, *texts, *more], sort_keys=True)
