"""What a page offers to collaborate in: domains with their goals, shipped or in this folder."""

from __future__ import annotations

import os
import re
from contextlib import suppress
from pathlib import Path

from hrcplan.pddl import library

_DOMAIN_OF = re.compile(r"\(\s*:domain\s+([^\s()]+)")
_HEADING = 100_000  # characters in which a problem has named its domain


def offers() -> list[dict[str, str]]:
    """Return pairs of a domain and goals, as JSON objects: ``domain``, ``goals`` and ``label``.

    ``goals`` is a folder of problems, or, for a single problem, "" with both names in ``domain``.
    """
    rows = [row for folder in _folders() for row in _rows(folder)]
    return sorted(rows, key=lambda row: (bool(row["single"]), row["label"]))


def _folders() -> list[Path]:
    """Return the folders of problems here, then those that are shipped."""
    folders: dict[str, Path] = {}
    for root in (Path("problems"), library.root() / "problems"):
        with suppress(OSError):  # a folder that is missing, or may not be read, has no problems
            for folder in sorted(path for path in root.iterdir() if os.path.isdir(path)):
                folders.setdefault(folder.name, folder)
    return list(folders.values())


def _rows(folder: Path) -> list[dict[str, str]]:
    files = sorted(folder.glob("*.pddl"))
    domain = _domain_of(files[0]) if files else None
    if domain is None:
        return []
    goals = {"domain": domain, "goals": folder.name, "label": folder.name, "single": ""}
    problems = [
        {"domain": f"{folder.name}/{file.stem}", "goals": "", "single": "yes",
         "label": f"{folder.name}/{file.stem}"}
        for file in files
    ]  # fmt: skip
    return [goals, *problems] if folder.name == domain else [goals]


def _domain_of(path: Path) -> str | None:
    if not os.path.isfile(path):  # the reading of a pipe would not end
        return None
    try:
        with path.open(encoding="utf-8", errors="replace") as file:
            match = _DOMAIN_OF.search(file.read(_HEADING))
    except OSError:
        return None
    return match.group(1).lower() if match else None
