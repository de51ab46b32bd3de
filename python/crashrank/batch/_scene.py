"""One row: a scenario that was read, and its ranking."""

from __future__ import annotations

import dataclasses
import os
import stat
from typing import Any, NamedTuple

from .. import _core
from .._checks import as_path
from .._errors import Error, InternalError, bad_input, make_error, printable
from .._ranking import Ranking, rank
from .._scenario import _IN_MEMORY, _JSON_FILE, Scenario, _parse, _to_json
from ._hashes import file_hash, input_hash, models_hash
from ._models import CACHE, GivenModel
from ._settings import Settings

MAX_BYTES = 16 << 20  # of a scenario, as the library reads


class Row(NamedTuple):
    """A scenario to rank: its text, or the file that holds it."""

    id: str
    text: str | None
    """JSON; None: in the file."""
    file: str | None
    """Where the scenario stands; None: in no file."""
    base: str | None
    """The folder of its paths; None: that of the file, or the current one."""

    @property
    def folder(self) -> str:
        """The folder that its paths are relative to."""
        if self.base or not self.file:
            return self.base or "."
        return os.path.dirname(os.path.abspath(self.file))


@dataclasses.dataclass(frozen=True)
class Scene:
    """A scenario of a row, or the error that it has in place of one."""

    id: str
    scenario: Scenario | None
    error: Error | None
    input_hash: str | None
    models_hash: str | None

    @property
    def key(self) -> list[str | None]:
        """What the row's result depends on beside settings and version.

        An error is part of it: it may come from files that the other hashes do not cover.
        """
        error = None if self.error is None else str(self.error)
        return [self.id, self.input_hash, self.models_hash, error]


def read_scene(row: Row, given: dict[str, GivenModel], settings: Settings) -> Scene:
    """Read a row's scenario; what is wrong with it becomes its error.

    Parameters
    ----------
    row
        What to read.
    given
        Models by name, in place of those of the scenario.
    settings
        Whose allowed folders count.
    """
    hashed = None
    try:
        text = _read_text(row.file) if row.text is None else row.text
        hashed = input_hash(text, row.folder)
        scenario, own = _read(row, text, given, settings)
        found = [(name, file_hash(path)) for name, path in scenario._situation.model_files()]
        return Scene(row.id, scenario, None, hashed, models_hash([*found, *own]))
    except Error as error:
        if row.file is not None and not error.file:
            error.file = row.file
        error.file = printable(error.file)
        return Scene(row.id, None, error, hashed, None)
    except Exception as error:
        return Scene(row.id, None, _unexpected(error), hashed, None)


def _read(
    row: Row, text: str, given: dict[str, GivenModel], settings: Settings
) -> tuple[Scenario, list[tuple[str, str]]]:
    """Return the scenario, and names and hashes of the given models that it uses."""
    as_path(row.folder, "base")
    bodies = {}
    own: list[tuple[str, str]] = []
    if given:
        document = _parse(text)
        entries = document.get("models")
        used = entries if isinstance(entries, dict) else {}
        for name in used.keys() & given.keys():
            bodies[name] = given[name].model._body
            own.append((name, given[name].hash))
            if isinstance(used[name], dict) and "mesh" not in used[name]:
                used[name]["mesh"] = _IN_MEMORY
                text = ""
        text = text or _to_json(document)
    scenario = Scenario.__new__(Scenario)
    scenario._situation = _core.read_scenario_text(
        text,
        row.file or os.path.join(row.folder, _JSON_FILE),
        list(settings.allow),
        bodies,
        CACHE,
    )
    return scenario, own


def _read_text(file: str | None) -> str:
    if file is None:
        raise bad_input("scenario", "is null", "give the scenario's JSON text")
    as_path(file, "")
    try:
        if not stat.S_ISREG(os.stat(file).st_mode):  # a pipe would wait for somebody who writes
            raise make_error("not_found", file, "", "is no file", "leave it out")
        with open(file, "rb") as source:
            data = source.read(MAX_BYTES + 1)
        return data.decode("utf-8")
    except UnicodeDecodeError:
        raise bad_input("", "is not UTF-8", "name a scenario in JSON") from None
    except OSError as error:
        raise make_error(
            "not_found", file, "", f"cannot be read: {error.strerror}", "check the path"
        ) from None


def _unexpected(error: Exception) -> Error:
    code = "out_of_memory" if isinstance(error, MemoryError) else "internal"
    return make_error(code, "", "", f"{type(error).__name__}: {error}", "report this defect")


def rank_scene(scene: Scene, settings: Settings) -> Ranking | Error:
    """Return the ranking of a scene, or its error.

    Raises KeyboardInterrupt where Ctrl-C ended it: a partial answer is no result.
    """
    if scene.scenario is None:
        return scene.error or InternalError("internal", reason="was not read")
    try:
        ranking = rank(scene.scenario, **settings.options())
    except Error as error:
        return error
    except Exception as error:
        return _unexpected(error)
    if ranking.interrupted:
        raise KeyboardInterrupt
    return ranking


def error_members(error: Error) -> dict[str, Any]:
    """Return the columns that an error fills."""
    return {"status": "error", "error": str(error), "error_code": error.code}
