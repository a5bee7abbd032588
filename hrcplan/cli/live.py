"""A run as it goes: one lane per agent, progress, and every replan with its reasons."""

from __future__ import annotations

import shutil
import textwrap
import time
from dataclasses import dataclass, field
from itertools import zip_longest
from typing import TYPE_CHECKING

from hrcplan.cli import output
from hrcplan.core.numbers import number_text
from hrcplan.core.text import plural
from hrcplan.execution import events as ev
from hrcplan.execution.events import Command, Event
from hrcplan.execution.outcome import Outcome
from hrcplan.execution.run import Run, RunningAction
from hrcplan.pddl.conventions import robots
from hrcplan.pddl.model import Problem, fact_text
from hrcplan.plans import lane

if TYPE_CHECKING:
    from hrcplan.core.numbers import Number

_BEGUN, _MARK = "▶", {ev.DONE: "✓", ev.FAILED: "✗", ev.CANCELLED: "·"}
_WIDTH = (14, 34)
_TIME = 11  # characters before the lanes


@dataclass
class Live:
    """Prints a line per instant; ``speed`` simulated seconds take one second (None: no wait)."""

    problem: Problem
    speed: float | None = None
    _cells: dict[str, str] = field(default_factory=dict)
    _notes: list[str] = field(default_factory=list)
    _running: dict[int, RunningAction] = field(default_factory=dict)
    _n_plans: int = 0
    _shown_s: float = 0.0
    _has_head: bool = False

    def watch(self, run: Run, event: Event, commands: tuple[Command, ...]) -> None:
        """Show one step of the monitor."""
        if isinstance(event, ev.Ended) and event.number in self._running:
            step = self._running.pop(event.number).step
            words = self._short(fact_text((step.schema.name, *step.binding.values())), step.agent)
            self._cell(step.agent, f"{_MARK.get(event.outcome, '?')} {words}")
        if isinstance(event, ev.Sensed):
            values = (f"{fact_text(k)} = {_value(v)}" for k, v in event.values.items())
            self._notes.append(f"sensed {', '.join(values)}")
        if isinstance(event, ev.Happened):
            self._notes.append(f"{event.text} comes by itself")
        is_complete = isinstance(event, (ev.Settled, ev.Planned))
        if is_complete:
            self._flush(run)
        for command in commands:
            self._take(command)
        self._running = {r.number: r for r in run.running}
        if is_complete:
            self._flush(run)

    def _take(self, command: Command) -> None:
        match command:
            case ev.AskPlan(reasons=reasons) if reasons:
                self._notes.append(f"replanning, {'; '.join(reasons)}")
            case ev.Adopt(plan=plan):
                self._n_plans += 1
                name = f"replan {self._n_plans - 1}" if self._n_plans > 1 else "plan"
                lanes = [lane(a.args, self.problem) or "" for a in plan.actions]
                shares = ", ".join(f"{a} {lanes.count(a)}" for a in self._agents)
                self._notes.append(f"{name}: {plural(len(lanes), 'action')} ({shares.strip()})")
            case ev.Dispatch():
                self._cell(command.agent, f"{_BEGUN} {self._short(str(command), command.agent)}")
            case ev.Tell(_, _, message):
                self._notes.append(message)

    @property
    def _agents(self) -> list[str]:
        taking = robots(self.problem)
        return sorted(self.problem.agents, key=lambda a: a not in taking) or [""]

    def _cell(self, agent: str, text: str) -> None:
        if agent in self._cells:
            self._print_cells("")
        self._cells[agent] = text

    def _short(self, words: str, agent: str) -> str:
        inner = words[1:-1].split(" ")
        if agent in inner[1:]:
            inner.remove(agent)
        return " ".join(inner)

    def _flush(self, run: Run) -> None:
        """Print what has come together, after the time that has passed."""
        if not (self._cells or self._notes):
            return
        if self.speed is not None:
            time.sleep(max(0.0, run.t - self._shown_s) / self.speed)
        self._shown_s = run.t
        when = f"{run.t:g} s"
        if not self.problem.domain.is_temporal:
            when = f"{run.t:g}"
        if self._cells:
            self._print_cells(when, self._progress(run))
        for note in self._notes:
            self._line(when, f"· {note}", fold=True)
        self._notes = []

    def _progress(self, run: Run) -> str:
        if run.current_plan is None:
            return ""
        n, whole = len(run.current_plan.ended), len(run.current_plan.plan.actions)
        count = f"{n}/{whole}"
        room = self._columns() - _TIME - self._width() * len(self._agents) - 2 * len(str(whole)) - 2
        return f"{'█' * n}{'░' * (whole - n)} {count}" if whole <= min(30, room) else count

    def _print_cells(self, when: str, progress: str = "") -> None:
        width = self._width() - 1
        lanes = (
            textwrap.wrap(self._cells.get(agent, ""), width, subsequent_indent="  ",
                          break_long_words=False, break_on_hyphens=False)
            for agent in self._agents
        )  # fmt: skip
        for row in zip_longest(*lanes, fillvalue=""):
            self._line(when, "".join(f"{cell:<{width}} " for cell in row) + progress)
            when = progress = ""
        self._cells = {}

    def _columns(self) -> int:
        return shutil.get_terminal_size((110, 24)).columns

    def _width(self) -> int:
        room = (self._columns() - 30) // len(self._agents)
        return max(_WIDTH[0], min(_WIDTH[1], room))

    def _line(self, when: str, text: str, fold: bool = False) -> None:
        if not self._has_head:
            self._has_head = True
            names = "".join(f"{agent:<{self._width()}}" for agent in self._agents)
            output.result(f"{'':9}  {names}done".rstrip())
        line = f"{when:>9}  {text}".rstrip()
        output.result(output.fold(line, indent=_TIME + 2) if fold else line)

    def finish(self, run: Run, row: Outcome) -> None:
        """Print how the run ended and what was counted."""
        why = f" ({run.why})" if run.why else ""
        unit = " s" if self.problem.domain.is_temporal else " steps"
        reasons = {
            "change": row.replans_change, "failure": row.replans_failure,
            "deviation": row.replans_deviation,
        }  # fmt: skip
        counts = ", ".join(f"{n} {kind}" for kind, n in reasons.items() if n)
        n_failed = row.failed_human + row.failed_robot
        actions = f"{row.executed_human} human and {row.executed_robot} robot actions"
        if not robots(self.problem):
            actions = plural(row.executed_human + row.executed_robot, "action")
        counted = (
            f"{row.ending}{why}: {row.makespan_s:g}{unit}, {plural(row.replans, 'replan')}"
            f"{f' ({counts})' if counts else ''}, {plural(row.plans_confirmed, 'plan')} confirmed, "
            f"{actions}, {n_failed} failed"
        )
        output.result(f"\n{output.fold(counted)}")


def _value(value: float | Number) -> str:
    return f"{value:g}" if isinstance(value, float) else number_text(value)
