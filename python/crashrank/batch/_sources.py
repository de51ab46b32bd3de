"""Inputs of ``crashrank-batch``: folders, scenario files and parquet, divided into parts."""

from __future__ import annotations

import contextlib
import itertools
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

from .._errors import BadInputError, Error, NotFoundError, bad_input, usage
from ._arrow import arrow, parquet
from ._ids import Source, check_ids
from ._parts import STATE
from ._scene import Row
from ._table import table_rows, text_column

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

    Raises `NotFoundError`, `BadInputError` and `UsageError`: for what cannot be read, for rows
    without an id and for ids that are there twice.
    """

    def __init__(self, paths: Sequence[str], result_folder: str) -> None:
        self._result = os.path.realpath(result_folder)
        self._sources: list[Source] = []
        for path in paths:
            files, tables = self._find(path)
            self._sources += [files, *tables] if files else tables
        ids = [_read_ids(source) for source in self._sources]
        self.rows = sum(len(column) for column in ids)
        if not self.rows:
            raise bad_input(
                "INPUT", "holds no scenario", "name .json or .parquet files, and no result of a run"
            )
        check_ids(self._sources, ids)

    def _find(self, path: str) -> tuple[list[Row], list[str]]:
        if not path:
            raise usage("INPUT", "is empty", "name a folder or a file")
        if os.path.isdir(path):
            if os.path.realpath(path) == self._result:
                raise usage("-o", f"{path} is an input, too", "name another folder, or one in it")
            found = sorted(self._walk(path))
            rows = [
                _file_row(file, Path(os.path.relpath(file, path)).as_posix())
                for file in found
                if file.endswith(".json")
            ]
            return rows, [os.path.abspath(file) for file in found if file.endswith(".parquet")]
        if not os.path.isfile(path):
            what = "is neither a file nor a folder" if os.path.exists(path) else "is not there"
            raise NotFoundError("not_found", path, "", what, "check the path")
        if path.endswith(".parquet"):
            return [], [os.path.abspath(path)]
        return [_file_row(path, os.path.basename(path))], []

    def _walk(self, folder: str) -> Iterator[str]:
        for at, folders, files in os.walk(folder, onerror=_raise_unread):
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


def _file_row(file: str, name: str) -> Row:
    """Return the row of a scenario's file. Its id is text that UTF-8 can hold, as parquet needs."""
    row_id = name.encode("utf-8", "backslashreplace").decode()
    return Row(row_id, None, os.path.abspath(file), None)


def _raise_unread(error: OSError) -> NoReturn:
    raise NotFoundError(
        "not_found",
        str(error.filename),
        "",
        f"cannot be read: {error.strerror}",
        "check its permissions, or leave it out",
    ) from None


@contextlib.contextmanager
def _reading(path: str) -> Iterator[None]:
    """Make errors meanwhile name the table."""
    try:
        yield
    except Error as error:
        error.file = error.file or path
        raise
    except (OSError, arrow().ArrowException) as error:
        reason = str(error).splitlines()[0]
        raise BadInputError(
            "bad_input", path, "", f"is damaged: {reason}", "write it again"
        ) from None


def _open(path: str) -> Any:
    try:
        if not os.path.isfile(path):  # opening a pipe would wait for somebody who writes
            os.stat(path)
            raise BadInputError("bad_input", path, "", "is no file", "leave it out")
        with open(path, "rb"):
            pass
    except OSError as error:
        _raise_unread(error)
    try:
        file = parquet().ParquetFile(path)
    except Exception as error:
        reason = str(error).splitlines()[0]
        raise BadInputError(
            "bad_input", path, "", f"is no parquet file: {reason}", "write it again"
        ) from None
    names = file.schema_arrow.names
    for name, least in (("id", 1), ("scenario", 1), ("base", 0)):
        count = names.count(name)
        if not least <= count <= 1:
            what = f"has {count} columns" if count else "has no column"
            raise BadInputError(
                "bad_input", path, "", f"{what} {name!r}", "see docs/guide/batch.md"
            )
    with _reading(path):
        table_rows(file.schema_arrow.empty_table(), "")  # columns of other types are refused
    return file


def _count_rows(path: str) -> int:
    with _open(path) as file:
        return int(file.metadata.num_rows)


def _read_ids(source: Source) -> Any:
    """Return the ids of a source as a ``pyarrow.ChunkedArray`` of strings."""
    pa = arrow()
    if not isinstance(source, str):
        return pa.chunked_array([pa.array([row.id for row in source], pa.string())])
    with _open(source) as file, _reading(source):
        return text_column(file.read(columns=["id"], use_threads=False), "id")


def _read_rows(path: str) -> Iterator[Row]:
    folder = os.path.dirname(path)
    with _open(path) as file, _reading(path):
        names = [name for name in ("id", "scenario", "base") if name in file.schema_arrow.names]
        for batch in file.iter_batches(batch_size=256, columns=names, use_threads=False):
            for row in table_rows(arrow().Table.from_batches([batch]), folder):
                yield row._replace(base=os.path.join(folder, row.base or "."))
