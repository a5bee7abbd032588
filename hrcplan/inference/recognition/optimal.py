"""Proven distances to goals: Fast Downward's A* with LM-cut, many searches to one child process.

Its program is under the GPL, so it is run, never imported. It reads tasks in its own translated
format, which is written here from the bits of a grounded task, without its translator.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory

from hrcplan.core.bits import positions
from hrcplan.planners.fast_downward import find_binary
from hrcplan.planners.process import ProcessLimits, run
from hrcplan.search.distances import Way
from hrcplan.search.packed_states import FactPacking
from hrcplan.search.relevance import relevant
from hrcplan.task.conditions import Test
from hrcplan.task.steps import Operator

N_PROCESSES = 2
MEMORY_BYTES = 1 << 30
GRACE_S = 1.0

# For each task: at most $2 seconds; its plan goes to a file. CPU seconds are whole
# numbers in a shell, so the search limits itself, and $3 ends everything in time.
_SCRIPT = """
for task in *.sas; do
  "$0" --internal-plan-file "${task%.sas}.plan" --search "$1" < "$task" > /dev/null 2>&1
done
"""


class Searcher:
    """Writes searches for one goal as Fast Downward reads them.

    Args:
        ops: What can be done; none may have conditional effects.
        goal: The facts to reach.
    """

    def __init__(self, ops: Sequence[Operator], goal: Test) -> None:
        useful, literals = relevant(ops, (goal,))
        index = {id(op): i for i, op in enumerate(ops)}
        self.ops = [index[id(op)] for op in useful]
        self._useful = useful
        self._packing = FactPacking.of_facts(literals.facts)
        self._goal = goal

    @cached_property
    def _place(self) -> dict[int, int]:
        return {position: i for i, position in enumerate(self._packing.positions)}

    @cached_property
    def _head(self) -> str:
        lines = ["begin_version", "3", "end_version", "begin_metric", "1", "end_metric"]
        lines.append(str(len(self._place)))
        for i in self._place.values():
            lines += ["begin_variable", f"v{i}", "-1", "2", f"Atom f{i}()", f"NegatedAtom f{i}()",
                      "end_variable"]  # fmt: skip
        return "\n".join([*lines, "0", "begin_state"])

    @cached_property
    def _tail(self) -> str:
        lines = ["end_state", "begin_goal", *self._facts(*self._goal), "end_goal"]
        lines.append(str(len(self._useful)))
        for number, op in zip(self.ops, self._useful, strict=True):
            lines += self._operator(number, op)
        return "\n".join([*lines, "0", ""])

    def _facts(self, mask: int, value: int) -> list[str]:
        facts = [f"{self._place[p]} {_value(value, p)}" for p in positions(mask)]
        return [str(len(facts)), *facts]

    def _operator(self, number: int, op: Operator) -> list[str]:
        rule = op.simple_rule
        assert rule is not None
        mask, value, touched_facts, adds = rule
        own_facts = sum(1 << p for p in self._place)
        own_touches = touched_facts & own_facts
        effects = []
        for p in positions(own_touches):
            before = _value(value, p) if mask >> p & 1 else -1
            effects.append(f"0 {self._place[p]} {before} {_value(adds, p)}")
        return ["begin_operator", f"o{number}", *self._facts(mask & ~own_touches, value),
                str(len(effects)), *effects, str(op.cost), "end_operator"]  # fmt: skip

    def text(self, state: int) -> str:
        """Return the search from a state."""
        values = (_value(state, p) for p in self._packing.positions)
        return "\n".join([self._head, *map(str, values), self._tail])

    @property
    def relevant_facts(self) -> int:
        """The facts that matter to the goal, as bits."""
        return self._packing.mask


class FastDownwardProver:
    """Proves distances by Fast Downward; without its program it proves none.

    Args:
        ops: The operators, all of them simple.
    """

    def __init__(self, ops: Sequence[Operator]) -> None:
        self._ops = ops
        self._searchers: dict[Test, Searcher] = {}

    def _searcher(self, goal: Test) -> Searcher:
        if goal not in self._searchers:
            self._searchers[goal] = Searcher(self._ops, goal)
        return self._searchers[goal]

    def relevant_facts(self, goal: Test) -> int:
        """Return the facts that matter to a goal, as bits."""
        return self._searcher(goal).relevant_facts

    def cheapest_ways(
        self, searches: Sequence[tuple[int, Test]], limit_s: float, total_s: float
    ) -> list[Way | None]:
        """Return a cheapest way for each (state, goal); None where there is none, or no time."""
        texts = [self._searcher(goal).text(state) for state, goal in searches]
        return search(texts, limit_s, total_s)


def search(texts: Sequence[str], limit_s: float, total_s: float) -> list[Way | None]:
    """Return cheapest ways, proven; None where there is none, or it was not found in time.

    Args:
        texts: What ``Searcher.text`` gives.
        limit_s: Seconds for each search.
        total_s: Seconds for all.
    """
    binary = find_binary()
    if binary is None or not texts:
        return [None] * len(texts)
    lanes = [texts[i::N_PROCESSES] for i in range(min(N_PROCESSES, len(texts)))]
    with ThreadPoolExecutor(len(lanes)) as pool:
        answers = list(pool.map(lambda lane: _lane(binary, lane, limit_s, total_s), lanes))
    return [answers[i % len(lanes)][i // len(lanes)] for i in range(len(texts))]


def _lane(binary: Path, texts: Sequence[str], limit_s: float, total_s: float) -> list[Way | None]:
    with TemporaryDirectory(prefix="hrcplan-") as folder:
        cwd = Path(folder)
        for i, text in enumerate(texts):
            (cwd / f"{i:04d}.sas").write_text(text)
        method = f"astar(lmcut(),max_time={limit_s:.3f})"
        limits = ProcessLimits(total_s, MEMORY_BYTES)
        run(["/bin/sh", "-c", _SCRIPT, str(binary), method], cwd=cwd, limits=limits)
        return [_way(cwd / f"{i:04d}.plan") for i in range(len(texts))]


def _way(path: Path) -> Way | None:
    if not path.is_file():
        return None
    text = path.read_text()
    cost = re.search(r"; cost = (\d+)", text)
    if cost is None:
        return None
    ops = tuple(int(number) for number in re.findall(r"^\(o(\d+)\s*\)", text, re.MULTILINE))
    return Way(int(cost[1]), ops)


def _value(bits: int, position: int) -> int:
    """Return Fast Downward's value of a fact: 0 if it holds, else 1."""
    return 1 - (bits >> position & 1)
