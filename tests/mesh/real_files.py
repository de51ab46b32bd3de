"""Reads meshes of public repositories and holds their numbers of triangles against other readers'.

    real_files.py CRASHRANK FOLDER [TABLE]

FOLDER holds clones named OWNER+NAME. TABLE, by default docs/evidence/real-meshes.csv, lists kind,
repository, commit and file of each mesh; the other columns are written anew. The other reader is
trimesh; where it does not read the format, a count of the polygons' corners in the file.
"""

from __future__ import annotations

import csv
import importlib.metadata
import json
import re
import struct
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

TABLE = Path(__file__).parents[2] / "docs/evidence/real-meshes.csv"
COLUMNS = ["kind", "repository", "commit", "file", "crashrank", "other", "reader", "size_m"]


def extract(clone: Path, commit: str, file: str, folder: Path) -> Path:
    """Write the mesh and the buffers and materials beside it; return its path."""
    git = next(each for each in (clone, clone / ".git", clone / "repo", clone / "repo/.git")
               if (each / "HEAD").is_file())

    def run(*words: str) -> bytes:
        return subprocess.run(["git", f"--git-dir={git}", *words], capture_output=True,
                              check=True).stdout

    place = Path(file).parent
    for name in run("ls-tree", "--name-only", commit, f"{place}/").decode().splitlines():
        if name == file or Path(name).suffix in (".bin", ".mtl"):
            (folder / Path(name).name).write_bytes(run("show", f"{commit}:{name}"))
    return folder / Path(file).name


def count_with_trimesh(file: Path) -> int:
    import trimesh

    scene = trimesh.load_scene(file, process=False, skip_materials=True)
    faces = {name: len(mesh.faces) for name, mesh in scene.geometry.items()
             if isinstance(mesh, trimesh.Trimesh)}
    return sum(faces.get(scene.graph[node][1], 0) for node in scene.graph.nodes_geometry)


def count_ac3d(file: Path) -> int:
    """Closed polygons have corners less two triangles, lines none, strips corners less two."""
    text = file.read_text(errors="replace")
    return sum(max(int(refs) - 2, 0) for flags, refs in re.findall(
        r"SURF\s+(0x[0-9a-fA-F]+)\s+(?:mat\s+\d+\s+)?refs\s+(\d+)", text)
        if int(flags, 16) & 15 in (0, 4))


def count_3ds(file: Path) -> int:
    data = file.read_bytes()

    def count(begin: int, end: int) -> int:
        found = 0
        while begin + 6 <= end:
            number, size = struct.unpack_from("<HI", data, begin)
            inside = begin + 6
            if number == 0x4120:
                found += struct.unpack_from("<H", data, inside)[0]
            elif number == 0x4000:
                found += count(data.index(b"\0", inside) + 1, begin + size)
            elif number in (0x4D4D, 0x3D3D, 0x4100):
                found += count(inside, begin + size)
            begin += max(size, 6)
        return found

    return count(0, len(data))


def count_fbx(file: Path) -> int:
    """Of text: the last corner of each polygon is negative."""
    polygons = re.findall(r"PolygonVertexIndex:[^-\d]*\*?\d*\s*\{?\s*a?:?\s*([-\d,\s]+)",
                          file.read_text(errors="replace"))
    corners = [int(each) for text in polygons for each in re.split(r"[,\s]+", text) if each]
    return len(corners) - 2 * sum(corner < 0 for corner in corners)


def count_gltf(file: Path) -> int:
    """By the numbers of indices that the document states; compressed meshes state them too."""
    data = file.read_bytes()
    document: dict[str, Any] = json.loads(
        data[20:20 + struct.unpack_from("<I", data, 12)[0]] if data[:4] == b"glTF" else data)
    found = 0
    nodes = list(document["scenes"][document.get("scene", 0)]["nodes"])
    while nodes:
        node = document["nodes"][nodes.pop()]
        nodes += node.get("children", [])
        # Version 1 has a list of meshes.
        for mesh in node.get("meshes", [node["mesh"]] if "mesh" in node else []):
            for primitive in document["meshes"][mesh]["primitives"]:
                place = primitive.get("indices", primitive["attributes"]["POSITION"])
                found += document["accessors"][place]["count"] // 3
    return found


COUNTS = {".ac": count_ac3d, ".3ds": count_3ds, ".fbx": count_fbx,
          ".glb": count_gltf, ".gltf": count_gltf}


def read(program: str, clones: Path, row: dict[str, str]) -> dict[str, str]:
    with tempfile.TemporaryDirectory() as folder:
        clone = clones / row["repository"].replace("/", "+")
        mesh = extract(clone, row["commit"], row["file"], Path(folder))
        run = subprocess.run([program, "inspect", "--json", mesh], capture_output=True, text=True,
                             check=False)
        answer = json.loads(run.stdout)["files"][0] if run.returncode == 0 else {}
        count = COUNTS.get(mesh.suffix.lower())
        other = count(mesh) if count else count_with_trimesh(mesh)
        version = importlib.metadata.version("trimesh")
    return {**row, "crashrank": str(answer.get("triangles", run.stderr.strip())),
            "other": str(other), "reader": "count" if count else f"trimesh {version}",
            "size_m": " x ".join(f"{x:.3g}" for x in answer.get("extent_m", []))}


def main() -> int:
    program, clones = sys.argv[1], Path(sys.argv[2])
    table = Path(sys.argv[3]) if len(sys.argv) > 3 else TABLE
    with table.open(newline="") as listed:
        rows = [read(program, clones, row) for row in csv.DictReader(listed)]
    with table.open("w", newline="") as out:
        writer = csv.DictWriter(out, COLUMNS, lineterminator="\n", extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)
    differ = [row for row in rows if row["crashrank"] != row["other"]]
    for row in differ:
        print(f"{row['repository']} {row['file']}: {row['crashrank']}, other {row['other']}")
    print(f"{len(rows)} files, {len(differ)} differ")
    return 0


if __name__ == "__main__":
    sys.exit(main())
