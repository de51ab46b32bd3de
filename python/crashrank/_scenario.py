"""Scenarios: one moment of decision, from a file, JSON, a dict or built in code."""

from __future__ import annotations

import dataclasses
import json
import math
import os
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np

from . import _core
from ._checks import as_path, as_text
from ._errors import BadInputError, UsageError, bad_input, checked_call, wrong_type
from ._model import Model
from ._parts import Body

_IN_MEMORY = "in memory"
_JSON_FILE = "scenario.json"
_GIVE_BASE = (
    "without base= paths are relative to the current folder: give base=, the folder that they are "
    "relative to, or allow=, a list of folders in which meshes may lie"
)


class Scenario:
    """One moment in which a crash can hardly be avoided.

    The format is that of scenario files (``data/scenario.schema.json``): SI units, degrees,
    x forward, y left, z up, poses from body to world. Checked when it is made; the models are
    read when they are first needed and kept. A scenario never changes, and any number of threads
    may use it. Copies are the scenario itself. A pickled one names its files by absolute paths and
    reads them again; models from memory are pickled with it.

    Parameters
    ----------
    document : mapping
        The scenario as a dict with the keys of a scenario file. Numpy numbers and arrays, and the
        classes `Ego`, `Actor`, `Body`, `Candidate` and `Pose` may stand in it. Copied.
    base : path, optional
        Folder that the mesh paths are relative to. Default: the current folder.
    models : mapping of str to Model, optional
        Bodies for some names of ``document["models"]``, in place of mesh files. Their entries
        need no ``mesh``.
    allow : iterable of path
        Folders outside `base` in which meshes may lie.

    Raises
    ------
    BadInputError
        For keys and values that are not accepted; ``place`` is the key path.
    """

    __slots__ = ("__weakref__", "_origin", "_situation")

    _situation: _core.Situation
    _origin: tuple[Callable[..., Scenario], tuple[object, ...]]

    @checked_call
    def __init__(
        self,
        document: Mapping[str, Any],
        *,
        base: object = None,
        models: Mapping[str, Model] | None = None,
        allow: Iterable[object] = (),
    ) -> None:
        if not isinstance(document, Mapping):
            raise wrong_type(
                "document",
                f"is a {type(document).__name__}, not a mapping",
                "see Scenario.load for files and Scenario.from_json for text",
            )
        plain = _to_plain(document)
        bodies = _as_bodies(models, plain)
        self._read(_to_json(plain), base, bodies, allow)

    def __reduce__(self) -> tuple[Callable[..., Scenario], tuple[object, ...]]:
        """Pickle the text, or the path of the file, that it was read from."""
        return self._origin

    def __copy__(self) -> Scenario:
        return self

    def __deepcopy__(self, memo: object) -> Scenario:
        return self

    @classmethod
    @checked_call
    def load(cls, path: object, *, allow: Iterable[object] = ()) -> Scenario:
        """Read a scenario file.

        Parameters
        ----------
        path : path
            The file. Meshes have to lie in its folder or below, or below a folder above it that
            holds a file named ``crashrank.root``.
        allow : iterable of path
            Further folders in which meshes may lie.
        """
        scenario = cls.__new__(cls)
        file, folders = as_path(path, "path"), _as_paths(allow)
        scenario._situation = _core.read_scenario_file(file, folders, {})
        scenario._origin = (_load_again, (_absolute(file), [_absolute(each) for each in folders]))
        return scenario

    @classmethod
    @checked_call
    def from_json(
        cls,
        text: str | bytes,
        *,
        base: object = None,
        models: Mapping[str, Model] | None = None,
        allow: Iterable[object] = (),
    ) -> Scenario:
        """Read a scenario from its JSON text, bytes in UTF-8; parameters as of the class."""
        scenario = cls.__new__(cls)
        given = as_text(_decoded(text) if isinstance(text, bytes) else text, "text")
        if models:
            return cls(_parse(given), base=base, models=models, allow=allow)
        scenario._read(given, base, {}, allow)
        return scenario

    @classmethod
    @checked_call
    def build(
        cls,
        *,
        models: Mapping[str, Any],
        ego: Any,
        actors: Iterable[Any] = (),
        candidates: Iterable[Any] | Mapping[str, Any] | None = None,
        base: object = None,
        allow: Iterable[object] = (),
        **more: Any,
    ) -> Scenario:
        """Build a scenario in code.

        Parameters
        ----------
        models : mapping of str to Body
            The bodies' shapes by name.
        ego : Ego
            The vehicle that decides.
        actors : iterable of Actor
            Everything that can be hit.
        candidates : iterable of Candidate or mapping, optional
            Manoeuvres written out, in place of the generated grid; or the mapping of a scenario
            file. Default: the generated grid.
        base, allow
            As of the class, for meshes that are named by paths.
        **more
            Other keys of a scenario file: ``name``, ``horizon_s``, ``grip``, ``road``, ...

        Examples
        --------
        >>> import crashrank
        >>> scene = crashrank.Scenario.build(
        ...     models={"car": crashrank.Body("data/models/sedan.obj", kind="car")},
        ...     ego=crashrank.Ego(model="car", speed_mps=20.0),
        ...     actors=[crashrank.Actor("other", model="car", pose=crashrank.Pose(x_m=30.0))],
        ...     candidates=[crashrank.Candidate("brake", acceleration_mps2=-7.0)],
        ... )
        >>> scene.actors
        ('other',)
        """
        document: dict[str, Any] = {"scenario_version": 2, **more, "models": dict(models)}
        document["ego"] = ego
        document["actors"] = list(actors)
        if candidates is not None:
            listed = not isinstance(candidates, Mapping)
            document["candidates"] = (
                {"listed": list(candidates), "grid": False} if listed else candidates
            )
        bodies = {
            name: body.mesh
            for name, body in models.items()
            if isinstance(body, Body) and isinstance(body.mesh, Model)
        }
        return cls(document, base=base, models=bodies, allow=allow)

    def _read(
        self, text: str, base: object, bodies: dict[str, _core.Body], allow: Iterable[object]
    ) -> None:
        folder = "." if base is None else as_path(base, "base")
        file = os.path.join(folder, _JSON_FILE)
        folders = _as_paths(allow)
        models = {name: Model._of(body) for name, body in bodies.items()}
        places = (_absolute(folder), [_absolute(each) for each in folders])
        self._origin = (_read_again, (text, models, *places))
        try:
            self._situation = _core.read_scenario_text(text, file, folders, bodies)
        except BadInputError as error:
            if base is None and "lies outside" in error.reason:
                raise bad_input(error.place, error.reason, _GIVE_BASE) from None
            raise

    @property
    def name(self) -> str:
        """Its name; of a file that gives none, the file's."""
        return self._situation.name

    @property
    def description(self) -> str:
        """What happens, for people."""
        return self._situation.description

    @property
    def horizon_s(self) -> float:
        """How far ahead contacts are searched for, s."""
        return self._situation.horizon_s

    @property
    def measure(self) -> str:
        """What is compared unless the caller chooses."""
        return self._situation.measure

    @property
    def actors(self) -> tuple[str, ...]:
        """Names of the actors."""
        return tuple(self._situation.actor_names())

    @property
    def candidates(self) -> tuple[str, ...]:
        """Names of the candidates, generated ones included; reads the models."""
        return tuple(self._situation.candidate_names())

    def load_models(self) -> Scenario:
        """Read the models now rather than when they are needed; return the scenario itself."""
        self._situation.load()
        return self

    def __repr__(self) -> str:
        """Return name and number of actors."""
        return f"Scenario({self.name!r}, {len(self.actors)} actors)"


def _absolute(path: str) -> str:
    return os.path.abspath(path)


def _load_again(path: str, allow: list[str]) -> Scenario:
    """Return the scenario of a file; what a pickled one is made by."""
    return Scenario.load(path, allow=allow)


def _read_again(text: str, models: dict[str, Model], base: str, allow: list[str]) -> Scenario:
    """Return the scenario of a text; what a pickled one is made by."""
    return Scenario.from_json(text, base=base, models=models, allow=allow)


def as_scenario(value: object, base: object, allow: Iterable[object]) -> Scenario:
    """Return a scenario, read from a path, JSON text or a mapping where it is none yet."""
    if isinstance(value, Scenario):
        return value
    if isinstance(value, Mapping):
        return Scenario(value, base=base, allow=allow)
    if isinstance(value, (str, bytes)) and value.lstrip()[:1] in ("{", b"{"):
        return Scenario.from_json(value, base=base, allow=allow)
    if isinstance(value, (str, bytes, os.PathLike)):
        return Scenario.load(value, allow=allow)
    raise wrong_type(
        "scenario", f"is a {type(value).__name__}", "give a Scenario, a path, JSON text or a dict"
    )


def _as_paths(values: Iterable[object]) -> list[str]:
    if isinstance(values, (str, bytes, os.PathLike)):
        raise wrong_type("allow", "is one path", "give a list of folders")
    try:
        return [as_path(value, f"allow[{i}]") for i, value in enumerate(values)]
    except TypeError as error:
        if isinstance(error, UsageError):
            raise
        raise wrong_type(
            "allow", f"is a {type(values).__name__}, not a list", "give a list of folders"
        ) from None


def _decoded(text: bytes) -> str:
    try:
        return text.decode()
    except UnicodeDecodeError as error:
        raise bad_input(
            f"byte {error.start + 1}", "is not UTF-8", "encode the scenario's text in UTF-8"
        ) from None


def _parse(text: str) -> dict[str, Any]:
    try:
        document = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise bad_input("", f"is not JSON: {error}", "give a scenario as JSON") from None
    if not isinstance(document, dict):
        raise bad_input("", "is not a JSON object", "give a scenario as JSON")
    return document


def _as_bodies(models: object, document: dict[str, Any]) -> dict[str, _core.Body]:
    """Check bodies given by name; their entries get a mesh that no file has."""
    if models is None:
        return {}
    if not isinstance(models, Mapping):
        raise wrong_type(
            "models", f"is a {type(models).__name__}, not a mapping", "give Models by name"
        )
    entries = document.get("models")
    bodies: dict[str, _core.Body] = {}
    for key, model in models.items():
        name = as_text(key, "models")
        if not isinstance(model, Model):
            raise wrong_type(
                f"models.{name}", f"is a {type(model).__name__}", "give a crashrank.Model"
            )
        if isinstance(entries, dict) and isinstance(entries.get(name), dict):
            entries[name]["mesh"] = _IN_MEMORY
        bodies[name] = model._body
    return bodies


def _to_plain(value: Any, depth: int = 0) -> Any:
    """Return dicts, lists and plain numbers; everything is copied."""
    if depth > 32:
        raise bad_input("", "is nested more than 32 deep", "pass a scenario without cycles")
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = ((f.name, getattr(value, f.name)) for f in dataclasses.fields(value))
        value = {name: member for name, member in fields if member is not None}
    if isinstance(value, Mapping):
        plain = {}
        for key, member in value.items():
            plain[as_text(key, "a key of the scenario")] = _to_plain(member, depth + 1)
        return plain
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [_to_plain(member, depth + 1) for member in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, Model):
        return _IN_MEMORY
    if isinstance(value, os.PathLike):
        return as_path(value, "a path of the scenario")
    if value is None or isinstance(value, (str, bool, int, float)):
        return value
    raise wrong_type(
        "",
        f"a {type(value).__name__} cannot stand in a scenario",
        "give dicts, lists, strings, numbers, or classes of crashrank",
    )


def _to_json(plain: dict[str, Any]) -> str:
    try:
        return json.dumps(plain, allow_nan=False)
    except ValueError:
        raise bad_input(_not_finite(plain), "is not finite", "give a number") from None


def _not_finite(plain: Any, place: str = "") -> str:
    """Return the key of the first number that is not finite, empty without one."""
    if isinstance(plain, dict):
        members = ((f"{place}.{key}" if place else key, member) for key, member in plain.items())
    elif isinstance(plain, list):
        members = ((f"{place}[{i}]", member) for i, member in enumerate(plain))
    else:
        return place if isinstance(plain, float) and not math.isfinite(plain) else ""
    return next((found for key, member in members if (found := _not_finite(member, key))), "")
