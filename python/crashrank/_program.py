"""The console script ``crashrank``: the program of the wheel, and ``crashrank import``."""

from __future__ import annotations

import os
import sys
from pathlib import Path

_IMPORT_HELP = """usage: crashrank import FORMAT FILE -o SCENARIO.json

Converts scenarios of other tools to scenario files. This version has no reader.
"""


def program_path() -> Path:
    """Return where the program of this package is, or that CRASHRANK_PROGRAM names."""
    named = os.environ.get("CRASHRANK_PROGRAM", "")
    return Path(named) if named else Path(__file__).parent / "crashrank"


def main() -> int:
    """Run a subcommand: `import` here, all others by the program, in place of this process."""
    words = sys.argv[1:]
    if words[:1] == ["import"]:
        return _import(words[1:])
    program = program_path()
    try:
        os.execv(program, ["crashrank", *words])
    except OSError as error:
        print(f"crashrank: {program} cannot be run: {error.strerror}", file=sys.stderr)
        return 1


def _import(words: list[str]) -> int:
    if words[:1] in (["--help"], ["-h"]):
        print(_IMPORT_HELP, end="")
        return 0
    if not words:
        print("crashrank: no format is given; see crashrank import --help", file=sys.stderr)
    else:
        print(
            f"crashrank: there is no reader of {words[0]!r}: this version has none",
            file=sys.stderr,
        )
    return 2
