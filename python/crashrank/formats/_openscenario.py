"""OpenSCENARIO XML 1.x: entities that stand, keep their speed or follow a timed polyline.

Everything else, triggers and lane changes above all, is decided by an engine while it simulates.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NoReturn

from .._errors import BadInputError
from ._document import Imported, make_document
from ._entities import Entity, read_entities
from ._parameters import Parameters
from ._refusals import checked_choices, input_error, refuse
from ._scene import FIXED, Body, Pose, Report, Scene, State, Track, moved, velocity_along
from ._tables import ego_of
from ._tracks import checked_track
from ._xml import Node, read_xml

MAX_VERTICES = 200_000
_ENGINE = (
    "run it in esmini with --csv_logger LOG.csv and import that as esmini-csv, or let esmini's "
    "dat2xosc write it as trajectories"
)
_WITHOUT_EFFECT = ("VisibilityAction", "EnvironmentAction", "AppearanceAction")


def read_openscenario(
    path: object,
    time_s: float | None = None,
    ego: str | int | None = None,
    *,
    horizon_s: float = 4.0,
) -> Imported:
    """Read an OpenSCENARIO XML file of version 1.x that needs no engine.

    Read are world positions, initial speeds, and `FollowTrajectoryAction` along polylines that
    start with the simulation or at a stated time. The first element that needs an engine is
    refused with its line. What the ego would do after time 0 is left out: its candidates take the
    place of that.

    Parameters
    ----------
    path : path
        The file. Catalogues are those of the directories of its CatalogLocations, which lie in its
        folder or below; without any they are searched for there.
    time_s : float, optional
        Moment of decision, seconds of simulation. Default: 0.
    ego : str, optional
        Name of an entity. Default: the one named Ego, Host or Hero, else the first vehicle.
    horizon_s : float, default 4
        Seconds after the moment of decision that count.
    """
    chosen, at_s, horizon = checked_choices(ego, time_s, horizon_s)
    at_s = at_s or 0.0
    root = read_xml(path, "OpenSCENARIO", "OpenSCENARIO file")
    header = root.need("FileHeader")
    if header.get("revMajor") != "1":
        refuse(
            root.file, header.place, f"has the version {header.get('revMajor')}.x",
            "convert it to OpenSCENARIO XML 1.x",
        )  # fmt: skip
    if root.child("Storyboard") is None:
        refuse(root.file, root.place, "has no Storyboard: a catalogue", "name a scenario")
    report = Report(f"OpenSCENARIO 1.{header.get('revMinor') or '?'}", root.file)
    parameters = Parameters().declared(root.child("ParameterDeclarations"))
    entities = read_entities(root, parameters, report)
    stubs = {
        name: Body(name, each.node.place, each.kind, each.size_m, [])
        for name, each in entities.items()
    }
    name = ego_of(stubs, chosen, report)
    actors = {key: _Actor(entity) for key, entity in entities.items()}
    story = _Story(root, parameters, actors, name, report, at_s > 0.0)
    story.read()
    bodies: dict[str, Body] = {}
    for key, actor in actors.items():
        body = actor.body(report)
        if body is not None:
            bodies[key] = body
    if name not in bodies:
        refuse(root.file, f"entity {name}", "has no position", "give it a TeleportAction")
    others = [body for key, body in bodies.items() if key != name]
    if root.at("RoadNetwork", "LogicFile") is not None:
        report.leave_out("the road network: the road has no end")
    title = header.get("description") or "OpenSCENARIO"
    return make_document(Scene(title, at_s, bodies[name], others, report, horizon_s=horizon))


@dataclass
class _Actor:
    """An entity and what the storyboard does with it; poses are those of its origin."""

    entity: Entity
    start: Pose | None = None
    speed_mps: float | None = None
    followed: list[State] = field(default_factory=list)

    def body(self, report: Report) -> Body | None:
        entity = self.entity
        states = list(self.followed)
        if self.start is not None and (not states or states[0].t_s > 1e-6):
            speed = self.speed_mps or 0.0
            velocity = velocity_along(self.start.yaw_rad, speed)
            states.insert(0, State(0.0, self.start, velocity, 0.0))
            if speed and not self.followed:
                report.assume("keeps its speed and goes straight on: no road is read", entity.name)
        if not states:
            report.leave_out(f"{entity.name}: it has no position")
            return None
        centred = [
            State(s.t_s, moved(s.pose, *entity.centre_m), s.velocity_mps, s.yaw_rate_radps)
            for s in checked_track(states)
        ]
        stands = entity.kind in FIXED or (len(centred) == 1 and not self.speed_mps)
        return Body(
            entity.name, entity.node.place, entity.kind, entity.size_m, [Track(centred)],
            stands=stands, mass_kg=entity.mass_kg, wheelbase_m=entity.wheelbase_m,
        )  # fmt: skip


class _Story:
    """The storyboard: initial actions, and events that start at known times."""

    def __init__(
        self, root: Node, parameters: Parameters, actors: dict[str, _Actor], ego: str,
        report: Report, later: bool,
    ) -> None:  # fmt: skip
        self._board = root.need("Storyboard")
        self._parameters = parameters
        self._actors = actors
        self._ego = ego
        self._report = report
        self._later = later

    def read(self) -> None:
        """Fill in what happens to the actors."""
        actions = self._board.at("Init", "Actions")
        for node in actions.children("Private") if actions is not None else []:
            actor = self._actor(node, self._parameters)
            delayed = []
            for action in node.children("PrivateAction"):
                kind, detail = _innermost(action)
                if kind == "FollowTrajectoryAction":
                    delayed.append(detail)  # after the position and the speed
                else:
                    self._initial(actor, kind, detail)
            for detail in delayed:
                self._follow(actor, detail, 0.0, self._parameters)
        for story in self._board.children("Story"):
            parameters = self._parameters.declared(story.child("ParameterDeclarations"))
            for act in story.children("Act"):
                start_s = self._start(act, 0.0, parameters)
                for group in act.children("ManeuverGroup"):
                    self._group(group, start_s, parameters)

    def _actor(self, node: Node, parameters: Parameters) -> _Actor:
        name = parameters.text(node, "entityRef")
        if name not in self._actors:
            refuse(node.file, node.place, f"names the unknown entity {name!r}", "declare it")
        return self._actors[name]

    def _initial(self, actor: _Actor, kind: str, node: Node) -> None:
        parameters = self._parameters
        if kind == "TeleportAction":
            actor.start = _world(node.need("Position"), parameters, None)
        elif kind == "SpeedAction":
            target = node.at("SpeedActionTarget", "AbsoluteTargetSpeed")
            dynamics = node.child("SpeedActionDynamics")
            at_once = dynamics is None or (
                parameters.text(dynamics, "dynamicsShape", "step") == "step"
                or parameters.number(dynamics, "value", 0.0) == 0.0
            )
            if target is None or not at_once:
                _engine(node)
            actor.speed_mps = parameters.number(target, "value", low=-150, high=150)
        elif kind in _WITHOUT_EFFECT:
            return
        elif actor.entity.name == self._ego and not self._later:
            self._report.leave_out(f"{kind} of the ego: its candidates take the place of it")
        else:
            _engine(node)

    def _group(self, group: Node, start_s: float, parameters: Parameters) -> None:
        found = group.need("Actors")
        if found.get("selectTriggeringEntities") == "true":
            _engine(found)
        actors = [self._actor(each, parameters) for each in found.children("EntityRef")]
        if group.children("CatalogReference"):
            _engine(group.need("CatalogReference"))
        only_ego = bool(actors) and all(each.entity.name == self._ego for each in actors)
        for maneuver in group.children("Maneuver"):
            inner = parameters.declared(maneuver.child("ParameterDeclarations"))
            for event in maneuver.children("Event"):
                if only_ego and not self._later:
                    self._report.leave_out(
                        f"{event.place} of the ego: its candidates take the place of it"
                    )
                    continue
                self._event(event, actors, start_s, inner)

    def _event(
        self, event: Node, actors: list[_Actor], start_s: float, parameters: Parameters
    ) -> None:
        actions = event.children("Action")
        kinds = [_innermost(child) for action in actions for child in action.children()]
        if all(kind in _WITHOUT_EFFECT for kind, _ in kinds):
            return
        for kind, node in kinds:
            if kind != "FollowTrajectoryAction" and kind not in _WITHOUT_EFFECT:
                _engine(node)
        at_s = self._start(event, start_s, parameters)
        for kind, node in kinds:
            if kind == "FollowTrajectoryAction":
                for actor in actors:
                    self._follow(actor, node, at_s, parameters)

    def _start(self, node: Node, otherwise_s: float, parameters: Parameters) -> float:
        """Return when an act or event starts; refuse conditions that only an engine can decide."""
        trigger = node.child("StartTrigger")
        conditions = trigger.descendants("Condition") if trigger is not None else []
        if not conditions:
            return otherwise_s
        if len(conditions) > 1:
            _engine(conditions[1])
        condition = conditions[0]
        delay = parameters.number(condition, "delay", 0.0, 0, 1e5)
        timed = condition.at("ByValueCondition", "SimulationTimeCondition")
        if timed is not None and parameters.text(timed, "rule", "greaterThan") != "lessThan":
            return max(otherwise_s, parameters.number(timed, "value", low=-1e5, high=1e5)) + delay
        state = condition.at("ByValueCondition", "StoryboardElementStateCondition")
        if state is not None and (
            parameters.text(state, "state", "") in ("startTransition", "runningState")
            and parameters.text(state, "storyboardElementType", "") in ("act", "story")
        ):
            return otherwise_s + delay
        raise _engine_error(_deciding(condition))

    def _follow(self, actor: _Actor, node: Node, at_s: float, parameters: Parameters) -> None:
        if parameters.number(node, "initialDistanceOffset", 0.0) != 0.0:
            _engine(node)
        if node.descendants("CatalogReference"):
            _engine(node.descendants("CatalogReference")[0])
        trajectory = node.child("Trajectory") or node.at("TrajectoryRef", "Trajectory")
        if trajectory is None:
            refuse(node.file, node.place, "has no Trajectory", "add it")
        scope = parameters.declared(trajectory.child("ParameterDeclarations"))
        polyline = trajectory.at("Shape", "Polyline")
        if polyline is None:
            _engine(trajectory.child("Shape") or trajectory)
        vertices = polyline.children("Vertex")
        if not 2 <= len(vertices) <= MAX_VERTICES:
            refuse(
                polyline.file, polyline.place, f"has {len(vertices)} vertices",
                f"give 2 to {MAX_VERTICES}",
            )  # fmt: skip
        poses = _headed([_vertex(vertex, scope) for vertex in vertices])
        times = self._times(actor, node, vertices, poses, at_s, scope)
        actor.followed += [State(t, pose) for t, pose in zip(times, poses, strict=True)]

    def _times(
        self, actor: _Actor, node: Node, vertices: list[Node], poses: list[Pose], at_s: float,
        parameters: Parameters,
    ) -> list[float]:  # fmt: skip
        """Return when each vertex is reached: as stated, or at the entity's initial speed."""
        timing = node.at("TimeReference", "Timing")
        if timing is not None:
            scale = parameters.number(timing, "scale", 1.0, 1e-6, 1e6)
            offset = parameters.number(timing, "offset", 0.0, -1e6, 1e6)
            absolute = parameters.text(timing, "domainAbsoluteRelative", "absolute") == "absolute"
            origin = offset if absolute else offset + at_s
            times = [origin + scale * parameters.number(each, "time") for each in vertices]
        else:
            speed = abs(actor.speed_mps or 0.0)
            if speed < 0.01:
                refuse(
                    node.file, node.place, "has no Timing, and its entity no initial speed",
                    "state a TimeReference with Timing, or the speed",
                )  # fmt: skip
            name = actor.entity.name
            self._report.assume("follows its trajectory at its initial speed", name)
            times = [at_s]
            for a, b in pairwise(poses):
                times.append(times[-1] + math.dist(a[:2], b[:2]) / speed)
        if any(b < a for a, b in pairwise(times)):
            refuse(node.file, node.place, "has times that fall", "order the vertices by time")
        return times


def _innermost(node: Node) -> tuple[str, Node]:
    """Return the action that others only wrap, and its name."""
    wrappers = (
        "PrivateAction", "GlobalAction", "LongitudinalAction", "LateralAction", "RoutingAction",
    )  # fmt: skip
    while node.tag in wrappers and node.children():
        node = node.children()[0]
    return node.tag, node


def _deciding(condition: Node) -> Node:
    """Return the element of a condition that says what it waits for."""
    wrappers = ("ByEntityCondition", "ByValueCondition", "EntityCondition")
    for node in condition.walk():
        if node.tag.endswith("Condition") and node.tag not in wrappers:
            return node
    return condition


def _vertex(vertex: Node, parameters: Parameters) -> tuple[Pose, bool]:
    """Return the pose of a vertex, and whether it states a heading."""
    position = vertex.need("Position")
    world = position.child("WorldPosition")
    stated = world is not None and world.get("h") is not None
    return _world(position, parameters, 0.0), stated


def _headed(vertices: list[tuple[Pose, bool]]) -> list[Pose]:
    """Return poses; those without a heading look to the next vertex, the last as the one before."""
    if any(stated for _, stated in vertices):
        return [pose for pose, _ in vertices]
    poses: list[Pose] = []
    for i, (pose, _) in enumerate(vertices):
        yaw = poses[-1].yaw_rad if poses else 0.0
        for after, _ in vertices[i + 1 :]:
            if math.dist(pose[:2], after[:2]) > 1e-3:
                yaw = math.atan2(after.y_m - pose.y_m, after.x_m - pose.x_m)
                break
        poses.append(Pose(pose.x_m, pose.y_m, yaw))
    return poses


def _world(position: Node, parameters: Parameters, otherwise: float | None) -> Pose:
    """Return a world position; others depend on the road or on other entities."""
    world = position.child("WorldPosition")
    if world is None:
        _engine(next(iter(position.children()), position))
    return Pose(
        parameters.number(world, "x", low=-1e7, high=1e7),
        parameters.number(world, "y", low=-1e7, high=1e7),
        parameters.number(world, "h", otherwise or 0.0, -1e4, 1e4),
    )


def _engine_error(node: Node) -> BadInputError:
    return input_error(node.file, node.place, f"{node.tag} needs a simulation engine", _ENGINE)


def _engine(node: Node) -> NoReturn:
    raise _engine_error(node)
