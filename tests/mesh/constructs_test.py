"""Holds what crashrank reads of each construct of each mesh format against a hand count.

    constructs_test.py CRASHRANK                  the test
    constructs_test.py CRASHRANK --compare CSV    the same files through trimesh, open3d and Assimp
                                                  (pyassimp) too, written as a table
    constructs_test.py CRASHRANK --write FOLDER   the files
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from constructs.fbx import fbx_rows
from constructs.gltf import gltf_rows
from constructs.row import Row
from constructs.scenes import collada_rows, rows_3ds, rows_ac3d
from constructs.text import obj_rows, off_rows, ply_rows, stl_rows

ROWS = [*obj_rows(), *stl_rows(), *ply_rows(), *off_rows(), *gltf_rows(), *collada_rows(),
        *fbx_rows(), *rows_3ds(), *rows_ac3d()]
LENGTH_M = 2e-4  # what the coarsest coordinates, 16-bit integers, are rounded by


def difference(row: Row, found: dict[str, Any]) -> str:
    """How a reader's surface differs from the expected one; empty if it does not."""
    if found["triangles"] != row.triangles:
        return f"{found['triangles']} triangles"
    size = max(abs(x) for x in (*row.low, *row.high))
    for key, expected in (("min_m", row.low), ("max_m", row.high)):
        if any(abs(a - b) > LENGTH_M * size for a, b in zip(found[key], expected)):
            return f"{key} " + " ".join(f"{x:.4g}" for x in found[key])
    if abs(found["area_m2"] - row.area) > 2e-3 * row.area:
        return f"{found['area_m2']:.4g} m2"
    return ""


def read_with_crashrank(program: str, file: Path) -> tuple[dict[str, Any] | None, str]:
    """The surface, or nothing, and what is said about it."""
    run = subprocess.run([program, "inspect", "--json", file], capture_output=True, text=True,
                         timeout=60, check=False)
    if run.returncode != 0:
        return None, run.stderr.strip()
    found = json.loads(run.stdout)["files"][0]
    return found, " ".join(found["warnings"])


def fault(row: Row, found: dict[str, Any] | None, words: str) -> str:
    """What is wrong with crashrank's answer."""
    if row.refused:
        refused = found is None and row.refused in words
        return "" if refused else f"expected to be refused with {row.refused!r}: {words or 'read'}"
    if found is None:
        return words
    wrong = difference(row, found)
    if row.listed:
        wrong = "" if wrong == row.listed else f"{wrong or 'nothing'} instead of {row.listed}"
    if not wrong and len(found["parts"]) != row.parts:
        wrong = f"{len(found['parts'])} parts"
    if not wrong and row.warned not in words:
        wrong = f"warned {words!r}"
    return wrong


def main() -> int:
    program = sys.argv[1]
    names = [row.name for row in ROWS]
    assert len(set(names)) == len(names), "two rows have the same file name"
    with tempfile.TemporaryDirectory() as folder:
        if sys.argv[2:3] == ["--write"]:
            folder = sys.argv[3]
        for row in ROWS:
            (Path(folder) / row.name).write_bytes(row.bytes())
        answers = [read_with_crashrank(program, Path(folder) / row.name) for row in ROWS]
        faults = [fault(row, *answer) for row, answer in zip(ROWS, answers)]
        for row, wrong in zip(ROWS, faults):
            if wrong:
                print(f"{row.name}: {row.construct}: {wrong}")
        print(f"{len(ROWS)} files, {sum(map(bool, faults))} differ")
        if sys.argv[2:3] == ["--compare"]:
            from constructs.others import compare

            compare(Path(folder), ROWS, answers, difference, Path(sys.argv[3]), program)
    return 1 if any(faults) else 0


if __name__ == "__main__":
    sys.exit(main())
