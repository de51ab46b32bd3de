"""The Ray engine: actors on this machine or on a cluster.

Actors are driven one task at a time rather than through Ray Data: an actor that ends is then seen
and replaced at once, and no processor is needed to read. Tasks name files or carry texts; models
are loaded by the actors from their paths and never pass through the object store.
"""

from __future__ import annotations

import os
import socket
import time
from typing import Any

from .._errors import InternalError, NotFoundError
from .._tables import missing
from ._engine import Event
from ._worker import Job, Task, Worker

# Two actors of nearly one processor leave none for Ray's own tasks on a machine of two.
PROCESSORS = 0.5
START_SECONDS = 120.0


class Ray:
    """Actors, one for each processor unless stated otherwise.

    Without an address a Ray of its own is started on this machine, and `stop` ends it. With one
    the cluster stays as it is: its machines have this version of the package and see input, models
    and result under the same paths.
    """

    MOST_FAILED_STARTS = 8

    def __init__(self, job: Job, workers: int | None, address: str | None) -> None:
        try:
            os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
            import ray
        except ImportError:
            raise missing("ray", "ray") from None
        self._ray: Any = ray
        self._job = job
        self._count = workers
        self._address = address
        self._actors: list[Any] = []
        self._starting: dict[Any, int] = {}  # reference of `hello` to worker
        self._running: dict[Any, tuple[int, Task]] = {}
        self._ready: set[int] = set()
        self._failed_starts = 0
        self._started = 0.0

    def start(self) -> None:
        """Connect, or start Ray, and ask for the actors."""
        ray = self._ray
        try:
            if self._address:
                _reach(self._address)
            ray.init(
                address=self._address or "local",
                include_dashboard=None if self._address else False,
                log_to_driver=False,
                logging_level="ERROR",
            )
        except Exception as error:
            raise NotFoundError(
                "not_found",
                "",
                "--address" if self._address else "--engine ray",
                f"no Ray at {self._address or 'this machine'}: {_first_line(error)}",
                "see ray start --help",
            ) from error
        if self._count is None:
            self._count = max(1, int(ray.cluster_resources().get("CPU", 1)))
        self._started = time.monotonic()
        self._actors = [None] * self._count
        for i in range(self._count):
            self._make(i)

    def _make(self, index: int) -> None:
        remote: Any = self._ray.remote(
            num_cpus=PROCESSORS, max_restarts=0, max_task_retries=0, scheduling_strategy="SPREAD"
        )(Worker)
        self._actors[index] = remote.remote(self._job)
        self._starting[self._actors[index].hello.remote()] = index

    def idle(self) -> list[int]:
        """Return actors that are placed and have no task; others may be waiting for a machine."""
        busy = {worker for worker, _ in self._running.values()}
        return sorted(self._ready - busy)

    def give(self, worker: int, task: Task) -> None:
        """Send a task."""
        self._running[self._actors[worker].run_safely.remote(task)] = (worker, task)

    def wait(self, seconds: float) -> list[Event]:
        """Return tasks that have ended, and replace actors that have."""
        waiting = [*self._running, *self._starting]
        if not waiting:
            return []
        if not self._ready and time.monotonic() - self._started > START_SECONDS:
            raise InternalError(
                "internal",
                "",
                "",
                f"no actor could be placed in {START_SECONDS:.0f} s",
                f"free {PROCESSORS} processors of the cluster: see ray status",
            )
        ended, _ = self._ray.wait(waiting, num_returns=1, timeout=seconds)
        more, _ = self._ray.wait(waiting, num_returns=len(waiting), timeout=0)
        events = []
        for reference in dict.fromkeys([*ended, *more]):
            if reference in self._starting:
                self._greet(self._starting.pop(reference), reference)
                continue
            worker, task = self._running.pop(reference)
            try:
                events.append(Event(task, self._ray.get(reference)))
            except self._ray.exceptions.RayError as error:
                self._ready.discard(worker)
                self._make(worker)
                events.append(Event(task, None, _first_line(error)))
        return events

    def _greet(self, worker: int, reference: Any) -> None:
        from .. import _core

        try:
            version, sees = self._ray.get(reference)
        except self._ray.exceptions.RayError as error:
            self._failed_starts += 1
            if self._failed_starts >= self.MOST_FAILED_STARTS:
                raise InternalError(
                    "internal",
                    "",
                    "",
                    f"actors end as they start: {_first_line(error)}",
                    "install crashrank[ray] on every machine of the cluster",
                ) from error
            self._make(worker)
            return
        if version != _core.version or not sees:
            what = f"has version {version}" if version != _core.version else "does not see it"
            raise InternalError(
                "internal",
                self._job.folder,
                "",
                f"a machine of the cluster {what}",
                f"all machines need crashrank {_core.version} and the same shared folders",
            )
        self._failed_starts = 0
        self._ready.add(worker)

    def stop(self) -> None:
        """End the actors; end Ray where `start` has started it, else leave the cluster."""
        ray = self._ray
        if not ray.is_initialized():
            return
        for actor in self._actors:
            try:
                ray.kill(actor)
            except Exception:  # noqa: S112
                continue  # it has ended already
        ray.shutdown()

    def describe(self) -> str:
        """Return the engine in words."""
        return f"Ray, {self._count} actors"


def _reach(address: str) -> None:
    """Raise OSError where nothing listens at HOST:PORT: Ray would end the process."""
    host, colon, port = address.rpartition(":")
    if colon and port.isdigit() and "/" not in host:
        socket.create_connection((host.strip("[]"), int(port)), timeout=10).close()


def _first_line(error: BaseException) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return lines[0] if lines else type(error).__name__
