"""The console script ``crashrank``: the program of the wheel, ``import`` and ``benchmark``."""

from __future__ import annotations

import os
import sys
from pathlib import Path


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
        os.execv(program, ["crashrank", *words])
    except OSError as error:
        print(f"crashrank: {program} cannot be run: {error.strerror}", file=sys.stderr)
        return 1
