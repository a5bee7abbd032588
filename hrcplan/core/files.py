"""Reading files with clear errors, writing them whole or not at all, and the cache folder."""

from __future__ import annotations

import contextlib
import errno
import os
from collections.abc import Sequence
from itertools import combinations
from typing import TYPE_CHECKING

from hrcplan.core.text import harmless
from hrcplan.errors import InputError, UsageError

if TYPE_CHECKING:
    from pathlib import Path

MAX_BYTES = 64 << 20  # of a text that is read: also ends the reading of what never ends

_SHORT = 1 << 16


def read_bytes(path: str | Path, limit: int | None = MAX_BYTES) -> bytes:
    """Return the content of a file.

    Raises:
        InputError: if there is no such file, it is a folder or longer than ``limit`` bytes, or it
            may not be read; the message names the path and the reason.
    """
    name = harmless(str(path))
    try:
        with open(path, "rb") as file:
            data = file.read(_SHORT)  # asking for much at once takes a while, however short it is
            if len(data) == _SHORT:
                data += file.read(-1 if limit is None else limit + 1 - _SHORT)
    except IsADirectoryError:
        message, hint = f"{name} is a folder, not a file", "name one file inside it"
        raise InputError(message, code="is-folder", path=name, hint=hint) from None
    except FileNotFoundError:
        raise InputError(f"there is no file {name}", code="no-file", path=name) from None
    except (OSError, ValueError) as error:
        message = f"cannot read {name}: {reason_of(error)}"
        raise InputError(message, code="no-access", path=name) from None
    if limit is not None and len(data) > limit:
        message = f"{name} holds more than {limit >> 20} MiB"
        raise InputError(message, code="too-large", path=name)
    return data


_ARCHIVES = {b"BZh": "bzip2", b"\x1f\x8b": "gzip", b"\xfd7zXZ\0": "xz", b"PK\x03\x04": "zip",
             b"7z\xbc\xaf": "7z", b"\x28\xb5\x2f\xfd": "zstd"}  # fmt: skip
_TAR_MAGIC = slice(257, 262)
UNPACK_HINT = "unpack it first, for example with: tar xf ARCHIVE, or unzip ARCHIVE"


def archive_kind(data: bytes | memoryview) -> str | None:
    """Return what kind of archive or compressed file bytes are; None if they are neither.

    >>> archive_kind(b"BZh91AY"), archive_kind(b"(define (domain d))")
    ('bzip2', None)
    """
    if data[_TAR_MAGIC] == b"ustar":
        return "tar"
    return next((kind for magic, kind in _ARCHIVES.items() if data[: len(magic)] == magic), None)


def reason_of(error: Exception) -> str:
    """Return why a file could not be used, without the path."""
    return getattr(error, "strerror", None) or harmless(str(error))


def write_atomically(path: Path, data: str | bytes) -> None:
    """Write a file by rename, with the permissions that a new file gets.

    A link stays and its target is written; a device such as ``/dev/stdout`` is written to directly.

    Raises:
        UsageError: if the folder is missing or may not be written.
    """
    place = str(path)
    try:
        raw = data.encode() if isinstance(data, str) else data
        place = os.path.realpath(path)
        if os.path.islink(place):  # still one: it leads to itself
            raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))
        if os.path.exists(place) and not os.path.isfile(place):
            with open(place, "wb") as device:
                device.write(raw)
            return
        import tempfile  # it takes 2 ms, and most commands write nothing

        # The name of the new file is no longer than a file system takes.
        folder, base = os.path.split(place)
        handle, name = tempfile.mkstemp(dir=folder, prefix=f".{base[:40]}.")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(raw)
            mask = os.umask(0)
            os.umask(mask)
            os.chmod(name, 0o666 & ~mask)
            os.replace(name, place)
        except BaseException:
            with contextlib.suppress(FileNotFoundError):
                os.unlink(name)
            raise
    except (OSError, ValueError) as error:
        target_name = harmless(place)
        raise UsageError(
            f"cannot write {target_name}: {reason_of(error)}", path=target_name
        ) from None


def make_folder(path: Path) -> None:
    """Make a folder and those above it; nothing happens if it is there.

    Raises:
        UsageError: if it cannot be made.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        name = harmless(str(path))
        raise UsageError(f"cannot make {name}: {reason_of(error)}", path=name) from None


def check_target(path: Path | None, *inputs: str | Path) -> None:
    """Refuse an output that cannot be written, or would replace a file that is read.

    Raises:
        UsageError: if ``path`` is a folder, its folder is missing, or it is one of ``inputs``.
    """
    if path is None:
        return
    name = harmless(str(path))
    if os.path.isdir(path) or not os.path.isdir(path.parent):
        raise UsageError(f"cannot write {name}: no such folder, or it is one", path=name)
    if any(_is_same(path, one) for one in inputs):
        message = f"cannot write {name}: the command reads it"
        raise UsageError(message, code="output-is-input", path=name, hint="name another file")


def check_targets(targets: Sequence[Path | None], *inputs: str | Path) -> None:
    """Refuse outputs as `check_target` does, and two outputs that would replace each other.

    Raises:
        UsageError: if one of ``targets`` cannot be written, is an input, or is there twice.
    """
    paths = [path for path in targets if path is not None]
    for path in paths:
        check_target(path, *inputs)
    for one, other in combinations(paths, 2):
        if os.path.realpath(one) == os.path.realpath(other) or _is_same(one, other):
            if os.path.exists(one) and not os.path.isfile(one):
                continue  # a device, such as /dev/null
            name = harmless(str(other))
            message = f"cannot write {name}: another result is written there"
            raise UsageError(message, code="same-output", path=name, hint="name another file")


def _is_same(one: str | Path, other: str | Path) -> bool:
    try:
        return os.path.samefile(one, other)
    except (OSError, ValueError):  # one of them is not there
        return False


def cache_folder() -> Path | None:
    """Return the folder of caches: files that can be made again. It need not exist.

    That is ``$HRCPLAN_CACHE``, else ``$XDG_CACHE_HOME/hrcplan``, else ``~/.cache/hrcplan``; None if
    the user has no home.
    """
    from pathlib import Path

    own, standard = os.environ.get("HRCPLAN_CACHE"), os.environ.get("XDG_CACHE_HOME", "")
    if own:
        return Path(own)
    if os.path.isabs(standard):  # the standard has others ignored
        return Path(standard) / "hrcplan"
    try:
        return Path.home() / ".cache" / "hrcplan"
    except RuntimeError:
        return None
