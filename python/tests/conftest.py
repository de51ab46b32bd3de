"""What the tests share: shipped files, and the command that answers are held against."""

from __future__ import annotations

import importlib
import json
import os
import pathlib
import shutil
import subprocess
from typing import Any

import crashrank
import numpy as np
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA = ROOT / "data"
SCENARIOS = sorted(DATA.glob("scenarios/*.json")) + sorted(DATA.glob("scenarios/choosers/*.json"))
SHARED = pathlib.Path(
    os.environ.get("CRASHRANK_SHARED_SCENARIOS") or ROOT.parent / "shared/scenarios"
)
"""Files of others, which the project does not hold."""


def needs_file(path: pathlib.Path) -> pytest.MarkDecorator:
    """Return the mark that skips a test where a file of others is not there."""
    return pytest.mark.skipif(
        not path.is_file(), reason=f"{path} is not there: no files of others are read"
    )


def expect_extra_named(module: str, package: str, extra: str) -> None:
    """Expect that a module without its package is refused by names of package and extra."""
    with pytest.raises(crashrank.NotFoundError) as caught:
        importlib.import_module(module)
    assert f"{package}: is not installed" in str(caught.value)
    assert f"[{extra}]" in caught.value.remedy


def program() -> str:
    """Return the command: a build's, or the installed console script."""
    named = os.environ.get("CRASHRANK_PROGRAM") or shutil.which("crashrank")
    assert named, "neither CRASHRANK_PROGRAM nor an installed crashrank is there"
    return named


def run_command(*words: object) -> Any:
    """Return the JSON that the command prints."""
    done = subprocess.run(
        [program(), *map(str, words), "--json"], capture_output=True, text=True, check=False
    )
    assert done.returncode in (0, 4), done.stderr
    return json.loads(done.stdout)


def box(size: float = 1.0, at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> crashrank.Model:
    """Return a closed cube of 12 triangles, its lowest corner at `at`; m."""
    vertices, faces = box_arrays(size, at)
    return crashrank.Model(vertices, faces)


def box_arrays(size=1.0, at=(0.0, 0.0, 0.0)):
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return corners * size + at, np.array(faces)


@pytest.fixture(scope="session")
def sedan() -> crashrank.Model:
    return crashrank.load_model(DATA / "models/sedan.obj")


@pytest.fixture(scope="session")
def pole() -> crashrank.Model:
    return crashrank.load_model(DATA / "models/pole.obj")


@pytest.fixture(scope="session")
def truck_ranking() -> crashrank.Ranking:
    return crashrank.rank(DATA / "scenarios/oncoming_truck.json")


def random_poses(seed: int, count: int, reach_m: float) -> np.ndarray:
    """Return poses with rotations drawn evenly and translations within a cube."""
    random = np.random.default_rng(seed)
    quaternions = random.normal(size=(count, 4))
    w, x, y, z = (quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)).T
    poses = np.zeros((count, 4, 4))
    poses[:, 0, :3] = np.stack(
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)], axis=1
    )
    poses[:, 1, :3] = np.stack(
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)], axis=1
    )
    poses[:, 2, :3] = np.stack(
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)], axis=1
    )
    poses[:, :3, 3] = random.uniform(-reach_m, reach_m, size=(count, 3))
    poses[:, 3, 3] = 1
    return poses


@pytest.fixture
def scenes(tmp_path) -> pathlib.Path:
    """Return a folder of twelve small scenes and their models."""
    from batch_scenes import make_folder

    return make_folder(tmp_path / "scenes", 12)
