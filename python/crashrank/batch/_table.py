"""`rank_table`: a row for every scenario, in and out."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from .. import _core
from .._checks import as_path
from .._errors import Error, InternalError, bad_input, checked_call, wrong_type
from .._model import Model
from .._ranking import Ranking
from .._tables import COLUMNS, value_at
from ._arrow import arrow
from ._hashes import result_hash
from ._models import given_models
from ._scene import Row, Scene, error_members, rank_scene, read_scene
from ._settings import Settings, make_settings

if TYPE_CHECKING:
    import pyarrow

# Of every contact: column, type, and the keys that lead to it.
CONTACT_COLUMNS: tuple[tuple[str, str, tuple[str | int, ...]], ...] = (
    ("first", "string", ("bodies", 0)),
    ("second", "string", ("bodies", 1)),
    ("time_of_impact_s", "float64", ("time_of_impact_s",)),
    ("closing_speed_mps", "float64", ("closing_speed_mps",)),
    ("exposure_first_mps", "float64", ("severity", "a", "exposure_mps")),
    ("exposure_second_mps", "float64", ("severity", "b", "exposure_mps")),
    ("pdof_first_deg", "float64", ("severity", "a", "pdof_deg")),
    ("pdof_second_deg", "float64", ("severity", "b", "pdof_deg")),
)


def result_schema() -> pyarrow.Schema:
    """Return the schema of the tables that `rank_table` returns; needs ``crashrank[arrow]``.

    ``ranking`` is a list of a struct for each candidate, best first, with the columns of
    `Ranking.to_arrow` and the list ``contacts``.
    """
    pa = arrow()
    types = {
        "int64": pa.int64(),
        "float64": pa.float64(),
        "bool": pa.bool_(),
        "string": pa.string(),
        "list<string>": pa.list_(pa.string()),
    }
    contact = pa.struct([(name, types[kind]) for name, kind, _ in CONTACT_COLUMNS])
    candidate = pa.struct(
        [*((name, types[kind]) for name, kind, _ in COLUMNS), ("contacts", pa.list_(contact))]
    )
    text = ("id", "input_hash", "models_hash", "settings_hash", "version", "status", "error")
    return pa.schema(
        [
            *((name, pa.string()) for name in text),
            ("error_code", pa.string()),
            ("measure", pa.string()),
            ("measure_unit", pa.string()),
            ("complete", pa.bool_()),
            ("best", pa.string()),
            ("best_score", pa.float64()),
            ("result_hash", pa.string()),
            ("warnings", pa.list_(pa.string())),
            ("ranking", pa.list_(candidate)),
        ]
    )


@checked_call
def rank_table(
    table: pyarrow.Table,
    models: Mapping[str, Model | object] | None = None,
    *,
    base: object = ".",
    measure: str | None = None,
    risk: str | None = None,
    infeasible: str = "demote",
    profile: object = None,
    futures: int = 64,
    work_budget: int | None = None,
    allow: Iterable[object] = (),
) -> pyarrow.Table:
    """Rank a table of scenarios: a row for each, in and out; needs ``crashrank[arrow]``.

    The answer depends on the rows, the files that they name and the arguments alone: any engine
    that maps tables may call it, in any process. Every process keeps the models that it has
    loaded. One thread works; a scenario that cannot be ranked becomes a row with its error.

    Parameters
    ----------
    table : pyarrow.Table or pyarrow.RecordBatch
        Columns ``id`` and ``scenario`` (JSON text), further columns are ignored but for
        ``base``: the folder that the row's paths are relative to.
    models : mapping of str to Model or path, optional
        Models that stand for these names in every scenario that has them, in place of the
        scenario's own. Entries of the scenario then need no ``mesh``.
    base : path
        The folder for rows that have none. Default: the current one.
    measure, risk, infeasible, profile, futures, work_budget
        As of `rank`, for every row.
    allow : iterable of path
        As of `Scenario`.

    Returns
    -------
    pyarrow.Table
        With the schema of `crashrank.batch.result_schema`, in the order of the rows: ``id``,
        ``input_hash``, ``models_hash``, ``settings_hash``, ``version``, ``status`` (``ok`` or
        ``error``), ``error``, ``error_code``, ``measure``, ``measure_unit``, ``complete``,
        ``best``, ``best_score``, ``result_hash``, ``warnings``, ``ranking``.

    Raises
    ------
    BadInputError
        For a table without the columns.
    NotFoundError, BadInputError, LimitError
        For `models` and a `profile` that cannot be read.
    """
    pa = arrow()
    if isinstance(table, pa.RecordBatch):
        table = pa.Table.from_batches([table])
    if not isinstance(table, pa.Table):
        raise wrong_type("table", f"is a {type(table).__name__}", "give a pyarrow.Table")
    settings = make_settings(measure, risk, infeasible, profile, futures, work_budget, allow)
    folder = as_path(base, "base")
    given = given_models(models)
    settings_hash = settings.hash
    records = [
        rank_row(read_scene(row, given, settings), settings, settings_hash)
        for row in table_rows(table, folder)
    ]
    return pa.Table.from_pylist(records, schema=result_schema())


def table_rows(table: pyarrow.Table, folder: str) -> list[Row]:
    """Return the rows of a table; `folder` is the base of those that have none."""
    columns = {}
    for name in ("id", "scenario", "base"):
        count = table.column_names.count(name)
        if count == 0 and name == "base":
            columns[name] = [None] * table.num_rows
            continue
        if count != 1:
            what = f"has {count} columns" if count else "has no column"
            raise bad_input("table", f"{what} {name!r}", "see help(crashrank.rank_table)")
        columns[name] = text_column(table, name).to_pylist()
    return [
        Row(row_id or "", text, None, base or folder)
        for row_id, text, base in zip(*columns.values(), strict=True)
    ]


def text_column(table: pyarrow.Table, name: str) -> pyarrow.ChunkedArray:
    """Return a column as strings that are UTF-8: readers and writers of parquet do not check it."""
    pa = arrow()
    column = table.column(name)
    try:
        text = column.cast(pa.string())
        text.validate(full=True)
    except pa.ArrowException:
        kind = column.type
        texts = pa.types.is_string(kind) or pa.types.is_large_string(kind)
        what = "holds text that is not UTF-8" if texts else f"is a column of {kind}"
        raise bad_input(f"table.{name}", what, "give strings in UTF-8") from None
    return text


def rank_row(
    scene: Scene,
    settings: Settings,
    settings_hash: str,
    rank_it: Callable[[Scene, Settings], Ranking | Error] = rank_scene,
) -> dict[str, Any]:
    """Return a row of the result as a dict."""
    row = {
        "id": scene.id,
        "input_hash": scene.input_hash,
        "models_hash": scene.models_hash,
        "settings_hash": settings_hash,
        "version": _core.version,
    }
    answer = rank_it(scene, settings)
    if isinstance(answer, Error):
        return row | error_members(answer)
    document = answer.to_dict()
    candidates = document["ranking"]
    best = candidates[0] if candidates else {"candidate": None, "score": None}
    return row | {
        "status": "ok",
        "measure": document["measure"],
        "measure_unit": document["measure_unit"],
        "complete": document["complete"],
        "best": best["candidate"],
        "best_score": best["score"],
        "result_hash": result_hash(document),
        "warnings": document["warnings"],
        "ranking": [_candidate(candidate) for candidate in candidates],
    }


def _candidate(document: dict[str, Any]) -> dict[str, Any]:
    row = {name: value_at(document, path) for name, _, path in COLUMNS}
    row["contacts"] = [
        {name: value_at(contact, path) for name, _, path in CONTACT_COLUMNS}
        for contact in document["contacts"]
    ]
    return row


def killed_row(kills: str) -> Callable[[Scene, Settings], Ranking | Error]:
    """Return what stands for the ranking of a row that ends the processes which rank it."""

    def rank_it(_scene: Scene, _settings: Settings) -> Error:
        return InternalError(
            "internal", "", "", kills, "rank it alone with crashrank rank, and report the defect"
        )

    return rank_it
