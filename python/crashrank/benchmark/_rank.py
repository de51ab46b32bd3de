"""The answers made anew, and how they differ from the stored ones."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from .._errors import NotFoundError
from .._ranking import Ranking, rank
from ._data import Benchmark, StoredAnswer, candidate_names, data_folder, written


def models_folder(named: str | None) -> Path:
    """Return the folder of the meshes: that which is named, else data/models of the checkout."""
    folder = Path(named) if named else data_folder().parent / "models"
    if not (folder / "hatch.obj").is_file():
        raise NotFoundError(
            "not_found", str(folder), "--models", "has no meshes of the benchmark",
            "name the folder data/models of a checkout of the repository",
        )  # fmt: skip
    return folder.resolve()


def rank_scene(scene: dict[str, Any], models: Path) -> Ranking:
    """Rank a scene with its meshes from that folder; Ctrl-C raises KeyboardInterrupt."""
    moved = {
        name: {**model, "mesh": str(models / Path(model["mesh"]).name)}
        for name, model in scene["models"].items()
    }
    workers = min(len(os.sched_getaffinity(0)), 64)
    ranking = rank({**scene, "models": moved}, workers=workers, measure="harm", allow=[models])
    if ranking.interrupted:
        raise KeyboardInterrupt
    return ranking


def answers_of(scene: dict[str, Any], ranking: Ranking) -> list[StoredAnswer]:
    """Return a ranking's answers with the stored digits, in the order of the candidates."""
    found = []
    for name in candidate_names(scene):
        row = ranking[name]
        harm = [float(written(x)) for x in (row.score or 0.0, *row.score_interval)]
        found.append(StoredAnswer(scene["name"], name, harm[0], harm[1], harm[2], *row.places))
    return found


def differences(
    stored: Benchmark, models: Path, done: Callable[[], None]
) -> Iterator[tuple[StoredAnswer, StoredAnswer]]:
    """Rank every scene; return the answers that differ from the stored: stored, and now.

    `done` is called after each scene.
    """
    for scene, answers in zip(stored.scenes, stored.answers, strict=True):
        now = answers_of(scene, rank_scene(scene, models))
        yield from ((a, b) for a, b in zip(answers, now, strict=True) if a[:7] != b[:7])
        done()
