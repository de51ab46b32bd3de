"""Set-based predictions as paths of a body that stays in its sets."""

from __future__ import annotations

import math

from ._boxes import oriented_box
from ._scene import Pose, Ring, State, Track, wrapped

# Where in each set a path runs: shares of the room ahead and behind, left and right of its middle.
_PATHS = ((0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))
_LEAST_WAY_M = 0.05
_SAME_M = 0.05


def paths_through_sets(
    start: State,
    size_m: tuple[float, float, float],
    sets: list[tuple[float, Ring]],
    horizon_s: float,
) -> list[Track]:
    """Return paths of equal probability: through the middles of the sets, and along their sides.

    A set says where a body may be, not how probable that is. Its side's paths touch it with the
    body's box, where the set is larger than the box along that direction.

    Parameters
    ----------
    start : State
        Middle of the body's box at its first time.
    sets : list
        Times, and corners of the area that the body may occupy.
    """
    last_s = start.t_s + horizon_s + 60.0
    sets = [(t_s, ring) for t_s, ring in sets if start.t_s < t_s <= last_s and len(ring) > 1]
    boxes = []
    yaw, before = start.pose.yaw_rad, (start.pose.x_m, start.pose.y_m)
    for t_s, ring in sets:
        middle = oriented_box(ring, yaw)[0]
        way = math.dist(before, middle[:2])
        course = math.atan2(middle.y_m - before[1], middle.x_m - before[0])
        if way > _LEAST_WAY_M and abs(wrapped(course - yaw)) < math.pi / 3:
            yaw = course
        boxes.append((t_s, oriented_box(ring, yaw)))
        before = middle[:2]
    tracks: list[Track] = []
    for ahead, left in _PATHS:
        states = [start]
        for t_s, (middle, length, width) in boxes:
            a = ahead * max(length - size_m[0], 0.0) / 2
            b = left * max(width - size_m[1], 0.0) / 2
            cosine, sine = math.cos(middle.yaw_rad), math.sin(middle.yaw_rad)
            x, y = middle.x_m + cosine * a - sine * b, middle.y_m + sine * a + cosine * b
            states.append(State(t_s, Pose(x, y, middle.yaw_rad)))
        if not any(_same(states, track.states) for track in tracks):
            tracks.append(Track(states))
    for track in tracks:
        track.probability = 1.0 / len(tracks)
    return tracks


def _same(a: list[State], b: list[State]) -> bool:
    return all(
        math.dist(one.pose[:2], two.pose[:2]) < _SAME_M for one, two in zip(a, b, strict=True)
    )
