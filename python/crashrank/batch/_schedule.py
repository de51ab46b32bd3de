"""The order of tasks: every part once, those of workers that ended again, killing rows found."""

from __future__ import annotations

import collections
import dataclasses
from collections.abc import Callable, Iterable, Iterator

from .._errors import Error, InternalError
from ._engine import Engine, Event
from ._worker import Done, Task

# A worker that ends once may have been ended by somebody; the part is tried again. The second time
# its rows are tried one by one, and a row alone with which workers end so often is left out.
KILLS_OF_A_PART = 2
KILLS_OF_A_ROW = 2
MOST_KILLS = 6


@dataclasses.dataclass
class _Trouble:
    """A part with which workers have ended."""

    kills: int = 0
    probing: int = 0
    row_kills: dict[int, int] = dataclasses.field(default_factory=dict)
    skip: dict[int, str] = dataclasses.field(default_factory=dict)


class Schedule:
    """Runs tasks on an engine. Answers come in the order in which they end."""

    def __init__(self, engine: Engine, on_death: Callable[[str], None]) -> None:
        self._engine = engine
        self._on_death = on_death
        self._again: collections.deque[Task] = collections.deque()
        self._trouble: dict[int, _Trouble] = {}

    def run(self, tasks: Iterable[Task]) -> Iterator[tuple[Task, Done]]:
        """Yield each task that is done. Raises the error that ends the run."""
        fresh = iter(tasks)
        open_tasks = 0
        more = True
        while more or self._again or open_tasks:
            for worker in self._engine.idle():
                task = self._again.popleft() if self._again else next(fresh, None)
                if task is None:
                    more = False
                    break
                self._engine.give(worker, task)
                open_tasks += 1
            for event in self._engine.wait(0.25):
                open_tasks -= 1
                if event.done is None:
                    self._handle_death(event)
                elif isinstance(event.done, Error):
                    raise event.done
                elif event.task.probe is not None:
                    self._end_probe(event.task)
                else:
                    yield event.task, event.done

    def _handle_death(self, event: Event) -> None:
        task = event.task
        index = task.part.number
        trouble = self._trouble.setdefault(index, _Trouble())
        self._on_death(f"a worker ended in part {index} ({event.reason}); the part is ranked again")
        if task.probe is not None:
            kills = trouble.row_kills.get(task.probe, 0) + 1
            trouble.row_kills[task.probe] = kills
            if kills < KILLS_OF_A_ROW:
                self._again.append(task)
                return
            trouble.skip[task.probe] = f"ended its worker {kills} times ({event.reason})"
            self._end_probe(task)
            return
        trouble.kills += 1
        if trouble.kills > MOST_KILLS:
            raise InternalError(
                "internal",
                "",
                f"part {index}",
                f"{trouble.kills} workers ended ({event.reason}), with none of its rows alone",
                "give fewer --workers or fewer --rows-per-part: memory may have run out",
            )
        rows = len(task.part.rows)
        if task.report is not None or trouble.kills % KILLS_OF_A_PART:
            self._again.append(task)
            return
        trouble.probing = rows
        trouble.row_kills.clear()
        self._again.extend(dataclasses.replace(task, probe=row) for row in range(rows))

    def _end_probe(self, task: Task) -> None:
        trouble = self._trouble[task.part.number]
        trouble.probing -= 1
        if trouble.probing == 0:
            skip = tuple(sorted(trouble.skip.items()))
            self._again.append(dataclasses.replace(task, probe=None, skip=skip))
