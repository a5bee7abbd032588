"""Files that are there completely or not at all, and where those go that can be made again."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from hrcplan.errors import UsageError


def write_atomically(path: Path, data: str | bytes) -> None:
    """Write a file by rename, with the permissions that a new file gets.

    A link stays and its target is written; a device such as ``/dev/stdout`` is written to directly.

    Raises:
        UsageError: if the folder is missing or may not be written.
    """
    raw = data.encode() if isinstance(data, str) else data
    try:
        path = path.resolve()
        if path.exists() and not path.is_file():
            path.write_bytes(raw)
            return
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(raw)
            mask = os.umask(0)
            os.umask(mask)
            os.chmod(name, 0o666 & ~mask)
            Path(name).replace(path)
        except BaseException:
            Path(name).unlink(missing_ok=True)
            raise
    except OSError as error:
        reason = error.strerror or str(error)
        raise UsageError(f"cannot write {path}: {reason}", path=str(path)) from None


def cache_folder() -> Path | None:
    """Return the folder for what can be made again; it need not exist.

    That is ``$HRCPLAN_CACHE``, else ``$XDG_CACHE_HOME/hrcplan``, else ``~/.cache/hrcplan``; None if
    the user has no home.
    """
    own, shared = os.environ.get("HRCPLAN_CACHE"), os.environ.get("XDG_CACHE_HOME", "")
    if own:
        return Path(own)
    if os.path.isabs(shared):  # the standard has others ignored
        return Path(shared) / "hrcplan"
    try:
        return Path.home() / ".cache" / "hrcplan"
    except RuntimeError:
        return None
