"""Ids of a run's scenarios: every row has one of its own, or the run does not begin."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from .._errors import BadInputError, Error, UsageError
from ._arrow import arrow, compute
from ._scene import Row

if TYPE_CHECKING:
    import pyarrow

# Files with their rows, or the path of a table.
Source = list[Row] | str


def check_ids(sources: Sequence[Source], ids: Sequence[pyarrow.ChunkedArray]) -> None:
    """Check that no id is absent and none is there twice.

    Results are joined to their scenarios by id, so that two rows of one id could not be told apart.

    Parameters
    ----------
    sources
        All sources of a run.
    ids
        The ids of each, one for each row, as strings.

    Raises
    ------
    BadInputError
        For the first row of a table without an id, or with that of another row or file.
    UsageError
        For two files of one id.
    """
    pc = compute()
    for source, column in zip(sources, ids, strict=True):
        at = pc.index(pc.fill_null(column, ""), "").as_py()
        if at >= 0:
            raise BadInputError("bad_input", *_place(source, at), "has no id", _REMEDY)
    chunks = [chunk for column in ids for chunk in column.chunks]
    whole = arrow().chunked_array(chunks, arrow().string())
    # Counting needs a fraction of the memory that a set of the texts does.
    repeated = len(whole) - pc.count_distinct(whole).as_py()
    if repeated:
        raise _first_repeated(sources, ids, repeated)


_REMEDY = "give every row an id of its own (rows are counted from 1)"


def _first_repeated(
    sources: Sequence[Source], ids: Sequence[pyarrow.ChunkedArray], repeated: int
) -> Error:
    """Return the error that names both places of the first id that is there twice."""
    # By the sources' numbers: one that is named twice equals itself.
    seen: dict[str, tuple[int, int]] = {}
    places = (
        (row_id, number, row)
        for number, column in enumerate(ids)
        for row, row_id in enumerate(column.to_pylist())
    )
    row_id, number, row = next(
        each for each in places if seen.setdefault(each[0], each[1:]) != each[1:]
    )
    source, first_source = sources[number], sources[seen[row_id][0]]
    file, place = _place(source, row)
    first_file, first_place = _place(first_source, seen[row_id][1])
    if (file, place) == (first_file, first_place):
        return UsageError("usage", file, "", "is named twice by the inputs", "name it once")
    named = (first_place, "" if first_file == file and first_place else first_file)
    first = " of ".join(part for part in named if part)
    reason = f"has the same id {row_id!r} as {first}"
    if repeated > 1:
        reason += f" ({repeated} rows in all repeat an id)"
    if isinstance(source, str) or isinstance(first_source, str):
        return BadInputError("bad_input", file, place, reason, _REMEDY)
    return UsageError("usage", file, place, reason, "name the folder above both instead")


def _place(source: Source, row: int) -> tuple[str, str]:
    """Return the file of a row, and where in it the row is."""
    if isinstance(source, str):
        return source, f"row {row + 1}"
    return source[row].file or "", ""
