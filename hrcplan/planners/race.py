"""Planners side by side: each job in a worker of its own, within the limits of one request."""

from __future__ import annotations

import contextlib
import os
import selectors
import signal
import threading
import time
from collections.abc import Callable, Iterable, Sized
from dataclasses import dataclass, field, replace

from hrcplan.core import progress
from hrcplan.core.numbers import number_text
from hrcplan.core.records import record
from hrcplan.errors import HrcplanError, LimitError, PlannerError
from hrcplan.planners import orphans
from hrcplan.planners.choice import Job
from hrcplan.planners.contract import Answer, Request, Status
from hrcplan.planners.portfolio import Portfolio
from hrcplan.planners.registry import BUILT_IN
from hrcplan.planners.result import Result, ask, check_answer
from hrcplan.planners.workers import Watch, Work, Worker, end, largest_beyond
from hrcplan.plans import Plan

OnBetter = Callable[[Result], None]
"""Is called with every plan that is better than those before it."""

OVERTIME_S = 0.4
"""What a planner that ends at the deadline may take to report."""
LATER = (1 / 30, 1 / 6, 1 / 3)
"""When one more job than there are cores may start, as parts of the whole time."""
DUTY = 20
"""A look at the memory of all processes may take one part in so many of the time."""
STAGGER_S = 0.1
"""How long the first job runs alone: many tasks need no more."""
LATE_NICENESS = 5
"""How much jobs that start later give way to those that stand first."""
_TICK_S = 0.1


def can_race() -> bool:
    """Return whether planners can run side by side here: copies need a process of one thread."""
    return threading.active_count() == 1 and threading.current_thread() is threading.main_thread()


def cores() -> int:
    """Return how many processors this process may use."""
    return len(os.sched_getaffinity(0))


@record
class _Improvement:
    """A plan of a planner that goes on."""

    result: Result


_Message = _Improvement | Result | HrcplanError


@dataclass
class _Lane:
    """A job at work."""

    job: Job
    worker: Worker[_Message]
    has_answered: bool = False
    start_s: float = field(default_factory=time.monotonic)


def race(request: Request, waiting: Iterable[Job], lanes: bool, on_better: OnBetter) -> Portfolio:
    """Return what jobs say that run side by side until the result is settled or time is up.

    As many as there are cores (two at least) run at the same time, those that stand first begin.
    They share the memory of the request: the largest is stopped if all together use more.
    """
    return _Race(request, waiting, lanes, on_better).run()


class _Queue:
    """Jobs that wait; an iterator of them goes on when its next job is needed."""

    def __init__(self, jobs: Iterable[Job]) -> None:
        self._jobs = iter(jobs)
        self._next: Job | None = None

    def __bool__(self) -> bool:
        self._next = self._next or next(self._jobs, None)
        return self._next is not None

    def pop(self) -> Job:
        """Return the next job of a queue that is not empty."""
        assert self
        job, self._next = self._next, None
        assert job is not None
        return job

    def clear(self) -> None:
        """Forget all jobs."""
        self._jobs, self._next = iter(()), None


class _Race:
    """The jobs at work, the jobs that wait, and what they have said."""

    def __init__(
        self, request: Request, waiting: Iterable[Job], lanes: bool, on_better: OnBetter
    ) -> None:
        self.request = request
        self.portfolio = Portfolio(request.problem, request.any_plan)
        self._waiting = _Queue(waiting)
        self._slots = max(2, cores())
        self._lanes: list[_Lane] = []
        self._is_clean = True  # workers have ended by themselves, so nothing is left of them
        self._ready = selectors.PollSelector()
        self._in_lanes = lanes
        self._on_better = on_better
        self._start_s = time.monotonic()
        n = len(waiting) if isinstance(waiting, Sized) else len(BUILT_IN)
        self._share = request.memory_bytes // min(max(1, n), self._slots)
        self._look_at_memory_s = self._start_s + STAGGER_S  # until then memory holds little

    def run(self) -> Portfolio:
        """Return the portfolio once it is settled, all jobs have ended, or time is up."""
        with orphans.adoption() as family:
            try:
                self._run()
            finally:
                if not self._is_clean:
                    family.end_orphans()
        return self.portfolio

    def _run(self) -> None:
        stop_at = self.request.deadline + OVERTIME_S
        self._watch = Watch()
        try:
            while (self._lanes or self._waiting) and not self.portfolio.is_settled:
                self._start()
                if time.monotonic() >= stop_at:
                    break
                self._step(min(_TICK_S, max(0.0, stop_at - time.monotonic())))
                progress.report(self._standing, int(time.monotonic() - self._start_s))
        finally:
            progress.hide()
            self._is_clean &= end([lane.worker for lane in self._lanes])
            self._watch.close()
            self._ready.close()

    @property
    def _standing(self) -> str:
        """Who is at work and the best plan so far, to be said after the number of seconds."""
        names = ", ".join(dict.fromkeys(lane.job.name for lane in self._lanes))
        best = self.portfolio.best
        value = None if best is None else best.objective
        plan = "" if value is None else f"; best so far: {number_text(value)}"
        return f"s; at work: {names}{plan}"

    def _start(self) -> None:
        """Begin jobs as long as there is room and time for them."""
        room = self._room()
        while len(self._lanes) < room and self.request.time_left_s > 0 and self._waiting:
            job = self._waiting.pop()
            request = replace(
                self.request,
                memory_bytes=self._share,
                any_plan=job.any_plan or self.request.any_plan,
                improves=not self.request.any_plan,
                n_threads=cores(),
            )
            niceness = LATE_NICENESS if len(self._lanes) >= self._slots else 0
            work = _work(job, request, self._in_lanes, niceness)
            lane = _Lane(job, Worker(work, self._watch.group))
            self._lanes.append(lane)
            self._ready.register(lane.worker.fd, selectors.EVENT_READ, lane)
        if self.request.time_left_s <= 0:
            self._waiting.clear()

    def _room(self) -> int:
        """Return how many jobs may be at work now."""
        elapsed_s = time.monotonic() - self._start_s
        whole = self.request.deadline - self._start_s
        if elapsed_s < min(STAGGER_S, LATER[0] * whole):
            return 1
        return self._slots + sum(elapsed_s > part * whole for part in LATER)

    def _step(self, wait_s: float) -> None:
        """Wait for what the jobs say, and take it."""
        for key, _ in self._ready.select(wait_s):
            lane = key.data
            for message in lane.worker.receive():
                self._take(lane, message)
            if lane.worker.is_over:
                self._remove(lane)
        if time.monotonic() >= self._look_at_memory_s:
            self._watch_memory()

    def _watch_memory(self) -> None:
        """Stop the largest job if all together use more memory than they may."""
        start_s, memory = time.monotonic(), self.request.memory_bytes
        worker = largest_beyond([lane.worker for lane in self._lanes], memory)
        for lane in [lane for lane in self._lanes if lane.worker is worker]:
            lane.worker.signal(signal.SIGKILL)
            words = f"stopped: all planners together use more than {memory >> 20} MiB of memory"
            self._take(lane, LimitError(words))
        end_s = time.monotonic()
        self._look_at_memory_s = end_s + DUTY * (end_s - start_s)

    def _take(self, lane: _Lane, message: _Message) -> None:
        before = self.portfolio.best
        match message:
            case _Improvement(result):
                self.portfolio.take_plan(result)
            case Result() as result:
                lane.has_answered = True
                if lane.job.finds_plans:
                    self.portfolio.take(result)
                else:
                    self.portfolio.take_bound(result)
            case HrcplanError() as error if lane.job.finds_plans and not lane.has_answered:
                lane.has_answered = True
                wall_s = time.monotonic() - lane.start_s
                self.portfolio.take_failure(lane.job.name, error, wall_s)
            case HrcplanError() as error if not lane.has_answered:
                lane.has_answered = True
                self.portfolio.take_no_bound(error)
        best = self.portfolio.best
        goes_on = len(self._lanes) > 1 or isinstance(message, _Improvement)
        if best is not None and best is not before and goes_on and not self.portfolio.is_settled:
            progress.hide()
            self._on_better(best)

    def _remove(self, lane: _Lane) -> None:
        self._is_clean &= lane.has_answered
        self._take(lane, PlannerError(f"{lane.job.name} ended without an answer"))
        self._ready.unregister(lane.worker.fd)
        self._lanes.remove(lane)
        lane.worker.close()


def _work(job: Job, request: Request, lanes: bool, niceness: int) -> Work[_Message]:
    """Return what a worker does: ask a planner, and send its plans and its answer, checked."""

    def work(send: Callable[[_Message], None]) -> None:
        def on_plan(plan: Plan) -> None:
            answer = Answer(Status.SOLVED, plan)
            with contextlib.suppress(PlannerError):
                card, problem = job.planner.card, request.problem
                send(
                    _Improvement(
                        check_answer(card, problem, answer, lanes, job.why, request.replays)
                    )
                )

        os.nice(niceness)
        try:
            send(ask(job.planner, replace(request, on_plan=on_plan), lanes, job.why))
        except HrcplanError as error:
            send(error)
        except MemoryError:
            send(LimitError("stopped: out of memory"))
        except Exception as error:  # noqa: BLE001  an installed planner may raise anything
            send(PlannerError(f"{job.name} failed: {type(error).__name__}: {error}"))

    return work
