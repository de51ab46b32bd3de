"""A crashrank scenario at another moment: all bodies moved on, or back, by their motions.

The closed forms are those of ``include/crashrank/motion/motion.hpp``.
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._checks import as_number
from .._scenario import Scenario, _to_plain
from ._document import Imported
from ._refusals import (
    MAX_HORIZON_S,
    checked_choices,
    choice_error,
    decoded,
    guarded_parse,
    read_bytes,
)
from ._scene import Report

MAX_BYTES = 64 * 2**20
# Between the poses of what speeds up, brakes or turns only from the beginning on, s.
_SAMPLE_S = 0.02
_LEAST_S = 0.1
_RATES = ("speed_mps", "acceleration_mps2", "yaw_rate_dps")

_Array = NDArray[np.float64]
_Place = tuple[_Array, _Array]
"""Position, m, and rotation of a body."""


def scenario_at(
    document: Mapping[str, Any],
    time_s: float,
    *,
    horizon_s: float | None = None,
    base: object = None,
    allow: Iterable[object] = (),
) -> dict[str, Any]:
    """Return a scenario as it stands some seconds after its beginning, or before.

    The ego holds its speed and yaw rate, every actor moves as stated; what brakes to standstill
    stays there. Before the beginning the actors have held their speed and course: what then speeds
    up, brakes or turns becomes timed poses every 0.02 s. Probabilities and errors of states stay.

    Parameters
    ----------
    document : mapping
        With the keys of a scenario file; its candidates are replaced by the grid.
    time_s : float
        After the beginning, s; negative before it.
    horizon_s : float, optional
        How long contacts count from then on, s. Default: to the end of the document's horizon.
    base, allow
        As of `crashrank.Scenario`.

    Returns
    -------
    dict
        With the keys of a scenario file.

    Raises
    ------
    UsageError
        For times at or after the end of the horizon.
    BadInputError
        As of `crashrank.Scenario`.

    Examples
    --------
    >>> from crashrank import formats
    >>> car = {"box": [4.5, 1.8, 1.5], "kind": "car"}
    >>> ego = {"model": "car", "speed_mps": 10.0}
    >>> scene = {"scenario_version": 1, "models": {"car": car}, "ego": ego}
    >>> formats.scenario_at(scene, -0.5)["ego"]["pose"]
    {'x_m': -5.0}
    """
    Scenario(document, base=base, allow=allow)
    return _at(_to_plain(document), as_number(time_s, "time_s", "seconds"), horizon_s)


def read_scenario(
    path: object,
    time_s: float | None = None,
    ego: str | int | None = None,
    *,
    horizon_s: float | None = None,
) -> Imported:
    """Read a crashrank scenario at a moment after its beginning, or before it.

    Parameters
    ----------
    path : path
        The scenario's file. Paths of meshes become absolute.
    time_s, horizon_s
        As of `scenario_at`; default: its beginning.
    ego : str, optional
        Other readers need it; here ``ego`` alone.

    Returns
    -------
    Imported

    Raises
    ------
    NotFoundError, LimitError, BadInputError, UsageError
        As of the other readers and `scenario_at`.
    """
    name, at_s, _ = checked_choices(ego, time_s, 4.0 if horizon_s is None else horizon_s)
    file, data = read_bytes(path, MAX_BYTES)
    if name not in (None, "ego"):
        raise choice_error(file, "ego", f"is {name!r}", "leave it out: a scenario names its ego")
    Scenario.load(file)
    document = guarded_parse(file, "JSON", lambda: json.loads(decoded(file, data)))
    document.pop("$schema", None)
    for model in document["models"].values():
        if "mesh" in model:
            model["mesh"] = os.path.abspath(os.path.join(os.path.dirname(file), model["mesh"]))
    at_s = at_s or 0.0
    found = _at(document, at_s, horizon_s)
    road = document.get("road", {}).get("drivable", [])
    report = Report("crashrank", file, at_s, "ego", len(found["actors"]), len(road))
    if at_s:
        report.assume("until then the ego has held its speed and yaw rate")
    if at_s < 0.0:
        report.assume("before the beginning the others have held their speed and course")
    return Imported(found, report, {"acceleration_mps2": 0.0})


def _at(document: dict[str, Any], time_s: float, horizon_s: float | None) -> dict[str, Any]:
    """Return a checked document at another moment; its own members are shared where they stay."""
    end_s = float(document.get("horizon_s", 4.0))
    if horizon_s is None:
        if end_s - time_s < _LEAST_S:
            raise choice_error(
                "", "time_s", f"is {time_s:g}, the horizon ends at {end_s:g} s",
                "choose an earlier time, or state horizon_s",
            )  # fmt: skip
        horizon_s = min(end_s - time_s, MAX_HORIZON_S)
    ego = document["ego"]
    place, speed = _driven(_place(ego.get("pose", {})), *_rates(ego), time_s)
    found = {
        **document,
        "ego": {**ego, "pose": _pose(place), "speed_mps": speed},
        "actors": [_actor_at(each, time_s, horizon_s) for each in document.get("actors", [])],
        "candidates": {"grid": document.get("candidates", {}).get("grid") or True},
        "horizon_s": horizon_s,
    }
    if "futures" in document:
        found["futures"] = [
            {
                **future,
                "motions": {
                    name: _motion_at(motion, time_s, horizon_s)
                    for name, motion in future["motions"].items()
                },
            }
            for future in document["futures"]
        ]
    return found


def _actor_at(actor: dict[str, Any], time_s: float, horizon_s: float) -> dict[str, Any]:
    kept = {key: value for key, value in actor.items() if key not in ("pose", "poses", *_RATES)}
    if "predictions" not in actor:
        return {**kept, **_motion_at(actor, time_s, horizon_s)}
    stated: dict[str, Any] = {key: actor[key] for key in ("pose", "speed_mps") if key in actor}
    kept["predictions"] = [
        {"probability": each["probability"], **_motion_at({**stated, **each}, time_s, horizon_s)}
        for each in actor["predictions"]
    ]
    return kept


def _motion_at(motion: Mapping[str, Any], time_s: float, horizon_s: float) -> dict[str, Any]:
    """Return the members of a motion, as a scenario states them, that begins at another time."""
    if "poses" in motion:
        path = [(each["t_s"], _place(each)) for each in motion["poses"]]
        (first_s, first), (second_s, second) = path[0], path[min(1, len(path) - 1)]
        velocity = (second[0] - first[0]) / (second_s - first_s) if len(path) > 1 else np.zeros(3)
        if time_s < 0.0 and velocity.any():
            path.insert(0, (time_s, (first[0] + time_s * velocity, first[1])))
        return {"poses": list(_cut(path, time_s, time_s + horizon_s))}
    start, (speed, acceleration, rate) = _place(motion.get("pose", {})), _rates(motion)
    if time_s < 0.0:
        before = start[0] + time_s * speed * start[1][:, 0], start[1]
        end_s = min(time_s + horizon_s, _stop_s(speed, acceleration))
        if end_s <= 0.0 or not (acceleration or rate):
            return _members(before, speed)
        times = np.append(np.arange(0.0, end_s, _SAMPLE_S), end_s)
        later = [(float(t), _driven(start, speed, acceleration, rate, t)[0]) for t in times]
        return {"poses": list(_cut([(time_s, before), *later], time_s, time_s + horizon_s))}
    place, now = _driven(start, speed, acceleration, rate, time_s)
    if time_s >= _stop_s(speed, acceleration):
        return _members(place)
    return _members(place, now, acceleration, math.degrees(rate))


def _members(place: _Place, *rates: float) -> dict[str, Any]:
    return {
        "pose": _pose(place),
        **{key: rate for key, rate in zip(_RATES, rates, strict=False) if rate},
    }


def _rates(motion: Mapping[str, Any]) -> tuple[float, float, float]:
    """Return speed, acceleration and yaw rate, SI units."""
    speed, acceleration, rate = (float(motion.get(key, 0.0)) for key in _RATES)
    return speed, acceleration, math.radians(rate)


def _stop_s(speed: float, acceleration: float) -> float:
    """Return when a body has braked to standstill; infinity if it does not brake."""
    brakes = speed * acceleration < 0.0 or (speed == 0.0 and acceleration < 0.0)
    return -speed / acceleration if brakes else math.inf


def _driven(
    start: _Place, speed: float, acceleration: float, rate: float, seconds: float
) -> tuple[_Place, float]:
    """Return place and speed of a body that drives along its forward axis, as TurnMotion."""
    position, rotation = start
    stop_s = _stop_s(speed, acceleration)
    t = min(seconds, stop_s)
    half = rate * t / 2
    # The mean of the speed's linear part along the chord, and across it.
    across = (math.sin(half) - half * math.cos(half)) / half**2 if abs(half) > 0.01 else half / 3
    along = (speed + acceleration * t / 2) * float(np.sinc(half / math.pi))
    way = t * complex(along, acceleration * t / 2 * across)
    way *= complex(math.cos(half), math.sin(half))
    forward = rotation[:, 0]
    level = math.hypot(forward[0], forward[1])
    heading = forward[:2] / level if level else np.array([1.0, 0.0])
    left = np.array([-heading[1], heading[0], 0.0])
    normal = np.array([*(-forward[2] * heading), level])
    moved = position + way.real * forward + way.imag * left
    now = 0.0 if seconds >= stop_s else speed + acceleration * t
    return (moved, _turn(normal, rate * t) @ rotation), now


def _cut(path: list[tuple[float, _Place]], begin: float, end: float) -> Iterator[dict[str, Any]]:
    """Return the timed poses between two times, counted from the first of them."""
    times = [t for t, _ in path]
    inside = [t for t in times if begin + 1e-6 < t < end - 1e-6]
    for t in [begin, *inside, *([end] if times[-1] > end - 1e-6 else [])]:
        i = int(np.searchsorted(times, t, side="right"))
        if i in (0, len(path)):
            place = path[max(i - 1, 0)][1]
        else:
            (from_s, a), (until_s, b) = path[i - 1], path[i]
            place = _between(a, b, (t - from_s) / (until_s - from_s))
        yield {"t_s": max(t - begin, 0.0), **_pose(place)}


def _between(a: _Place, b: _Place, share: float) -> _Place:
    """Return the place at a share of an even motion that turns about one axis."""
    turned = a[1].T @ b[1]
    skew = np.array(
        [turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]]
    )
    sine = float(np.linalg.norm(skew)) / 2
    angle = math.atan2(sine, (float(np.trace(turned)) - 1) / 2)
    axis = skew / (2 * sine) if sine > 1e-12 else np.array([0.0, 0.0, 1.0])
    return a[0] + share * (b[0] - a[0]), a[1] @ _turn(axis, share * angle)


def _turn(axis: _Array, angle_rad: float) -> _Array:
    """Return the rotation about a unit vector (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turned = math.sin(angle_rad) * cross + (1 - math.cos(angle_rad)) * (cross @ cross)
    return np.asarray(np.eye(3) + turned)


def _place(pose: Mapping[str, Any]) -> _Place:
    yaw, pitch, roll = (
        _turn(axis, math.radians(float(pose.get(key, 0.0))))
        for axis, key in zip(np.eye(3)[::-1], ("yaw_deg", "pitch_deg", "roll_deg"), strict=True)
    )
    position = np.array([float(pose.get(key, 0.0)) for key in ("x_m", "y_m", "z_m")])
    return position, yaw @ pitch @ roll


def _pose(place: _Place) -> dict[str, float]:
    """Return a pose as a scenario states it, members that are 0 left out."""
    position, rotation = place
    angles = {
        "yaw_deg": math.atan2(rotation[1, 0], rotation[0, 0]),
        "pitch_deg": -math.asin(min(max(rotation[2, 0], -1.0), 1.0)),
        "roll_deg": math.atan2(rotation[2, 1], rotation[2, 2]),
    }
    metres = dict(zip(("x_m", "y_m", "z_m"), map(float, position), strict=True))
    members = {**metres, **{key: math.degrees(angle) for key, angle in angles.items()}}
    return {key: value for key, value in members.items() if value}
