"""The local engine: processes of this machine, spawned and never forked.

A fork copies locks that threads of the engine or of pyarrow may hold. Spawned processes import the
package anew and get tasks through pipes. SIGINT is blocked in them and in the importers that they
start: on Ctrl-C the parent ends them.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
from collections.abc import Iterator
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from typing import Any

from .._errors import InternalError
from ._engine import Event
from ._worker import Job, Task, Worker

READY = "ready"


def serve(pipe: Connection, job: Job) -> None:
    """Do tasks from a pipe until it closes or the parent has gone: what a process runs."""
    parent = os.getppid()

    def alive() -> None:
        if os.getppid() != parent:
            os._exit(1)  # nobody waits for this part, and the next run makes it

    worker = Worker(job, alive)
    with contextlib.suppress(EOFError, OSError):
        pipe.send(READY)
        while True:
            pipe.send(worker.run_safely(pipe.recv()))


class _Process:
    """A worker process, its pipe and its task."""

    def __init__(self, job: Job) -> None:
        context = multiprocessing.get_context("spawn")
        self.pipe, other = context.Pipe()
        self.process: SpawnProcess = context.Process(
            target=serve, args=(other, job), name="crashrank-batch worker", daemon=True
        )
        self.task: Task | None = None
        self.ready = False
        # The tracker's start lets SIGINT through again: it has to run before.
        resource_tracker.ensure_running()
        with _interrupts_blocked():
            self.process.start()
        other.close()

    def reason(self) -> str:
        """Return how it ended."""
        self.process.join()
        code = self.process.exitcode or 0
        return f"signal {-code}" if code < 0 else f"exit code {code}"

    def end(self) -> None:
        """End it at once."""
        self.process.kill()
        self.process.join()
        self.pipe.close()


@contextlib.contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Block SIGINT meanwhile: processes started then never see it."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


class Local:
    """A number of processes of this machine."""

    # Workers that end as often without a task are not to be had.
    MOST_FAILED_STARTS = 3

    def __init__(self, job: Job, workers: int) -> None:
        self._job = job
        self._count = workers
        self._workers: list[_Process] = []
        self._failed_starts = 0

    def start(self) -> None:
        """Start the processes; they are ready some hundred milliseconds later."""
        self._workers = [_Process(self._job) for _ in range(self._count)]

    def idle(self) -> list[int]:
        """Return workers that are ready and have no task."""
        return [i for i, each in enumerate(self._workers) if each.ready and each.task is None]

    def give(self, worker: int, task: Task) -> None:
        """Send a task. A worker that has ended meanwhile is found by `wait`."""
        self._workers[worker].task = task
        with contextlib.suppress(OSError):
            self._workers[worker].pipe.send(task)

    def wait(self, seconds: float) -> list[Event]:
        """Return tasks that have ended, and replace workers that have."""
        handles: list[Any] = [each.pipe for each in self._workers]
        handles += [each.process.sentinel for each in self._workers]
        wait(handles, seconds)
        events = (self._examine(i) for i in range(len(self._workers)))
        return [event for event in events if event is not None]

    def _examine(self, index: int) -> Event | None:
        worker = self._workers[index]
        try:
            if worker.pipe.poll():
                return self._receive(worker, worker.pipe.recv())
            if worker.process.is_alive():
                return None
        except (EOFError, OSError):
            pass  # its end of the pipe is closed: it has ended or is about to
        return self._replace(index)

    def _receive(self, worker: _Process, message: Any) -> Event | None:
        task, worker.task = worker.task, None
        if task is None:
            worker.ready = True
            self._failed_starts = 0
            return None
        return Event(task, message)

    def _replace(self, index: int) -> Event | None:
        worker = self._workers[index]
        worker.process.join(timeout=5)
        worker.process.kill()
        reason = worker.reason()
        worker.pipe.close()
        if not worker.ready:
            self._failed_starts += 1
            if self._failed_starts >= self.MOST_FAILED_STARTS:
                raise InternalError(
                    "internal",
                    "",
                    "",
                    f"worker processes end as they start ({reason})",
                    "run crashrank-batch --sequential to see why",
                )
        self._workers[index] = _Process(self._job)
        return Event(worker.task, None, reason) if worker.task else None

    def stop(self) -> None:
        """Kill the processes: parts are written whole or not at all."""
        for worker in self._workers:
            worker.end()
        self._workers = []

    def describe(self) -> str:
        """Return the engine in words."""
        return f"{self._count} process" + ("es" if self._count > 1 else "")
