"""Hashes of inputs, models, settings and results: SHA-256 as 64 hex digits."""

from __future__ import annotations

import functools
import hashlib
import json
import os
import stat
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from .. import _core

MISSING = "missing"

# Members of an answer that say how it was computed. Warnings name paths of the machine.
_NOT_RESULT = frozenset({"elapsed_s", "effort", "work", "warnings"})


def digest(data: bytes) -> str:
    """Return the SHA-256 of bytes."""
    return hashlib.sha256(data).hexdigest()


def json_digest(value: object) -> str:
    """Return the SHA-256 of a value's JSON, keys sorted, without spaces."""
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    return digest(text.encode("utf-8", "surrogatepass"))


def result_hash(document: Mapping[str, Any]) -> str:
    """Return the fingerprint of an answer of ``crashrank rank --json`` or `Ranking.to_dict`.

    It covers every member that is the same on every machine and for every number of workers:
    all but ``elapsed_s``, ``effort``, ``work`` and ``warnings``.

    Parameters
    ----------
    document : mapping
        The answer.

    Returns
    -------
    str
        64 hexadecimal digits.
    """
    return json_digest({key: document[key] for key in document if key not in _NOT_RESULT})


def file_hash(path: str, *, with_buffers: bool = True) -> str:
    """Return the SHA-256 of a file and of the buffers that a glTF file names, or ``missing``."""
    try:
        state = os.stat(path)
        if not stat.S_ISREG(state.st_mode):
            return MISSING  # a pipe would wait for somebody who writes
        found, beside = _file_hash(path, state.st_ino, state.st_size, state.st_mtime_ns)
    except OSError:
        return MISSING
    if not beside or not with_buffers:
        return found
    return json_digest([found, *(file_hash(each, with_buffers=False) for each in beside)])


@functools.lru_cache(maxsize=4096)
def _file_hash(path: str, _inode: int, _size: int, _time_ns: int) -> tuple[str, tuple[str, ...]]:
    """Return a file's hash and the files beside it that belong to it."""
    whole = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(1 << 20):
            whole.update(block)
    beside = _gltf_buffers(path) if path.lower().endswith(".gltf") else ()
    return whole.hexdigest(), tuple(str(Path(path).parent / name) for name in beside)


def _gltf_buffers(path: str) -> list[str]:
    """Return the files that a glTF document names as buffers; none where it is damaged."""
    try:
        document = json.loads(Path(path).read_bytes())
        names = [buffer.get("uri", "data:") for buffer in document.get("buffers", [])]
    except (ValueError, AttributeError, RecursionError):
        return []
    return [name for name in names if isinstance(name, str) and not name.startswith("data:")]


def models_hash(files: Iterable[tuple[str, str]]) -> str:
    """Return the hash of a scenario's models from their names and the hashes of their files."""
    return json_digest(sorted(files))


def input_hash(text: str, folder: str) -> str:
    """Return the hash of a scenario's text and of the table of candidates that it names."""
    plain = digest(text.encode("utf-8", "surrogatepass"))
    if '"table"' not in text:
        return plain
    try:
        table = json.loads(text)["candidates"]["table"]
        path = os.path.join(folder, table)
    except (ValueError, TypeError, LookupError, RecursionError):
        return plain
    return json_digest([plain, file_hash(path)])


@functools.cache
def engine_hash() -> str:
    """Return the hash of the extension module: versions under development differ in it."""
    return file_hash(str(_core.__file__))


class ResultsSum:
    """A fingerprint of many rows that depends neither on their order nor on how they are divided.

    The sum, modulo 2 to the 256, of the SHA-256 of each row's id and result.
    """

    def __init__(self, value: str = "0") -> None:
        self._sum = int(value, 16)

    def add_row(self, row_id: str, result: str | None, error_code: str | None) -> None:
        """Add a row: its result's hash, or the code of its error."""
        text = json.dumps([row_id, result, error_code])
        self._sum += int(digest(text.encode()), 16)

    def add(self, other: str) -> None:
        """Add the sum of other rows."""
        self._sum += int(other, 16)

    @property
    def hex(self) -> str:
        """The sum as 64 hex digits."""
        return f"{self._sum % (1 << 256):064x}"
