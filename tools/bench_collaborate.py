"""How robots do in collaborations by themselves: who finishes, how soon, with how many questions.

    .venv/bin/python tools/bench_collaborate.py DOMAIN GOALS N [FIRST_SEED [ROBOT,ROBOT...]]

GOALS is a folder, or - for those of the domain. Each seed is one course of two goals with a change,
once in free pace and once in turns, one agent at a time. A decision is everything from the question
to the robot to its answer, in processor time.
"""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from hrcplan.bank import Bank, read_goals
from hrcplan.collaboration import events as shared
from hrcplan.collaboration.adviser import Adviser
from hrcplan.collaboration.collaborate import bank_for, course_of, make_setup, simulated
from hrcplan.collaboration.history import AskedGoal, EndedAction, actions_in
from hrcplan.collaboration.outcome import collaboration_outcome
from hrcplan.collaboration.robots import assistant_maker
from hrcplan.collaboration.run import CompanionRun
from hrcplan.collaboration.setup import FREE, TURNS
from hrcplan.episodes.humans import Course
from hrcplan.execution import events as ev
from hrcplan.studies.collaboration.prices import TaskPrices

ROBOTS = "joint,joint-without-asking,goal-only,hrcplan,joint-oracle"


@dataclass
class Figures:
    """What was measured of one robot; one number per run, or per decision."""

    finished: list[bool] = field(default_factory=list)
    makespan_s: list[float] = field(default_factory=list)
    one_at_a_time_s: list[float] = field(default_factory=list)
    questions: list[int] = field(default_factory=list)
    followed: list[int] = field(default_factory=list)
    decision_ms: list[float] = field(default_factory=list)

    def row(self, name: str) -> str:
        """Return a line of the table."""
        ratio = np.mean(self.makespan_s) / np.mean(self.one_at_a_time_s)
        return (
            f"| {name} | {100 * np.mean(self.finished):.1f} | {np.mean(self.makespan_s):.1f} | "
            f"{ratio:.3f} | {np.mean(self.questions):.2f} | {max(self.questions)} | "
            f"{np.median(self.followed):.0f} | {np.median(self.decision_ms):.2f} | "
            f"{np.quantile(self.decision_ms, 0.95):.1f} |"
        )


class Watch:
    """Counts the human's actions from the change of goal until the robot follows."""

    def __init__(self, course: Course, names: tuple[str, ...]) -> None:
        self.goal, self.turn = names[course.goals[-1]], max(course.turns, default=0)
        self.n_moves = self.n_after = 0
        self.is_followed = False

    def __call__(self, run: CompanionRun, event: Any, commands: Any) -> None:
        """Take note of one step of the machine."""
        if isinstance(event, shared.Begun | shared.Passed):
            self.n_moves += 1
            is_after = self.n_moves > self.turn and isinstance(event, shared.Begun)
            self.n_after += is_after and not self.is_followed
        if isinstance(event, shared.Chosen) and self.n_after:
            self.is_followed = self.is_followed or event.goals[0][0] == self.goal


def timed(adviser: Adviser, decision_ms: list[float]) -> None:
    """Let an adviser note how long its decisions take."""
    answer = adviser.answer

    def measure(ask: Any) -> Any:
        begin = time.process_time()
        event = answer(ask)
        if isinstance(ask, shared.AskStep):
            decision_ms.append(1000 * (time.process_time() - begin))
        return event

    adviser.answer = measure  # type: ignore[method-assign]


def total_s(run: CompanionRun, prices: TaskPrices) -> float:
    """Return how long all actions that were done take by the PDDL, one after the other."""
    done = {m.number for m in run.history if isinstance(m, EndedAction) and m.outcome == ev.DONE}
    words = (action.words for action in actions_in(run.history) if action.number in done)
    return sum(map(prices.durations_s.__getitem__, words))


def measured(bank: Bank, name: str, seeds: range) -> Figures:
    """Return the figures of one robot."""
    figures, robot = Figures(), assistant_maker(name)(bank)
    prices = TaskPrices(bank)
    for seed in seeds:
        course = course_of(bank, seed)
        for pace in (FREE, TURNS):
            setup = make_setup(bank, pace=pace, method=name, seed=seed)
            parts = simulated(setup, bank, course, make_assistant=lambda _: robot)
            timed(parts.adviser, figures.decision_ms)
            watch = Watch(course, bank.names)
            run = parts.run(watch=watch)
            outcome = collaboration_outcome(run)
            if pace == TURNS:  # where every step lasts 1
                figures.one_at_a_time_s.append(total_s(run, prices))
                continue
            figures.finished.append(outcome.success)
            figures.makespan_s.append(outcome.duration_s)
            figures.questions.append(sum(isinstance(mark, AskedGoal) for mark in run.history))
            if watch.n_after:
                figures.followed.append(watch.n_after)
    return figures


def main(domain: str, goals: str, n: int, first: int = 0, robots: str = ROBOTS) -> None:
    """Print the table."""
    bank = bank_for(read_goals(domain, None if goals == "-" else goals))
    print("| robot | finished (%) | makespan | over one at a time | questions | most | "
          "followed after | decision (ms) | 95 % |")  # fmt: skip
    print("|---" * 9 + "|")
    for name in robots.split(","):
        print(measured(bank, name, range(first, first + n)).row(name), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], *map(int, sys.argv[3:5]), *sys.argv[5:6])
