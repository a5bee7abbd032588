"""Phrases of people read as steps: how many right, wrong without asking, and how fast."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from rows import Row

from hrcplan.reading import Lexicon, Reading, read_words

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from tests import phrases

RIGHT, WRONG, OTHERS_RIGHT, P99_MS = 0.92, 0.01, 0.8, 5


def rows() -> Iterator[Row]:
    """Yield a row for each set of phrases, and the time of a reading."""
    times: list[float] = []

    def timed(lexicon: Lexicon, text: str, steps: Sequence[tuple[str, ...]]) -> Reading:
        start = time.thread_time()
        reading = read_words(lexicon, text, steps)
        times.append(time.thread_time() - start)
        return reading

    problems = phrases.problems_of("kitchen")
    scenes = [moment for p in problems for moment in phrases.moments(p, 1)]
    plain = [m for p in map(phrases.names_only, problems) for m in phrases.moments(p, 1)]
    together = []
    for name in phrases.KITCHEN:
        said = list(phrases.trials(phrases.sayings(name, phrases.TEST), scenes, timed))
        together += said
        yield _row(f"{name}, with notes", said)
    yield _row("kitchen, all of them", together, RIGHT)
    idle = [trial for trial in together if not trial.saying.meanings]
    refused = _share(not trial.reading.options for trial in idle)
    yield Row(
        f"of these mean no step: {len(idle)} readings", f"{refused:.0%} refused, others asked"
    )
    for name in phrases.KITCHEN:
        said = list(phrases.trials(phrases.sayings(name, phrases.TEST), plain, timed))
        yield _row(f"{name}, names only", said)
    for name in phrases.OTHERS:
        n_walks = phrases.N_WALKS.get(name, 6)
        own = [phrases.names_only(problem) for problem in phrases.problems_of(name)]
        places = [moment for problem in own for moment in phrases.moments(problem, n_walks)]
        said = list(phrases.trials(phrases.sayings(name, phrases.TEST), places, timed))
        yield _row(f"{name}, names only", said, OTHERS_RIGHT)
    times.sort()
    p99 = 1e3 * times[int(len(times) * 0.99)]
    middle = 1e3 * times[len(times) // 2]
    yield Row("one reading, 99 of 100", f"{p99:.1f} ms", f"median {middle:.1f} ms",
              f"<= {P99_MS} ms", p99 > P99_MS)  # fmt: skip


def _row(what: str, said: Sequence[phrases.Trial], bar: float | None = None) -> Row:
    sensible = [trial for trial in said if trial.can_be_meant]
    right = _share(trial.is_right for trial in sensible)
    wrong = _share(trial.is_wrong for trial in said)
    acted = _share(trial.is_acted for trial in sensible if len(trial.meant) == 1)
    goal = "" if bar is None else f">= {bar:.0%} right, <= {WRONG:.0%} wrong"
    missed = bar is not None and (right < bar or wrong > WRONG)
    return Row(f"{what}: {len(sensible)} readings", f"{right:.1%} right, {wrong:.1%} wrong unasked",
               f"{acted:.0%} of clear ones without a question", goal, missed)  # fmt: skip


def _share(values: Iterable[bool]) -> float:
    every = list(values)
    return sum(every) / max(1, len(every))
