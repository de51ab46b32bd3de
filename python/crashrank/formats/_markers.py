"""Rankings as markers of ROS 2 in a bag, for RViz and Foxglove."""

from __future__ import annotations

import math
import os
import pathlib
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._checks import as_path, as_text
from .._errors import NotFoundError, no_candidate, usage
from .._ranking import Ranking
from ._bag import typestore
from ._refusals import required_module
from ._scene import DEFAULT_SIZE_M

PATH_POINTS = 40
_KIND = "visualization_msgs/msg/Marker"
_CUBE, _LINE_STRIP, _TEXT = 1, 4, 9
_EGO = (0.04, 0.43, 0.6, 0.8)
_HIT = (0.75, 0.22, 0.17, 0.8)
_OTHER = (0.54, 0.56, 0.6, 0.6)
_WHITE = (1.0, 1.0, 1.0, 1.0)


def to_markers(
    ranking: Ranking,
    path: object,
    *,
    candidate: str | None = None,
    frame: str = "map",
    topic: str = "/crashrank/markers",
) -> None:
    """Write a ranking as one MarkerArray into a new ROS 2 bag (MCAP); needs ``crashrank[ros]``.

    Namespaces: ``paths`` has a line for each candidate, from green for the least score to red for
    the greatest, wider for the one that is shown; ``bodies`` boxes around the ego and the actors
    where they are at its first contact in the likeliest future, else at the horizon, as high as
    is usual for their kind; ``text`` their names, and the candidate with its score.

    Parameters
    ----------
    path : path
        The bag's folder, which must not be there yet.
    candidate : str, optional
        Whose contact is shown. Default: the best.
    frame, topic : str
        Frame of the scenario's world coordinates, and the topic.
    """
    writer = required_module("rosbags.rosbag2", "rosbags", "ros")
    folder = as_path(path, "path")
    if os.path.lexists(folder):
        raise usage("path", f"{folder} is there already", "name a folder that is not there")
    names = [row.candidate for row in ranking]
    if candidate is not None and candidate not in names:
        raise no_candidate(candidate)
    shown = 0 if candidate is None else names.index(candidate)
    store = typestore()
    make = _Maker(store.types, as_text(frame, "frame"))
    markers = [*_paths(ranking, shown, make), *_bodies(ranking, shown, make)]
    array = make("visualization_msgs/msg/MarkerArray", markers=markers)
    data = store.serialize_cdr(array, array.__msgtype__)
    where = as_text(topic, "topic")
    try:
        with writer.Writer(
            pathlib.Path(folder), version=9, storage_plugin=writer.StoragePlugin.MCAP
        ) as bag:
            bag.write(bag.add_connection(where, array.__msgtype__, typestore=store), 0, data)
    except OSError as error:
        raise NotFoundError(
            "not_found", folder, "", f"cannot be written: {error.strerror}", "choose another folder"
        ) from None


class _Maker:
    """Makes messages of a store of types."""

    def __init__(self, types: Any, frame: str) -> None:
        self._types = types
        self._frame = frame

    def __call__(self, name: str, **members: Any) -> Any:
        return self._types[name](**members)

    def point(self, x: float, y: float, z: float, name: str = "Point") -> Any:
        """Return a message with three coordinates."""
        return self(f"geometry_msgs/msg/{name}", x=float(x), y=float(y), z=float(z))

    def colour(self, rgba: tuple[float, float, float, float]) -> Any:
        """Return a colour; members from 0 to 1."""
        return self("std_msgs/msg/ColorRGBA", **dict(zip("rgba", rgba, strict=True)))

    def marker(
        self,
        namespace: str,
        number: int,
        kind: int,
        rgba: tuple[float, float, float, float],
        scale: tuple[float, float, float],
        at: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0),
        points: tuple[Any, ...] = (),
        text: str = "",
    ) -> Any:
        """Return a marker at x, y, z, in m, turned by a heading in rad."""
        half = at[3] / 2
        now = {"sec": 0, "nanosec": 0}
        stamp = self("builtin_interfaces/msg/Time", **now)
        bytes_ = np.zeros(0, dtype=np.uint8)
        header = self("std_msgs/msg/Header", stamp=stamp, frame_id=self._frame)
        image = self("sensor_msgs/msg/CompressedImage", header=header, format="", data=bytes_)
        turned = self(
            "geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=math.sin(half), w=math.cos(half)
        )
        return self(
            _KIND, header=header, ns=namespace, id=number, type=kind, action=0,
            pose=self(
                "geometry_msgs/msg/Pose", position=self.point(*at[:3]), orientation=turned
            ),
            scale=self.point(*scale, "Vector3"), color=self.colour(rgba),
            lifetime=self("builtin_interfaces/msg/Duration", **now), frame_locked=False,
            points=list(points), colors=[], texture_resource="", texture=image,
            uv_coordinates=[], text=text, mesh_resource="",
            mesh_file=self("visualization_msgs/msg/MeshFile", filename="", data=bytes_),
            mesh_use_embedded_materials=False,
        )  # fmt: skip


def _paths(ranking: Ranking, shown: int, make: _Maker) -> Iterator[Any]:
    """Return a line for each candidate, coloured by its score or the middle of its interval."""
    times = np.linspace(0.0, ranking._ranked.horizon_s, PATH_POINTS)
    paths = ranking._ranked.candidate_paths(times)
    scores = [sum(row.score_interval) / 2 if row.score is None else row.score for row in ranking]
    low, high = min(scores), max(scores)
    for i, (path, score) in enumerate(zip(paths, scores, strict=True)):
        share = (score - low) / (high - low) if high > low else 0.0
        rgba = (share, 1.0 - share, 0.0, 1.0 if i == shown else 0.5)
        width = 0.2 if i == shown else 0.05
        points = tuple(make.point(x, y, 0.05) for x, y, _ in path)
        yield make.marker("paths", i, _LINE_STRIP, rgba, (width, 0.0, 0.0), points=points)


def _bodies(ranking: Ranking, shown: int, make: _Maker) -> Iterator[Any]:
    """Return boxes and names of the bodies at the first contact of a candidate."""
    row, ranked = ranking[shown], ranking._ranked
    at_s = ranked.horizon_s if row.time_of_impact_s is None else row.time_of_impact_s
    times = np.array([at_s])
    score = "score not known" if row.score is None else f"{row.score:.4g} {ranking.measure_unit}"
    poses = [ranked.candidate_paths(times)[shown, 0], *ranked.actor_paths(times)[:, 0]]
    for i, (body, pose) in enumerate(zip((ranking.ego, *ranking.actors), poses, strict=True)):
        x_m, y_m, yaw_rad = (float(value) for value in pose)
        middle, sides = _box(ranked.outline(i - 1))
        height = DEFAULT_SIZE_M[body.kind][2]
        ahead, left = middle
        cosine, sine = math.cos(yaw_rad), math.sin(yaw_rad)
        x_m, y_m = x_m + cosine * ahead - sine * left, y_m + sine * ahead + cosine * left
        rgba = _EGO if i == 0 else _HIT if body.name == row.other else _OTHER
        yield make.marker(
            "bodies", i, _CUBE, rgba, (*sides, height), (x_m, y_m, height / 2, yaw_rad)
        )
        text = f"{row.candidate}: {score}" if i == 0 else body.name
        above = (x_m, y_m, height + 0.5, 0.0)
        yield make.marker("text", i, _TEXT, _WHITE, (0.0, 0.0, 0.5), above, text=text)


def _box(outline: NDArray[np.float64]) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the middle and the sides of the rectangle around an outline, body axes."""
    low, high = outline.min(axis=0), outline.max(axis=0)
    (x, y), (length, width) = ((low + high) / 2).tolist(), (high - low).tolist()
    return (x, y), (length, width)
