"""Exceptions of the package: one class for each kind of error of the library."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")

# Where the library knows nothing more particular.
_REMEDIES = {
    "usage": "see the function's help for what it takes",
    "bad_input": "correct the input there",
    "not_found": "check the path and its permissions",
    "limit_exceeded": "give less, or split it",
    "out_of_budget": "allow more time or work",
    "out_of_memory": "free memory or give less; nothing was kept, and the call may be repeated",
    "internal": "report it with the call, its input and crashrank.__version__",
}


class Error(Exception):
    """Base class of all errors that crashrank raises.

    Attributes
    ----------
    code : str
        Kind of error: ``usage``, ``bad_input``, ``not_found``, ``limit_exceeded``,
        ``out_of_budget``, ``out_of_memory`` or ``internal``.
    file : str
        File concerned; empty where there is none.
    place : str
        Element, line, key path or argument; empty where the whole is meant.
    reason : str
        What is wrong.
    remedy : str
        What to do about it.
    """

    def __init__(
        self, code: str, file: str = "", place: str = "", reason: str = "", remedy: str = ""
    ) -> None:
        remedy = remedy or _REMEDIES.get(code, _REMEDIES["internal"])
        super().__init__(code, file, place, reason, remedy)
        self.code = code
        self.file = file
        self.place = place
        self.reason = reason
        self.remedy = remedy

    def __str__(self) -> str:
        """Return "FILE: PLACE: REASON; REMEDY", absent members left out."""
        head = "".join(part + ": " for part in (self.file, self.place) if part)
        return f"{head}{self.reason}; {self.remedy}"


class UsageError(Error, ValueError):
    """The call has no meaning (code ``usage``)."""


class ArgumentTypeError(UsageError, TypeError):
    """An argument has the wrong type, or the call does not fit the signature (``usage``)."""


class BadInputError(Error, ValueError):
    """A file, mesh, array, scenario or pose is not acceptable (code ``bad_input``)."""


class NotFoundError(Error, LookupError):
    """A file or program is missing or cannot be read (code ``not_found``)."""


class LimitError(Error, ValueError):
    """Input is larger than a stated limit (code ``limit_exceeded``)."""


class BudgetError(Error, TimeoutError):
    """A deadline or a budget ended the work (code ``out_of_budget``)."""


class OutOfMemoryError(Error, MemoryError):
    """An allocation failed; nothing was kept (code ``out_of_memory``)."""


class InternalError(Error, RuntimeError):
    """A failure of the library or the machine (code ``internal``)."""


_CLASSES: dict[str, type[Error]] = {
    "usage": UsageError,
    "bad_input": BadInputError,
    "not_found": NotFoundError,
    "limit_exceeded": LimitError,
    "out_of_budget": BudgetError,
    "out_of_memory": OutOfMemoryError,
}


def make_error(code: str, file: str, place: str, reason: str, remedy: str) -> Error:
    """Return the exception for an error of the library; the extension module calls this."""
    return _CLASSES.get(code, InternalError)(code, file, place, reason, remedy)


def usage(place: str, reason: str, remedy: str) -> UsageError:
    """Return the error for an argument of that name whose value has no meaning."""
    return UsageError("usage", "", place, reason, remedy)


def wrong_type(place: str, reason: str, remedy: str) -> ArgumentTypeError:
    """Return the error for an argument of that name that has the wrong type."""
    return ArgumentTypeError("usage", "", place, reason, remedy)


def bad_input(place: str, reason: str, remedy: str) -> BadInputError:
    """Return the error for input that is not acceptable."""
    return BadInputError("bad_input", "", place, reason, remedy)


def printable(text: str) -> str:
    """Return a text on one line that every stream takes: what cannot be printed is escaped."""
    return "".join(
        each if each.isprintable() else each.encode("unicode_escape").decode() for each in text
    )


def no_candidate(name: str) -> UsageError:
    """Return the error for the name of a candidate that a ranking does not have."""
    return usage(
        "candidate", f"there is no candidate {name!r}", "see the members `candidate` of the ranking"
    )


def checked_call(function: Callable[P, R]) -> Callable[P, R]:
    """Make calls that do not fit the signature raise `ArgumentTypeError`.

    Python raises a plain TypeError for them before the function begins: its traceback then has
    no frame of the function.
    """

    @functools.wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> R:
        try:
            return function(*args, **kwargs)
        except TypeError as error:
            trace = error.__traceback__
            if isinstance(error, Error) or trace is None or trace.tb_next is not None:
                raise
            name = function.__qualname__.removesuffix(".__init__")
            raise wrong_type("", str(error), f"see help(crashrank.{name})") from None

    return call
