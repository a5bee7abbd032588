"""Episodes that have failed on a cluster time and again: a file that names them, and an error."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path

from hrcplan.core.files import write_atomically
from hrcplan.core.text import cut, plural
from hrcplan.errors import LimitError
from hrcplan.studies.study import Episode

FILE = "quarantine.json"
MAX_NAMES = 3  # episodes that the message names
MAX_REASON = 300  # characters of a reason in the message


def end_with_quarantine(folder: Path, failures: Mapping[Episode, str]) -> None:
    """Write which episodes of a study have no row and why; without any, remove that file.

    Args:
        folder: The folder of the study.
        failures: Why, by episode.

    Raises:
        LimitError: if there are any, after the file was written.
    """
    path = folder / FILE
    if not failures:
        path.unlink(missing_ok=True)
        return
    entries = [{**asdict(episode), "why": why} for episode, why in failures.items()]
    entries.sort(key=lambda entry: (entry["table"], str(entry["cell"]), entry["run"]))
    write_atomically(path, json.dumps({"episodes": entries}, indent=2) + "\n")
    names = [f"{e['table']}, cell {e['cell']}, run {e['run']}: {cut(e['why'], MAX_REASON)}"
             for e in entries[:MAX_NAMES]]  # fmt: skip
    more = [f"and {len(entries) - MAX_NAMES} more"] if len(entries) > MAX_NAMES else []
    text = f"{plural(len(entries), 'episode')} in quarantine, all other rows are written: "
    hint = f"{path} lists them; the same command tries them again"
    raise LimitError(text + "; ".join([*names, *more]), code="quarantine", hint=hint)
