"""The same files through other readers: trimesh, open3d and Assimp (pyassimp)."""

from __future__ import annotations

import csv
import importlib.metadata
import json
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from .row import Row

Surface = dict[str, Any]
READERS = {"trimesh": "trimesh", "open3d": "open3d", "assimp": "pyassimp"}


def surface(triangles: Any) -> Surface:
    """Number, bounds and area of triangles, an array of n x 3 x 3."""
    import numpy as np

    t = np.asarray(triangles, float).reshape(-1, 3, 3)
    if not len(t):
        raise ValueError("no triangles")
    area = 0.5 * np.linalg.norm(np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]), axis=1).sum()
    return {"triangles": len(t), "area_m2": float(area), "min_m": t.min((0, 1)).tolist(),
            "max_m": t.max((0, 1)).tolist()}


def with_trimesh(file: str) -> Surface:
    import trimesh

    loaded = trimesh.load_scene(file, process=False)
    # trimesh keeps a file's unit beside its coordinates.
    return surface(loaded.to_mesh().triangles * (
        trimesh.units.unit_conversion(loaded.units, "m") if loaded.units else 1.0))


def with_open3d(file: str) -> Surface:
    import numpy as np
    import open3d

    mesh = open3d.io.read_triangle_mesh(file)
    return surface(np.asarray(mesh.vertices)[np.asarray(mesh.triangles)])


def with_assimp(file: str) -> Surface:
    import numpy as np
    import pyassimp
    from pyassimp import postprocess

    steps = (postprocess.aiProcess_Triangulate | postprocess.aiProcess_SortByPType
             | postprocess.aiProcess_PreTransformVertices)
    with pyassimp.load(file, processing=steps) as scene:
        return surface(np.concatenate([
            np.asarray(mesh.vertices)[[face for face in mesh.faces if len(face) == 3]]
            for mesh in scene.meshes if any(len(face) == 3 for face in mesh.faces)]))


def read_all(reader: str, files: Sequence[str]) -> dict[str, Surface | str]:
    """What a reader makes of each file, in processes of its own: it may end itself."""
    answers: dict[str, Surface | str] = {}
    if version(READERS[reader]) == "absent":
        return dict.fromkeys(files, "not installed")
    while len(answers) < len(files):
        rest = files[len(answers):]
        run = subprocess.run([sys.executable, "-m", "constructs.others", reader, *rest],
                             cwd=Path(__file__).parent.parent, capture_output=True, text=True,
                             timeout=600, check=False)
        for line in run.stdout.splitlines():
            if line.startswith('{"file"'):
                found = json.loads(line)
                answers[found.pop("file")] = found.get("error") or found
        if run.returncode != 0:
            answers[files[len(answers)]] = "ends the process"
    return answers


def version(module: str) -> str:
    try:
        return importlib.metadata.version(module)
    except importlib.metadata.PackageNotFoundError:
        return "absent"


def compare(folder: Path, rows: Sequence[Row], answers: Sequence[tuple[Surface | None, str]],
            difference: Callable[[Row, Surface], str], table: Path, program: str) -> None:
    """Writes a row for each file: expected, and how each reader differs."""
    names = [str(folder / row.name) for row in rows]
    others = {reader: read_all(reader, names) for reader in READERS}
    own = subprocess.run([program, "--version"], capture_output=True, text=True, check=True)
    heads = [f"{reader} {version(module)}" for reader, module in READERS.items()]
    with table.open("w", newline="") as out:
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(["file", "construct", "triangles", "area_m2", own.stdout.split("\n")[0],
                         *heads])
        for row, name, (found, _) in zip(rows, names, answers):
            cells = ["refused by name" if found is None else difference(row, found) or "right"]
            for reader in READERS:
                answer = others[reader][name]
                wrong = answer if isinstance(answer, str) else difference(row, answer)
                cells.append(wrong or "right")
            writer.writerow([row.name, row.construct, row.triangles, f"{row.area:.6g}", *cells])


if __name__ == "__main__":
    read = {"trimesh": with_trimesh, "open3d": with_open3d, "assimp": with_assimp}[sys.argv[1]]
    for path in sys.argv[2:]:
        try:
            print(json.dumps({"file": path, **read(path)}), flush=True)
        except Exception:  # whatever a reader fails with is its answer
            print(json.dumps({"file": path, "error": "not read"}), flush=True)
