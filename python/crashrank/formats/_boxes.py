"""Outlines as boxes: rectangles around polygons, walls along them, and overlaps of boxes."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ._scene import Pose, Ring

Box = tuple[Pose, float, float]
"""Middle and heading, length along the heading, width."""

WALL_M = 0.2
MAX_WALLS = 64


def oriented_box(points: Sequence[tuple[float, float]], yaw_rad: float) -> Box:
    """Return the rectangle of that heading around points."""
    cosine, sine = math.cos(yaw_rad), math.sin(yaw_rad)
    ahead = [cosine * x + sine * y for x, y in points]
    left = [cosine * y - sine * x for x, y in points]
    a, b = (min(ahead) + max(ahead)) / 2, (min(left) + max(left)) / 2
    middle = Pose(cosine * a - sine * b, sine * a + cosine * b, yaw_rad)
    return middle, max(ahead) - min(ahead), max(left) - min(left)


def least_box(points: Sequence[tuple[float, float]]) -> Box:
    """Return the rectangle of least area around points, its length not below its width.

    Among the rectangles around a set of points one of least area shares a side with the convex
    hull (Freeman and Shapira, 1975). Cost: the square of the number of corners of the hull.
    """
    hull = np.array(convex_hull(points), dtype=float)
    edges = np.roll(hull, -1, axis=0) - hull
    yaws = np.concatenate([[0.0], np.arctan2(edges[:, 1], edges[:, 0])])
    # Extents of the hull along and across each edge.
    ahead = np.outer(np.cos(yaws), hull[:, 0]) + np.outer(np.sin(yaws), hull[:, 1])
    left = np.outer(np.cos(yaws), hull[:, 1]) - np.outer(np.sin(yaws), hull[:, 0])
    areas = np.ptp(ahead, axis=1) * np.ptp(left, axis=1)
    yaw = float(yaws[int(np.argmin(areas * np.where(yaws == 0.0, 1 - 1e-12, 1.0)))])
    pose, length, width = oriented_box(list(map(tuple, hull.tolist())), yaw)
    if length < width:
        return Pose(pose.x_m, pose.y_m, pose.yaw_rad + math.pi / 2), width, length
    return pose, length, width


def convex_hull(points: Sequence[tuple[float, float]]) -> Ring:
    """Return the corners of the convex hull, counter-clockwise (Andrew's monotone chain)."""
    ordered = sorted(set(points))
    if len(ordered) < 3:
        return ordered
    lower = _chain(ordered)
    upper = _chain(ordered[::-1])
    return lower[:-1] + upper[:-1]


def _chain(points: Ring) -> Ring:
    chain: Ring = []
    for point in points:
        while len(chain) > 1 and _turn(chain[-2], chain[-1], point) <= 0:
            chain.pop()
        chain.append(point)
    return chain


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def ring_area(ring: Sequence[tuple[float, float]]) -> float:
    """Return the signed area, m2, positive where the corners run counter-clockwise."""
    return 0.5 * sum(
        ring[i - 1][0] * ring[i][1] - ring[i][0] * ring[i - 1][1] for i in range(len(ring))
    )


def boxes_of_outline(ring: Ring) -> list[Box]:
    """Return boxes for a body that stands and has this outline.

    One rectangle where it is less than a tenth larger than the outline, else a wall of `WALL_M`
    inside each edge, at most `MAX_WALLS`.
    """
    around = least_box(ring)
    area = abs(ring_area(ring))
    if area >= 0.9 * around[1] * around[2] or len(ring) > MAX_WALLS or min(around[1:]) < 2 * WALL_M:
        return [around]
    inwards = math.copysign(WALL_M / 2, ring_area(ring))
    walls: list[Box] = []
    for i, (x, y) in enumerate(ring):
        nx, ny = ring[(i + 1) % len(ring)]
        length = math.hypot(nx - x, ny - y)
        if length < 0.05:
            continue
        yaw = math.atan2(ny - y, nx - x)
        middle = Pose(
            (x + nx) / 2 - inwards * math.sin(yaw), (y + ny) / 2 + inwards * math.cos(yaw), yaw
        )
        walls.append((middle, length, WALL_M))
    return walls


def overlap_depths(
    a: NDArray[np.float64],
    a_size: tuple[float, float],
    b: NDArray[np.float64],
    b_size: tuple[float, float],
) -> NDArray[np.float64]:
    """Return how deep two rectangles overlap at each of several times, m; below 0: they do not.

    Separating axes of two rectangles are the directions of their sides.

    Parameters
    ----------
    a, b : array of shape (T, 3)
        Middles and headings.
    a_size, b_size : tuple of float
        Length and width.
    """
    apart = b[:, :2] - a[:, :2]
    depths = np.full(len(a), np.inf)
    for yaw in (a[:, 2], a[:, 2] + np.pi / 2, b[:, 2], b[:, 2] + np.pi / 2):
        axis = np.stack([np.cos(yaw), np.sin(yaw)], axis=1)
        reach = _reach(a[:, 2] - yaw, a_size) + _reach(b[:, 2] - yaw, b_size)
        depths = np.minimum(depths, reach - np.abs((apart * axis).sum(axis=1)))
    return depths


def _reach(turned: NDArray[np.float64], size: tuple[float, float]) -> NDArray[np.float64]:
    """Return half the extent of a rectangle along an axis, from the angle between them."""
    reach: NDArray[np.float64] = (
        np.abs(np.cos(turned)) * size[0] + np.abs(np.sin(turned)) * size[1]
    ) / 2
    return reach
