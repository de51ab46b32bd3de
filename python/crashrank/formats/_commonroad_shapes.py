"""CommonRoad: shapes, values and states of obstacles.

Formats 2018b and 2020a, and the XML that commonroad-io 2026.1 writes. `center` and `orientation`
of a shape are in the body's axes and turn with its heading; `originXShift` is where the body's
reference point lies ahead of the middle of its rectangle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ._boxes import Box, boxes_of_outline, oriented_box
from ._refusals import refuse, refuse_size
from ._scene import Pose, Report, Ring, State, moved
from ._xml import Node

MAX_CORNERS = 1_000
MAX_POINTS = 20_000
SHAPES = ("rectangle", "circle", "polygon", "truckShape", "semiTrailerTruckShape")


@dataclass(frozen=True)
class Outline:
    """A shape in the body's axes: its rectangle, or its corners, and the wheelbase if stated."""

    box: Box
    corners: Ring
    round: bool = False
    wheelbase_m: float | None = None


def read_outline(node: Node, report: Report, name: str) -> Outline:
    """Return the outline of a `shape`; of several shapes the rectangle around all."""
    shapes = node.children(*SHAPES)
    unknown = [child.tag for child in node.children() if child.tag not in SHAPES]
    if unknown:
        refuse(
            node.file,
            node.place,
            f"has the unknown shape {unknown[0]}",
            f"know: {', '.join(SHAPES)}",
        )
    if not shapes:
        refuse(node.file, node.place, "has no shape in it", f"add one of {', '.join(SHAPES)}")
    outlines = [_outline(shape, report, name) for shape in shapes]
    if len(outlines) == 1:
        return outlines[0]
    report.assume("several shapes are one rectangle around them", name)
    corners = [corner for outline in outlines for corner in outline.corners]
    return Outline(oriented_box(corners, 0.0), corners)


def _outline(node: Node, report: Report, name: str) -> Outline:
    if node.tag == "rectangle":
        length, width = (_side(node.need(side)) for side in ("length", "width"))
        shift = node.child("originXShift")
        ahead = -shift.number(-100, 100) if shift is not None else 0.0
        middle = moved(_offset(node), ahead, 0.0)
        return Outline((middle, length, width), corners_of((middle, length, width)))
    if node.tag == "circle":
        across = 2.0 * node.need("radius").number(0.01, 50)
        middle = _offset(node)
        return Outline((middle, across, across), corners_of((middle, across, across)), round=True)
    if node.tag == "polygon":
        corners = read_points(node, MAX_CORNERS)
        box = oriented_box(corners, 0.0)
        if box[1] <= 0 or box[2] <= 0:
            refuse(node.file, node.place, "has no area", "give three corners that span one")
        return Outline(box, corners)
    return _truck(node, report, name)


def _truck(node: Node, report: Report, name: str) -> Outline:
    """Return the rectangle of a truck; with a trailer, that of both in one line."""
    truck = node.need("truckShape") if node.tag == "semiTrailerTruckShape" else node
    dims = truck.need("truckDims")
    length, width = (_side(dims.need(side)) for side in ("length", "width"))
    overhang = dims.need("distFromRearToRearAxle").number(-20, 50)
    wheelbase = dims.need("wheelbase").number(0.1, 50)
    shift = truck.child("originXShift")
    axle = overhang - length / 2
    origin = shift.number(-100, 100) if shift is not None else axle
    front, rear = length / 2 - origin, -length / 2 - origin
    if node.tag == "semiTrailerTruckShape":
        trailer = node.need("trailerDims")
        hitch = axle - origin + dims.need("distFromRearAxleToHitch").number(-20, 20)
        behind = _side(trailer.need("length")) - trailer.need("distFromFrontToHitch").number(
            -20, 50
        )
        rear = min(rear, hitch - behind)
        width = max(width, _side(trailer.need("width")))
        report.assume("tractor and trailer are one box, in one line", name)
    box = (Pose((front + rear) / 2, 0.0, 0.0), front - rear, width)
    return Outline(box, corners_of(box), wheelbase_m=wheelbase)


def _side(node: Node) -> float:
    return node.number(0.01, 200)


def _offset(node: Node) -> Pose:
    """Return where a shape lies in the body's axes: its `center` and `orientation`."""
    centre, turned = node.child("center"), node.child("orientation")
    x = y = yaw = 0.0
    if centre is not None:
        x, y = (centre.need(axis).number(-1e7, 1e7) for axis in ("x", "y"))
    if turned is not None:
        exact = turned.child("exact")
        yaw = (exact if exact is not None else turned).number(-100, 100)
    return Pose(x, y, yaw)


def corners_of(box: Box) -> Ring:
    """Return the corners of a rectangle, counter-clockwise."""
    pose, length, width = box
    signs = ((1, 1), (-1, 1), (-1, -1), (1, -1))
    return [moved(pose, a * length / 2, b * width / 2)[:2] for a, b in signs]


def read_points(node: Node, most: int) -> Ring:
    """Return the corners of a polygon or a line; the last one is not the first again."""
    points = node.children("point")
    if len(points) > most:
        refuse_size(
            node.file, node.place, f"has {len(points)} points, at most {most} are read",
            "simplify it",
        )  # fmt: skip
    corners = [
        (point.need("x").number(-1e7, 1e7), point.need("y").number(-1e7, 1e7)) for point in points
    ]
    if len(corners) > 1 and corners[0] == corners[-1]:
        corners.pop()
    if len(corners) < 2:
        refuse(node.file, node.place, "has fewer than two points", "give all its points")
    return corners


def placed(pose: Pose, box: Box) -> Pose:
    """Return the middle of a box that is given in a body's axes, for the body at a pose."""
    middle = box[0]
    return moved(pose, middle.x_m, middle.y_m, middle.yaw_rad)


def standing_boxes(outline: Outline, pose: Pose) -> list[Box]:
    """Return the boxes of a body that stands at a pose."""
    if len(outline.corners) > 2 and outline.corners != corners_of(outline.box):
        ring = [moved(pose, x, y)[:2] for x, y in outline.corners]
        return boxes_of_outline(ring)
    return [(placed(pose, outline.box), outline.box[1], outline.box[2])]


def read_value(node: Node, report: Report, name: str, low: float, high: float) -> float:
    """Return an exact value, or the middle of an interval, which is reported."""
    exact = node.child("exact")
    if exact is not None:
        return exact.number(low, high)
    start, end = node.child("intervalStart"), node.child("intervalEnd")
    if start is None or end is None:
        if node.text():
            return node.number(low, high)
        refuse(node.file, node.place, "has neither exact nor an interval", "state its value")
    report.assume("intervals are read as their middles", name)
    return (start.number(low, high) + end.number(low, high)) / 2


def read_state(node: Node, step_s: float, report: Report, name: str) -> State:
    """Return a state: time from steps, heading from the velocity where none is stated.

    `velocity` is along the heading; beside `velocityY` it is along x, as point masses have it.
    """
    time_s = step_s * read_value(node.need("time"), report, name, -1e7, 1e7)
    x, y = _position(node.need("position"), report, name)
    velocity, sideways = node.child("velocity"), node.child("velocityY")
    turned, rate = node.child("orientation"), node.child("yawRate")
    speed = None if velocity is None else read_value(velocity, report, name, -200, 200)
    across = None if sideways is None else read_value(sideways, report, name, -200, 200)
    if turned is not None:
        yaw = read_value(turned, report, name, -100, 100)
    elif speed is not None and across is not None:
        yaw = math.atan2(across, speed)
    else:
        refuse(node.file, node.place, "has no orientation", "state it, or velocityY")
    components = None
    if speed is not None and across is not None and turned is None:
        components = (speed, across)
    elif speed is not None:
        slip = node.child("slipAngle")
        course = yaw + (0.0 if slip is None else read_value(slip, report, name, -4, 4))
        components = (speed * math.cos(course), speed * math.sin(course))
    yaw_rate = None if rate is None else read_value(rate, report, name, -100, 100)
    return State(time_s, Pose(x, y, yaw), components, yaw_rate)


def _position(node: Node, report: Report, name: str) -> tuple[float, float]:
    point = node.child("point")
    if point is not None:
        return point.need("x").number(-1e7, 1e7), point.need("y").number(-1e7, 1e7)
    shapes = node.children("rectangle", "circle", "polygon")
    if not shapes:
        refuse(node.file, node.place, "has neither a point nor a shape", "give its point")
    report.assume("positions in a region are read as its middle", name)
    middle = _outline(shapes[0], report, name).box[0]
    return middle.x_m, middle.y_m
