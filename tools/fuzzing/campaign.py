"""A number of mutants of one kind: what came out, how long the slowest took, and what is wrong."""

from __future__ import annotations

import gc
import random
import signal
import time
import traceback
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from types import FrameType

from fuzzing.targets import TARGETS, warm
from hrcplan.errors import HrcplanError

HANG_S = 5.0
LONG_S = 60.0


class Hang(BaseException):
    """A mutant took more than ``HANG_S`` of the processor, or ``LONG_S`` by the clock."""


@dataclass
class Outcome:
    """What mutants of one kind led to.

    ``faults`` maps each place at which something went wrong to how often, and to the number of the
    first mutant that led there.
    """

    kind: str
    n: int = 0
    n_accepted: int = 0
    typed: Counter[str] = field(default_factory=Counter)
    faults: dict[str, tuple[int, int]] = field(default_factory=dict)
    slowest_s: float = 0.0

    def add_fault(self, place: str, number: int) -> None:
        """Count something that must not happen."""
        times, first = self.faults.get(place, (0, number))
        self.faults[place] = times + 1, first


def campaign(kind: str, n: int, seed: int, folder: Path, first: int = 0) -> Outcome:
    """Return what ``n`` mutants led to; mutant ``i`` depends on kind, seed and ``i`` alone."""
    outcome = Outcome(kind)
    place = folder / kind
    place.mkdir(parents=True, exist_ok=True)
    warm(kind, folder)
    gc.freeze()  # what the mutants share is not looked through again
    gc.set_threshold(20_000)
    before = [(number, signal.signal(number, _hang)) for number in (signal.SIGALRM, signal.SIGPROF)]
    try:
        for number in range(first, first + n):
            _one(outcome, f"{seed}/{kind}/{number}", place, number)
            outcome.n += 1
    finally:
        for number, handler in before:
            signal.signal(number, handler)
    return outcome


def _one(outcome: Outcome, seed: str, folder: Path, number: int, again: bool = False) -> None:
    begin = time.process_time()
    signal.setitimer(signal.ITIMER_PROF, HANG_S)  # of the processor: the machine may be busy
    signal.setitimer(signal.ITIMER_REAL, LONG_S)
    try:
        TARGETS[outcome.kind](random.Random(seed), folder)
        outcome.n_accepted += 1
    except HrcplanError as error:
        outcome.typed[error.code] += 1
    except Hang as error:
        if again or time.process_time() - begin >= HANG_S / 2:
            outcome.add_fault(f"hang at {_place(error)}", number)
        else:  # it waited, or other programs had the processor
            _one(outcome, seed, folder, number, again=True)
    except Exception as error:  # noqa: BLE001  to find these is what this is for
        outcome.add_fault(f"{type(error).__name__} at {_place(error)}: {str(error)[:160]}", number)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.setitimer(signal.ITIMER_PROF, 0)
    outcome.slowest_s = max(outcome.slowest_s, time.process_time() - begin)


def _hang(number: int, frame: FrameType | None) -> None:
    raise Hang


def _place(error: BaseException) -> str:
    """Return the last line of hrcplan on the way to an error."""
    frames = traceback.extract_tb(error.__traceback__)
    ours = [f for f in frames if "/hrcplan/" in f.filename and ".venv" not in f.filename] or frames
    return f"{ours[-1].filename.rpartition('/hrcplan/')[2]}:{ours[-1].lineno}"
