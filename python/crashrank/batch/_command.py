"""The console script ``crashrank-batch``."""

from __future__ import annotations

import argparse
import json
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import NoReturn

from .. import _core
from .._checks import as_path
from .._errors import Error, NotFoundError, printable, usage
from ._arrow import arrow
from ._engine import Engine, Sequential
from ._hashes import MISSING, file_hash
from ._local import Local
from ._parts import not_written
from ._ray import Ray
from ._run import REPORTS, SUMMARY, Outcome, Run, failed, locked, read_state
from ._settings import make_settings
from ._sources import Inputs, default_rows_per_part
from ._worker import Job, make_job

INTERRUPTED = 4
EXIT_CODES = {
    "usage": 2,
    "bad_input": 3,
    "not_found": 3,
    "limit_exceeded": 3,
    "out_of_budget": 4,
    "out_of_memory": 4,
    "internal": 1,
}
MOST_WORKERS = 100_000
MOST_ROWS = 1_000_000

_DESCRIPTION = """Ranks many scenarios and writes parquet parts. The same command continues a run
that was ended, and makes anew what has changed: a scenario, a model, an option or the version."""

_EPILOG = """exit codes: 0 done, rows with an error included; 1 internal failure or a folder that
cannot be written; 2 usage; 3 bad input, or no row could be ranked; 4 Ctrl-C or memory ended it.
What is done stays."""


def main(words: list[str] | None = None) -> int:
    """Run the program; return its exit code."""
    options = _parser().parse_args(words)
    signal.signal(signal.SIGTERM, _interrupt)
    if sys.stderr is None:  # closed by whoever started the program
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
    run: Run | None = None
    try:
        arrow()
        folder = Path(as_path(options.output, "-o"))
        inputs = Inputs(options.input, options.output)
        with locked(folder):
            job = _job(options)
            rows = options.rows_per_part or _rows_per_part(folder, inputs.rows)
            run = Run(inputs, job, _engine(options, job), rows, options.reports)
            outcome = run.run()
    except OSError as error:
        return _tell(not_written(error.filename2 or error.filename or folder, error), run)
    except Error as error:
        return _tell(error, run)
    except KeyboardInterrupt:
        _ignore_interrupts()
        print("crashrank-batch: interrupted", file=sys.stderr)
        return INTERRUPTED
    try:
        return _end(options, run, outcome)
    except OSError as error:
        if not isinstance(error, BrokenPipeError):  # else whoever read it has ended
            _tell(not_written("standard output", error), run)
        # What Python still holds of it goes nowhere.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1


def _tell(error: Error, run: Run | None) -> int:
    """Print an error that ends the run; return the exit code."""
    told = failed(error, run.outcome) if run and error.code == "internal" else error
    print(f"crashrank-batch: {printable(str(told))}", file=sys.stderr)
    return EXIT_CODES.get(error.code, 1)


def _ignore_interrupts() -> None:
    """Let no second Ctrl-C change the exit code of the first."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)


def _interrupt(_number: int, _frame: FrameType | None) -> NoReturn:
    raise KeyboardInterrupt


def _end(options: argparse.Namespace, run: Run, outcome: Outcome) -> int:
    """Print what the run came to; return the exit code."""
    folder = Path(options.output)
    summary = printable(str(folder / SUMMARY))
    if outcome.interrupted:
        _ignore_interrupts()
        print(
            f"crashrank-batch: interrupted; {outcome.done_rows} of {outcome.rows} scenes are done, "
            "the same command continues",
            file=sys.stderr,
        )
    if outcome.errors:
        print(
            f"crashrank-batch: {outcome.errors} scenes have an error, see {summary}",
            file=sys.stderr,
        )
    if options.json:
        print(json.dumps(outcome.to_dict(), ensure_ascii=False), flush=True)
    else:
        ranked = outcome.done_rows - outcome.found_rows
        print(
            f"{outcome.done_rows} of {outcome.rows} scenes in {outcome.parts} parts, "
            f"{outcome.errors} with an error; {ranked} ranked in {outcome.seconds:.1f} s, "
            f"{run.progress.rate:.3g} a second\n"
            f"results {outcome.results.hex}\n{summary}",
            flush=True,
        )
    if outcome.interrupted:
        return INTERRUPTED
    return 3 if outcome.errors == outcome.rows else 0


def _job(options: argparse.Namespace) -> Job:
    settings = make_settings(
        options.measure,
        options.risk,
        options.infeasible,
        os.path.abspath(options.profile) if options.profile else None,
        options.futures,
        options.work_budget,
        [os.path.abspath(folder) for folder in options.allow],
    )
    models: list[tuple[str, str]] = []
    for text in options.model:
        name, _, path = text.partition("=")
        if not name or not path:
            raise usage("--model", f"is {text!r}", "write NAME=FILE")
        if file_hash(path) == MISSING:
            raise NotFoundError("not_found", path, "--model", "is not there", "check the path")
        if name in dict(models):
            raise usage("--model", f"names {name!r} twice", "name each model once")
        models.append((name, os.path.abspath(path)))
    folder = os.path.abspath(options.output)
    return make_job(folder, settings, tuple(models), options.retry)


def _rows_per_part(folder: Path, rows: int) -> int:
    """Return the number of the folder's last run, so that its parts stay; else the default."""
    stated = read_state(folder).get("rows_per_part")
    if isinstance(stated, int) and 1 <= stated <= MOST_ROWS:
        return stated
    return default_rows_per_part(rows)


def _engine(options: argparse.Namespace, job: Job) -> Engine:
    if options.address and options.engine != "ray":
        raise usage("--address", "is for --engine ray", "leave it out")
    if options.sequential:
        return Sequential(job)
    if options.engine == "ray":
        return Ray(job, options.workers, options.address)
    return Local(job, options.workers or len(os.sched_getaffinity(0)))


def _count(highest: int, lowest: int = 1) -> Callable[[str], int]:
    def read(text: str) -> int:
        value = int(text)
        if not lowest <= value <= highest:
            raise argparse.ArgumentTypeError(f"{text} is not from {lowest} to {highest}")
        return value

    read.__name__ = "integer"
    return read


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        "crashrank-batch", description=_DESCRIPTION, epilog=_EPILOG, allow_abbrev=False
    )
    add = parser.add_argument
    add("input", nargs="+", metavar="INPUT", help="folder, scenario in JSON, or parquet")
    add("-o", "--output", required=True, metavar="FOLDER", help="where the parts are written")
    add("--engine", choices=("local", "ray"), default="local", help="default: local")
    add("--address", help="of a Ray cluster; default: Ray is started on this machine")
    add("--workers", type=_count(MOST_WORKERS), metavar="N", help="default: one a processor")
    add("--rows-per-part", type=_count(MOST_ROWS), metavar="N", help="default: 1 to 256")
    add("--sequential", action="store_true", help="rank in this process, for debugging")
    add("--measure", help="default: the scenario's")
    add("--risk", help="default: the scenario's")
    add("--infeasible", choices=("demote", "drop", "keep"), default="demote")
    add("--profile", metavar="FILE", help="weights and ranges over those of the scenarios")
    add("--futures", type=_count(_core.max_sampled_futures), default=64, metavar="N")
    add("--work-budget", type=_count(2**64 - 1, 0), metavar="N", help="tests for each scenario")
    add("--model", action="append", default=[], metavar="NAME=FILE", help="for every scenario")
    add("--allow", action="append", default=[], metavar="FOLDER", help="meshes may lie there, too")
    add("--retry", action="store_true", help="rank again what the machine failed at")
    add(
        "--reports",
        type=_count(1000, 0),
        default=10,
        metavar="N",
        help=f"of the worst scenes, in {REPORTS}; default: 10",
    )
    add("--json", action="store_true", help="print the outcome as JSON")
    add("--version", action="version", version=f"crashrank-batch {_core.version}")
    return parser


if __name__ == "__main__":
    sys.exit(main())
