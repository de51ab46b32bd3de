"""``crashrank benchmark``: score a chooser of manoeuvres on scenes in which a crash is certain."""

from __future__ import annotations

import argparse
import sys

from .._errors import Error, NotFoundError, printable
from ..batch._command import EXIT_CODES, INTERRUPTED
from ..batch._progress import Progress
from ._data import Benchmark, load, written
from ._rank import differences, models_folder
from ._score import chooser_of, rows_csv, score_with, stored_rows, table

_DESCRIPTION = """Scores a function that chooses a manoeuvre on the stored scenes, in all of which
every manoeuvre ends in a crash, and prints it beside simple choosers. Regret is harm, persons,
above that of the scene's least harmful candidate; a choice may be best where it is first in a
sample of what is not known. Nothing is ranked: the answers are stored."""

_EPILOG = """FUNCTION takes a scene, a dict with the keys of a scenario file, and returns the name
or the index of one of scene["candidates"]["listed"]. Exit codes: 0 done, 1 OUT cannot be written,
2 usage, 3 bad input or answers that differ, 4 Ctrl-C."""

_LISTED = 20  # differences that are printed


def main(words: list[str]) -> int:
    """Run the command with the words behind ``benchmark``; return its exit code."""
    try:
        return _run(words)
    except Error as error:
        print(f"crashrank: {printable(str(error))}", file=sys.stderr)
        return EXIT_CODES.get(error.code, 3)
    except KeyboardInterrupt:
        print("crashrank: interrupted", file=sys.stderr)
        return INTERRUPTED


def _run(words: list[str]) -> int:
    stored = load()
    options = _parser(len(stored.lines)).parse_args(words)
    some = stored.first(options.scenes)
    if options.rank and (code := _compare(some, options.models)):
        return code
    rows = stored_rows(some)
    if options.chooser is not None:
        rows = score_with(some, chooser_of(options.chooser), options.chooser) + rows
    if options.output is not None:
        try:
            with open(options.output, "w", encoding="utf-8", newline="") as file:
                file.write(rows_csv(rows))
        except OSError as error:
            reason = f"cannot be written: {error.strerror}"
            raised = NotFoundError("not_found", options.output, "", reason, "name another file")
            print(f"crashrank: {printable(str(raised))}", file=sys.stderr)
            return 1
    print(f"Version {stored.version}, {len(some.lines)} of {len(stored.lines)} scenes, SHA-256 "
          f"{stored.sha256}\nRegret in persons\n{table(rows)}", flush=True)  # fmt: skip
    return 0


def _compare(stored: Benchmark, models: str | None) -> int:
    """Rank anew and print what differs; return the exit code."""
    folder, progress = models_folder(models), Progress(len(stored.lines))
    found = list(differences(stored, folder, lambda: progress.add(1, 0, False)))
    progress.clear()
    count = sum(map(len, stored.answers))
    for was, now in found[:_LISTED]:
        print(
            f"{was.scene}, {was.candidate}: {_words(was)} stored, {_words(now)} now",
            flush=True,
        )
    if not found:
        print(f"{count} answers ranked anew: all as stored", flush=True)
        return 0
    print(
        f"crashrank: {len(found)} of {count} answers differ from the stored; compare versions, or "
        "renew them with data/benchmark/make --answers",
        file=sys.stderr,
    )
    return 3


def _words(answer: tuple[object, ...]) -> str:
    _, _, harm, lowest, highest, best, worst, *_ = answer
    text = "{} ({} to {}), places {} to {}"
    return text.format(*(written(float(str(x))) for x in (harm, lowest, highest)), best, worst)


def _parser(count: int) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        "crashrank benchmark", description=_DESCRIPTION, epilog=_EPILOG, allow_abbrev=False
    )

    def scenes(text: str) -> int:
        value = int(text)
        if not 1 <= value <= count:
            raise argparse.ArgumentTypeError(f"{text} is not from 1 to {count}")
        return value

    scenes.__name__ = "integer"
    add = parser.add_argument
    add("--chooser", metavar="MODULE:FUNCTION", help="default: the stored choosers alone")
    add("--scenes", type=scenes, default=count, metavar="N", help="the first N; default: all")
    add("-o", "--output", metavar="OUT.csv", help="choice, harm and regret of every scene")
    add("--rank", action="store_true", help="rank all anew first and say what differs")
    add("--models", metavar="FOLDER", help="meshes for --rank; default: the checkout's data/models")
    return parser
