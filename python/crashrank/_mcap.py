"""MCAP files with Foxglove's messages of a report's scene; needs ``crashrank[mcap]``."""

from __future__ import annotations

import importlib.util
import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import NotFoundError
from ._played import (
    ARROW_S,
    CONTACT_COLOUR,
    EGO,
    EGO_COLOUR,
    FUTURE_COLOUR,
    OTHER_COLOUR,
    ROAD_COLOUR,
    TEXT_COLOUR,
    Floats,
    PlayedCandidate,
    PlayedScene,
)

if TYPE_CHECKING:
    from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
    from mcap_protobuf.writer import Writer

WORLD = "world"


def topic_of(candidate: PlayedCandidate) -> str:
    """Return the topic with the scene of a candidate."""
    word = re.sub(r"[^0-9a-z]+", "_", candidate.name.lower()).strip("_")
    return f"/candidates/{candidate.row + 1}_{word}".rstrip("_")


def layout_path(path: str) -> Path:
    """Return where the layout for a file is written: out.layout.json beside out.mcap."""
    return Path(path).with_suffix(".layout.json")


def check_packages() -> None:
    """Raise `NotFoundError` where a package of the extra is missing."""
    from ._tables import missing

    packages = {
        "mcap_protobuf": "mcap-protobuf-support",
        "foxglove_schemas_protobuf": "foxglove-schemas-protobuf",
    }
    for module, package in packages.items():
        if importlib.util.find_spec(module) is None:
            raise missing(package, "mcap")


def write_mcap(page: str, path: str) -> None:
    """Write the scene of a report's page, and a layout for Foxglove beside it.

    Topics: ``/ranking`` (Log, places and contacts in words), ``/transforms`` (FrameTransforms,
    every body of every candidate in a frame of its own), ``/road`` and one topic for each
    candidate (SceneUpdate). A viewer that jumps to a time shows the last message of a topic: each
    has all bodies of its candidate.
    """
    check_packages()
    from mcap_protobuf.writer import Writer

    scene = PlayedScene(page)
    try:
        with open(path, "wb") as file, Writer(file) as writer:
            _Recorder(writer, scene).write()
        layout = json.dumps(_layout(scene), indent=1, ensure_ascii=False)
        layout_path(path).write_text(layout + "\n", encoding="utf-8")
    except OSError as error:
        raise NotFoundError(
            "not_found", path, "", f"cannot be written: {error.strerror}", "choose another file"
        ) from error


class _Recorder:
    def __init__(self, writer: Writer, scene: PlayedScene) -> None:
        self._writer = writer
        self._scene = scene
        self._meshes: dict[tuple[int, bytes], SceneEntity] = {}

    def write(self) -> None:
        from foxglove_schemas_protobuf.Log_pb2 import Log

        self._put("/road", 0.0, self._update(0.0, [self._road()]))
        lines = []
        for candidate in self._scene.candidates:
            lines.append((0.0, candidate.title))
            for each in candidate.contacts:
                words = f"{candidate.place}. {candidate.name}: {self._scene.contact_words(each)}"
                lines.append((each.time_s, words))
            self._transforms(candidate)
            for time_s in candidate.state_times:
                self._put(topic_of(candidate), time_s, self._state(candidate, time_s))
        for time_s, words in sorted(lines, key=lambda each: each[0]):
            log = Log(level=Log.INFO, message=words, name="crashrank")
            _stamp(log.timestamp, time_s)
            self._put("/ranking", time_s, log)

    def _put(self, topic: str, time_s: float, message: Any) -> None:
        nanos = _nanos(time_s)
        self._writer.write_message(topic, message, log_time=nanos, publish_time=nanos)

    def _update(self, time_s: float, entities: list[SceneEntity]) -> Any:
        from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

        for each in entities:
            _stamp(each.timestamp, time_s)
        return SceneUpdate(entities=entities)

    def _frame(self, candidate: PlayedCandidate, body: int) -> str:
        return f"{candidate.row + 1}/{self._scene.name(body)}"

    def _transforms(self, candidate: PlayedCandidate) -> None:
        """Write where the bodies are: of one that stays, where its stay begins and ends.

        Viewers interpolate between the times that are there.
        """
        from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms

        times = candidate.times
        poses = {body: candidate.poses(body, times) for body in self._scene.bodies}
        needed = {}
        for body, pose in poses.items():
            moves = np.any(np.diff(np.hstack(pose), axis=0), axis=1)
            needed[body] = np.append(moves, False) | np.insert(moves, 0, True)
        for i, time_s in enumerate(times):
            message = FrameTransforms()
            for body, (points, turns) in poses.items():
                if not needed[body][i]:
                    continue
                each = message.transforms.add(
                    parent_frame_id=WORLD, child_frame_id=self._frame(candidate, body)
                )
                _stamp(each.timestamp, float(time_s))
                _set_point(each.translation, points[i])
                each.rotation.x, each.rotation.y, each.rotation.z, each.rotation.w = turns[i]
            if message.transforms:
                self._put("/transforms", float(time_s), message)

    def _state(self, candidate: PlayedCandidate, time_s: float) -> Any:
        entities = [self._ways(candidate), self._contacts(candidate, time_s)]
        entities += [self._body(candidate, body, time_s) for body in self._scene.bodies]
        return self._update(time_s, entities)

    def _body(self, candidate: PlayedCandidate, body: int, time_s: float) -> SceneEntity:
        damage = candidate.damage(body, time_s)
        key = (body, b"" if damage is None else damage.tobytes())
        if key not in self._meshes:
            self._meshes[key] = self._mesh(body, damage)
        entity = _entity(self._scene.name(body), self._frame(candidate, body), candidate)
        entity.frame_locked = True
        entity.MergeFrom(self._meshes[key])
        return entity

    def _mesh(self, body: int, damage: Any) -> SceneEntity:
        from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity

        entity = SceneEntity()
        mesh = self._scene.mesh(body)
        colours, which = np.unique(mesh.painted(damage), axis=0, return_inverse=True)
        for i, colour in enumerate(colours):
            used, indices = np.unique(mesh.triangles[which.ravel() == i], return_inverse=True)
            triangles = entity.triangles.add(indices=indices.ravel().tolist())
            _set_colour(triangles.color, colour)
            triangles.pose.orientation.w = 1.0
            for x, y, z in mesh.corners[used]:
                triangles.points.add(x=x, y=y, z=z)
        _add_text(entity, self._scene.name(body), self._scene.label_point(body), TEXT_COLOUR)
        return entity

    def _contacts(self, candidate: PlayedCandidate, time_s: float) -> SceneEntity:
        """Return the contacts until then, with changes of velocity as arrows."""
        entity = _entity("contacts", WORLD, candidate)
        for contact in candidate.contacts_by(time_s):
            sphere = entity.spheres.add()
            sphere.pose.orientation.w = 1.0
            _set_point(sphere.pose.position, contact.point_m)
            sphere.size.x = sphere.size.y = sphere.size.z = 0.3
            _set_colour(sphere.color, CONTACT_COLOUR)
            above = contact.point_m + np.array([0.0, 0.0, 1.0])
            _add_text(entity, self._scene.contact_words(contact), above, CONTACT_COLOUR)
            for body, kick in zip(contact.bodies, contact.kicks_mps, strict=True):
                length = ARROW_S * float(np.linalg.norm(kick))
                if length < ARROW_S:
                    continue
                arrow = entity.arrows.add(head_length=0.4, head_diameter=0.4, shaft_diameter=0.15)
                arrow.shaft_length = max(0.0, length - arrow.head_length)
                _set_point(arrow.pose.position, contact.point_m)
                half = 0.5 * float(np.arctan2(kick[1], kick[0]))
                arrow.pose.orientation.z, arrow.pose.orientation.w = np.sin(half), np.cos(half)
                _set_colour(arrow.color, EGO_COLOUR if body == EGO else OTHER_COLOUR)
        return entity

    def _ways(self, candidate: PlayedCandidate) -> SceneEntity:
        entity = _entity("ways", WORLD, candidate)
        _add_line(entity, candidate.way(), 0.15, EGO_COLOUR)
        for label, way in self._scene.elsewhere():
            _add_line(entity, way, 0.1, FUTURE_COLOUR)
            _add_text(entity, label, way[-1], FUTURE_COLOUR)
        return entity

    def _road(self) -> SceneEntity:
        entity = _entity("road", WORLD, None)
        for border in self._scene.road():
            _add_line(entity, border, 0.1, ROAD_COLOUR)
        return entity


def _entity(name: str, frame: str, candidate: PlayedCandidate | None) -> SceneEntity:
    from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity

    entity = SceneEntity(id=name, frame_id=frame)
    if candidate is not None:
        entity.metadata.add(key="candidate", value=candidate.name)
        entity.metadata.add(key="place", value=candidate.place)
        entity.metadata.add(key="score", value=candidate.score_words)
    return entity


def _add_text(entity: SceneEntity, words: str, at: Floats, colour: Any) -> None:
    text = entity.texts.add(text=words, billboard=True, font_size=14.0, scale_invariant=True)
    text.pose.orientation.w = 1.0
    _set_point(text.pose.position, at)
    _set_colour(text.color, colour)


def _add_line(entity: SceneEntity, points: Floats, thickness_m: float, colour: Any) -> None:
    line = entity.lines.add(thickness=thickness_m)  # the type that is default: a strip
    line.pose.orientation.w = 1.0
    _set_colour(line.color, colour)
    for point in points:
        _set_point(line.points.add(), point)


def _set_point(message: Any, point: Floats) -> None:
    message.x, message.y, message.z = point


def _set_colour(message: Any, rgb: Any) -> None:
    message.r, message.g, message.b = (value / 255.0 for value in rgb)
    message.a = 1.0


def _nanos(time_s: float) -> int:
    return round(1e9 * time_s)


def _stamp(message: Any, time_s: float) -> None:
    message.FromNanoseconds(_nanos(time_s))


def _layout(scene: PlayedScene) -> dict[str, Any]:
    """Return a layout: the first candidate from behind and above, all candidates in words."""
    first = scene.candidates[0]
    at_s = first.contacts[0].time_s if first.contacts else 0.0
    points, _ = first.poses(EGO, np.array([0.0, at_s]))
    topics = {topic_of(each): {"visible": each is first} for each in scene.candidates}
    view = {
        "cameraState": {
            "perspective": True,
            "distance": 20.0 + float(np.linalg.norm(points[1] - points[0])),
            "phi": 60.0,
            "thetaOffset": 45.0,
            "target": [0.0, 0.0, 0.0],
            "targetOffset": points.mean(axis=0).tolist(),
            "targetOrientation": [0.0, 0.0, 0.0, 1.0],
            "fovy": 45.0,
            "near": 0.5,
            "far": 5000.0,
        },
        "followMode": "follow-none",
        "followTf": WORLD,
        "scene": {"transforms": {"axisScale": 0, "showLabel": False, "enablePreloading": True}},
        "transforms": {},
        "topics": {"/road": {"visible": True}, **topics},
        "layers": {"grid": {"visible": True, "layerId": "foxglove.Grid", "instanceId": "grid",
                            "size": 200, "divisions": 20, "frameId": WORLD}},
    }  # fmt: skip
    return {
        "configById": {"3D!scene": view, "RosOut!ranking": {"topicToRender": "/ranking"}},
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 0.25},
        "layout": {
            "direction": "column",
            "first": "3D!scene",
            "second": "RosOut!ranking",
            "splitPercentage": 75,
        },
    }
