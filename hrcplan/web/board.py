"""Tells streams, from any thread, that there is something new."""

from __future__ import annotations

import asyncio


class Board:
    """A signal from the threads of sessions to the streams of pages."""

    def __init__(self) -> None:
        self._loop: asyncio.AbstractEventLoop | None = None
        self._watchers: set[asyncio.Event] = set()
        self.is_closed = False

    def watch(self) -> asyncio.Event:
        """Return a signal that is set, in the running event loop, when there is something new."""
        self._loop = asyncio.get_running_loop()
        signal = asyncio.Event()
        self._watchers.add(signal)
        return signal

    def leave(self, signal: asyncio.Event) -> None:
        """Stop setting a signal."""
        self._watchers.discard(signal)

    def notify(self) -> None:
        """Wake all streams; can be called in any thread."""
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._wake)

    def close(self) -> None:
        """Let all streams end."""
        self.is_closed = True
        self.notify()

    def _wake(self) -> None:
        for signal in self._watchers:
            signal.set()
