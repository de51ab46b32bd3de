"""What a worker does, the same in every engine: one task at a time, in one thread."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import time
from collections.abc import Callable
from pathlib import Path

from .. import _core
from .._errors import Error, InternalError
from ._arrow import arrow
from ._hashes import engine_hash
from ._models import GivenModel, given_models
from ._parts import (
    STALE,
    PartMeta,
    not_written,
    part_key,
    part_name,
    read_meta,
    write_part,
    write_whole,
)
from ._scene import Row, Scene, rank_scene, read_scene
from ._settings import Settings
from ._sources import Part
from ._table import killed_row, rank_row, result_schema


@dataclasses.dataclass(frozen=True)
class Job:
    """What all tasks of a run share."""

    folder: str
    settings: Settings
    settings_hash: str
    engine: str
    models: tuple[tuple[str, str], ...] = ()
    """Names and paths of models that stand for those of every scenario."""
    retry: bool = False
    """Rank again what failed for a reason of the machine."""


@dataclasses.dataclass(frozen=True)
class Task:
    """A piece of work. Everything in it can be sent to another machine."""

    part: Part
    present: tuple[str, ...] = ()
    """Files with this part's number, of this run or another one."""
    stale: tuple[str, ...] = ()
    """The same in the folder of replaced parts."""
    skip: tuple[tuple[int, str], ...] = ()
    """Rows that end workers, and how they do."""
    probe: int | None = None
    """Rank this row alone and write nothing: does it end the worker?"""
    report: tuple[int, str] | None = None
    """Write the report of this row to that file instead."""


@dataclasses.dataclass(frozen=True)
class Done:
    """What a task came to."""

    name: str = ""
    meta: PartMeta | None = None
    was_there: bool = False
    seconds: float = 0.0


class Worker:
    """Ranks parts. Made once in each process; `alive` is called between rows."""

    def __init__(self, job: Job, alive: Callable[[], None] = lambda: None) -> None:
        self._job = job
        self._alive = alive
        self._given: dict[str, GivenModel] | None = None
        with contextlib.suppress(Exception):
            arrow().set_cpu_count(1)
            arrow().set_io_thread_count(1)

    def hello(self) -> tuple[str, bool]:
        """Return the version, and whether this machine has the result's folder."""
        return _core.version, Path(self._job.folder, "_lock").is_file()

    def run(self, task: Task) -> Done | Error:
        """Do a task. An error is returned where it ends the whole run; rows keep their own."""
        try:
            if self._given is None:
                self._given = given_models(dict(self._job.models))
            if task.probe is not None:
                rank_scene(self._read(task.part.rows[task.probe]), self._job.settings)
                return Done()
            if task.report is not None:
                return self._report(task.part.rows[task.report[0]], Path(task.report[1]))
            return self._rank_part(task)
        except Error as error:
            return error
        except OSError as error:
            return not_written(error.filename2 or error.filename or self._job.folder, error)

    def run_safely(self, task: Task) -> Done | Error:
        """Do a task; a defect of this package ends the run with an error, and not the worker."""
        try:
            return self.run(task)
        except Exception as error:
            return InternalError(
                "internal",
                "",
                f"part {task.part.number}",
                f"{type(error).__name__}: {error}",
                "report this defect; --sequential shows where it is",
            )

    def _read(self, row: Row) -> Scene:
        self._alive()
        return read_scene(row, self._given or {}, self._job.settings)

    def _rank_part(self, task: Task) -> Done:
        started = time.monotonic()
        job = self._job
        folder = Path(job.folder)
        scenes = [self._read(row) for row in task.part.rows]
        key = part_key(scenes, job.settings_hash, job.engine)
        name = part_name(task.part.number, key)
        meta = self._find_done(task, folder, name, key)
        if meta is not None:
            return Done(name, meta, was_there=True, seconds=time.monotonic() - started)
        skip = dict(task.skip)
        records = []
        for i, scene in enumerate(scenes):
            self._alive()
            how = killed_row(skip[i]) if i in skip else rank_scene
            records.append(rank_row(scene, job.settings, job.settings_hash, how))
        table = arrow().Table.from_pylist(records, schema=result_schema())
        meta = write_part(folder / name, table, key)
        return Done(name, meta, seconds=time.monotonic() - started)

    def _find_done(self, task: Task, folder: Path, name: str, key: str) -> PartMeta | None:
        """Return what the part states if it is there; move parts that it replaces away."""
        for other in task.present:
            if other != name:
                move(folder / other, folder / STALE / other)
        if name in task.stale and name not in task.present:
            move(folder / STALE / name, folder / name)
        elif name not in task.present:
            return None
        meta = read_meta(folder / name, key)
        again = meta is not None and self._job.retry and meta.passing_errors > 0
        return None if again else meta

    def _report(self, row: Row, path: Path) -> Done:
        answer = rank_scene(self._read(row), self._job.settings)
        if isinstance(answer, Error):
            return Done()  # its files have changed since; the summary then has no link
        write_whole(path, answer._ranked.html(24).encode())
        return Done()


def move(source: Path, target: Path) -> None:
    """Rename a file; one that is gone, or was moved by a worker that ended since, is no error."""
    with contextlib.suppress(FileNotFoundError):
        target.parent.mkdir(exist_ok=True)
        os.replace(source, target)


def make_job(
    folder: str, settings: Settings, models: tuple[tuple[str, str], ...], retry: bool
) -> Job:
    """Return the job of a run on this machine's version of the engine."""
    return Job(folder, settings, settings.hash, engine_hash(), models, retry)
