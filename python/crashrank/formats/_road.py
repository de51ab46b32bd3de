"""Drivable areas: rings without crossing edges, those near the ego."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ._boxes import ring_area
from ._scene import Pose, Report, Ring

MAX_AREAS = 1_000
MAX_CORNERS = 10_000
MAX_RING = 500
MAX_POINTS = 60_000
_LEAST_STEP_M = 0.01
_LEAST_AREA_M2 = 0.01
_STRAIGHT_M = 0.005


def reach_of(speed_mps: float, horizon_s: float) -> float:
    """Return how far from the ego areas are read, m: what it can reach, and 50 m more."""
    return abs(speed_mps) * horizon_s + 5.0 * horizon_s**2 + 50.0


def areas_between(
    lines: Sequence[tuple[Ring, Ring]], ego: Pose, reach_m: float, report: Report
) -> list[Ring]:
    """Return the areas between pairs of lines within reach of the ego, nearest first.

    At most `MAX_POINTS` points of lines are looked at.
    """
    near = sorted(
        (distance, i)
        for i, (left, right) in enumerate(lines)
        if (distance := _distance(left + right, ego.x_m, ego.y_m)) <= reach_m
    )
    rings: list[Ring] = []
    points = unread = 0
    for _, i in near:
        left, right = lines[i]
        points += len(left) + len(right)
        if points > MAX_POINTS or len(rings) > MAX_AREAS:
            report.warn("the road has more points than are read: only the nearest lanes are read")
            break
        found = between_lines(left, right)
        rings += found
        unread += not found
    if unread:
        report.leave_out(f"{unread} lanes whose bounds cross")
    return rings


def between_lines(left: Ring, right: Ring) -> list[Ring]:
    """Return the area between two lines that run the same way, as rings without crossings.

    One ring; where its edges cross, quadrilaterals between the lines, pair of points by pair.
    """
    ring = simplified(left + right[::-1])
    if ring and is_simple(ring):
        return [ring]
    count = max(len(left), len(right))
    a, b = resampled(left, count), resampled(right, count)
    pieces = []
    for i in range(count - 1):
        piece = simplified([a[i], a[i + 1], b[i + 1], b[i]])
        if piece and is_simple(piece):
            pieces.append(piece)
    return pieces


def resampled(line: Ring, count: int) -> Ring:
    """Return `count` points evenly along a line; the line itself where it has as many."""
    if len(line) == count:
        return line
    points = np.array(line, dtype=float)
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    wanted = np.linspace(0.0, along[-1], count)
    x, y = (np.interp(wanted, along, points[:, axis]) for axis in (0, 1))
    return [(float(a), float(b)) for a, b in zip(x, y, strict=True)]


def simplified(ring: Ring) -> Ring:
    """Return a ring without corners that are close to the one before or on a straight line.

    Empty where no area is left.
    """
    kept: Ring = []
    for point in ring:
        if not kept or math.dist(point, kept[-1]) >= _LEAST_STEP_M:
            kept.append(point)
    while len(kept) > 1 and math.dist(kept[0], kept[-1]) < _LEAST_STEP_M:
        kept.pop()
    straightened: Ring = []
    for i, point in enumerate(kept):
        before = straightened[-1] if straightened else kept[-1]
        after = kept[(i + 1) % len(kept)]
        if _off_line(point, before, after) >= _STRAIGHT_M:
            straightened.append(point)
    if len(straightened) < 3 or abs(ring_area(straightened)) < _LEAST_AREA_M2:
        return []
    return straightened


def _off_line(point: tuple[float, float], a: tuple[float, float], b: tuple[float, float]) -> float:
    """Return the distance of a point from the segment between two others."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    squared = dx * dx + dy * dy
    share = 0.0 if squared == 0 else ((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / squared
    share = min(max(share, 0.0), 1.0)
    return math.hypot(point[0] - a[0] - share * dx, point[1] - a[1] - share * dy)


def is_simple(ring: Ring) -> bool:
    """Return whether no two edges of a ring touch but neighbours in their corner.

    Cost: the square of the number of corners, which is at most `MAX_RING`.
    """
    if len(ring) > MAX_RING:
        return False
    a = np.array(ring, dtype=float)
    b = np.roll(a, -1, axis=0)
    count = len(ring)
    i, j = np.triu_indices(count, 1)
    apart = (j - i > 1) & ~((i == 0) & (j == count - 1))
    i, j = i[apart], j[apart]
    one, two = _side(a[i], b[i], a[j]), _side(a[i], b[i], b[j])
    three, four = _side(a[j], b[j], a[i]), _side(a[j], b[j], b[i])
    crosses = (one * two <= 0) & (three * four <= 0)
    # Edges on one line have all sides 0: they touch where their bounds do.
    low_i, high_i = np.minimum(a[i], b[i]), np.maximum(a[i], b[i])
    low_j, high_j = np.minimum(a[j], b[j]), np.maximum(a[j], b[j])
    near = ((low_i <= high_j) & (low_j <= high_i)).all(axis=1)
    return not bool((crosses & near).any()) and not _folds(a, b)


def _folds(a: NDArray[np.float64], b: NDArray[np.float64]) -> bool:
    """Return whether an edge runs back along the one before."""
    forward, following = b - a, np.roll(b - a, -1, axis=0)
    cross = forward[:, 0] * following[:, 1] - forward[:, 1] * following[:, 0]
    dot = (forward * following).sum(axis=1)
    return bool(((np.abs(cross) <= 1e-12) & (dot < 0)).any())


def _side(
    a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]
) -> NDArray[np.float64]:
    side: NDArray[np.float64] = np.sign(
        (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    )
    return side


def contains(ring: Ring, x_m: float, y_m: float) -> bool:
    """Return whether a point lies in a ring, by the parity of crossings of a ray."""
    inside = False
    for i, (x, y) in enumerate(ring):
        px, py = ring[i - 1]
        if (y > y_m) != (py > y_m) and x_m < (px - x) * (y_m - y) / (py - y) + x:
            inside = not inside
    return inside


def near_areas(
    rings: Sequence[Ring], ego: Pose, wheels: Sequence[Pose], report: Report
) -> list[Ring]:
    """Return the rings that matter to the ego: none where a wheel stands beside all of them.

    Nearest first, at most `MAX_AREAS` with `MAX_CORNERS` corners together.
    """
    if not rings:
        return []
    x_m, y_m, _ = ego
    if not all(any(contains(ring, x, y) for ring in rings) for x, y, _ in wheels):
        report.warn("the ego stands beside the drivable areas of the file: the road has no end")
        return []
    ordered = sorted(rings, key=lambda ring: _distance(ring, x_m, y_m))
    kept: list[Ring] = []
    corners = 0
    for ring in ordered:
        corners += len(ring)
        if corners > MAX_CORNERS or len(kept) == MAX_AREAS:
            report.warn(f"only the {len(kept)} nearest drivable areas are read")
            break
        kept.append(ring)
    return kept


def _distance(ring: Ring, x_m: float, y_m: float) -> float:
    """Return the distance of a point from the bounds of a ring."""
    xs, ys = [x for x, _ in ring], [y for _, y in ring]
    dx = max(min(xs) - x_m, 0.0, x_m - max(xs))
    dy = max(min(ys) - y_m, 0.0, y_m - max(ys))
    return math.hypot(dx, dy)
