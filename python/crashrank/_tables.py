"""Rankings as tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._errors import NotFoundError

if TYPE_CHECKING:
    import pandas
    import pyarrow

# Column, type, and the keys that lead to it in a row of the JSON answer.
COLUMNS: tuple[tuple[str, str, tuple[str | int, ...]], ...] = (
    ("rank", "int64", ("rank",)),
    ("candidate", "string", ("candidate",)),
    ("score", "float64", ("score",)),
    ("score_lowest", "float64", ("score_interval", 0)),
    ("score_highest", "float64", ("score_interval", 1)),
    ("feasible", "bool", ("feasible",)),
    ("grip_demand", "float64", ("grip_demand",)),
    ("collides", "bool", ("collides",)),
    ("collision_probability", "float64", ("collision_probability",)),
    ("other", "string", ("other",)),
    ("time_of_impact_s", "float64", ("time_of_impact_s",)),
    ("closing_speed_mps", "float64", ("closing_speed_mps",)),
    ("delta_v_ego_mps", "float64", ("delta_v_mps", "ego")),
    ("delta_v_other_mps", "float64", ("delta_v_mps", "other")),
    ("pdof_ego_deg", "float64", ("pdof_deg", "ego")),
    ("pdof_other_deg", "float64", ("pdof_deg", "other")),
    ("damaged_triangles_ego", "int64", ("damaged_triangles", "ego")),
    ("damaged_triangles_other", "int64", ("damaged_triangles", "other")),
    ("damaged_area_ego_m2", "float64", ("damaged_area_m2", "ego")),
    ("damaged_area_other_m2", "float64", ("damaged_area_m2", "other")),
    ("damaged_parts_ego", "list<string>", ("damaged_parts", "ego")),
    ("damaged_parts_other", "list<string>", ("damaged_parts", "other")),
    ("leaves_road_s", "float64", ("leaves_road", "time_s")),
    ("least_distance_m", "float64", ("least_distance_m",)),
    ("least_time_gap_s", "float64", ("least_time_gap_s",)),
    ("time_to_collision_s", "float64", ("time_to_collision_s",)),
    ("tied_with", "list<string>", ("tied_with",)),
    ("origin", "string", ("origin",)),
    ("acceleration_mps2", "float64", ("acceleration_mps2",)),
    ("curvature_per_m", "float64", ("curvature_per_m",)),
)


def value_at(row: Any, path: tuple[str | int, ...]) -> Any:
    """Return what the keys lead to in a JSON answer; None where an object on the way is null."""
    for key in path:
        if row is None:
            return None
        row = row[key]
    return row


def _column(document: dict[str, Any], path: tuple[str | int, ...]) -> list[Any]:
    return [value_at(row, path) for row in document["ranking"]]


def missing(package: str, extra: str) -> NotFoundError:
    """Return the error for a package that is not installed."""
    return NotFoundError(
        "not_found",
        "",
        package,
        "is not installed",
        f"pip install '.[{extra}]' in the folder of crashrank's source",
    )


def to_arrow(document: dict[str, Any]) -> pyarrow.Table:
    """Return the table of a ranking's JSON answer."""
    try:
        import pyarrow
    except ImportError:
        raise missing("pyarrow", "arrow") from None
    types = {
        "int64": pyarrow.int64(),
        "float64": pyarrow.float64(),
        "bool": pyarrow.bool_(),
        "string": pyarrow.string(),
        "list<string>": pyarrow.list_(pyarrow.string()),
    }
    metadata = {key: str(document[key]) for key in ("scenario", "measure", "measure_unit")}
    schema = pyarrow.schema([(name, types[kind]) for name, kind, _ in COLUMNS], metadata=metadata)
    columns = {name: _column(document, path) for name, _, path in COLUMNS}
    return pyarrow.table(columns, schema=schema)


def to_pandas(document: dict[str, Any]) -> pandas.DataFrame:
    """Return the same as a data frame; what is absent is NA."""
    try:
        import pandas
    except ImportError:
        raise missing("pandas", "notebook") from None
    types = {"int64": "Int64", "float64": "Float64", "bool": "boolean", "string": "string"}
    frame = pandas.DataFrame(
        {
            name: pandas.array(_column(document, path), dtype=types.get(kind, "object"))
            for name, kind, path in COLUMNS
        }
    )
    frame.attrs.update({key: document[key] for key in ("scenario", "measure", "measure_unit")})
    return frame
