"""Arguments of a Ranker's calls: states, motions and poses."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._checks import as_array, as_number, as_text, check_size, contiguous
from ._errors import bad_input, usage, wrong_type

MAX_CANDIDATES = 100_000
MAX_POSE_TIMES = 10_000
POSE_KEYS = ("x_m", "y_m", "z_m", "yaw_deg", "pitch_deg", "roll_deg")
RADIANS = math.pi / 180.0


def as_mapping(value: Any, name: str) -> dict[str, Any]:
    """Return a mapping's or dataclass's members that are not None."""
    if value is None:
        return {}
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        value = {field.name: getattr(value, field.name) for field in dataclasses.fields(value)}
    if not isinstance(value, Mapping):
        raise wrong_type(
            name,
            f"is a {type(value).__name__}, not a mapping",
            "give a dict",
        )
    return {key: member for key, member in value.items() if member is not None}


def _check_keys(members: dict[str, Any], known: Iterable[str], place: str) -> None:
    for key in members:
        if key not in known:
            raise usage(place, f"has the unknown member {key!r}", f"know: {', '.join(known)}")


def _pose_numbers(value: Any, place: str) -> list[float]:
    """Return x, y, z in m and yaw, pitch, roll in rad."""
    members = as_mapping(value, place)
    _check_keys(members, POSE_KEYS, place)
    numbers = [as_number(members.get(key, 0.0), f"{place}.{key}") for key in POSE_KEYS]
    return numbers[:3] + [RADIANS * angle for angle in numbers[3:]]


def ego_state(value: object) -> _core.EgoState:
    """Return what an update changes of the ego."""
    members = as_mapping(value, "ego")
    if not dataclasses.is_dataclass(value):
        _check_keys(members, ("pose", "speed_mps", "yaw_rate_dps"), "ego")
    state = _core.EgoState()
    if "pose" in members:
        state.set_pose(*_pose_numbers(members["pose"], "ego.pose"))
    if "speed_mps" in members:
        state.speed_mps = as_number(members["speed_mps"], "ego.speed_mps", "m/s")
    if "yaw_rate_dps" in members:
        rate = as_number(members["yaw_rate_dps"], "ego.yaw_rate_dps", "degrees/s")
        state.yaw_rate_radps = RADIANS * rate
    return state


def set_motion(state: _core.ActorState, members: dict[str, Any], place: str) -> None:
    """Set a motion with constant acceleration and yaw rate; absent members are 0."""
    rates = ("speed_mps", "acceleration_mps2", "yaw_rate_dps")
    _check_keys(members, ("name", "model", "pose", *rates), place)
    numbers = [as_number(members.get(key, 0.0), f"{place}.{key}") for key in rates]
    x_m, y_m, z_m, yaw, pitch, roll = _pose_numbers(members.get("pose"), f"{place}.pose")
    rate = RADIANS * numbers[2]
    state.set_motion(x_m, y_m, z_m, yaw, pitch, roll, numbers[0], numbers[1], rate)


def as_times(value: object) -> NDArray[np.float64]:
    """Return times of poses, s, rising from 0."""
    array = as_array(value, "times_s", "fiu", "numbers")
    if array.ndim != 1 or array.size == 0:
        raise bad_input("times_s", f"has the shape {array.shape}", "give the shape (T,)")
    check_size(array.size, MAX_POSE_TIMES, "times_s", "times")
    times = contiguous(array, np.float64, "times_s")
    if not bool(np.isfinite(times).all()) or times[0] != 0 or bool((np.diff(times) <= 0).any()):
        raise bad_input("times_s", "do not rise from 0", "give seconds from now")
    return times


def as_path_array(value: object, name: str, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the poses of one body, (T, 3), one for each time."""
    array = as_array(value, name, "fiu", "numbers")
    if array.shape != (times.size, 3):
        raise bad_input(name, f"has the shape {array.shape}", f"give the shape ({times.size}, 3)")
    return contiguous(array, np.float64, name)


def as_candidates(
    value: object, times_s: object
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the poses of candidates, (N, T, 3), and their times."""
    array = as_array(value, "candidates", "fiu", "numbers")
    if array.ndim != 3 or array.shape[2] != 3:
        raise bad_input("candidates", f"has the shape {array.shape}", "give the shape (N, T, 3)")
    check_size(array.shape[0], MAX_CANDIDATES, "candidates", "candidates")
    if times_s is None:
        raise usage("times_s", "are missing", "give the times of the poses, shape (T,)")
    times = as_times(times_s)
    if times.size != array.shape[1]:
        raise bad_input(
            "times_s",
            f"are {times.size}, the candidates have {array.shape[1]} poses each",
            "give one time for each pose",
        )
    check_size(array.size, 3 * 10_000_000, "candidates", "numbers")
    return contiguous(array, np.float64, "candidates"), times


def as_names(value: object, count: int) -> list[str]:
    """Return different names of candidates; their indices where none are given."""
    if value is None:
        return [str(i) for i in range(count)]
    if isinstance(value, str) or not isinstance(value, Iterable):
        raise wrong_type(
            "names", f"is a {type(value).__name__}, not a list of strings", "give a list of names"
        )
    names = [as_text(name, f"names[{i}]") for i, name in enumerate(value)]
    if len(names) != count or len(set(names)) != count:
        raise usage(
            "names", f"are not {count} different names", "give a different one for each candidate"
        )
    return names
