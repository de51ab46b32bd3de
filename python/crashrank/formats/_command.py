"""``python -m crashrank import FORMAT FILE -o SCENARIO.json``."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from typing import Any

from .._errors import Error, NotFoundError, printable
from ._bag import read_bag
from ._commonroad import read_commonroad
from ._document import Imported
from ._openscenario import read_openscenario
from ._osi import read_osi
from ._tables import read_esmini_csv, read_poses_csv

EXIT_CODES = {"usage": 2, "internal": 1, "out_of_memory": 4, "out_of_budget": 4}


def _commonroad(path: str, **options: Any) -> Imported:
    return read_commonroad(path, **options)


READERS: dict[str, Callable[..., Imported]] = {
    "commonroad": _commonroad,
    "openscenario": read_openscenario,
    "osi": read_osi,
    "esmini-csv": read_esmini_csv,
    "poses-csv": read_poses_csv,
    "ros-bag": read_bag,
}

_DESCRIPTION = "Converts a scene of another tool to a scenario file, and prints what was assumed."

_EPILOG = """formats: commonroad (XML 2018b, 2020a), openscenario (followed trajectories), osi
(ground truth, .osi or .mcap), esmini-csv (its log), poses-csv (columns t_s, id, x_m, y_m, yaw_deg
and others), ros-bag (predicted objects of Autoware). Packages: pip install 'crashrank[formats]' for
the first two, [osi] and [ros] for theirs. Exit codes: 0 done, 1 it cannot be written, 2 usage,
3 bad input, 4 the memory ended it."""


def main(words: list[str]) -> int:
    """Run the command with the words behind ``import``; return its exit code."""
    options = _parser().parse_args(words)
    reader = READERS.get(options.format)
    if reader is None:
        known = ", ".join(READERS)
        return _fail(f"there is no reader of {options.format!r}; choose {known}", 2)
    try:
        found = reader(
            options.file, time_s=options.time, ego=options.ego, horizon_s=options.horizon
        )
    except Error as error:
        return _fail(str(error), EXIT_CODES.get(error.code, 3))
    except MemoryError:
        return _fail(f"{options.file}: does not fit into memory; cut out what matters", 4)
    try:
        _write(found, options.output)
    except OSError as error:
        missing = NotFoundError(
            "not_found", options.output, "", f"cannot be written: {error.strerror}", "name another"
        )
        return _fail(str(missing), 1)
    if options.json:
        print(json.dumps(found.report.to_dict(), ensure_ascii=False), file=sys.stderr)
    elif not options.quiet:
        for line in found.report.lines():
            print(f"crashrank: {printable(line)}", file=sys.stderr)
    return 0


def _write(found: Imported, output: str) -> None:
    if output == "-":
        json.dump(found.scenario, sys.stdout, indent=1)
        print(flush=True)
    else:
        found.save(output)


def _fail(text: str, code: int) -> int:
    print(f"crashrank: {printable(text)}", file=sys.stderr)
    return code


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        "crashrank import", description=_DESCRIPTION, epilog=_EPILOG, allow_abbrev=False
    )
    add = parser.add_argument
    add("format", metavar="FORMAT", help=", ".join(READERS))
    add("file", metavar="FILE", help="what is read")
    add("-o", "--output", required=True, metavar="SCENARIO.json", help="- for standard output")
    add("--ego", metavar="ID", help="what decides, as the file names it")
    add("--time", type=float, metavar="T", help="moment of decision, seconds on the file's clock")
    add("--horizon", type=float, default=4.0, metavar="S", help="seconds that count; default: 4")
    add("--json", action="store_true", help="print the report as JSON, on standard error")
    add("--quiet", action="store_true", help="print no report")
    return parser
