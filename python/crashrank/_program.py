"""The console script ``crashrank``: the program of the wheel, ``import`` and ``benchmark``."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from ._errors import Error, usage


def program_path() -> Path:
    """Return where the program of this package is, or that CRASHRANK_PROGRAM names."""
    named = os.environ.get("CRASHRANK_PROGRAM", "")
    return Path(named) if named else Path(__file__).parent / "crashrank"


def main() -> int:
    """Run a subcommand: two here, all others by the program, in place of this process."""
    words = sys.argv[1:]
    if words[:1] == ["import"]:
        from .formats._command import main as run_import

        return run_import(words[1:])
    if words[:1] == ["benchmark"]:
        from .benchmark._command import main as run_benchmark

        return run_benchmark(words[1:])
    program = program_path()
    try:
        if words[:1] == ["rank"] and any(_is_option(each, "--mcap") for each in words):
            return _rank_to_mcap(program, words)
        os.execv(program, ["crashrank", *words])
    except Error as error:
        print(f"crashrank: {error}", file=sys.stderr)
        return 2 if error.code == "usage" else 3
    except OSError as error:
        print(f"crashrank: {program} cannot be run: {error.strerror}", file=sys.stderr)
        return 1


def _is_option(word: str, name: str) -> bool:
    return word == name or word.startswith(name + "=")


def _take(words: list[str], name: str) -> tuple[list[str], list[str]]:
    """Return the values of an option, and the words without it."""
    values, rest, left = [], [], iter(words)
    for word in left:
        if _is_option(word, name):
            values.append(word.partition("=")[2] if "=" in word else next(left, ""))
        else:
            rest.append(word)
    return values, rest


def _rank_to_mcap(program: Path, words: list[str]) -> int:
    """Rank by the program, and write the scene of its report as MCAP; return the exit code."""
    from ._mcap import check_packages, write_mcap

    files, words = _take(words, "--mcap")
    if len(files) > 1 or files[0] in ("", "-"):
        raise usage("--mcap", "does not name one file", "give --mcap OUT.mcap")
    check_packages()
    reports, rest = _take(words, "--report")
    if "-" in reports:
        raise usage("--mcap", "needs the report in a file", "give --report a file, or leave it out")
    with tempfile.TemporaryDirectory() as folder:
        page = Path(reports[0] if reports else os.path.join(folder, "report.html"))
        if not reports:
            words = [*rest, f"--report={page}"]
        before = page.stat().st_mtime_ns if page.exists() else None
        code = _run([str(program), *words])
        if page.exists() and page.stat().st_mtime_ns != before:
            write_mcap(page.read_text(encoding="utf-8"), files[0])
    return code


def _run(words: list[str]) -> int:
    """Return the exit code of a program; Ctrl-C ends that program, and this waits for it."""
    with subprocess.Popen(words) as process:
        while True:
            try:
                return process.wait()
            except KeyboardInterrupt:
                continue
