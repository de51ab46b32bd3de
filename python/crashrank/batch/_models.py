"""Models of a batch: loaded once in a process and kept between rows."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Mapping

from .. import _core
from .._checks import as_path, as_text
from .._errors import wrong_type
from .._model import Model, load_model
from ._hashes import MISSING, file_hash, json_digest

# About 170 bytes a triangle: 1.4 GB at most in a process, and what the scenarios of a part use.
MOST_TRIANGLES = 8_000_000

# One a process: workers of every engine rank row after row with it.
CACHE = _core.ModelCache(MOST_TRIANGLES)

_loaded: dict[tuple[str, str], Model] = {}


@dataclasses.dataclass(frozen=True)
class GivenModel:
    """A model that stands for one name in every scenario of a batch."""

    model: Model
    hash: str


def given_models(models: object) -> dict[str, GivenModel]:
    """Return the models of a mapping of names to paths or `Model`; None has none.

    Raises the errors of `load_model` and of wrong types.
    """
    if models is None:
        return {}
    if not isinstance(models, Mapping):
        raise wrong_type(
            "models", f"is a {type(models).__name__}, not a mapping", "give models by name"
        )
    given: dict[str, GivenModel] = {}
    for key, value in models.items():
        name = as_text(key, "models")
        if isinstance(value, Model):
            given[name] = GivenModel(value, _array_hash(value))
        else:
            given[name] = _load(as_path(value, f"models.{name}"))
    return given


def _load(path: str) -> GivenModel:
    found = file_hash(path)
    key = (path, found)
    if found == MISSING or key not in _loaded:
        model = load_model(path)
        for old in [other for other in _loaded if other[0] == path]:
            del _loaded[old]
        _loaded[key] = model
    return GivenModel(_loaded[key], found)


def _array_hash(model: Model) -> str:
    arrays = [
        hashlib.sha256(array.tobytes()).hexdigest() for array in (model.vertices, model.faces)
    ]
    return json_digest([*arrays, model.parts, model.mass_kg])
