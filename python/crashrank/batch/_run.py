"""One run: parts that are missing are made, then the summary."""

from __future__ import annotations

import contextlib
import dataclasses
import fcntl
import json
import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from .. import _core
from .._errors import Error, InternalError, usage
from ._engine import Engine
from ._hashes import ResultsSum
from ._parts import STALE, STATE, list_parts, remove_temporary_files, write_whole
from ._progress import Progress
from ._schedule import Schedule
from ._sources import Inputs, Part
from ._summary import Summary, Worst
from ._worker import Done, Job, Task, move

SUMMARY = "_summary.html"
REPORTS = "_reports"


@dataclasses.dataclass
class Outcome:
    """What a run came to."""

    rows: int
    parts: int
    done_rows: int = 0
    found_rows: int = 0
    errors: int = 0
    complete: bool = False
    interrupted: bool = False
    seconds: float = 0.0
    results: ResultsSum = dataclasses.field(default_factory=ResultsSum)

    def to_dict(self) -> dict[str, Any]:
        """Return the members for JSON; ``results`` is the sum over all rows."""
        members = {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}
        return members | {"results": self.results.hex}


@contextlib.contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Make the folder and hold its lock: two runs never write one folder."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        lock = open(folder / "_lock", "w", encoding="utf-8")  # noqa: SIM115
    except OSError as error:
        raise usage(
            "-o", f"{folder} cannot be written: {error.strerror}", "choose another folder"
        ) from None
    with lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise usage("-o", f"another run writes {folder}", "wait for it or end it") from None
        except OSError:
            pass  # a file system without locks
        yield


def read_state(folder: Path) -> dict[str, Any]:
    """Return what the last run of a folder wrote about itself; empty without one."""
    try:
        state = json.loads((folder / STATE).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return state if isinstance(state, dict) else {}


class Run:
    """A run of one engine over all inputs, into one folder. The folder is locked meanwhile."""

    def __init__(
        self, inputs: Inputs, job: Job, engine: Engine, rows_per_part: int, reports: int
    ) -> None:
        self._inputs = inputs
        self._job = job
        self._engine = engine
        self._rows_per_part = rows_per_part
        self._reports = reports
        self._folder = Path(job.folder)
        self._parts = inputs.count_parts(rows_per_part)
        self.outcome = Outcome(inputs.rows, self._parts)
        self.progress = Progress(inputs.rows)
        self._names: dict[int, str] = {}

    def run(self) -> Outcome:
        """Rank what is missing. Raises `Error` where the run cannot go on; parts stay."""
        outcome = self.outcome
        remove_temporary_files(self._folder)
        self._write_state()
        try:
            self._engine.start()
            schedule = Schedule(self._engine, self.progress.say)
            for task, done in schedule.run(self._tasks()):
                self._count(task, done)
            outcome.complete = True
            self._remove_stale()
            self._finish(schedule)
        except KeyboardInterrupt:
            outcome.interrupted = True
        finally:
            self._engine.stop()
            self.progress.clear()
        outcome.seconds = round(self.progress.seconds, 3)
        if outcome.interrupted:
            with contextlib.suppress(KeyboardInterrupt):
                self._finish(None)
        self._write_state()
        return outcome

    def _tasks(self) -> Iterator[Task]:
        present = list_parts(self._folder)
        stale = list_parts(self._folder / STALE)
        for index in [index for index in present if index >= self._parts]:
            for name in present.pop(index):
                move(self._folder / name, self._folder / STALE / name)
        for part in self._inputs.parts(self._rows_per_part):
            found = tuple(present.get(part.number, ()))
            yield Task(part, found, tuple(stale.get(part.number, ())))

    def _count(self, task: Task, done: Done) -> None:
        if done.meta is None:
            raise InternalError("internal", "", f"part {task.part.number}", "has no result")
        outcome, meta = self.outcome, done.meta
        self._names[task.part.number] = done.name
        outcome.done_rows += meta.rows
        outcome.found_rows += meta.rows if done.was_there else 0
        outcome.errors += meta.errors
        outcome.results.add(meta.results)
        self.progress.add(meta.rows, meta.errors, done.was_there)

    def _remove_stale(self) -> None:
        shutil.rmtree(self._folder / STALE, ignore_errors=True)

    def _finish(self, schedule: Schedule | None) -> None:
        """Write the summary, with a schedule the reports of the worst scenes before it."""
        summary = Summary(self._reports)
        for index in sorted(self._names):
            summary.add(index, self._folder / self._names[index])
        folder = self._folder / REPORTS
        worst = summary.worst()
        wanted = {each.report: each for each in worst}
        missing = {name: each for name, each in wanted.items() if not (folder / name).is_file()}
        if schedule is not None and missing:
            folder.mkdir(exist_ok=True)
            for _ in schedule.run(self._report_tasks(missing)):
                pass
        if schedule is not None:
            _remove_others(folder, set(wanted))
        links = {name for name in wanted if (folder / name).is_file()}
        page = summary.page(self.outcome.to_dict(), REPORTS, links)
        write_whole(self._folder / SUMMARY, page.encode("utf-8", "replace"))

    def _report_tasks(self, missing: dict[str, Worst]) -> Iterator[Task]:
        by_part: dict[int, list[tuple[str, int]]] = {}
        for name, each in missing.items():
            by_part.setdefault(each.part, []).append((name, each.row))
        for part in self._inputs.parts(self._rows_per_part):
            for name, row in by_part.get(part.number, ()):
                if row >= len(part.rows):
                    continue  # its table has changed since; the summary then has no link
                alone = Part(part.number, [part.rows[row]])
                yield Task(alone, report=(0, str(self._folder / REPORTS / name)))

    def _write_state(self) -> None:
        state = {
            "format": 1,
            "version": _core.version,
            "engine": self._job.engine,
            "settings": dataclasses.asdict(self._job.settings),
            "settings_hash": self._job.settings_hash,
            "models": dict(self._job.models),
            "rows_per_part": self._rows_per_part,
            **self.outcome.to_dict(),
        }
        text = json.dumps(state, indent=2, ensure_ascii=False) + "\n"
        write_whole(self._folder / STATE, text.encode("utf-8", "replace"))


def _remove_others(folder: Path, wanted: set[str]) -> None:
    for name in os.listdir(folder) if folder.is_dir() else []:
        if name.endswith(".html") and name not in wanted:
            (folder / name).unlink(missing_ok=True)


def failed(error: Error, outcome: Outcome) -> Error:
    """Return an error that also says how much is done."""
    error.reason += f"; {outcome.done_rows} of {outcome.rows} scenes are done and stay"
    return error
