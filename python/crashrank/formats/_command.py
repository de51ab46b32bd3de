"""``python -m crashrank import FORMAT FILE -o SCENARIO.json``."""

from __future__ import annotations

import argparse
import json
import os
import sys
from typing import Any

from .. import _core
from .._errors import Error, NotFoundError, printable
from ._decision import find_decision_point
from ._readers import READERS, reader_of
from ._survey import survey_table

EXIT_CODES = {"usage": 2, "internal": 1, "out_of_memory": 4, "out_of_budget": 4}

_DESCRIPTION = """Converts a scene of another tool to a scenario file, and prints what was assumed.
With --decide the moment of decision is the last at which the contact ahead can be avoided. The
format survey writes a table (CSV) of all files in a folder: read or refused, what is hit, and the
least harm that is found within a second."""

_EPILOG = """formats: commonroad (XML 2018b, 2020a), openscenario (followed trajectories), osi
(ground truth, .osi or .mcap), esmini-csv (its log), poses-csv (columns t_s, id, x_m, y_m, yaw_deg
and others), ros-bag (predicted objects of Autoware), crashrank (a scenario, at another
time). Packages: pip install '.[formats]' in the
folder of the source for the first two, [osi] and [ros] for theirs. Exit codes: 0 done, 1 it cannot
be written, 2 usage, 3 bad input, 4 the memory ended it."""


def main(words: list[str]) -> int:
    """Run the command with the words behind ``import``; return its exit code."""
    options = _parser().parse_args(words)
    try:
        text, report, lines = _converted(options)
    except Error as error:
        return _fail(str(error), EXIT_CODES.get(error.code, 3))
    except MemoryError:
        return _fail(f"{options.file}: does not fit into memory; cut out what matters", 4)
    try:
        if options.output == "-":
            sys.stdout.buffer.write(text.encode())
            sys.stdout.flush()
        else:
            with open(options.output, "w", encoding="utf-8") as file:
                file.write(text)
    except OSError as error:
        missing = NotFoundError(
            "not_found", options.output, "", f"cannot be written: {error.strerror}", "name another"
        )
        return _fail(str(missing), 1)
    if options.json:
        print(json.dumps(report, ensure_ascii=False), file=sys.stderr)
    elif not options.quiet:
        for line in lines:
            print(f"crashrank: {printable(line)}", file=sys.stderr)
    return 0


def _converted(options: argparse.Namespace) -> tuple[str, dict[str, Any], list[str]]:
    """Return what is written, and the report as members and as lines."""
    horizon = {} if options.horizon is None else {"horizon_s": options.horizon}
    if options.format == "survey":
        return survey_table(options.file, **horizon), {}, []
    reader = reader_of(options.file, options.format, "survey")
    time_s, curve = options.time, None
    if options.decide:
        curve = find_decision_point(
            options.file, format=options.format, ego=options.ego, time_s=time_s, **horizon,
            step_s=options.step, workers=min(os.cpu_count() or 1, _core.max_workers),
            progress=None if options.quiet or options.json else _show_progress,
        )  # fmt: skip
        time_s = (curve.last_avoidable or curve.steps[0]).time_s
    found = reader(options.file, time_s=time_s, ego=options.ego, **horizon)
    report, lines = found.report.to_dict(), found.report.lines()
    if curve is not None:
        report, lines = {**report, "decision": curve.to_dict()}, lines + curve.lines()
    return found.to_json(), report, lines


def _show_progress(done: int, steps: int) -> None:
    """Say once what is computed; on a terminal count the steps, too."""
    if done == 0:
        print(
            f"crashrank: searching {steps} moments for the least harm; a longer --step makes them "
            "fewer",
            file=sys.stderr,
        )
    if sys.stderr.isatty():
        end = "\n" if done + 1 == steps else ""
        print(f"\r{done + 1} of {steps}", end=end, file=sys.stderr, flush=True)


def _fail(text: str, code: int) -> int:
    print(f"crashrank: {printable(text)}", file=sys.stderr)
    return code


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        "crashrank import", description=_DESCRIPTION, epilog=_EPILOG, allow_abbrev=False
    )
    add = parser.add_argument
    add("format", metavar="FORMAT", help=", ".join([*READERS, "survey"]))
    add("file", metavar="FILE", help="what is read; for survey a folder")
    add("-o", "--output", required=True, metavar="OUT", help="- for standard output")
    add("--ego", metavar="ID", help="what decides, as the file names it")
    add("--time", type=float, metavar="T", help="moment of decision, seconds on the file's clock")
    add(
        "--horizon",
        type=float,
        metavar="S",
        help="seconds that count; default: 4; 10 where a contact is searched for",
    )
    add(
        "--decide",
        action="store_true",
        help="choose the last moment at which the crash can be avoided, without one the first of "
        "the curve, and print the curve of the least harm over time",
    )
    add(
        "--step", type=float, default=0.1, metavar="S",
        help="seconds between the moments of --decide; default: 0.1",
    )  # fmt: skip
    add("--json", action="store_true", help="print the report as JSON, on standard error")
    add("--quiet", action="store_true", help="print no report")
    return parser
