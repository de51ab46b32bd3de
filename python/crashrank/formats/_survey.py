"""A table of the files in a folder: read or refused and why, what the ego hits, least harm."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Iterator
from typing import Any

from .. import _core
from .._checks import as_path
from .._errors import Error, NotFoundError
from .._ranking import rank
from ._decision import first_contact
from ._readers import format_of, reader_of

DEADLINE_S = 1.0
COLUMNS = (
    "file", "format", "read", "reason", "ego", "time_s", "bodies", "areas", "warnings", "hits",
    "contact_time_s", "least_harm_persons", "proved",
)  # fmt: skip


def survey(folder: object, *, horizon_s: float = 10.0) -> Iterator[dict[str, Any]]:
    """Return a row with `COLUMNS` for each file below a folder whose format is known.

    ``hits`` is the actor that the ego hits if it goes on within `horizon_s`, at
    ``contact_time_s`` on the file's clock; empty without a contact. ``least_harm_persons`` is that
    of the first of the standard grid; an upper bound where `DEADLINE_S` leaves it not ``proved``.
    """
    workers = min(os.cpu_count() or 1, _core.max_workers)
    for path in _files(as_path(folder, "folder")):
        row: dict[str, Any] = {"file": path, "format": format_of(path), "read": False}
        try:
            found = reader_of(path)(path, horizon_s=horizon_s)
            contact = first_contact(found)
            ranking = rank(
                found.scenario, measure="harm", first_place_only=True, deadline_s=DEADLINE_S,
                workers=workers,
            )  # fmt: skip
        except Error as error:
            yield {**row, "reason": str(error).removeprefix(f"{path}: ")}
            continue
        report = found.report
        row.update(read=True, ego=report.ego, time_s=report.time_s, bodies=report.bodies)
        row.update(areas=report.areas, warnings=len(report.warnings))
        first = ranking.best
        least = first.score_interval[1] if first.score is None else first.score
        row.update(least_harm_persons=float(f"{least:.3g}"), proved=ranking.proved)
        if contact is not None:
            row.update(hits=contact[1], contact_time_s=round(contact[0], 3))
        yield row


def survey_table(folder: object, *, horizon_s: float = 10.0) -> str:
    """Return the table of `survey` as CSV text."""
    text = io.StringIO()
    table = csv.DictWriter(text, COLUMNS, restval="", lineterminator="\n")
    table.writeheader()
    table.writerows(survey(folder, horizon_s=horizon_s))
    return text.getvalue()


def _files(folder: str) -> Iterator[str]:
    """Return the files and bags of other tools below a folder, sorted."""
    if not os.path.isdir(folder):
        raise NotFoundError("not_found", folder, "", "is no folder", "name a folder")
    for at, folders, files in os.walk(folder):
        folders.sort()
        if format_of(at):
            folders.clear()
            yield at
            continue
        for name in sorted(files):
            path = os.path.join(at, name)
            if format_of(path) not in (None, "crashrank"):
                yield path
