"""What every reader returns: bodies, the ego, the road and a report, before they are a scenario.

Positions are in m in the file's plane, x and y; headings in rad, counter-clockwise; times in s on
the file's clock. A state's position is the middle of the body's box. crashrank's origin is another
point, the middle of the rear axle on the ground: `origin_of_box` converts.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, NamedTuple

MAX_POSITION_M = 100_000.0
VEHICLES = ("car", "truck", "bus", "motorcycle", "bicycle")
FIXED = ("barrier", "pole", "building")
LONGEST_CAR_M = 7.5

# Length, width and height, m, of a body whose file states none, by kind. Choices: an estate car, a
# two-axled lorry, a city bus, a motorcycle and a bicycle with their riders, a standing adult.
DEFAULT_SIZE_M: dict[str, tuple[float, float, float]] = {
    "car": (4.5, 1.8, 1.5),
    "truck": (8.0, 2.5, 3.5),
    "bus": (12.0, 2.55, 3.0),
    "motorcycle": (2.1, 0.8, 1.5),
    "bicycle": (1.8, 0.6, 1.75),
    "pedestrian": (0.5, 0.5, 1.75),
    "barrier": (4.0, 0.6, 0.8),
    "pole": (0.3, 0.3, 6.0),
    "building": (10.0, 10.0, 5.0),
}

# Distance from the rear end to the origin as a share of the length, of bodies that are known by
# their box. The origin of the others is the middle.
ORIGIN_SHARE: dict[str, float] = {
    "car": 0.2,
    "truck": 0.25,
    "bus": 0.27,
    "motorcycle": 0.17,
    "bicycle": 0.19,
}


class Pose(NamedTuple):
    """Position and heading in the plane, m and rad."""

    x_m: float
    y_m: float
    yaw_rad: float


def origin_of_box(centre: Pose, kind: str, length_m: float) -> Pose:
    """Return the pose of a body's origin from that of the middle of its box.

    The origin lies on the box's axis, at `ORIGIN_SHARE` of the length from the rear end.
    """
    ahead = (ORIGIN_SHARE.get(kind, 0.5) - 0.5) * length_m
    return moved(centre, ahead, 0.0)


def moved(pose: Pose, ahead_m: float, left_m: float, turned_rad: float = 0.0) -> Pose:
    """Return the pose that lies ahead and to the left of another, in its axes, and is turned."""
    cosine, sine = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
    return Pose(
        pose.x_m + cosine * ahead_m - sine * left_m,
        pose.y_m + sine * ahead_m + cosine * left_m,
        wrapped(pose.yaw_rad + turned_rad),
    )


def wrapped(angle_rad: float) -> float:
    """Return an angle within -pi and pi."""
    return math.remainder(angle_rad, math.tau)


@dataclass(frozen=True)
class State:
    """A body at one time: the middle of its box, and its velocity where the file states it."""

    t_s: float
    pose: Pose
    velocity_mps: tuple[float, float] | None = None
    yaw_rate_radps: float | None = None


def velocity_along(yaw_rad: float, speed_mps: float) -> tuple[float, float]:
    """Return the velocity of a body that moves along its heading."""
    return speed_mps * math.cos(yaw_rad), speed_mps * math.sin(yaw_rad)


@dataclass
class Track:
    """States of a body by rising time, and how probable it is that it moves so."""

    states: list[State]
    probability: float = 1.0


@dataclass
class Body:
    """Something with a box. Several tracks exclude each other; one state means constant velocity.

    Attributes
    ----------
    name : str
        As the file names it; made unique later.
    place : str
        Where the file states it, for messages.
    size_m : tuple of float
        Length, width and height, m.
    tracks : list of Track
        At least one, of at least one state each.
    stands : bool
        Whether it never moves; its track has one state, valid at all times.
    """

    name: str
    place: str
    kind: str
    size_m: tuple[float, float, float]
    tracks: list[Track]
    stands: bool = False
    existence_probability: float = 1.0
    mass_kg: float | None = None
    wheelbase_m: float | None = None
    ground_m: float = 0.0


Ring = list[tuple[float, float]]


@dataclass
class Report:
    """What a reader took, left out and assumed; every entry is one line.

    Attributes
    ----------
    format, file : str
        What was read.
    time_s : float
        Moment of decision on the file's clock, time 0 of the scenario.
    ego : str
        What decides.
    bodies : int
        Number of actors of the scenario.
    areas : int
        Number of drivable areas of the scenario.
    left_out : list of str
        Elements of the file that are not in the scenario, and why.
    warnings : list of str
        What makes the answer doubtful: recorded overlaps, jumps, bodies that appear late.
    """

    format: str
    file: str
    time_s: float = 0.0
    ego: str = ""
    bodies: int = 0
    areas: int = 0
    left_out: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    _assumed: dict[str, list[str]] = field(default_factory=dict)

    def assume(self, text: str, name: str = "") -> None:
        """Add an assumption once; bodies of which the same is assumed share a line."""
        names = self._assumed.setdefault(text, [])
        if name and name not in names:
            names.append(name)

    @property
    def assumed(self) -> list[str]:
        """Values that the file does not state."""
        found = []
        for text, names in self._assumed.items():
            more = f" and {len(names) - 5} more" if len(names) > 5 else ""
            found.append(f"{', '.join(names[:5])}{more}: {text}" if names else text)
        return found

    def leave_out(self, text: str) -> None:
        """Add something that is not read, once."""
        if text not in self.left_out:
            self.left_out.append(text)

    def warn(self, text: str) -> None:
        """Add a warning once."""
        if text not in self.warnings:
            self.warnings.append(text)

    def to_dict(self) -> dict[str, Any]:
        """Return the members as plain dicts and lists."""
        members = {name: value for name, value in vars(self).items() if name != "_assumed"}
        return {**members, "assumed": self.assumed}

    def lines(self) -> list[str]:
        """Return the report as text, a line for each entry."""
        found = [
            f"{self.file}: {self.format}, ego {self.ego} at {self.time_s:g} s, "
            f"{counted(self.bodies, 'other body', 'other bodies')}, "
            f"{counted(self.areas, 'drivable area', 'drivable areas')}"
        ]
        for title, entries in (
            ("assumed", self.assumed),
            ("left out", self.left_out),
            ("warning", self.warnings),
        ):
            found += [f"{title}: {entry}" for entry in entries]
        return found


@dataclass
class Scene:
    """A file at one moment of decision."""

    name: str
    time_s: float
    ego: Body
    bodies: list[Body]
    report: Report
    areas: list[Ring] = field(default_factory=list)
    horizon_s: float = 4.0


def counted(number: int, one: str, many: str) -> str:
    """Return a number with its noun."""
    return f"{number} {one if number == 1 else many}"


def kind_by_size(size_m: tuple[float, float, float]) -> str:
    """Return the kind of a moving body whose file states none, by length and width."""
    length, width = max(size_m[:2]), min(size_m[:2])
    if length > 9.0 and width > 2.2:
        return "bus" if length < 14.0 else "truck"
    if length > 6.0:
        return "truck"
    if length > 2.6 or width > 1.2:
        return "car"
    return "bicycle" if length > 1.2 else "pedestrian"


def completed_size(
    kind: str, length_m: float, width_m: float, height_m: float, report: Report, name: str
) -> tuple[float, float, float]:
    """Return length, width and height, those that are not above 0 by kind, which is reported."""
    default = DEFAULT_SIZE_M[kind]
    stated = (length_m, width_m, height_m)
    missing = [i for i in range(3) if not stated[i] > 0.0]
    for i in missing:
        what = ("length", "width", "height")[i]
        if i == 2:
            report.assume(f"height of every {kind} without one: {default[i]:g} m")
        else:
            report.assume(f"its {what} is {default[i]:g} m, as of a {kind}", name)
    length, width, height = (default[i] if i in missing else stated[i] for i in range(3))
    return length, width, height
