"""Inputs of ``crashrank-batch``: folders, scenario files and parquet, divided into parts."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from .._errors import NotFoundError, bad_input, usage
from ._arrow import arrow, parquet
from ._parts import STATE
from ._scene import Row
from ._table import table_rows

MOST_ROWS = 256  # in a part, unless stated
WANTED_PARTS = 64


class Part(NamedTuple):
    """Consecutive rows of one input."""

    number: int
    rows: list[Row]


class Inputs:
    """All scenarios of a run, in a fixed order.

    A folder has the ``.json`` and ``.parquet`` files in it and below it, by name; files have an
    id by their path in the folder, a file that is named itself has its name. Rows of parquet have
    the columns ``id`` and ``scenario`` and, for the folder of their paths, may have ``base``;
    default: the folder of the parquet file.

    Raises `NotFoundError` and `BadInputError`.
    """

    def __init__(self, paths: Sequence[str], result_folder: str) -> None:
        self._result = os.path.realpath(result_folder)
        self._sources: list[list[Row] | str] = []
        self.rows = 0
        ids: set[str] = set()
        for path in paths:
            files, tables = self._find(path)
            for row in files:
                if row.id in ids:
                    raise usage(
                        "INPUT", f"has two files {row.id!r}", "name the folder above both instead"
                    )
                ids.add(row.id)
            if files:
                self._sources.append(files)
                self.rows += len(files)
            for table in tables:
                self._sources.append(table)
                self.rows += _count_rows(table)
        if not self.rows:
            raise bad_input("INPUT", "holds no scenario", "name .json or .parquet files")

    def _find(self, path: str) -> tuple[list[Row], list[str]]:
        if os.path.isdir(path):
            found = sorted(self._walk(path))
            rows = [
                Row(Path(os.path.relpath(file, path)).as_posix(), None, os.path.abspath(file), None)
                for file in found
                if file.endswith(".json")
            ]
            return rows, [os.path.abspath(file) for file in found if file.endswith(".parquet")]
        if not os.path.isfile(path):
            raise NotFoundError("not_found", path, "", "is not there", "check the path")
        if path.endswith(".parquet"):
            return [], [os.path.abspath(path)]
        return [Row(os.path.basename(path), None, os.path.abspath(path), None)], []

    def _walk(self, folder: str) -> Iterator[str]:
        for at, folders, files in os.walk(folder):
            if STATE in files or os.path.realpath(at) == self._result:
                folders.clear()  # results of a run
                continue
            folders[:] = [name for name in folders if not name.startswith((".", "_"))]
            yield from (os.path.join(at, name) for name in files if not name.startswith((".", "_")))

    def parts(self, rows_per_part: int) -> Iterator[Part]:
        """Return the parts; parquet is read as they are taken. No part spans two inputs."""
        index = 0
        for source in self._sources:
            rows = _read_rows(source) if isinstance(source, str) else iter(source)
            while chunk := list(itertools.islice(rows, rows_per_part)):
                yield Part(index, chunk)
                index += 1

    def count_parts(self, rows_per_part: int) -> int:
        """Return how many parts there are."""
        sizes = (
            _count_rows(source) if isinstance(source, str) else len(source)
            for source in self._sources
        )
        return sum(-(-size // rows_per_part) for size in sizes)


def default_rows_per_part(rows: int) -> int:
    """Return a power of two, so that a few rows more change no part that is there."""
    size = 1
    while size < MOST_ROWS and size * 2 * WANTED_PARTS <= rows:
        size *= 2
    return size


def _open(path: str) -> Any:
    pq = parquet()
    try:
        file = pq.ParquetFile(path)
    except Exception as error:
        reason = str(error).splitlines()[0]
        raise bad_input(path, f"is no parquet file: {reason}", "write it again") from None
    for name in ("id", "scenario"):
        if name not in file.schema_arrow.names:
            raise bad_input(path, f"has no column {name!r}", "see docs/guide/batch.md")
    return file


def _count_rows(path: str) -> int:
    with _open(path) as file:
        return int(file.metadata.num_rows)


def _read_rows(path: str) -> Iterator[Row]:
    folder = os.path.dirname(path)
    with _open(path) as file:
        names = [name for name in ("id", "scenario", "base") if name in file.schema_arrow.names]
        for batch in file.iter_batches(batch_size=256, columns=names, use_threads=False):
            for row in table_rows(arrow().Table.from_batches([batch]), folder):
                yield row._replace(base=os.path.join(folder, row.base or "."))
