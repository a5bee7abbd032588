"""Arrays in one file: a short prefix, a JSON header, arrays, and a hash over all of it.

::

    8 bytes  magic
    4 bytes  version of the format
    4 bytes  zero
    8 bytes  length of the header
    8 bytes  length of the arrays
    32 bytes SHA-256 of the 32 bytes above, the header and the arrays
    header   JSON: whatever the file is about, and where arrays begin
    arrays   little-endian, each beginning at a multiple of 8
"""

from __future__ import annotations

import hashlib
import json
import math
import mmap
import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hrcplan.core.files import UNPACK_HINT, archive_kind
from hrcplan.core.json_values import json_of
from hrcplan.core.records import record
from hrcplan.errors import InputError

_PREFIX = struct.Struct("<8sIIQQ")
_HASH = hashlib.sha256().digest_size
_ALIGN = 8


class Arrays:
    """Arrays one after the other, each beginning at a multiple of 8.

    >>> arrays = Arrays()
    >>> arrays.add(np.arange(3), "<i4"), arrays.add(np.eye(2), "<f4")
    ({'at': 0, 'shape': [3]}, {'at': 16, 'shape': [2, 2]})
    >>> array(memoryview(b"".join(arrays.parts)), {"at": 16, "shape": [2, 2]}, "<f4").tolist()
    [[1.0, 0.0], [0.0, 1.0]]
    """

    def __init__(self) -> None:
        self.parts: list[bytes] = []
        self.n_bytes = 0

    def add(self, array: NDArray[Any], dtype: str) -> dict[str, Any]:
        """Append an array and return its entry: where it begins, and its shape."""
        data = np.ascontiguousarray(array, dtype=dtype).tobytes()
        entry = {"at": self.n_bytes, "shape": list(array.shape)}
        self.parts.append(data + b"\0" * (-len(data) % _ALIGN))
        self.n_bytes += len(self.parts[-1])
        return entry


def array(body: memoryview, entry: Mapping[str, Any], dtype: str) -> NDArray[Any]:
    """Return an array that was taken in, without a copy.

    Raises:
        ValueError: if there is no such array.
    """
    at, shape = entry["at"], entry["shape"]
    if any(type(n) is not int or n < 0 for n in (at, *shape)) or at % _ALIGN:
        raise ValueError(f"no array is at {at!r} with shape {shape!r}")
    size = math.prod(shape)  # of Python integers: it cannot overflow
    if at + size * np.dtype(dtype).itemsize > len(body):
        raise ValueError(f"the array at {at} with shape {shape} goes beyond the end")
    if not size:
        return np.zeros(shape, dtype=dtype)
    return np.frombuffer(body, dtype=dtype, count=size, offset=at).reshape(shape)


def map_file(path: Path) -> memoryview:
    """Return the bytes of a file, in memory that all processes share.

    The file may be removed or replaced by rename in the meantime, but not cut.

    Raises:
        OSError: if there is no such file, or it may not be read.
    """
    with path.open("rb") as file:
        if not file.seek(0, 2):  # nothing cannot be mapped
            return memoryview(b"")
        return memoryview(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ))


@record
class Format:
    """A file format; ``noun``, ``title`` and ``hint`` say in errors what it is and how to get one.

    Files of ``version`` are written; those of ``also_reads`` can be read, too.

    >>> toys = Format(b"TOYSTOYS", 1, "toy", "box of toys", "buy one")
    >>> toys.decode(toys.encode({"n": 2}, Arrays()), "a file")[0]
    {'n': 2}
    >>> toys.decode(b"TOY", "a file")
    Traceback (most recent call last):
    ...
    hrcplan.errors.InputError: 'a file' is no box of toys
    """

    magic: bytes
    version: int
    noun: str
    title: str
    hint: str
    also_reads: tuple[int, ...] = ()

    def encode(self, header: Mapping[str, Any], arrays: Arrays) -> bytes:
        """Return header and arrays as the bytes of a file."""
        head = json.dumps(header, ensure_ascii=False, separators=(",", ":")).encode()
        head += b" " * (-len(head) % _ALIGN)
        body = b"".join(arrays.parts)
        prefix = _PREFIX.pack(self.magic, self.version, 0, len(head), len(body))
        return prefix + hashlib.sha256(prefix + head + body).digest() + head + body

    def decode(self, data: bytes | memoryview, name: str) -> tuple[dict[str, Any], memoryview]:
        """Return header and arrays of a file, checked as far as the format allows.

        Args:
            data: The bytes of a file.
            name: What errors call it.

        Raises:
            InputError: if it has another format, is of another version, cut short or damaged.
        """
        view, begin = memoryview(data), _PREFIX.size + _HASH
        if (kind := archive_kind(view)) is not None:
            message = f"'{name}' is a file packed by {kind}, no {self.title}"
            raise InputError(message, code="archive", path=name, hint=UNPACK_HINT)
        if view[: len(self.magic)] != self.magic:
            raise self._refusal(name, f"not-a-{self.noun}", f"is no {self.title}")
        if len(view) < begin:
            raise self._refusal(name, f"{self.noun}-truncated", f"is cut short: {len(view)} bytes")
        _, version, _, n_head, n_body = _PREFIX.unpack_from(view)
        readable = sorted({self.version, *self.also_reads})
        if version not in readable:
            reads = " and ".join(map(str, readable))
            message = f"is a {self.noun} of format {version}; this hrcplan reads {reads}"
            raise self._refusal(name, f"{self.noun}-version", message)
        if len(view) != begin + n_head + n_body:
            message = f"has {len(view)} bytes instead of {begin + n_head + n_body}"
            raise self._refusal(name, f"{self.noun}-truncated", message)
        digest = hashlib.sha256(view[: _PREFIX.size])
        digest.update(view[begin:])
        if digest.digest() != view[_PREFIX.size : begin]:
            message = "is damaged: its checksum is wrong"
            raise self._refusal(name, f"{self.noun}-damaged", message)
        return self._header(bytes(view[begin : begin + n_head]), name), view[begin + n_head :]

    def _header(self, text: bytes, name: str) -> dict[str, Any]:
        try:
            header = json_of(text)
        except ValueError as error:
            message = f"has a header that is no JSON: {type(error).__name__}"
            raise self._refusal(name, f"{self.noun}-damaged", message) from None
        if not isinstance(header, dict):
            raise self._refusal(name, f"{self.noun}-damaged", "has a header that is no object")
        return header

    def _refusal(self, name: str, code: str, message: str) -> InputError:
        return InputError(f"'{name}' {message}", code=code, path=name, hint=self.hint)
