"""Scenarios of commonroad-io as the text that `read_commonroad` takes; needs commonroad-io 2024."""

from __future__ import annotations

import contextlib
import io
import tempfile
from pathlib import Path
from typing import Any

from ._commonroad import read_commonroad
from ._document import Imported

_FILE = "scenario.xml"


def as_xml(scenario: Any) -> str:
    """Return a scenario of commonroad-io as the text of a file, without planning problems."""
    from commonroad.common.file_writer import CommonRoadFileWriter, OverwriteExistingFile
    from commonroad.planning.planning_problem import PlanningProblemSet

    # A scenario that was built in memory may have no names, which the writer asks for. More digits
    # than crashrank reads: it rounds to a tenth of a millimetre.
    writer = CommonRoadFileWriter(
        scenario, PlanningProblemSet(), author=scenario.author or "",
        affiliation=scenario.affiliation or "", source=scenario.source or "",
        tags=scenario.tags or set(), decimal_precision=9,
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / _FILE
        # The writer prints what it replaces.
        with contextlib.redirect_stdout(io.StringIO()):
            writer.write_scenario_to_file(str(file), OverwriteExistingFile.ALWAYS)
        return file.read_text(encoding="utf-8")


def read_text(text: str, time_step: int, ego: int, horizon_s: float) -> Imported:
    """Read what `as_xml` returned at a time step, with that obstacle as the ego."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / _FILE
        file.write_text(text, encoding="utf-8")
        return read_commonroad(file, time_step, ego, horizon_s=horizon_s)
