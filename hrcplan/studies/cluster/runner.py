"""Runs the episodes of a study on the workers of a Dask cluster.

Every worker is served by a coroutine: it compares the worker with this process, brings it the files
that it lacks, and gives each of its threads one batch after the other. Dask only carries tasks to
the worker that they are meant for; what is run where, and again, is decided here.
"""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import Callable, Coroutine, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from queue import SimpleQueue
from types import TracebackType
from typing import Any, Concatenate, ParamSpec, Self, TypeVar

from hrcplan.core.files import cache_folder
from hrcplan.errors import LimitError, PlannerError, UsageError
from hrcplan.studies.cluster import tasks
from hrcplan.studies.cluster.backlog import Backlog
from hrcplan.studies.cluster.connection import ANSWER_S, CLOSE_S, connect
from hrcplan.studies.cluster.process import call, end_processes
from hrcplan.studies.cluster.tasks import ClusterJob, DifferenceError, WorkerError
from hrcplan.studies.runner import StudyWork
from hrcplan.studies.study import Episode, Say
from hrcplan.studies.trace_files import EpisodeResult

P = ParamSpec("P")
T = TypeVar("T")
TakeResults = Callable[[list[EpisodeResult]], None]

LOOK_S = 0.5
"""Time between two looks at which workers there are."""
PATIENCE_S = 300.0
"""How long to wait while there is no worker."""
MAX_FAULTS = 3  # workers that one message names
ENDED = "ended before it could be compared; is hrcplan installed there?"
SAME = "start scheduler and workers again, from the environment that this command runs in"
RESUME = "call the command again to go on; rows that were written stay"


class ClusterRunner:
    """Runs episodes on the workers of a cluster; only this process writes rows.

    Args:
        address: The scheduler's, as `find_scheduler` returns it.
        work: What results depend on.
        inputs_sha256: The digest of the study's inputs here.
        list_files: Returns the files of the cache folder that episodes may need.
        say: Called with what the user should know.

    Raises:
        UsageError: when entered, if a worker that is there differs from this process.
        PlannerError: if the scheduler is gone.
        LimitError: if there is no worker for ``PATIENCE_S``.
    """

    def __init__(
        self, address: str, work: StudyWork, inputs_sha256: str,
        list_files: Callable[[], Sequence[Path]], say: Say,
    ) -> None:  # fmt: skip
        self.failures: dict[Episode, str] = {}
        self._address, self._list_files, self._say = address, list_files, say
        self._job = ClusterJob(work, os.getcwd(), tasks.software_versions(), inputs_sha256)
        self._refusals: dict[str, str] = {}
        self._admitted: set[str] = set()
        self._file_names: list[str] = []
        self._last_seen, self._is_waiting = time.monotonic(), False

    def __enter__(self) -> Self:
        """Return the runner, after all workers that are there were compared with this process."""
        self._client = connect(self._address)
        assert self._client.loop is not None, "it has a thread of its own"
        self._loop = self._client.loop.asyncio_loop  # type: ignore[attr-defined]
        try:
            self._sending = asyncio.Lock()
            self._wait(self._compare_all())
        except BaseException:
            self._close()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:  # fmt: skip
        """End what runs on the workers, and the connection."""
        self._close()

    def run(self, episodes: Sequence[Episode]) -> Iterator[list[EpisodeResult]]:
        """Yield results as they come.

        Raises:
            PlannerError: if the scheduler is gone.
            LimitError: if there is no worker for long.
        """
        inbox: SimpleQueue[list[EpisodeResult] | None] = SimpleQueue()
        running = asyncio.run_coroutine_threadsafe(self._run(episodes, inbox.put), self._loop)
        running.add_done_callback(lambda _: inbox.put(None))
        try:
            while (results := inbox.get()) is not None:
                yield results
            running.result()
        finally:
            running.cancel()

    # In the event loop of the client.

    async def _compare_all(self) -> None:
        """Compare all workers that are there with this process, and wait for a first one."""
        self._list_file_names()
        while not (present := await self._present()):
            await asyncio.sleep(LOOK_S)
        comparing = {worker: asyncio.create_task(self._admit(worker)) for worker in present}
        try:
            while not all(task.done() for task in comparing.values()):
                await asyncio.wait(comparing.values(), timeout=LOOK_S)
                for worker in comparing.keys() - (await self._present()).keys():
                    comparing[worker].cancel()
        finally:
            await _cancel(comparing.values())
        faults = [f"worker {worker} {why}" for worker, why in self._refusals.items()]
        for worker, task in comparing.items():
            if task.cancelled():
                faults += [f"worker {worker} {ENDED}"] if not self._admitted else []
            else:
                task.result()
        if faults:
            more = len(faults) - MAX_FAULTS
            text = "; ".join(faults[:MAX_FAULTS]) + (f"; and {more} more" if more > 0 else "")
            raise UsageError(text, code="worker-differs", hint=SAME)

    async def _run(self, episodes: Sequence[Episode], put: TakeResults) -> None:
        """Run episodes on all workers that are there or come."""
        self._list_file_names()
        backlog, serving = Backlog(episodes), dict[str, asyncio.Task[None]]()
        try:
            while not backlog.done.is_set():
                present = await self._present()
                backlog.n_slots = max(1, sum(present.values()))
                for worker in [worker for worker in serving if worker not in present]:
                    serving.pop(worker).cancel()
                    if worker not in self._admitted:
                        self._say(f"worker {worker} {ENDED}")
                    self._admitted.discard(worker)
                for worker in [worker for worker, task in serving.items() if task.done()]:
                    task = serving.pop(worker)
                    if not task.cancelled():
                        task.result()
                for worker in present.keys() - serving.keys() - self._refusals.keys():
                    serve = self._serve(worker, present[worker], backlog, put)
                    serving[worker] = asyncio.create_task(serve)
                with suppress(asyncio.TimeoutError):
                    await asyncio.wait_for(backlog.done.wait(), LOOK_S)
        finally:
            await _cancel(serving.values())
        self.failures |= backlog.quarantine

    async def _present(self) -> Mapping[str, int]:
        """Return the workers that are there, with their numbers of threads.

        Raises:
            PlannerError: if the scheduler is gone.
            LimitError: if there was no worker that may run episodes for long.
        """
        try:
            if self._client.status != "running":
                raise ConnectionError
            present: dict[str, int] = await asyncio.wait_for(self._client.nthreads(), ANSWER_S)
        except (TimeoutError, OSError):
            message = f"the scheduler at {self._address} is gone"
            raise PlannerError(message, code="cluster-gone", hint=RESUME) from None
        for gone in self._refusals.keys() - present.keys():
            del self._refusals[gone]
        self._check_patience(bool(present.keys() - self._refusals.keys()))
        return present

    def _check_patience(self, has_worker: bool) -> None:
        now = time.monotonic()
        if has_worker:
            self._last_seen = now
            self._is_waiting = False
        elif not self._is_waiting:
            self._is_waiting = True
            self._say(f"waiting for workers of {self._address}")
        if now - self._last_seen > PATIENCE_S:
            message = f"no worker of {self._address} for {PATIENCE_S / 60:.0f} minutes"
            raise LimitError(message, code="no-workers", hint=RESUME)

    async def _serve(
        self,
        worker: str,
        n_threads: int,
        backlog: Backlog,
        put: TakeResults,
    ) -> None:
        """Give a worker batches, after it was compared with this process."""
        if await self._admit(worker):
            slots = (self._feed(worker, backlog, put) for _ in range(n_threads))
            await asyncio.gather(*slots)
        elif worker in self._refusals:
            self._say(f"worker {worker} takes no part: it {self._refusals[worker]}")

    async def _admit(self, worker: str) -> bool:
        """Return whether a worker may run episodes; it gets the files that it lacks."""
        try:
            await self._bring_files(worker)
            if worker not in self._admitted:
                await self._ask(worker, tasks.check_inputs)
        except (DifferenceError, WorkerError) as fault:
            self._refusals[worker] = str(fault)
            return False
        except ConnectionError:
            return False
        self._admitted.add(worker)
        return True

    async def _bring_files(self, worker: str) -> None:
        """Send a worker what its cache folder lacks; one worker at a time, for many share one."""
        async with self._sending:
            folder = cache_folder()
            for name in await self._ask(worker, tasks.list_absent_files, self._file_names):
                assert folder is not None
                with suppress(OSError, WorkerError):  # the worker makes what it cannot be sent
                    data = (folder / name).read_bytes()
                    sent = await self._client.scatter(data, workers=[worker], hash=False)
                    await self._ask(worker, tasks.store_file, name, sent)

    async def _feed(self, worker: str, backlog: Backlog, put: TakeResults) -> None:
        """Give one thread of a worker one batch after the other."""
        while True:
            batch = await backlog.take()
            began = time.monotonic()
            try:
                results = await self._ask(worker, tasks.run_batch, batch.episodes)
            except asyncio.CancelledError:
                backlog.fail(batch, f"worker {worker} ended")
                raise
            except WorkerError as fault:
                backlog.fail(batch, str(fault))
            except (DifferenceError, ConnectionError) as fault:
                if isinstance(fault, DifferenceError):
                    self._refusals[worker] = str(fault)
                backlog.put_back(batch)
                return
            else:
                put(results)
                backlog.close(batch, time.monotonic() - began)

    async def _ask(
        self, worker: str, function: Callable[Concatenate[ClusterJob, P], T],
        *args: P.args, **more: P.kwargs,
    ) -> T:  # fmt: skip
        """Return the value of a task that a worker has run.

        Raises:
            DifferenceError: if the worker differs from this process.
            WorkerError: if the task fails, or hrcplan cannot be imported there.
            ConnectionError: if the scheduler is gone.
            UsageError: if the scheduler lacks hrcplan, or has another one.
        """
        submit: Any = self._client.submit  # its arguments may be futures: files that were sent
        future = submit(call, function, self._job, *args, workers=[worker], pure=False, **more)
        error = await future.exception()
        if future.status == "finished":
            value: T = await future
            return value
        if isinstance(error, (DifferenceError, WorkerError)):
            raise error
        if error is None:
            raise ConnectionError(future.status)
        if "deserialization of the task graph" in str(error):
            message = f"the scheduler at {self._address} cannot read tasks of hrcplan"
            raise UsageError(message, code="scheduler-differs", hint=SAME)
        raise WorkerError(f"cannot run tasks of hrcplan: {type(error).__name__}: {error}")

    def _list_file_names(self) -> None:
        folder = cache_folder()
        files = self._list_files() if folder is not None else ()
        self._file_names = [str(f.relative_to(folder)) for f in files if folder and f.is_file()]

    # In the caller's thread.

    def _wait(self, work: Coroutine[Any, Any, T]) -> T:
        running = asyncio.run_coroutine_threadsafe(work, self._loop)
        try:
            return running.result()
        finally:
            running.cancel()

    def _close(self) -> None:
        if self._client.status == "running" and self._admitted:
            with suppress(OSError, asyncio.TimeoutError):
                self._wait(asyncio.wait_for(self._end_tasks(), CLOSE_S))
        self._client.close(timeout=CLOSE_S)

    async def _end_tasks(self) -> None:
        """End the processes of this study on all workers, also those that run a batch now."""
        workers = [worker for worker in await self._client.nthreads() if worker in self._admitted]
        await self._client.run(end_processes, self._job, workers=workers, on_error="ignore")


async def _cancel(running: Iterable[asyncio.Task[Any]]) -> None:
    """Cancel tasks, and wait for their ends."""
    for task in running:
        task.cancel()
    await asyncio.gather(*running, return_exceptions=True)
