"""The collaborations of one server: begun, found again by name, and continued from journals."""

from __future__ import annotations

import json
import os
import re
import secrets
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from hrcplan.core.files import make_folder, write_atomically
from hrcplan.core.json_values import json_of
from hrcplan.errors import InputError, UsageError
from hrcplan.web.banks import Banks
from hrcplan.web.live_session import LiveSession, SessionSpec

MAX_LIVE = 64  # collaborations that go on at once; each has a thread
MAX_KNOWN = 2000  # journals of a folder that pages list
_NAME = re.compile(r"[a-z0-9-]{4,40}")
_SPEC_FIELDS = {"domain": str, "goals": str, "pace": str, "method": str, "human": str, "seed": int}


def spec_of(document: dict[str, Any]) -> SessionSpec:
    """Return what a session is made of.

    Raises:
        UsageError: if the document does not say so; names of code (``module:Class``) are refused,
            for a page must not choose which code runs.
    """
    values: dict[str, Any] = {}
    for key, kind in _SPEC_FIELDS.items():
        value = document.get(key)
        if value is None or value == "":
            continue
        if not isinstance(value, kind) or (isinstance(value, str) and len(value) > 500):
            raise UsageError(f"'{key}' makes no sense", code="bad-request")
        values[key] = value
    if "domain" not in values:
        raise UsageError("a domain is needed", code="bad-request")
    for key in ("method", "human"):
        if ":" in values.get(key, ""):
            message = f"a page can only name a {key} that hrcplan knows"
            raise UsageError(message, code="unknown-name")
    return SessionSpec(**values)


class Sessions:
    """The collaborations whose journals are in one folder.

    Args:
        folder: Holds the journals (``NAME.jsonl``) and what they are of (``NAME.json``).
        banks: Where banks come from.
        changed: Is called, in any thread, when a session has something new.
    """

    def __init__(self, folder: Path, banks: Banks, changed: Callable[[], None]) -> None:
        self.folder, self.banks = folder, banks
        self._changed = changed
        self._lock = threading.Lock()
        self._live: dict[str, LiveSession] = {}

    def begin(self, spec: SessionSpec, name: str | None = None) -> LiveSession:
        """Return a new session, which has started.

        Raises:
            UsageError: if too many go on, or its files cannot be written.
        """
        name = name or secrets.token_hex(5)
        with self._lock:
            self._check_room()
            make_folder(self.folder)
            write_atomically(self._path(name, "json"), json.dumps(spec.to_json()) + "\n")
            return self._start(name, spec)

    def get(self, name: str) -> LiveSession | None:
        """Return a session by its name; one that has a journal here goes on; None if unknown."""
        if not _NAME.fullmatch(name):
            return None
        with self._lock:
            if name in self._live:
                return self._live[name]
            path = self._path(name, "json")
            if not os.path.isfile(path):
                return None
            self._check_room()
            return self._start(name, spec_in(path))

    def _check_room(self) -> None:
        over = [name for name, session in self._live.items() if session.is_over]
        for name in over[: max(0, len(self._live) + 1 - MAX_LIVE)]:
            del self._live[name]
        if len(self._live) >= MAX_LIVE:
            message = f"{MAX_LIVE} collaborations go on already"
            raise UsageError(message, code="too-many", hint="end one of them")

    def _start(self, name: str, spec: SessionSpec) -> LiveSession:
        session = LiveSession(name, spec, self.banks, self._path(name, "jsonl"), self._changed)
        self._live[name] = session
        session.start()
        return session

    def _path(self, name: str, kind: str) -> Path:
        return self.folder / f"{name}.{kind}"

    def overview(self) -> list[dict[str, Any]]:
        """Return every session's name, what it is of, and whether it goes on; the newest first.

        Of one whose file is damaged the phase says so, and what it is of is its name.
        """
        if not os.path.isdir(self.folder):
            return []
        paths = [p for p in self.folder.glob("*.json") if _NAME.fullmatch(p.stem)]
        paths.sort(key=lambda path: -_modified_s(path))
        return [self._row(path) for path in paths[:MAX_KNOWN]]

    def _row(self, path: Path) -> dict[str, Any]:
        session = self._live.get(path.stem)
        phase = session.now["phase"] if session is not None else "stopped"
        try:
            spec = spec_in(path)
        except InputError:
            phase, spec = "damaged", SessionSpec(path.stem)
        return {"name": path.stem, "phase": phase, **spec.to_json()}

    def delete(self, name: str) -> None:
        """Stop a session and remove its files."""
        with self._lock:
            session = self._live.pop(name, None)
        if session is not None:
            session.stop()
        for kind in ("jsonl", "json"):
            self._path(name, kind).unlink(missing_ok=True)

    def close(self) -> None:
        """Stop all sessions; their journals let them go on later."""
        with self._lock:
            sessions = list(self._live.values())
        for session in sessions:
            session.stop(wait_s=0)


def _modified_s(path: Path) -> float:
    """Return when a file was changed last; 0 if it is gone meanwhile."""
    try:
        return path.stat().st_mtime
    except OSError:
        return 0.0


def spec_in(path: Path) -> SessionSpec:
    """Return what a stored session is made of.

    Raises:
        InputError: if the file is damaged.
    """
    try:
        return spec_of(json_of(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, AttributeError, UsageError) as error:
        message = f"this does not say what a session is of: {error}"
        raise InputError(message, code="bad-session", path=str(path)) from None
