"""ROS 2 bags of Autoware: predicted objects and the odometry of the ego."""

from __future__ import annotations

import math
import os
from typing import Any

from ._boxes import oriented_box
from ._document import Imported, make_document
from ._refusals import (
    checked_choices,
    checked_file,
    choice_error,
    guarded_parse,
    refuse,
    refuse_size,
    required_module,
)
from ._scene import (
    DEFAULT_SIZE_M,
    ORIGIN_SHARE,
    Body,
    Pose,
    Report,
    Scene,
    State,
    Track,
    completed_size,
    kind_by_size,
    moved,
)
from ._tracks import checked_track

MAX_BYTES = 8 * 2**30
MAX_MESSAGE = 64 * 2**20
MAX_MESSAGES = 1_000_000
MAX_OBJECTS = 5_000
MAX_PATHS = 32
_MARGIN_S = 2.0
_OBJECTS = (
    "autoware_perception_msgs/msg/PredictedObjects",
    "autoware_auto_perception_msgs/msg/PredictedObjects",
)
_ODOMETRY = "nav_msgs/msg/Odometry"
# Of the square of a quaternion's length, as of tf2.
_UNIT_TOLERANCE = 0.01
_USUAL_TOPIC = "/localization/kinematic_state"

# Members of the messages, for bags that do not hold their definitions.
_DEFINITIONS = {
    "ObjectClassification": "uint8 label\nfloat32 probability",
    "PredictedPath": "geometry_msgs/Pose[] path\nbuiltin_interfaces/Duration time_step\n"
    "float32 confidence",
    "Shape": "uint8 type\ngeometry_msgs/Polygon footprint\ngeometry_msgs/Vector3 dimensions",
    "PredictedObjectKinematics": "geometry_msgs/PoseWithCovariance initial_pose_with_covariance\n"
    "geometry_msgs/TwistWithCovariance initial_twist_with_covariance\n"
    "geometry_msgs/AccelWithCovariance initial_acceleration_with_covariance\n"
    "{package}/PredictedPath[] predicted_paths",
    "PredictedObject": "unique_identifier_msgs/UUID object_id\nfloat32 existence_probability\n"
    "{package}/ObjectClassification[] classification\n"
    "{package}/PredictedObjectKinematics kinematics\n{package}/Shape shape",
    "PredictedObjects": "std_msgs/Header header\n{package}/PredictedObject[] objects",
}
_LABELS = {
    1: "car",
    2: "truck",
    3: "bus",
    4: "truck",
    5: "motorcycle",
    6: "bicycle",
    7: "pedestrian",
}
_CYLINDER, _POLYGON = 1, 2


def typestore() -> Any:
    """Return the types of ROS 2 with those of Autoware's predicted objects."""
    types = required_module("rosbags.typesys", "rosbags", "ros")
    store = types.get_typestore(types.Stores.ROS2_HUMBLE)
    found: dict[str, Any] = {}
    for package in ("autoware_perception_msgs", "autoware_auto_perception_msgs"):
        for name, text in _DEFINITIONS.items():
            definition = text.replace("{package}", package)
            found.update(types.get_types_from_msg(definition, f"{package}/msg/{name}"))
    store.register(found)
    return store


def read_bag(
    path: object,
    time_s: float | None = None,
    ego: str | None = None,
    *,
    horizon_s: float = 4.0,
) -> Imported:
    """Read a ROS 2 bag with Autoware's PredictedObjects and an Odometry; needs ``crashrank[ros]``.

    Parameters
    ----------
    path : path
        Folder of a bag with its ``metadata.yaml``.
    time_s : float, optional
        Moment of decision, seconds after the first predicted objects. Default: 0.
    ego : str, optional
        Topic of the ego's odometry. Default: ``/localization/kinematic_state``, else the only one.
    horizon_s : float, default 4
        Seconds after the moment of decision that count.
    """
    chosen, at_s, horizon = checked_choices(ego, time_s, horizon_s)
    at_s = at_s or 0.0
    reader = required_module("rosbags.highlevel", "rosbags", "ros")
    folder = _checked_folder(path)
    report = Report("ROS 2 bag", folder)
    store = typestore()
    import pathlib

    def read() -> Imported:
        with reader.AnyReader([pathlib.Path(folder)], default_typestore=store) as bag:
            return _read(_Bag(bag, folder), chosen, at_s, horizon, report)

    return guarded_parse(folder, "ROS 2 bag", read)


def _checked_folder(path: object) -> str:
    """Return the folder of a bag, its size checked before anything is read."""
    from .._checks import as_path
    from .._errors import NotFoundError

    folder = as_path(path, "path")
    if not os.path.isdir(folder):
        what = "is no folder" if os.path.exists(folder) else "is not there"
        raise NotFoundError(
            "not_found", folder, "", what, "name the folder of a bag, the one of metadata.yaml"
        )
    checked_file(os.path.join(folder, "metadata.yaml"), MAX_MESSAGE)
    size = 0
    with os.scandir(folder) as entries:
        for entry in entries:
            if not entry.is_file() or entry.is_symlink():
                continue
            size += entry.stat().st_size
    if size > MAX_BYTES:
        refuse_size(
            folder, "", f"has {size} bytes, at most {MAX_BYTES} are read", "cut out what matters"
        )
    return folder


class _Bag:
    """Messages of an open bag, by type."""

    def __init__(self, bag: Any, file: str) -> None:
        self._bag = bag
        self.file = file

    def topics(self, *types: str) -> list[str]:
        """Return the topics of these types."""
        return sorted({c.topic for c in self._bag.connections if c.msgtype in types})

    def messages(self, topic: str) -> Any:
        """Return the stamps of messages of a topic, s, and functions that read them."""
        connections = [c for c in self._bag.connections if c.topic == topic]
        for i, (connection, log_ns, data) in enumerate(self._bag.messages(connections)):
            place = f"{topic}, message {i + 1}"
            if i >= MAX_MESSAGES or len(data) > MAX_MESSAGE:
                refuse_size(self.file, place, "is beyond the limits", "cut out what matters")
            message = self._bag.deserialize(data, connection.msgtype)
            stamp = message.header.stamp
            seconds = stamp.sec + 1e-9 * stamp.nanosec
            yield place, seconds if stamp.sec else 1e-9 * log_ns, message


def _read(bag: _Bag, chosen: str | None, at_s: float, horizon_s: float, report: Report) -> Imported:
    topics = bag.topics(*_OBJECTS)
    if not topics:
        refuse(bag.file, "", "has no PredictedObjects of Autoware", "record that topic")
    if len(topics) > 1:
        report.leave_out(f"topics {', '.join(topics[1:])}")
    latest: tuple[str, float, Any] | None = None
    first_s: float | None = None
    for place, stamp_s, message in bag.messages(topics[0]):
        first_s = stamp_s if first_s is None else first_s
        if latest is None or stamp_s <= first_s + at_s + 1e-6:
            latest = (place, stamp_s, message)
        else:
            break
    if latest is None or first_s is None:
        refuse(bag.file, topics[0], "has no message", "record some")
    place, stamp_s, message = latest
    if at_s - (stamp_s - first_s) > 1.0:
        report.warn(f"the last objects are {at_s - (stamp_s - first_s):.3g} s old")
    frame = message.header.frame_id
    own = _ego(bag, chosen, first_s, at_s, (place, frame), report)
    if len(message.objects) > MAX_OBJECTS:
        refuse_size(bag.file, place, f"has more than {MAX_OBJECTS} objects", "leave some out")
    bodies = [
        _body(bag.file, place, i, each, stamp_s - first_s, report)
        for i, each in enumerate(message.objects)
    ]
    report.leave_out("the map: the road has no end")
    name = os.path.basename(os.path.normpath(bag.file)) or "bag"
    return make_document(Scene(name, at_s, own, bodies, report, horizon_s=horizon_s))


def _ego(
    bag: _Bag, chosen: str | None, first_s: float, at_s: float, objects: tuple[str, str],
    report: Report,
) -> Body:  # fmt: skip
    """Return the body of an odometry; `objects` are the place and the frame of the objects."""
    topics = bag.topics(_ODOMETRY)
    topic = chosen if chosen is not None else (_USUAL_TOPIC if _USUAL_TOPIC in topics else None)
    if topic is None and len(topics) == 1:
        topic = topics[0]
    if topic not in topics:
        listed = f"choose of {', '.join(topics)}" if topics else "record one"
        where = "a usual topic" if topic is None else repr(topic)
        raise choice_error(bag.file, "ego", f"has no Odometry on {where}", listed)
    length, width, height = DEFAULT_SIZE_M["car"]
    ahead = (0.5 - ORIGIN_SHARE["car"]) * length
    states: list[State] = []
    older = 0
    for place, stamp_s, message in bag.messages(topic):
        if message.header.frame_id != objects[1]:
            refuse(
                bag.file, place,
                f"is in frame {message.header.frame_id!r}, {objects[0]} in {objects[1]!r}",
                "transform both to one frame and record them again",
            )  # fmt: skip
        t_s = stamp_s - first_s
        if t_s < at_s - _MARGIN_S:
            older += 1
            states.clear()  # the last of the older ones is enough
        axle = _pose(bag.file, place, message.pose.pose)
        velocity, rate = _twist(bag.file, place, axle.yaw_rad, message.twist.twist)
        middle = moved(axle, ahead, 0.0)
        # The middle of the box moves sideways as the vehicle turns about its rear axle.
        turning = (-math.sin(axle.yaw_rad) * rate * ahead, math.cos(axle.yaw_rad) * rate * ahead)
        velocity = (velocity[0] + turning[0], velocity[1] + turning[1])
        states.append(State(t_s, middle, velocity, rate))
        if t_s > at_s + _MARGIN_S:
            break
    # A bag of one message is a snapshot, whose ego is moved on; a recording that has ended is not.
    if not states or (older > 1 and states[-1].t_s < at_s - _MARGIN_S):
        refuse(bag.file, topic, f"has no message near {at_s:g} s", "choose another time")
    report.assume(
        f"the ego is a car of {length:g} x {width:g} m, and its odometry that of its rear axle"
    )
    track = Track(checked_track(states))
    return Body(topic, topic, "car", (length, width, height), [track])


def _pose(file: str, place: str, pose: Any) -> Pose:
    """Return position and heading of a pose, its rotation a quaternion."""
    q = pose.orientation
    numbers = (pose.position.x, pose.position.y, q.x, q.y, q.z, q.w)
    if not all(math.isfinite(value) and abs(value) < 1e8 for value in numbers):
        refuse(file, place, "has a pose that is not finite", "remove it")
    if abs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1.0) > _UNIT_TOLERANCE:
        refuse(file, place, "has a rotation that is no unit quaternion", "normalise it")
    yaw = math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))
    return Pose(pose.position.x, pose.position.y, yaw)


def _twist(file: str, place: str, yaw_rad: float, twist: Any) -> tuple[tuple[float, float], float]:
    """Return the velocity in the map and the yaw rate of a twist in the body's axes."""
    ahead, left, rate = twist.linear.x, twist.linear.y, twist.angular.z
    if not all(math.isfinite(value) and abs(value) < 1e4 for value in (ahead, left, rate)):
        refuse(file, place, "has a velocity that is not finite", "remove it")
    cosine, sine = math.cos(yaw_rad), math.sin(yaw_rad)
    return (cosine * ahead - sine * left, sine * ahead + cosine * left), rate


def _body(file: str, place: str, i: int, found: Any, stamp_s: float, report: Report) -> Body:
    name = f"object {bytes(found.object_id.uuid).hex()[:8]}"
    place = f"{place}, {name} (number {i + 1})"
    kinematics = found.kinematics
    pose = _pose(file, place, kinematics.initial_pose_with_covariance.pose)
    twist = kinematics.initial_twist_with_covariance.twist
    velocity, rate = _twist(file, place, pose.yaw_rad, twist)
    shape = found.shape
    sides, middle = _box(shape)
    kind = _kind(found, sides, name, report)
    size = completed_size(kind, *sides, report, name)
    offset = (middle.x_m, middle.y_m)
    now = State(stamp_s, moved(pose, *offset), velocity, rate)
    tracks = []
    for p, predicted in enumerate(list(kinematics.predicted_paths)[:MAX_PATHS]):
        path = f"{place}, predicted path {p + 1}"
        step_s = predicted.time_step.sec + 1e-9 * predicted.time_step.nanosec
        confidence = float(predicted.confidence)
        if not (step_s > 0.0 and 0.0 <= confidence < math.inf):
            refuse(
                file, path, f"has a time_step of {step_s:g} s and the confidence {confidence:g}",
                "give a time_step above 0 and a finite confidence, or remove the path",
            )  # fmt: skip
        if not confidence:
            report.leave_out(f"{name}: predicted paths of confidence 0")
            continue
        states = [now]
        for k, each in enumerate(list(predicted.path)[:2_000]):
            if k:
                at = moved(_pose(file, path, each), *offset)
                states.append(State(stamp_s + k * step_s, at))
        tracks.append(Track(states, confidence))
    if len(kinematics.predicted_paths) > MAX_PATHS:
        report.warn(f"{name}: only {MAX_PATHS} predicted paths are read")
    existence = float(found.existence_probability)
    return Body(
        name, place, kind, size, tracks or [Track([now])],
        existence_probability=min(max(existence, 0.0), 1.0) if math.isfinite(existence) else 1.0,
    )  # fmt: skip


def _box(shape: Any) -> tuple[tuple[float, float, float], Pose]:
    """Return the sides of a shape and where its middle lies from its pose, in its axes."""
    x, y, z = (
        side if math.isfinite(side) and 0.0 < side < 500.0 else 0.0
        for side in (shape.dimensions.x, shape.dimensions.y, shape.dimensions.z)
    )
    if shape.type == _CYLINDER:
        return (x, x, z), Pose(0.0, 0.0, 0.0)
    points = [(float(p.x), float(p.y)) for p in list(shape.footprint.points)[:2_000]]
    points = [p for p in points if math.isfinite(p[0]) and math.isfinite(p[1])]
    if shape.type == _POLYGON and len(points) > 2:
        middle, length, width = oriented_box(points, 0.0)
        return (length, width, z), middle
    return (x, y, z), Pose(0.0, 0.0, 0.0)


def _kind(found: Any, sides: tuple[float, float, float], name: str, report: Report) -> str:
    """Return the kind of the most probable label."""
    labels = sorted(found.classification, key=lambda each: -each.probability)
    kind = _LABELS.get(labels[0].label) if labels else None
    if kind is None:
        kind = kind_by_size(sides) if sides[0] and sides[1] else "car"
        report.assume(f"its label is not known; by its size it is a {kind}", name)
    return kind
