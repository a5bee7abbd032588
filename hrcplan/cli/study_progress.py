"""How far a study has come: a bar on a terminal, else a line now and then."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hrcplan.cli import output

if TYPE_CHECKING:
    from types import TracebackType

    from rich.console import Console

FIRST_S, EVERY_S = 5.0, 10.0
"""How long the second line is after the first, and the third after it; each pause is longer by a
tenth of the time so far, so that a run of hours has some tens of lines."""
WINDOW_S = 120.0
"""The rate of the last seconds tells the time left: tables differ in how long episodes take."""
MIN_EPISODES = 20
"""So many episodes tell a rate. The first one is not counted: it loads and plans what others
need."""
LARGE = 1_000
"""More episodes than this take long: rows can be looked at before."""


class EpisodeLog:
    """Writes a line now and then: how many episodes are done, and how long the rest will take.

    Args:
        say: Writes a line.
        clock: Seconds that only grow.
    """

    def __init__(
        self, say: Callable[[str], None], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._say, self._clock = say, clock
        self._seen: deque[tuple[float, int]] = deque()
        self._began_s: float | None = None
        self._next_s = 0.0

    def __call__(self, n_done: int, n_all: int) -> None:
        """Take note of the episodes that have rows, out of all that are wanted."""
        now = self._clock()
        if self._began_s is None:
            self._began_s, self._next_s = now, now + FIRST_S
            if n_done < n_all:
                self._say(f"{n_done:,} of {n_all:,} episodes")
            return
        self._seen.append((now, n_done))
        while len(self._seen) > 2 and self._seen[1][0] <= now - WINDOW_S:
            self._seen.popleft()
        if now >= self._next_s and n_done < n_all:
            self._next_s = now + EVERY_S + (now - self._began_s) / 10
            self._say(f"{n_done:,} of {n_all:,} episodes{self._left(n_all)}")

    def _left(self, n_all: int) -> str:
        (first_s, first), (last_s, last) = self._seen[0], self._seen[-1]
        if last - first < MIN_EPISODES:
            return ""
        seconds = (n_all - last) * (last_s - first_s) / (last - first)
        return f"; about {duration(seconds)} left at the present rate"


def duration(seconds: float) -> str:
    """Return a duration in words, roughly.

    >>> duration(42.0), duration(200.0), duration(8000.0)
    ('42 s', '3 min', '2.2 h')
    """
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


@contextmanager
def study_progress(folder: Path) -> Iterator[Callable[[int, int], None]]:
    """Yield what shows the progress of a study on stderr.

    Args:
        folder: Where the study writes its rows.
    """
    from rich.console import Console

    console, has_hint = Console(stderr=True), False
    bar = _Bar(console) if console.is_terminal else nullcontext(EpisodeLog(output.note))
    with bar as show:

        def show_with_hint(n_done: int, n_all: int) -> None:
            nonlocal has_hint
            if not has_hint and n_all - n_done > LARGE:
                output.note(f"a page of the rows so far: hrcplan study report {folder}")
            has_hint = True
            show(n_done, n_all)

        yield show_with_hint


class _Bar:
    """A progress bar that is made when the first rows come in."""

    def __init__(self, console: Console) -> None:
        from rich.progress import (
            BarColumn,
            MofNCompleteColumn,
            Progress,
            TextColumn,
            TimeElapsedColumn,
            TimeRemainingColumn,
        )

        self._progress = Progress(
            BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(),
            TextColumn("left"), TimeRemainingColumn(), console=console, transient=True,
        )  # fmt: skip
        self._task: Any = None

    def __enter__(self) -> Callable[[int, int], None]:
        self._progress.start()
        return self._show

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:  # fmt: skip
        self._progress.stop()

    def _show(self, n_done: int, n_all: int) -> None:
        if self._task is None:
            self._task = self._progress.add_task("", total=n_all)
        self._progress.update(self._task, completed=n_done)
