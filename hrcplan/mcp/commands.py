"""Commands of hrcplan for a caller who may read the files of some folders only."""

from __future__ import annotations

import os
import re
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from hrcplan.core.files import reason_of
from hrcplan.core.json_values import json_of
from hrcplan.core.text import quote
from hrcplan.errors import UsageError
from hrcplan.planners.process import ProcessEnd, ProcessLimits, run

MAX_SECONDS = 300.0
_MARGIN_S = 30.0  # what a command may take besides its own limit
_NAME = re.compile(r"\w[\w-]*(/\w[\w-]*)?")  # never an option
_TEXT = re.compile(r"\s*[(;]|\s*[\d.]+\s*:")


class FolderCommands:
    """Runs commands in child processes; inputs are texts, shipped names, or files of the folders.

    Args:
        folders: Where files may lie; relative paths start from the first.
        inputs: Where texts are written for a while; by default the system's temporary folder.
    """

    def __init__(self, folders: Sequence[str | Path], inputs: str | None = None) -> None:
        self._inputs = inputs
        self.folders = [Path(os.path.realpath(folder)) for folder in folders]

    def run(self, *words: str, timeout_s: float = MAX_SECONDS) -> dict[str, Any]:
        """Return the document that a command prints with ``--json``; errors are documents, too.

        Raises:
            UsageError: if the command takes too long, cannot be called with these words, or ends
                without an answer.
        """
        command = [sys.executable, "-P", "-m", "hrcplan", *words, "--json"]
        limits = ProcessLimits(timeout_s + _MARGIN_S, memory_bytes=None)
        try:
            done = run(command, cwd=self.folders[0], limits=limits)
        except (OSError, ValueError) as error:  # a NUL in a word, or no further process
            raise UsageError(f"'{words[0]}' cannot be called: {reason_of(error)}") from None
        if done.end is ProcessEnd.MISSING:  # words that are too long
            raise UsageError(f"'{words[0]}' cannot be called: {done.stderr.strip()}")
        if done.end is ProcessEnd.TIMEOUT:
            raise UsageError(f"'{words[0]}' was stopped after {timeout_s:g} s")
        try:
            document: dict[str, Any] = json_of(done.stdout)
        except ValueError:  # it was killed
            message = f"'{words[0]}' ended with exit code {done.code} and without an answer"
            raise UsageError(message) from None
        return document | {"exit_code": done.code}

    @contextmanager
    def files(self, *inputs: str) -> Iterator[list[str]]:
        """Yield a file or shipped name for each input; texts are written to a folder for a while.

        Raises:
            UsageError: if a path leads out of the folders.
        """
        with tempfile.TemporaryDirectory(prefix="hrcplan-mcp-", dir=self._inputs) as folder:
            yield [self._file(text, Path(folder) / f"input-{number}.pddl")
                   for number, text in enumerate(inputs)]  # fmt: skip

    def _file(self, text: str, target: Path) -> str:
        if _TEXT.match(text):
            target.write_text(text, encoding="utf-8", errors="replace")
            return str(target)
        path = self.folders[0] / text
        with suppress(ValueError):  # a name that no file can have
            path = Path(os.path.realpath(path))
        is_inside = any(path.is_relative_to(folder) for folder in self.folders)
        is_there = os.path.exists(path)
        if is_inside and is_there:
            return str(path)
        if _NAME.fullmatch(text) and not is_there:
            return text
        message = f"{quote(text)} is no file of the folders, no shipped name, and no PDDL text"
        raise UsageError(message, hint=f"folders: {', '.join(map(str, self.folders))}")
