"""Tables of poses: the CSV log of esmini, and a plain table that any tool can write."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from ._document import Imported, make_document
from ._refusals import (
    checked_choices,
    choice_error,
    decoded,
    number,
    read_bytes,
    refuse,
    refuse_size,
)
from ._scene import (
    DEFAULT_SIZE_M,
    FIXED,
    LONGEST_CAR_M,
    VEHICLES,
    Body,
    Pose,
    Report,
    Scene,
    State,
    Track,
    completed_size,
    kind_by_size,
    moved,
    velocity_along,
)
from ._tracks import checked_track

MAX_BYTES = 256 * 2**20
MAX_LINE = 1_000_000
MAX_ROWS = 2_000_000
MAX_BODIES = 5_000

_NEEDED = ("t_s", "id", "x_m", "y_m", "yaw_deg")
_OPTIONAL = (
    "kind", "length_m", "width_m", "height_m", "speed_mps", "prediction", "probability",
)  # fmt: skip
_ENTITY = re.compile(r"#(\d{1,4}) (.+)")
_ESMINI = {
    "name": ("Entity_Name [-]", "Entitity_Name [-]"),
    "speed": ("Current_Speed [m/s]",),
    "x": ("World_Position_X [m]",),
    "y": ("World_Position_Y [m]",),
    "yaw": ("World_Heading_Angle [rad]",),
    "bb_x": ("bb_x [m]",),
    "bb_y": ("bb_y [m]",),
    "length": ("bb_length [m]",),
    "width": ("bb_width [m]",),
    "height": ("bb_height [m]",),
}


def read_poses_csv(
    path: object,
    time_s: float | None = None,
    ego: str | int | None = None,
    *,
    horizon_s: float = 4.0,
) -> Imported:
    """Read a table of poses with the columns below, in any order, one pose a line.

    ``t_s``, ``id``, ``x_m``, ``y_m`` (middle of the box) and ``yaw_deg`` are needed. May be there:
    ``kind`` (of a scenario's models), ``length_m``, ``width_m``, ``height_m``, ``speed_mps`` (along
    the heading), and ``prediction`` with ``probability`` for bodies with several futures. What is
    constant of a body is read from its first line. Other columns are left out.

    Parameters
    ----------
    path : path
        Comma-separated values in UTF-8 with a header line.
    time_s : float, optional
        Moment of decision on the clock of ``t_s``. Default: the ego's first line.
    ego : str or int, optional
        Its id. Default: ``ego`` if a body has that id, else the first vehicle.
    horizon_s : float, default 4
        Seconds after the moment of decision that count.
    """
    chosen, at_s, horizon = checked_choices(ego, time_s, horizon_s)
    file, data = read_bytes(path, MAX_BYTES)
    report = Report("table of poses", file)
    rows = _rows(file, decoded(file, data))
    _, header = next(rows, (0, []))
    columns = {name: i for i, name in enumerate(header)}
    missing = [name for name in _NEEDED if name not in columns]
    if missing:
        refuse(
            file, "line 1", f"has no column {missing[0]}", f"name the columns {', '.join(_NEEDED)}"
        )
    if len(columns) < len(header):
        refuse(file, "line 1", "names a column twice", "name each column once")
    unread = [name for name in header if name not in _NEEDED + _OPTIONAL]
    if unread:
        report.leave_out(f"columns {', '.join(unread[:10])}")
    bodies: dict[str, _Rows] = {}
    for line, row in rows:
        if len(row) != len(header):
            refuse(file, f"line {line}", f"has {len(row)} values", f"give {len(header)}")
        _Pose(file, line, row, columns).add_to(bodies)
    found = {name: each.body(name, report) for name, each in bodies.items()}
    return _finish(found, chosen, at_s, horizon, report)


@dataclass
class _Rows:
    """What the lines of one body say."""

    line: int
    kind: str
    sides: tuple[float, float, float]
    # By prediction and time, with their lines.
    states: dict[str, dict[float, tuple[int, State]]] = field(default_factory=dict)
    probabilities: dict[str, float] = field(default_factory=dict)

    def body(self, name: str, report: Report) -> Body:
        kind = self.kind
        moves = any(len(states) > 1 for states in self.states.values())
        if not kind:
            kind = kind_by_size(self.sides) if self.sides[0] and self.sides[1] else "car"
            report.assume(f"no kind is stated, so it is a {kind}", name)
        size = completed_size(kind, *self.sides, report, name)
        tracks = [
            Track([state for _, (_, state) in sorted(states.items())], self.probabilities[key])
            for key, states in self.states.items()
        ]
        stands = kind in FIXED or (
            not moves and all(s.velocity_mps is None for t in tracks for s in t.states)
        )
        if stands:
            tracks = [Track(tracks[0].states[:1])]
        return Body(name, f"line {self.line}", kind, size, tracks, stands=stands)


class _Pose:
    """One line of a table of poses."""

    def __init__(self, file: str, line: int, row: list[str], columns: dict[str, int]) -> None:
        self._file, self._line, self._row, self._columns = file, line, row, columns

    def _text(self, name: str) -> str:
        return self._row[self._columns[name]] if name in self._columns else ""

    def _number(self, name: str, low: float, high: float) -> float:
        return number(self._text(name), self._file, f"line {self._line}, {name}", low, high)

    def add_to(self, bodies: dict[str, _Rows]) -> None:
        name, prediction = self._text("id"), self._text("prediction")
        place = f"line {self._line}"
        if not name:
            refuse(self._file, f"{place}, id", "is empty", "name the body")
        if name not in bodies:
            if len(bodies) == MAX_BODIES:
                refuse_size(
                    self._file, place, f"has more than {MAX_BODIES} bodies", "leave some out"
                )
            bodies[name] = self._new()
        rows = bodies[name]
        yaw = math.radians(self._number("yaw_deg", -1e5, 1e5))
        pose = Pose(self._number("x_m", -1e7, 1e7), self._number("y_m", -1e7, 1e7), yaw)
        velocity = None
        if self._text("speed_mps"):
            velocity = velocity_along(yaw, self._number("speed_mps", -150, 150))
        if prediction not in rows.states:
            stated = bool(self._text("probability"))
            probability = self._number("probability", 1e-9, 1.0) if stated else 1.0
            rows.states[prediction], rows.probabilities[prediction] = {}, probability
        t_s = self._number("t_s", -1e9, 1e10)
        row = (self._line, State(t_s, pose, velocity))
        first, _ = rows.states[prediction].setdefault(round(t_s, 9), row)
        if first != self._line:
            refuse(
                self._file, f"{place}, t_s", f"is {t_s:g}, as of {name} in line {first}",
                "leave one of both out",
            )  # fmt: skip

    def _new(self) -> _Rows:
        kind = self._text("kind")
        if kind and kind not in DEFAULT_SIZE_M:
            refuse(
                self._file, f"line {self._line}, kind", f"is {kind!r}",
                f"give one of {', '.join(DEFAULT_SIZE_M)}",
            )  # fmt: skip
        sides = [
            self._number(name, 0.01, 200) if self._text(name) else 0.0
            for name in ("length_m", "width_m", "height_m")
        ]
        return _Rows(self._line, kind, (sides[0], sides[1], sides[2]))


def read_esmini_csv(
    path: object,
    time_s: float | None = None,
    ego: str | int | None = None,
    *,
    horizon_s: float = 4.0,
) -> Imported:
    """Read the log that ``esmini --csv_logger`` writes.

    Parameters
    ----------
    path : path
        The log.
    time_s : float, optional
        Moment of decision on the log's clock. Default: its first line.
    ego : str or int, optional
        Name of an entity. Default: the one named Ego, Host or Hero, else the first.
    horizon_s : float, default 4
        Seconds after the moment of decision that count.
    """
    chosen, at_s, horizon = checked_choices(ego, time_s, horizon_s)
    file, data = read_bytes(path, MAX_BYTES)
    report = Report("esmini log", file)
    rows = _rows(file, decoded(file, data))
    header: list[str] = []
    for line, row in rows:
        if row and row[0].startswith("Index"):
            header = row
            break
        if line > 50:
            break
    if "TimeStamp [s]" not in header:
        refuse(
            file, "", "has no line of columns that begins with Index and TimeStamp [s]",
            "write it with esmini --csv_logger",
        )  # fmt: skip
    entities = _entities(file, header)
    clock = header.index("TimeStamp [s]")
    states: list[list[State]] = [[] for _ in entities]
    firsts: list[dict[str, str]] = [{} for _ in entities]
    for line, row in rows:
        if not row[clock : clock + 1] or not row[clock].strip() or row[clock] == "-":
            continue
        t_s = number(row[clock], file, f"line {line}, TimeStamp [s]", -1e9, 1e9)
        for i, columns in enumerate(entities):
            words = {key: row[at] if at < len(row) else "" for key, at in columns.items()}
            if not words["x"]:
                continue  # an entity that is not there yet, or no more
            firsts[i] = firsts[i] or words
            states[i].append(_logged(file, line, i, words, t_s))
    found: dict[str, Body] = {}
    for i, words in enumerate(firsts):
        if states[i]:
            name = words.get("name") or f"#{i + 1}"
            while name in found:
                name += "'"
            found[name] = _logged_body(file, i, name, words, states[i], report)
    return _finish(found, chosen, at_s, horizon, report)


def _entities(file: str, header: list[str]) -> list[dict[str, int]]:
    """Return the columns of each entity by what they hold."""
    by_number: dict[int, dict[str, int]] = {}
    for i, name in enumerate(header):
        match = _ENTITY.fullmatch(name)
        if match:
            by_number.setdefault(int(match[1]), {})[match[2]] = i
    found = []
    for which, columns in sorted(by_number.items()):
        known = {
            key: columns[name]
            for key, names in _ESMINI.items()
            for name in names
            if name in columns
        }
        for key in ("x", "y", "yaw"):
            if key not in known:
                refuse(
                    file, f"#{which}", f"has no column {_ESMINI[key][0]}",
                    "write it with esmini --csv_logger",
                )  # fmt: skip
        found.append(known)
    if not found:
        refuse(file, "", "has no entities", "write it with esmini --csv_logger")
    return found


def _logged(file: str, line: int, i: int, words: dict[str, str], t_s: float) -> State:
    """Return the state of the middle of an entity's box; a log has its reference point."""

    def value(key: str, low: float, high: float) -> float:
        place = f"line {line}, #{i + 1} {_ESMINI[key][0]}"
        return number(words[key], file, place, low, high) if words.get(key) else 0.0

    yaw = value("yaw", -1e4, 1e4)
    reference = Pose(value("x", -1e7, 1e7), value("y", -1e7, 1e7), yaw)
    middle = moved(reference, value("bb_x", -100, 100), value("bb_y", -100, 100))
    speed = velocity_along(yaw, value("speed", -150, 150)) if words.get("speed") else None
    return State(t_s, middle, speed)


def _logged_body(
    file: str, i: int, name: str, words: dict[str, str], states: list[State], report: Report
) -> Body:
    length, width, height = (
        number(words[key], file, f"#{i + 1} {_ESMINI[key][0]}", 0, 200) if words.get(key) else 0.0
        for key in ("length", "width", "height")
    )
    kind = kind_by_size((length, width, height)) if length > 0 and width > 0 else "car"
    if kind == "car" and length > LONGEST_CAR_M:
        kind = "truck"
    report.assume(f"a log states no kind; by its size it is a {kind}", name)
    size = completed_size(kind, length, width, height, report, name)
    return Body(name, f"#{i + 1}", kind, size, [Track(checked_track(states))])


def _rows(file: str, text: str) -> Iterator[tuple[int, list[str]]]:
    """Return the lines' numbers and stripped values; blank lines are left out."""
    reader = csv.reader(io.StringIO(text, newline=""), skipinitialspace=True)
    count = 0
    previous = csv.field_size_limit(MAX_LINE)
    try:
        for row in reader:
            count += 1
            if count > MAX_ROWS:
                refuse_size(
                    file, f"line {reader.line_num}", f"has more than {MAX_ROWS} rows", "shorten it"
                )
            values = [value.strip() for value in row]
            if any(values):
                yield reader.line_num, values
    except csv.Error as error:
        refuse(file, f"line {reader.line_num}", f"is no CSV: {error}", "write the file again")
    finally:
        csv.field_size_limit(previous)


def _finish(
    bodies: dict[str, Body], chosen: str | None, at_s: float | None, horizon: float, report: Report
) -> Imported:
    """Return the scenario of some bodies, one of which decides."""
    if not bodies:
        refuse(report.file, "", "has no poses", "give one pose a line")
    name = ego_of(bodies, chosen, report)
    ego = bodies[name]
    others = [body for other, body in bodies.items() if other != name]
    time_s = ego.tracks[0].states[0].t_s if at_s is None else at_s
    return make_document(Scene(report.format, time_s, ego, others, report, horizon_s=horizon))


def ego_of(bodies: dict[str, Body], chosen: str | None, report: Report) -> str:
    """Return the name of the ego among bodies: as chosen, else by usual names, else the first."""
    if chosen is not None:
        if chosen not in bodies:
            raise choice_error(
                report.file, "ego", f"has no body {chosen!r}", f"choose of {', '.join(bodies)}"
            )
        return chosen
    for name in bodies:
        if name.lower() in ("ego", "host", "hero"):
            return name
    for name, body in bodies.items():
        if body.kind in VEHICLES:
            report.assume(f"{name} is the ego: the first vehicle")
            return name
    raise choice_error(report.file, "ego", "has no vehicle", "choose another file")
