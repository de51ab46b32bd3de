"""Errors of the readers, and bounded access to files: size first, content after."""

from __future__ import annotations

import math
import os
import stat
from collections.abc import Callable
from typing import Any, NoReturn, TypeVar

from .._checks import as_number, as_path
from .._errors import BadInputError, Error, LimitError, NotFoundError, UsageError
from .._tables import missing

T = TypeVar("T")
MAX_HORIZON_S = 60.0


def input_error(file: str, place: str, reason: str, remedy: str) -> BadInputError:
    """Return the error for input that is not acceptable."""
    return BadInputError("bad_input", file, _short(place), _short(reason), remedy)


def refuse(file: str, place: str, reason: str, remedy: str) -> NoReturn:
    """Raise the error for input that is not acceptable."""
    raise input_error(file, place, reason, remedy) from None


def refuse_size(file: str, place: str, reason: str, remedy: str) -> NoReturn:
    """Raise the error for input beyond a limit."""
    raise LimitError("limit_exceeded", file, _short(place), _short(reason), remedy) from None


def choice_error(file: str, place: str, reason: str, remedy: str) -> UsageError:
    """Return the error for an argument that does not fit the file."""
    return UsageError("usage", file, _short(place), _short(reason), _short(remedy, 400))


def _short(text: str, most: int = 300) -> str:
    """Return text of a file on one line that a terminal takes, and not too much of it."""
    text = text if len(text) <= most else text[: most - 3] + "..."
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def checked_file(path: object, most_bytes: int) -> tuple[str, int]:
    """Return a regular file's path and size.

    Raises `NotFoundError` for what is no file, `LimitError` for more than `most_bytes`.
    """
    name = as_path(path, "path")
    try:
        found = os.stat(name)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise NotFoundError(
            "not_found", name, "", f"cannot be read: {reason}", "check the path and its permissions"
        ) from None
    if not stat.S_ISREG(found.st_mode):
        raise NotFoundError("not_found", name, "", "is no file", "name a file")
    if found.st_size > most_bytes:
        refuse_size(
            name,
            "",
            f"has {found.st_size} bytes, at most {most_bytes} are read",
            "cut out the seconds that matter",
        )
    if found.st_size == 0:
        refuse(name, "", "is empty", "write it again")
    return name, found.st_size


def read_bytes(path: object, most_bytes: int) -> tuple[str, bytes]:
    """Return a file's path and content; errors as of `checked_file`."""
    name, _ = checked_file(path, most_bytes)
    data = guarded_read(name, lambda: _read(name, most_bytes))
    return name, data


def _read(name: str, most_bytes: int) -> bytes:
    with open(name, "rb") as file:
        return file.read(most_bytes + 1)[:most_bytes]


def guarded_read(file: str, read: Callable[[], T]) -> T:
    """Return what `read` returns; failures of the file system become `NotFoundError`."""
    try:
        return read()
    except OSError as error:
        raise NotFoundError(
            "not_found",
            file,
            "",
            f"cannot be read: {error.strerror or error}",
            "check the path and its permissions",
        ) from None


def decoded(file: str, data: bytes) -> str:
    """Return text in UTF-8, a byte order mark left out."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        refuse(file, f"byte {error.start + 1}", "is not UTF-8", "save the file in UTF-8")


def guarded_parse(file: str, what: str, parse: Callable[[], T]) -> T:
    """Return what `parse` returns; whatever another package raises is one refusal."""
    try:
        return parse()
    except Error:
        raise
    except (
        MemoryError
    ):  # packages allocate the sizes that a file states, whether it has them or not
        refuse_size(file, "", "does not fit into memory", "write the file again, or cut it")
    except Exception as error:
        reason = (str(error).splitlines() or [type(error).__name__])[0].rstrip(".")
        refuse(file, "", f"is no {what}: {reason}", "write the file again")


def required_module(name: str, package: str, extra: str) -> Any:
    """Return a module of an extra, or raise `NotFoundError` that names the extra."""
    import importlib

    try:
        return importlib.import_module(name)
    except ImportError:
        raise missing(package, extra) from None


def number(text: object, file: str, place: str, low: float, high: float) -> float:
    """Return a number as files write it, within a range; not inf, nan or with underscores."""
    word = str(text if text is not None else "").strip()
    try:
        value = float(word) if len(word) <= 64 and "_" not in word else math.nan
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        refuse(file, place, f"is {word[:40]!r}, not a number", "give a finite number")
    if not low <= value <= high:
        refuse(file, place, f"is {value:g}", f"give a number from {low:g} to {high:g}")
    return value


def checked_choices(
    ego: object, time_s: object, horizon_s: object
) -> tuple[str | None, float | None, float]:
    """Return what every reader takes: name of the ego, moment of decision and horizon, s."""
    if isinstance(ego, bool) or not isinstance(ego, (str, int, type(None))):
        raise choice_error(
            "", "ego", f"is a {type(ego).__name__}", "give its name or number in the file"
        )
    horizon = as_number(horizon_s, "horizon_s", "seconds")
    if not 0.1 <= horizon <= MAX_HORIZON_S:
        raise choice_error(
            "", "horizon_s", f"is {horizon:g}", f"give 0.1 to {MAX_HORIZON_S:g} seconds"
        )
    return (
        None if ego is None else str(ego),
        None if time_s is None else as_number(time_s, "time_s", "seconds"),
        horizon,
    )
