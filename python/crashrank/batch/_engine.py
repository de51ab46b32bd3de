"""What an engine is: workers that take tasks and may end without an answer."""

from __future__ import annotations

from typing import NamedTuple, Protocol

from .._errors import Error
from ._worker import Done, Job, Task, Worker


class Event(NamedTuple):
    """The end of a task."""

    task: Task
    done: Done | Error | None
    """None where the worker ended before the task did; an error ends the run."""
    reason: str = ""
    """How the worker ended: "signal 9"."""


class Engine(Protocol):
    """Workers by number, each with one task at a time."""

    def start(self) -> None:
        """Start the workers. Raises `Error` where it cannot."""

    def idle(self) -> list[int]:
        """Return workers that can take a task."""

    def give(self, worker: int, task: Task) -> None:
        """Hand a task to an idle worker."""

    def wait(self, seconds: float) -> list[Event]:
        """Return the tasks that have ended; wait that long for the first one at most.

        Workers that have ended are replaced.
        """

    def stop(self) -> None:
        """End the workers at once, and every process that `start` has started. Never raises."""

    def describe(self) -> str:
        """Return the engine and its size in words."""


class Sequential:
    """The calling process is the only worker: for debuggers, and as the reference."""

    def __init__(self, job: Job) -> None:
        self._worker = Worker(job)
        self._task: Task | None = None

    def start(self) -> None:
        """Do nothing."""

    def idle(self) -> list[int]:
        """Return the worker while it has no task."""
        return [] if self._task else [0]

    def give(self, worker: int, task: Task) -> None:
        """Keep the task for `wait`."""
        del worker  # there is one
        self._task = task

    def wait(self, seconds: float) -> list[Event]:
        """Do the task."""
        del seconds
        if self._task is None:
            return []
        event = Event(self._task, self._worker.run(self._task))
        self._task = None
        return [event]

    def stop(self) -> None:
        """Do nothing."""

    def describe(self) -> str:
        """Return the engine in words."""
        return "one process"
