"""Commands of hrcplan for a caller who may read the files of some folders only."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from hrcplan.errors import UsageError

MAX_SECONDS = 300.0
_MARGIN_S = 30.0  # what a command may take besides its own limit
_NAME = re.compile(r"[\w-]+(/[\w-]+)?")
_TEXT = re.compile(r"\s*[(;]|\s*[\d.]+\s*:")


class FolderCommands:
    """Runs commands in child processes; inputs are texts, shipped names, or files of the folders.

    Args:
        folders: Where files may lie; relative paths start from the first.
    """

    def __init__(self, folders: Sequence[str | Path]) -> None:
        self.folders = [Path(os.path.realpath(folder)) for folder in folders]

    def run(self, *words: str, timeout_s: float = MAX_SECONDS) -> dict[str, Any]:
        """Return the document that a command prints with ``--json``; errors are documents, too.

        Raises:
            UsageError: if the command takes too long.
        """
        command = [sys.executable, "-P", "-m", "hrcplan", *words, "--json"]
        try:
            done = subprocess.run(
                command, cwd=self.folders[0], stdin=subprocess.DEVNULL, capture_output=True,
                text=True, timeout=timeout_s + _MARGIN_S, check=False,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            raise UsageError(f"'{words[0]}' was stopped after {timeout_s:g} s") from None
        document: dict[str, Any] = json.loads(done.stdout)
        return document | {"exit_code": done.returncode}

    @contextmanager
    def files(self, *inputs: str) -> Iterator[list[str]]:
        """Yield a file or shipped name for each input; texts are written to a folder for a while.

        Raises:
            UsageError: if a path leads out of the folders.
        """
        with tempfile.TemporaryDirectory(prefix="hrcplan-mcp-") as folder:
            yield [self._file(text, Path(folder) / f"input-{number}.pddl")
                   for number, text in enumerate(inputs)]  # fmt: skip

    def _file(self, text: str, target: Path) -> str:
        if _TEXT.match(text):
            target.write_text(text)
            return str(target)
        path = Path(os.path.realpath(self.folders[0] / text))
        is_inside = any(path.is_relative_to(folder) for folder in self.folders)
        if (is_inside and path.exists()) or (_NAME.fullmatch(text) and not path.exists()):
            return str(path) if is_inside and path.exists() else text
        message = f"'{text}' is no file of the folders, no shipped name, and no PDDL text"
        raise UsageError(message, hint=f"folders: {', '.join(map(str, self.folders))}")
