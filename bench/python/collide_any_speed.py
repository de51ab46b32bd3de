"""Time of `collide_any` against the same loop in C++ and against python-fcl, in one run.

The three take turns, and the median of all rounds counts: what other programs do meanwhile falls on
all alike. C++ is given the same matrices: it reads and checks them, as `collide_any` does, and asks
with one buffer and one workspace. Poses are drawn within 2.5 m, where most touch or nearly do, and
within 40 m, where the bounding spheres of most are apart.

Usage: collide_any_speed.py build/release/bin/collide_any_native [POSES] [ROUNDS]
"""

from __future__ import annotations

import pathlib
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable

import crashrank
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python/tests"))

from conftest import random_poses  # noqa: E402

MODELS = [ROOT / "data/models/sedan.obj", ROOT / "data/models/hatch.obj"]
REACHES_M = (2.5, 40.0)


class Native:
    """The C++ program, which gets models and poses as files."""

    def __init__(self, program: str, folder: pathlib.Path, poses: np.ndarray) -> None:
        poses.tofile(folder / "poses")
        self.words = [program, str(folder / "0.crm"), str(folder / "1.crm"), str(folder / "poses")]

    def run(self, rounds: int) -> tuple[list[list[float]], int]:
        """Return the seconds of reading matrices and of querying by round, and how many touch."""
        done = subprocess.run(
            [*self.words, str(rounds)], capture_output=True, text=True, check=True
        )
        *rows, touching = done.stdout.splitlines()
        return [[float(word) for word in row.split()] for row in rows], int(touching)


def fcl_query(models: list[crashrank.Model], poses: np.ndarray) -> Callable[[], int] | None:
    """Return a function that asks python-fcl at all poses; None where it is not installed."""
    try:
        import fcl
    except ImportError:
        return None
    objects = []
    for model in models:
        body = fcl.BVHModel()
        body.beginModel(len(model.vertices), len(model.faces))
        body.addSubModel(np.asarray(model.vertices, float), np.asarray(model.faces, np.int64))
        body.endModel()
        objects.append(fcl.CollisionObject(body))

    def query() -> int:
        touching = 0
        for pose in poses:
            objects[1].setTransform(fcl.Transform(pose[:3, :3], pose[:3, 3]))
            touching += fcl.collide(*objects, fcl.CollisionRequest(), fcl.CollisionResult()) > 0
        return touching

    return query


def timed(query: Callable[[], object]) -> tuple[float, object]:
    start = time.perf_counter()
    answer = query()
    return time.perf_counter() - start, answer


def main() -> None:
    program = sys.argv[1]
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 10_000
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 15
    models = [crashrank.load_model(path) for path in MODELS]
    print(f"{count} poses, medians of {rounds} rounds in turn, us a pose, times C++")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for i, model in enumerate(models):
            model.save(folder / f"{i}.crm")
        for reach_m in REACHES_M:
            poses = random_poses(7, count, reach_m)
            native = Native(program, folder, poses)
            fcl = fcl_query(models, poses)
            seconds: dict[str, list[float]] = {}
            counts = set()
            for i in range(rounds):
                rows, touching = native.run(2)  # the first warms the caches
                seconds.setdefault("C++", []).append(sum(rows[1]))
                seconds.setdefault("C++, queries", []).append(rows[1][1])
                crashrank.collide_any(*models, poses)
                took, touch = timed(lambda poses=poses: crashrank.collide_any(*models, poses))
                seconds.setdefault("collide_any", []).append(took)
                counts |= {touching, int(np.sum(touch))}
                if fcl is not None and i < 3:
                    took, told = timed(fcl)
                    seconds.setdefault("python-fcl", []).append(took)
                    counts.add(told)
            if len(counts) != 1:
                sys.exit(f"the answers differ: {counts} touch")
            print(f"within {reach_m:g} m: {counts.pop()} touch")
            base = statistics.median(seconds["C++"])
            for what, each in seconds.items():
                one = statistics.median(each)
                print(f"  {what:13} {1e6 * one / count:9.3f} {one / base:9.3f}")


if __name__ == "__main__":
    main()
