"""Checks of arguments: what passes here is what the extension module expects."""

from __future__ import annotations

import math
import numbers
import os
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._errors import Error, OutOfMemoryError, bad_input, make_error, usage, wrong_type

MAX_POSES = 10_000_000
MAX_VERTICES = 60_000_000
MAX_FACES = 20_000_000


def as_path(value: object, name: str) -> str:
    """Return a path as text. Bytes and path objects are accepted."""
    try:
        path = os.fsdecode(os.fspath(value))  # type: ignore[call-overload]
        path.encode()
    except TypeError:
        raise wrong_type(name, f"is a {type(value).__name__}, not a path", "give a path") from None
    except UnicodeError:
        raise usage(name, "is a path that is not UTF-8", "rename the file") from None
    if "\0" in path or not path:
        raise usage(name, "is empty or holds a null character", "give the path of a file")
    return str(path)


def as_text(value: object, name: str) -> str:
    """Return a text that can be encoded."""
    if not isinstance(value, str):
        raise wrong_type(name, f"is a {type(value).__name__}, not a string", "give a string")
    try:
        value.encode()
    except UnicodeError:
        raise usage(
            name, "holds half of a character pair", "give text that UTF-8 can hold"
        ) from None
    return str(value)


def as_number(value: object, name: str, unit: str = "") -> float:
    """Return a finite number; a numpy scalar is one, a bool is none."""
    return _finite(as_real(value, name), name, unit)


def as_real(value: object, name: str) -> float:
    """Return a number that may be infinite, but not NaN."""
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, numbers.Real):
        raise wrong_type(name, f"is a {type(value).__name__}, not a number", "give a number")
    try:
        number = float(value)
    except (OverflowError, ValueError):
        raise usage(name, "is beyond a double", "give a number below 1.8e308") from None
    if math.isnan(number):
        raise usage(name, "is not a number", "give a number")
    return number


def _finite(number: float, name: str, unit: str) -> float:
    if not math.isfinite(number):
        raise usage(name, "is not finite", f"give a number{' of ' + unit if unit else ''}")
    return number


def as_count(value: object, name: str, lowest: int, highest: int) -> int:
    """Return an integer in a range."""
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, numbers.Integral):
        raise wrong_type(name, f"is a {type(value).__name__}, not an integer", "give an integer")
    number = int(value)
    if not lowest <= number <= highest:
        raise usage(name, f"is {number}", f"give an integer from {lowest} to {highest}")
    return number


def as_flag(value: object, name: str) -> bool:
    """Return a bool."""
    if not isinstance(value, (bool, np.bool_)):
        raise wrong_type(name, f"is a {type(value).__name__}, not a bool", "give True or False")
    return bool(value)


def as_triple(value: object, name: str) -> tuple[float, float, float]:
    """Return three finite numbers."""
    array = as_floats(value, name)
    if array.shape != (3,):
        raise usage(name, f"has the shape {array.shape}", "give three numbers")
    if not bool(np.isfinite(array).all()):
        raise usage(name, "holds a number that is not finite", "give finite numbers")
    return float(array[0]), float(array[1]), float(array[2])


def guarded_array(make: Callable[[], NDArray[Any]], name: str) -> NDArray[Any]:
    """Return the array that `make` returns; what a stranger's object raises becomes an error."""
    try:
        return make()
    except Error:
        raise
    except MemoryError:
        raise OutOfMemoryError(
            "out_of_memory", "", name, "does not fit into memory", "split it"
        ) from None
    except Exception as error:
        raise wrong_type(name, f"cannot be read as an array: {error}", "give an array") from error


def as_array(value: object, name: str, kinds: str, what: str) -> NDArray[Any]:
    """Return a plain numpy array of one of these kinds of numbers; copies nothing it need not."""
    if np.ma.is_masked(value):
        raise usage(name, "has masked values", "fill or leave them out")
    array = guarded_array(lambda: np.asarray(value), name)
    if array.dtype.kind not in kinds or array.dtype.hasobject:
        raise wrong_type(name, f"is an array of {array.dtype}", f"give an array of {what}")
    return array


def as_floats(value: object, name: str) -> NDArray[np.float64]:
    """Return an array of float64; integers are converted."""
    array = as_array(value, name, "fiu", "numbers")
    with np.errstate(over="ignore"):
        return guarded_array(lambda: np.asarray(array, dtype=np.float64), name)


def contiguous(array: NDArray[Any], dtype: type[np.generic], name: str) -> NDArray[Any]:
    """Return the array in C order and native byte order, copied only where it is not."""
    with np.errstate(over="ignore"):
        return guarded_array(lambda: np.ascontiguousarray(array, dtype=dtype), name)


def check_size(size: int, limit: int, name: str, what: str) -> None:
    """Refuse more than a limit before anything of that size is allocated."""
    if size > limit:
        raise make_error(
            "limit_exceeded", "", name, f"has {size} {what}, at most {limit} are read", "split it"
        )


def as_poses(value: object, name: str = "poses") -> NDArray[np.float64]:
    """Return poses as a contiguous (N, 4, 4) array of float64."""
    array = as_array(value, name, "fiu", "numbers")
    if array.ndim != 3 or array.shape[1:] != (4, 4):
        raise bad_input(name, f"has the shape {array.shape}", "give an array of shape (N, 4, 4)")
    check_size(array.shape[0], MAX_POSES, name, "poses")
    return contiguous(array, np.float64, name)


def as_pose(value: object, name: str = "pose") -> NDArray[np.float64]:
    """Return one pose as a contiguous (4, 4) array of float64."""
    array = as_array(value, name, "fiu", "numbers")
    if array.shape != (4, 4):
        raise bad_input(name, f"has the shape {array.shape}", "give an array of shape (4, 4)")
    return contiguous(array, np.float64, name)
