"""The stored scenes and answers: beside this file in a wheel, else in data/benchmark."""

from __future__ import annotations

import csv
import hashlib
import io
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from .._errors import BadInputError, NotFoundError

_DATA = "data/benchmark"
SCENES, ANSWERS, FACTS = "scenes.jsonl", "answers.csv", "benchmark.json"
DIGITS = 4
"""Significant digits of stored harm."""


class StoredAnswer(NamedTuple):
    """What crashrank says of a candidate: expected harm, persons, with its interval."""

    scene: str
    candidate: str
    harm_persons: float
    lowest: float
    highest: float
    best_place: int
    """The best place, from 1, that the candidate has in any sample of what is not known."""
    worst_place: int
    chosen_by: tuple[str, ...] = ()
    """The simple choosers that take it."""


@dataclass(frozen=True)
class Benchmark:
    """Scenes with their answers, in one order."""

    version: int
    sha256: str
    """Of the file of scenes."""
    floor_persons: float
    """Every candidate has at least this harm in every future."""
    choosers: tuple[str, ...]
    """The simple choosers whose choices are stored."""
    lines: tuple[str, ...]
    """The scenes as JSON text."""
    answers: tuple[tuple[StoredAnswer, ...], ...]
    """Of each scene, in the order of its candidates."""

    @property
    def scenes(self) -> list[dict[str, Any]]:
        """New dicts with the keys of scenario files; meshes are relative to data/benchmark."""
        return [json.loads(line) for line in self.lines]

    def first(self, count: int) -> Benchmark:
        """Return the first scenes alone."""
        return Benchmark(
            self.version, self.sha256, self.floor_persons, self.choosers, self.lines[:count],
            self.answers[:count],
        )  # fmt: skip


def data_folder() -> Path:
    """Return where the files are."""
    here = Path(__file__)
    return here.parent if (here.parent / SCENES).is_file() else here.resolve().parents[3] / _DATA


def load(folder: Path | None = None) -> Benchmark:
    """Read the stored scenes and answers.

    Parameters
    ----------
    folder : path, optional
        Where they are. Default: in the package, or in the checkout that it is used in.

    Raises
    ------
    NotFoundError
        Where the files are not there.
    BadInputError
        Where scenes, answers and hash do not belong together.
    """
    folder = data_folder() if folder is None else folder
    facts = json.loads(_text(folder / FACTS))
    text = _text(folder / SCENES)
    if hashlib.sha256(text.encode()).hexdigest() != facts["sha256"]:
        raise BadInputError(
            "bad_input", str(folder / SCENES), "",
            f"is not version {facts['version']} of the benchmark: its SHA-256 is another",
            f"restore it, or write all files with {_DATA}/make",
        )  # fmt: skip
    stored: dict[str, list[StoredAnswer]] = {}
    for row in csv.DictReader(io.StringIO(_text(folder / ANSWERS))):
        stored.setdefault(row["scene"], []).append(_answer(row))
    lines = tuple(text.splitlines())
    answers = tuple(tuple(rows) for rows in stored.values())
    if [_key(rows) for rows in answers] != [_scene_key(json.loads(line)) for line in lines]:
        raise BadInputError(
            "bad_input", str(folder / ANSWERS), "", f"has other candidates than {SCENES}",
            f"write it with {_DATA}/make --answers",
        )  # fmt: skip
    return Benchmark(
        facts["version"], facts["sha256"], facts["floor_persons"], tuple(facts["choosers"]), lines,
        answers,
    )  # fmt: skip


def candidate_names(scene: dict[str, Any]) -> list[str]:
    """Return the names of a scene's candidates, in order."""
    return [each["name"] for each in scene["candidates"]["listed"]]


def written(value: float) -> str:
    """Return a harm with the stored digits."""
    return f"{value:.{DIGITS}g}"


def _answer(row: dict[str, str]) -> StoredAnswer:
    return StoredAnswer(
        scene=row["scene"],
        candidate=row["candidate"],
        harm_persons=float(row["harm_persons"]),
        lowest=float(row["lowest"]),
        highest=float(row["highest"]),
        best_place=int(row["best_place"]),
        worst_place=int(row["worst_place"]),
        chosen_by=tuple(filter(None, row["chosen_by"].split(";"))),
    )


def _key(rows: Sequence[StoredAnswer]) -> tuple[str, list[str]]:
    return rows[0].scene, [row.candidate for row in rows]


def _scene_key(scene: dict[str, Any]) -> tuple[str, list[str]]:
    return scene["name"], candidate_names(scene)


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise NotFoundError(
            "not_found", str(path), "", f"cannot be read: {error.strerror}",
            "install the package's wheel, or use it in a checkout of the repository",
        ) from error  # fmt: skip
