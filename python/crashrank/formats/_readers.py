"""The readers by the names of their formats, and which of them a file is for."""

from __future__ import annotations

import os
from collections.abc import Callable

from ._advance import read_scenario
from ._bag import read_bag
from ._commonroad import read_commonroad
from ._document import Imported
from ._openscenario import read_openscenario
from ._osi import read_osi
from ._refusals import choice_error
from ._tables import read_esmini_csv, read_poses_csv

READERS: dict[str, Callable[..., Imported]] = {
    "commonroad": read_commonroad,
    "openscenario": read_openscenario,
    "osi": read_osi,
    "esmini-csv": read_esmini_csv,
    "poses-csv": read_poses_csv,
    "ros-bag": read_bag,
    "crashrank": read_scenario,
}
_BY_ENDING = {
    ".xml": "commonroad", ".xosc": "openscenario", ".osi": "osi", ".mcap": "osi",
    ".json": "crashrank",
}  # fmt: skip


def format_of(path: str) -> str | None:
    """Return the format that a file's ending or first bytes show; None for other files."""
    if os.path.isfile(os.path.join(path, "metadata.yaml")):
        return "ros-bag"
    ending = os.path.splitext(path)[1].lower()
    if ending != ".csv":
        return _BY_ENDING.get(ending)
    try:
        with open(path, "rb") as file:
            return "esmini-csv" if b"TimeStamp [s]" in file.read(65_536) else "poses-csv"
    except OSError:
        return "poses-csv"  # whose reader says why it cannot be read


def reader_of(path: str, name: str | None = None, *others: str) -> Callable[..., Imported]:
    """Return the reader of a format, or the one for a file.

    Raises `UsageError` without one, which names the formats and `others` that can be chosen.
    """
    chosen = format_of(path) if name is None else name
    if chosen in READERS:
        return READERS[chosen]
    what = "its format is not known" if name is None else f"there is no reader of {name!r}"
    remedy = f"choose {', '.join([*READERS, *others])}"
    raise choice_error(path if name is None else "", "format", what, remedy)
