"""ASAM OSI ground truth: traces of length-prefixed messages (.osi) and MCAP files."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, field
from typing import Any

from ._document import Imported, make_document
from ._osi_messages import trace_messages
from ._refusals import (
    checked_choices,
    checked_file,
    choice_error,
    refuse,
    refuse_size,
    required_module,
)
from ._road import areas_between, reach_of
from ._scene import (
    LONGEST_CAR_M,
    VEHICLES,
    Body,
    Pose,
    Report,
    Ring,
    Scene,
    State,
    Track,
    completed_size,
    kind_by_size,
)
from ._tracks import checked_track, forward_speed, state_at

MAX_BYTES = 2**30
MAX_STATES = 3_000_000
# Seconds around the moment of decision and the horizon of which states are kept.
_MARGIN_S = 2.0
_JOIN_M = 0.5

_VEHICLES = {
    "TYPE_SMALL_CAR": "car",
    "TYPE_COMPACT_CAR": "car",
    "TYPE_CAR": "car",
    "TYPE_MEDIUM_CAR": "car",
    "TYPE_LUXURY_CAR": "car",
    "TYPE_DELIVERY_VAN": "car",
    "TYPE_HEAVY_TRUCK": "truck",
    "TYPE_SEMITRACTOR": "truck",
    "TYPE_SEMITRAILER": "truck",
    "TYPE_TRAILER": "truck",
    "TYPE_BUS": "bus",
    "TYPE_TRAM": "bus",
    "TYPE_TRAIN": "truck",
    "TYPE_MOTORBIKE": "motorcycle",
    "TYPE_BICYCLE": "bicycle",
    "TYPE_WHEELCHAIR": "pedestrian",
    "TYPE_STANDUP_SCOOTER": "pedestrian",
}
_STANDING = {
    "TYPE_POLE": "pole",
    "TYPE_PYLON": "pole",
    "TYPE_DELINEATOR": "pole",
    "TYPE_TREE": "pole",
    "TYPE_STREET_LIGHT": "pole",
    "TYPE_BARRIER": "barrier",
    "TYPE_TRAFFIC_BARRIER": "barrier",
    "TYPE_CONSTRUCTION_SITE_ELEMENT": "barrier",
}
_DRIVABLE = ("TYPE_DRIVING", "TYPE_INTERSECTION", "TYPE_UNKNOWN", "TYPE_OTHER")


def read_osi(
    path: object,
    time_s: float | None = None,
    ego: str | int | None = None,
    *,
    horizon_s: float = 4.0,
) -> Imported:
    """Read a trace of OSI ground truth; needs ``crashrank[osi]``.

    What the trace says of later times is how bodies move. What only its first message has, lanes
    and standing objects, holds for all.

    Parameters
    ----------
    path : path
        A ``.osi`` file of GroundTruth messages, or of SensorView messages where its name has
        ``_sv_``, each behind its length; or a ``.mcap`` file with either.
    time_s : float, optional
        Moment of decision, seconds after the first message. Default: 0.
    ego : str or int, optional
        Id of a moving object. Default: the host vehicle, where the trace names it.
    horizon_s : float, default 4
        Seconds after the moment of decision that count.
    """
    chosen, at_s, horizon = checked_choices(ego, time_s, horizon_s)
    at_s = at_s or 0.0
    required_module("osi3", "osi-python", "osi")
    file, _ = checked_file(path, MAX_BYTES)
    report = Report("OSI ground truth", file)
    trace = _Trace(file, at_s, horizon)
    for place, message in trace_messages(file):
        trace.add(place, message)
    if trace.count > 1 and trace.last_s <= 0.0:
        refuse(file, "", "has messages of one time alone", "give each message its timestamp")
    if not trace.tracks or at_s < 0.0:
        span = f"the trace has 0 to {trace.last_s:g} s" if trace.count else "it has no message"
        refuse(file, "", f"has no moving object at {at_s:g} s", f"choose another time: {span}")
    bodies = {str(key): _body(key, each, report) for key, each in trace.tracks.items()}
    name = _ego_name(bodies, chosen, trace, report)
    standing = [
        body for each in trace.standing.values() if (body := _standing(each, report)) is not None
    ]
    others = [body for key, body in bodies.items() if key != name] + standing
    start = state_at(bodies[name].tracks[0], at_s)
    areas = _areas(trace, start, horizon, report)
    return make_document(
        Scene(os.path.basename(file), at_s, bodies[name], others, report, areas, horizon)
    )


@dataclass
class _Object:
    """A moving object of a trace: its last message and its states."""

    last: Any
    states: list[State] = field(default_factory=list)


class _Trace:
    """Messages of a trace around the moment of decision."""

    def __init__(self, file: str, at_s: float, horizon_s: float) -> None:
        self._file = file
        self._low_s, self._high_s = at_s - _MARGIN_S, at_s + horizon_s + _MARGIN_S
        self._first: float | None = None
        self._states = 0
        self.last_s = 0.0
        self.count = 0
        self.host: int | None = None
        self.tracks: dict[int, _Object] = {}
        self.standing: dict[int, Any] = {}
        self.lanes: list[Any] = []
        self.boundaries: dict[int, Any] = {}

    def add(self, place: str, message: Any) -> None:
        """Take a message: what stands always, states within the seconds that count."""
        self.count += 1
        stamp = message.timestamp
        clock = stamp.seconds + 1e-9 * stamp.nanos
        self._first = clock if self._first is None else self._first
        t_s = clock - self._first
        if t_s < self.last_s:
            refuse(self._file, place, f"is of {t_s:g} s, the one before of {self.last_s:g} s",
                   "write the messages in order of time")  # fmt: skip
        self.last_s = t_s
        if message.HasField("host_vehicle_id"):
            self.host = message.host_vehicle_id.value
        for each in message.stationary_object:
            self.standing.setdefault(each.id.value, each)
        if message.lane and not self.lanes:
            self.lanes = list(message.lane)
            self.boundaries = {each.id.value: each for each in message.lane_boundary}
        if not self._low_s <= t_s <= self._high_s:
            return
        self._states += len(message.moving_object)
        if self._states > MAX_STATES:
            refuse_size(self._file, place, f"is beyond {MAX_STATES} states", "cut out what matters")
        seen: set[int] = set()
        for each in message.moving_object:
            if each.id.value in seen:
                refuse(self._file, f"{place}, moving object {each.id.value}", "is there twice",
                       "give each object an id of its own")  # fmt: skip
            seen.add(each.id.value)
            state = _state(self._file, place, each, t_s)
            self.tracks.setdefault(each.id.value, _Object(each)).states.append(state)


def _state(file: str, place: str, moving: Any, t_s: float) -> State:
    base = moving.base
    numbers = (
        base.position.x, base.position.y, base.position.z, base.orientation.yaw,
        base.velocity.x, base.velocity.y, base.orientation_rate.yaw,
    )  # fmt: skip
    if not (
        base.HasField("position")
        and all(math.isfinite(value) and abs(value) < 1e8 for value in numbers)
    ):
        refuse(file, f"{place}, moving object {moving.id.value}", "has no finite pose", "remove it")
    velocity = (base.velocity.x, base.velocity.y) if base.HasField("velocity") else None
    rate = base.orientation_rate.yaw if base.HasField("orientation_rate") else None
    return State(t_s, Pose(base.position.x, base.position.y, base.orientation.yaw), velocity, rate)


def _sides(base: Any) -> tuple[float, float, float]:
    sides = (base.dimension.length, base.dimension.width, base.dimension.height)
    length, width, height = (
        side if math.isfinite(side) and 0.0 < side < 500.0 else 0.0 for side in sides
    )
    return length, width, height


def _body(key: int, found: _Object, report: Report) -> Body:
    moving = found.last
    sides = _sides(moving.base)
    kind = _moving_kind(moving, sides, f"object {key}", report)
    name = f"{kind} {key}"
    size = completed_size(kind, *sides, report, name)
    attributes = moving.vehicle_attributes
    wheelbase = attributes.bbcenter_to_front.x - attributes.bbcenter_to_rear.x
    stated = moving.HasField("vehicle_attributes") and math.isfinite(wheelbase) and wheelbase > 0.5
    ground = moving.base.position.z - size[2] / 2
    return Body(
        name,
        f"moving object {key}",
        kind,
        size,
        [Track(checked_track(found.states))],
        wheelbase_m=wheelbase if stated and kind in VEHICLES else None,
        ground_m=round(ground, 1) if math.isfinite(ground) else 0.0,
    )


def _moving_kind(moving: Any, sides: tuple[float, float, float], name: str, report: Report) -> str:
    stated = _enum_name(moving, "type")
    if stated in ("TYPE_PEDESTRIAN", "TYPE_ANIMAL"):
        if stated == "TYPE_ANIMAL":
            report.assume("animals are persons", name)
        return "pedestrian"
    found = _VEHICLES.get(_enum_name(moving.vehicle_classification, "type"))
    if found == "car" and sides[0] > LONGEST_CAR_M:
        report.assume(f"longer than {LONGEST_CAR_M:g} m, so it is a truck", name)
        return "truck"
    if found is None:
        found = kind_by_size(sides) if sides[0] and sides[1] else "car"
        report.assume(f"its type is not known; by its size it is a {found}", name)
    return found


def _enum_name(message: Any, field_name: str) -> str:
    """Return the name of an enumerator, empty for a number that this version does not know."""
    enum = message.DESCRIPTOR.fields_by_name[field_name].enum_type
    value = enum.values_by_number.get(getattr(message, field_name))
    return "" if value is None else str(value.name)


def _standing(found: Any, report: Report) -> Body | None:
    name = f"stationary object {found.id.value}"
    base = found.base
    where = (base.position.x, base.position.y, base.position.z, base.orientation.yaw)
    if not all(math.isfinite(value) and abs(value) < 1e8 for value in where):
        report.leave_out(f"{name}: it has no finite pose")
        return None
    sides = _sides(base)
    kind = _STANDING.get(_enum_name(found.classification, "type"), "building")
    if not (sides[0] and sides[1]):
        report.leave_out(f"{name}: it has no dimensions")
        return None
    size = completed_size(kind, *sides, report, name)
    state = State(0.0, Pose(where[0], where[1], where[3]), (0.0, 0.0), 0.0)
    ground = round(where[2] - size[2] / 2, 1)
    return Body(name, name, kind, size, [Track([state])], stands=True, ground_m=ground)


def _ego_name(bodies: dict[str, Body], chosen: str | None, trace: _Trace, report: Report) -> str:
    vehicles = [name for name, body in bodies.items() if body.kind in VEHICLES]
    listed = f"choose of {', '.join(vehicles)}" if vehicles else "it has no vehicle"
    if chosen is None:
        if trace.host is None:
            raise choice_error(
                report.file, "ego", "is not named: the trace has no host vehicle", listed
            )
        chosen = str(trace.host)
    if chosen not in bodies:
        raise choice_error(report.file, "ego", f"has no moving object {chosen!r} then", listed)
    return chosen


def _areas(trace: _Trace, ego: State, horizon_s: float, report: Report) -> list[Ring]:
    """Return lanes between their boundaries; lanes without both are left out."""
    lines: list[tuple[Ring, Ring]] = []
    open_lanes = 0
    for lane in trace.lanes:
        classification = lane.classification
        if _enum_name(classification, "type") not in _DRIVABLE:
            continue
        left = _line(trace, classification.left_lane_boundary_id)
        right = _line(trace, classification.right_lane_boundary_id)
        if len(left) < 2 or len(right) < 2:
            open_lanes += 1
            continue
        same = math.dist(left[0], right[0]) + math.dist(left[-1], right[-1])
        crossed = math.dist(left[0], right[-1]) + math.dist(left[-1], right[0])
        lines.append((left, right if same <= crossed else right[::-1]))
    if open_lanes:
        report.leave_out(f"{open_lanes} lanes without boundaries on both sides")
    return areas_between(lines, ego.pose, reach_of(forward_speed(ego), horizon_s), report)


def _line(trace: _Trace, ids: Any) -> Ring:
    """Return the points of some boundaries as one line, each put where it fits."""
    line: Ring = []
    for each in ids:
        boundary = trace.boundaries.get(each.value)
        points = [
            (point.position.x, point.position.y)
            for point in (boundary.boundary_line if boundary is not None else ())
            if math.isfinite(point.position.x) and math.isfinite(point.position.y)
        ]
        if line and points and math.dist(line[-1], points[0]) > _JOIN_M:
            if math.dist(line[-1], points[-1]) < math.dist(line[-1], points[0]):
                points.reverse()
            elif math.dist(line[0], points[-1]) < math.dist(line[-1], points[0]):
                line, points = points, line
        line = line + points
    return line[:2_000]
