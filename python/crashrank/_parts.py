"""Members of a scenario, to build one in code. None leaves a key out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from typing import Any, Literal

from ._model import Model

Axis = Literal["+x", "-x", "+y", "-y", "+z", "-z"]
Kind = Literal[
    "car",
    "truck",
    "bus",
    "motorcycle",
    "bicycle",
    "pedestrian",
    "barrier",
    "pole",
    "building",
]
Surface = Literal["sheet-metal", "steel", "concrete", "wood", "rubber", "person"]


@dataclass(frozen=True)
class Pose:
    """Where a body's origin is and how it is turned, body to world."""

    x_m: float | None = None
    """Forward, m."""
    y_m: float | None = None
    """To the left, m."""
    z_m: float | None = None
    """Up, m."""
    yaw_deg: float | None = None
    """About z, positive to the left, degrees."""
    pitch_deg: float | None = None
    """About y, positive nose down, degrees."""
    roll_deg: float | None = None
    """About x, positive to the right, degrees."""


@dataclass(frozen=True)
class TimedPose(Pose):
    """A pose that a body has at a time."""

    t_s: float = 0.0
    """Time from the decision, s; the first is 0, then rising."""


@dataclass(frozen=True)
class Body:
    """A shape: mesh or box, kind and what is stated of its mass."""

    mesh: str | PathLike[str] | Model | None = None
    """Mesh or model file, relative to the scenario's base; or a `Model`."""
    kind: Kind | None = None
    """What it is; decides mass, strength and risk curves. Has to be given."""
    mass_kg: float | None = None
    """With all aboard, kg."""
    scale: float | None = None
    """Metres per unit of the file."""
    up: Axis | None = None
    """The file's axis that points up."""
    forward: Axis | None = None
    """The file's axis that points forward."""
    origin_m: Sequence[float] | None = None
    """Where the body's origin lies, body axes after scaling, m."""
    center_of_mass_m: Sequence[float] | None = None
    """Body coordinates, m."""
    yaw_inertia_kgm2: float | None = None
    """About the vertical axis through the centre of mass, kg m2."""
    stiffness: float | None = None
    """Crush strength, times the default of its kind."""
    surface: Surface | None = None
    """Outer material; decides friction."""
    honeycomb: Mapping[str, float] | None = None
    """Crushable layer: ``pressure_pa``, ``depth_m``, ``low_m``, ``high_m``."""
    breakaway: Mapping[str, float] | None = None
    """Load at which a fixed body breaks away: ``force_n``, ``moment_nm``; needs ``mass_kg``."""
    deflection_m: float | None = None
    """How far a rail gives way, m."""
    deflection_force_n: float | None = None
    """Force at which it gives way, N."""
    box: Sequence[float] | None = None
    """Length, width and height in place of a mesh, m: the usual shape of its kind."""
    note: str | None = None
    """For people; not read."""


@dataclass(frozen=True)
class Ego:
    """The vehicle that decides, at time 0."""

    model: str
    """Name of one of the models."""
    speed_mps: float
    """Along its forward axis, m/s; negative when reversing."""
    pose: Pose | Mapping[str, float] | None = None
    """Body to world."""
    yaw_rate_dps: float | None = None
    """Degrees/s, left positive."""
    wheelbase_m: float | None = None
    """Distance between the axles, m."""
    max_acceleration_mps2: float | None = None
    """Of the engine, m/s2."""
    max_deceleration_mps2: float | None = None
    """Of the brakes, m/s2."""
    max_steering_deg: float | None = None
    """Of the road wheels, degrees, either way."""
    max_steering_rate_dps: float | None = None
    """Of the road wheels' angle, degrees/s."""
    occupants: float | None = None
    """Persons in it."""
    uncertainty: Mapping[str, float] | None = None
    """Standard deviations ``position_m``, ``heading_deg``, ``speed_mps``."""
    note: str | None = None
    """For people; not read."""


@dataclass(frozen=True)
class Actor:
    """Something that can be hit, and how it moves."""

    name: str
    """Unique."""
    model: str
    """Name of one of the models."""
    pose: Pose | Mapping[str, float] | None = None
    """Body to world at time 0."""
    speed_mps: float | None = None
    """Along its forward axis, m/s."""
    acceleration_mps2: float | None = None
    """Along its forward axis, m/s2; against the speed it brakes, to standstill."""
    yaw_rate_dps: float | None = None
    """Degrees/s, left positive, held while it moves."""
    poses: Sequence[TimedPose | Mapping[str, float]] | None = None
    """Timed poses in place of pose, speed, acceleration and yaw rate."""
    predictions: Sequence[Mapping[str, Any]] | None = None
    """Motions that exclude each other, each with its ``probability``; pose and speed stand for
    those that state none."""
    existence_probability: float | None = None
    """That it is there at all."""
    occupants: float | None = None
    """Persons in or on it."""
    perception: Mapping[str, float] | None = None
    """Standard deviations ``position_m``, ``heading_deg``, ``speed_mps``."""
    note: str | None = None
    """For people; not read."""


@dataclass(frozen=True)
class Candidate:
    """A manoeuvre that the ego can still choose."""

    name: str
    """Unique."""
    acceleration_mps2: float | None = None
    """Along the forward axis, m/s2; against the speed it brakes."""
    steering_deg: float | None = None
    """Angle of the road wheels, degrees, left positive."""
    yaw_rate_dps: float | None = None
    """Degrees/s, left positive, held while it moves."""
    poses: Sequence[TimedPose | Mapping[str, float]] | None = None
    """Timed poses in place of the others."""
