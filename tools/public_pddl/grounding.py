"""``Task(read(domain, problem))`` beside Fast Downward's translator, as whole processes."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import chain, zip_longest
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from public_pddl.archive import Pair

LIMIT_S = 60
AGAIN_S = 5
"""What takes less is called again, each program in turn; the quicker call of each counts."""
_OURS = "import sys; from hrcplan import Task, read; print(repr(Task(read(*sys.argv[1:]))))"
_TRANSLATE = ["-m", "fast_downward.translate", "--invariant-generation-max-time", "5"]


@dataclass(frozen=True)
class Call:
    """How a program ended: seconds of processor time, and whether it was done."""

    cpu_s: float
    done: bool
    words: str

    @property
    def refused(self) -> bool:
        """Whether it gave up before the limit."""
        return not self.done and self.cpu_s < LIMIT_S - 1

    def __str__(self) -> str:
        state = "" if self.done else " refused" if self.refused else " limit"
        return f"{self.cpu_s:.2f} s{state}"


def report(archives: Sequence[Sequence[Pair]], n: int) -> None:
    """Ground tasks of the archives in turn until ``n`` are compared; print a table and sums."""
    print("| task | ground actions | hrcplan | translator | ratio |\n|---|---|---|---|---|")
    compared = list[tuple[Call, Call]]()
    others = list[tuple[Call, Call]]()
    with TemporaryDirectory() as folder:
        for pair in _distinct(pair for pair in chain(*zip_longest(*archives)) if pair is not None):
            ours, theirs = calls = _both(pair, Path(folder))
            missing = ours.refused or theirs.refused or not (ours.done or theirs.done)
            (others if missing else compared).append(calls)
            name = f"{pair.domain.parent.name}/{pair.problem.stem}"
            ratio = "" if missing else f"{ours.cpu_s / theirs.cpu_s:.2f}"
            print(f"| {name} | {ours.words} | {ours} | {theirs} | {ratio} |", flush=True)
            if len(compared) >= n:
                break
    _summary(compared, others)


def _distinct(pairs: Iterable[Pair]) -> Iterator[Pair]:
    """Yield pairs without those whose files have been there: archives hold copies of each other."""
    texts = set[tuple[bytes, bytes]]()
    for pair in pairs:
        text = pair.domain.read_bytes(), pair.problem.read_bytes()
        if text not in texts:
            texts.add(text)
            yield pair


def _both(pair: Pair, folder: Path) -> tuple[Call, Call]:
    files = [str(pair.domain), str(pair.problem)]
    ours, theirs = first = _round(files, folder)
    if max(ours.cpu_s, theirs.cpu_s) > AGAIN_S:
        return first
    one, other = _round(files, folder)
    return min(ours, one, key=_cpu_s), min(theirs, other, key=_cpu_s)


def _cpu_s(call: Call) -> float:
    return call.cpu_s


def _round(files: Sequence[str], folder: Path) -> tuple[Call, Call]:
    return _call(["-c", _OURS, *files], folder), _call([*_TRANSLATE, *files], folder)


def _call(words: Sequence[str], folder: Path) -> Call:
    limit = partial(resource.setrlimit, resource.RLIMIT_CPU, (LIMIT_S, LIMIT_S + 5))
    output = folder / "output"
    with output.open("w+") as stream:
        argv = [sys.executable, "-P", *words]
        program = subprocess.Popen(
            argv, cwd=folder, stdout=stream, stderr=subprocess.DEVNULL, preexec_fn=limit
        )
        _, status, usage = os.wait4(program.pid, 0)
        program.returncode = status
    lines = output.read_text().splitlines()
    n_actions = next((line.split()[-2] for line in lines if line.startswith("<Task")), "")
    return Call(usage.ru_utime + usage.ru_stime, status == 0, n_actions)


def _summary(compared: Sequence[tuple[Call, Call]], others: Sequence[tuple[Call, Call]]) -> None:
    """Print the ratios of all, and of those that take the translator long."""
    for least_s in (0, 1):
        ratios = [a.cpu_s / b.cpu_s for a, b in compared if b.cpu_s >= least_s]
        if ratios:
            print(f"\n{len(ratios)} tasks, the translator takes {least_s} s or more: ratio", end="")
            print(f" {median(ratios):.2f} in the median, {max(ratios):.2f} at most", end="")
    print(f"\nlimits: hrcplan {sum(not a.done for a, _ in compared)}, translator ", end="")
    print(f"{sum(not b.done for _, b in compared)}; not compared: {len(others)}, ", end="")
    print(f"refused by hrcplan {sum(a.refused for a, _ in others)}, ", end="")
    print(f"by the translator {sum(b.refused for _, b in others)}")
