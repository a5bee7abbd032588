"""Python objects through a pipe, each with its length in front."""

from __future__ import annotations

import os
import pickle
from collections.abc import Iterator

_LENGTH = 8
_CHUNK = 1 << 20


def send(fd: int, message: object) -> None:
    """Write a message; wait until the pipe has taken all of it."""
    payload = pickle.dumps(message)
    rest = memoryview(len(payload).to_bytes(_LENGTH, "little") + payload)
    while rest:
        rest = rest[os.write(fd, rest) :]


class Inbox:
    """The messages of a pipe, read in pieces; ``is_over`` is set at the end of the pipe."""

    def __init__(self, fd: int) -> None:
        self.fd = fd
        self.is_over = False
        self._pending = bytearray()

    def receive(self) -> list[object]:
        """Return the messages that are complete after one more piece, which is waited for."""
        piece = os.read(self.fd, _CHUNK)
        self._pending += piece
        self.is_over = not piece
        return list(self._complete())

    def _complete(self) -> Iterator[object]:
        while len(self._pending) >= _LENGTH:
            end = _LENGTH + int.from_bytes(self._pending[:_LENGTH], "little")
            if len(self._pending) < end:
                return
            yield pickle.loads(bytes(self._pending[_LENGTH:end]))
            del self._pending[:end]
