"""Part files: written whole or not at all, and checked before they count as done."""

from __future__ import annotations

import io
import json
import os
import re
import socket
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from .. import _core
from .._errors import InternalError
from ._arrow import parquet
from ._hashes import ResultsSum, json_digest
from ._scene import Scene

if TYPE_CHECKING:
    import pyarrow

FORMAT = 1
STALE = "_stale"
STATE = "_run.json"
_METADATA = b"crashrank.part"
_NAME = re.compile(r"part-(\d{6,})-[0-9a-f]{16}\.parquet")
_TEMPORARY = re.compile(r"\..*\.parquet\.part")

# Codes of errors that another try may not have.
_PASSING = ("internal", "out_of_memory")


class PartMeta(NamedTuple):
    """What the footer of a part states."""

    key: str
    rows: int
    errors: int
    passing_errors: int
    """Of these, errors of the machine: another run may not have them."""
    results: str
    """`ResultsSum` of its rows."""


def part_key(scenes: Sequence[Scene], settings_hash: str, engine: str) -> str:
    """Return the hash of everything that a part's content depends on."""
    rows = [scene.key for scene in scenes]
    return json_digest([FORMAT, _core.version, engine, settings_hash, rows])


def part_name(index: int, key: str) -> str:
    """Return the name of a part's file."""
    return f"part-{index:06d}-{key[:16]}.parquet"


def part_index(name: str) -> int | None:
    """Return the number of the part with that file name; None for other files."""
    found = _NAME.fullmatch(name)
    return int(found[1]) if found else None


def list_parts(folder: Path) -> dict[int, list[str]]:
    """Return the names of part files by number."""
    names: dict[int, list[str]] = {}
    for name in sorted(os.listdir(folder)) if folder.is_dir() else []:
        index = part_index(name)
        if index is not None:
            names.setdefault(index, []).append(name)
    return names


def remove_temporary_files(folder: Path) -> None:
    """Remove what a run that was killed left unfinished."""
    for name in os.listdir(folder):
        if _TEMPORARY.fullmatch(name):
            (folder / name).unlink(missing_ok=True)


def write_part(path: Path, table: pyarrow.Table, key: str) -> PartMeta:
    """Write a part under a temporary name, bring it to the disk and rename it.

    Raises `InternalError` where the disk is full or the folder cannot be written; nothing of the
    part stays then.
    """
    meta = _meta_of(table, key)
    encoded = json.dumps(meta._asdict()).encode()
    buffer = io.BytesIO()
    parquet().write_table(
        table.replace_schema_metadata({_METADATA: encoded}),
        buffer,
        compression="zstd",
        write_page_checksum=True,
    )
    write_whole(path, buffer.getbuffer())
    return meta


def write_whole(path: Path, data: bytes | memoryview) -> None:
    """Replace a file by these bytes, or leave it as it is and raise `InternalError`."""
    temporary = path.with_name(f".{path.stem}-{socket.gethostname()}-{os.getpid()}.parquet.part")
    try:
        with open(temporary, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, path)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise not_written(path, error) from error


def not_written(path: Path | str, error: OSError) -> InternalError:
    """Return the error for a file or folder of the result that cannot be made."""
    return InternalError(
        "internal",
        str(path),
        "",
        f"cannot be written: {error.strerror}",
        "make room or choose another folder, and run the same command again",
    )


def read_meta(path: Path, key: str) -> PartMeta | None:
    """Return what a part states, or None where it is damaged or not the part of that key."""
    try:
        with parquet().ParquetFile(path, page_checksum_verification=True) as file:
            stated = PartMeta(**json.loads(file.schema_arrow.metadata[_METADATA]))
            if stated.key != key or file.metadata.num_rows != stated.rows:
                return None
            light = file.read(columns=["id", "result_hash", "status", "error_code"])
    except Exception:
        # Whatever a damaged file makes the reader raise: the part is made again.
        return None
    return stated if _meta_of(light, key) == stated else None


def _meta_of(table: pyarrow.Table, key: str) -> PartMeta:
    codes = table.column("error_code").to_pylist()
    results = ResultsSum()
    rows = zip(
        table.column("id").to_pylist(), table.column("result_hash").to_pylist(), codes, strict=True
    )
    for row_id, result, code in rows:
        results.add_row(row_id, result, code)
    errors = table.column("status").to_pylist().count("error")
    passing = sum(code in _PASSING for code in codes)
    return PartMeta(key, table.num_rows, errors, passing, results.hex)
