"""Time of `collide_any` over 10,000 poses against the engine's own and python-fcl's, in one run.

The engine's time is what `crashrank collide --any --repeat 3` reports: the median of each query's
seconds, summed. Rounds alternate and the least of each counts, so that other programs' work on the
machine falls on all alike.

Usage: collide_any_speed.py PROGRAM [POSES] [ROUNDS]
"""

from __future__ import annotations

import json
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

import crashrank

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python/tests"))

from conftest import random_poses  # noqa: E402

MODELS = [ROOT / "data/models/sedan.obj", ROOT / "data/models/hatch.obj"]


def engine_seconds(program: str, poses_file: str) -> float:
    words = [program, "collide", *map(str, MODELS), "--poses", poses_file, "--any", "--json"]
    done = subprocess.run([*words, "--repeat", "3"], capture_output=True, text=True, check=True)  # noqa: S603
    return sum(query["seconds"] for query in json.loads(done.stdout)["queries"])


def main() -> None:
    program = sys.argv[1]
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 10_000
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 5
    a, b = (crashrank.load_model(path) for path in MODELS)
    poses = random_poses(7, count, 3.0)
    times: dict[str, list[float]] = {"engine": [], "collide_any": [], "python-fcl": []}
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
        file.writelines(" ".join(map(repr, map(float, pose.ravel()))) + "\n" for pose in poses)
        file.flush()
        for _ in range(rounds):
            times["engine"].append(engine_seconds(program, file.name))
            start = time.perf_counter()
            touch = crashrank.collide_any(a, b, poses)
            times["collide_any"].append(time.perf_counter() - start)
    try:
        import fcl
    except ImportError:
        fcl = None
    if fcl is not None:
        objects = []
        for model in (a, b):
            body = fcl.BVHModel()
            body.beginModel(len(model.vertices), len(model.faces))
            body.addSubModel(np.asarray(model.vertices, float), np.asarray(model.faces, np.int64))
            body.endModel()
            objects.append(fcl.CollisionObject(body))
        for _ in range(min(rounds, 2)):
            start = time.perf_counter()
            told = []
            for pose in poses:
                objects[1].setTransform(fcl.Transform(pose[:3, :3], pose[:3, 3]))
                told.append(fcl.collide(*objects, fcl.CollisionRequest(), fcl.CollisionResult()) > 0)
            times["python-fcl"].append(time.perf_counter() - start)
        if not np.array_equal(told, touch):
            sys.exit("the answers differ")
    print(f"{count} poses, {int(touch.sum())} touch; least of {rounds} rounds")
    for name, seconds in times.items():
        if seconds:
            ratio = min(seconds) / min(times["engine"])
            print(f"{name:12} {min(seconds):9.4f} s  {ratio:8.3f} times the engine's")


if __name__ == "__main__":
    main()
