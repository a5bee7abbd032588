"""Which branches of hrcplan were taken: pairs of lines that follow each other in one function."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

import hrcplan

ROOT = str(Path(hrcplan.__file__).parent)
Arcs = dict[CodeType, set[tuple[int, int]]]


@contextmanager
def recorded(wanted: bool) -> Iterator[Arcs]:
    """Record branches while the block runs, if that is wanted."""
    arcs: Arcs = {}

    def enter(frame: FrameType, event: str, argument: Any) -> Any:
        if not frame.f_code.co_filename.startswith(ROOT):
            return None
        seen, last = arcs.setdefault(frame.f_code, set()), [frame.f_lineno]

        def step(inner: FrameType, what: str, value: Any) -> Any:
            if what == "line":
                seen.add((last[0], inner.f_lineno))
                last[0] = inner.f_lineno
            return step

        return step

    if wanted:
        sys.settrace(enter)
    try:
        yield arcs
    finally:
        if wanted:
            sys.settrace(None)


def report(arcs: Arcs) -> str:
    """Return how many branches were taken and which share of the lines, room by room."""
    by_room: dict[str, list[int]] = {}
    for code, seen in arcs.items():
        room = code.co_filename[len(ROOT) + 1 :].partition("/")[0]
        lines = {line for _, _, line in code.co_lines() if line is not None}
        count = by_room.setdefault(room, [0, 0, 0])
        count[0] += len(seen)
        count[1] += len(lines & ({b for _, b in seen} | {code.co_firstlineno}))
        count[2] += len(lines)
    return "\n".join(
        f"{room:24} {n} branches, {hit} of {of} lines of the functions that ran ({hit / of:.0%})"
        for room, (n, hit, of) in sorted(by_room.items())
    )
