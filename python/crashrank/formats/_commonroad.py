"""CommonRoad scenarios: XML of the versions 2018b and 2020a."""

from __future__ import annotations

from ._boxes import Box
from ._commonroad_shapes import (
    MAX_POINTS,
    Outline,
    placed,
    read_outline,
    read_points,
    read_state,
    read_value,
    standing_boxes,
)
from ._document import Imported, make_document
from ._refusals import checked_choices, choice_error, number, refuse
from ._road import areas_between, reach_of
from ._scene import (
    DEFAULT_SIZE_M,
    LONGEST_CAR_M,
    Body,
    Pose,
    Report,
    Ring,
    Scene,
    State,
    Track,
    completed_size,
    kind_by_size,
)
from ._sets import paths_through_sets
from ._tracks import checked_track, forward_speed, state_at
from ._xml import Node, read_xml

VERSIONS = ("2018b", "2020a")
_KINDS = {
    "car": "car",
    "taxi": "car",
    "priorityVehicle": "car",
    "parkedVehicle": "car",
    "truck": "truck",
    "bus": "bus",
    "motorcycle": "motorcycle",
    "bicycle": "bicycle",
    "pedestrian": "pedestrian",
    "train": "truck",
    "constructionZone": "barrier",
    "roadBoundary": "barrier",
    "median_strip": "barrier",
    "building": "building",
    "pillar": "pole",
}
_TRAIN_KG = 100_000.0
_NOT_READ = ("trafficSign", "trafficLight", "intersection", "area")
# Length, width and wheelbase of the vehicle of planning problems, m: vehicle 2 of the CommonRoad
# vehicle models, a BMW 320i. A problem states no vehicle.
_PROBLEM_SIZE_M = (4.508, 1.61)
_PROBLEM_WHEELBASE_M = 2.5789


def read_commonroad(
    path: object,
    time_step: int | None = None,
    ego: str | int | None = None,
    *,
    time_s: float | None = None,
    horizon_s: float = 4.0,
) -> Imported:
    """Read a CommonRoad scenario.

    Parameters
    ----------
    path : path
        XML of version 2018b or 2020a, as other tools or commonroad-io write it.
    time_step : int, optional
        Moment of decision. Default: where the ego begins.
    ego : str or int, optional
        Id of a planning problem or of a dynamic obstacle. Default: the first planning problem.
    time_s : float, optional
        The moment of decision in seconds, in place of `time_step`.
    horizon_s : float, default 4
        Seconds after it that count.

    Returns
    -------
    Imported
        The scenario and a report.

    Raises
    ------
    BadInputError, LimitError, NotFoundError, UsageError
        One line: file, element with its line, reason, remedy.
    """
    chosen, at_s, horizon = checked_choices(ego, time_s, horizon_s)
    root = read_xml(path, "commonRoad", "CommonRoad scenario")
    version = root.get("commonRoadVersion") or ""
    if version not in VERSIONS:
        refuse(
            root.file, root.place, f"has the version {version!r}",
            f"convert it with commonroad-io to {VERSIONS[-1]}",
        )  # fmt: skip
    step_s = number(root.attribute("timeStepSize"), root.file, root.place, 1e-4, 60)
    if at_s is None and time_step is not None:
        at_s = step_s * number(time_step, root.file, "time_step", -1e6, 1e6)
    report = Report(f"CommonRoad {version}", root.file)
    report.assume(f"between states, {step_s:g} s apart, bodies move evenly")
    reader = _Reader(root, step_s, report)
    found = reader.ego(chosen)
    if at_s is None:
        at_s = found.tracks[0].states[0].t_s
    name = root.get("benchmarkID") or "CommonRoad scenario"
    bodies = reader.bodies(found, horizon)
    at = state_at(found.tracks[0], at_s)
    areas = reader.areas(at.pose, reach_of(forward_speed(at), horizon))
    return make_document(Scene(name, at_s, found, bodies, report, areas, horizon))


class _Reader:
    """The elements of one file."""

    def __init__(self, root: Node, step_s: float, report: Report) -> None:
        self._root = root
        self._step_s = step_s
        self._report = report
        self._obstacles = root.children("obstacle", "dynamicObstacle", "staticObstacle")
        counts = {tag: len(root.children(tag)) for tag in _NOT_READ}
        for tag, count in counts.items():
            if count:
                report.leave_out(f"{count} elements {tag}: rules and signals have no effect here")

    def ego(self, chosen: str | None) -> Body:
        """Return the body that decides."""
        problems = self._root.children("planningProblem")
        moving = [node for node in self._obstacles if not _stands(node)]
        if chosen is None and problems:
            if len(problems) > 1:
                self._report.assume(f"the first of {len(problems)} planning problems is the ego")
            return self._problem(problems[0])
        for node in moving:
            if node.get("id") == chosen:
                body = self._moving(node, 60.0)
                body.tracks = body.tracks[:1]
                return body
        for node in problems:
            if node.get("id") == chosen:
                return self._problem(node)
        known = [f"planning problem {node.get('id')}" for node in problems[:5]]
        known += [str(node.get("id")) for node in moving[:20]]
        what = "has no planning problem" if chosen is None else f"has no ego {chosen!r}"
        choice = f"choose an ego: {', '.join(known)}" if known else "it has no vehicle that moves"
        raise choice_error(self._root.file, "ego", what, choice)

    def _problem(self, node: Node) -> Body:
        name = f"planning problem {node.get('id') or ''}".strip()
        state = read_state(node.need("initialState"), self._step_s, self._report, name)
        self._report.assume(
            f"{name} is a car of {_PROBLEM_SIZE_M[0]:g} x {_PROBLEM_SIZE_M[1]:g} m, and its "
            "position the car's middle"
        )
        size = (*_PROBLEM_SIZE_M, DEFAULT_SIZE_M["car"][2])
        return Body(
            name, node.place, "car", size, [Track([state])], wheelbase_m=_PROBLEM_WHEELBASE_M
        )

    def bodies(self, ego: Body, horizon_s: float) -> list[Body]:
        """Return everything that can be hit but the ego."""
        found: list[Body] = []
        for node in self._obstacles:
            if node.place == ego.place:
                continue
            found += self._standing(node) if _stands(node) else [self._moving(node, horizon_s)]
        for node in self._root.children("environmentObstacle"):
            outline = read_outline(node.need("shape"), self._report, _name(node))
            found += self._boxes(node, standing_boxes(outline, Pose(0.0, 0.0, 0.0)), "building")
        for node in self._root.children("phantomObstacle"):
            self._report.leave_out(f"{_name(node)}: a phantom, nobody has seen anything there")
        return found

    def _standing(self, node: Node) -> list[Body]:
        name = _name(node)
        outline = read_outline(node.need("shape"), self._report, name)
        state = read_state(node.need("initialState"), self._step_s, self._report, name)
        kind = self._kind(node, outline, moving=False)
        return self._boxes(node, standing_boxes(outline, state.pose), kind)

    def _boxes(self, node: Node, boxes: list[Box], kind: str) -> list[Body]:
        """Return one body for each box of something that stands."""
        name = _name(node)
        if len(boxes) > 1:
            self._report.assume("stands as walls along its outline", name)
            kind = "building"
        bodies = []
        for i, (pose, length, width) in enumerate(boxes):
            size = completed_size(kind, length, width, 0.0, self._report, name)
            part = name if len(boxes) == 1 else f"{name} wall {i + 1}"
            track = Track([State(0.0, pose, (0.0, 0.0), 0.0)])
            bodies.append(Body(part, node.place, kind, size, [track], stands=True))
        return bodies

    def _moving(self, node: Node, horizon_s: float) -> Body:
        name = _name(node)
        outline = read_outline(node.need("shape"), self._report, name)
        kind = self._kind(node, outline, moving=True)
        if len(outline.corners) > 2 and not outline.round and node.at("shape", "polygon"):
            self._report.assume("its outline is the rectangle around it", name)
        start = read_state(node.need("initialState"), self._step_s, self._report, name)
        size = completed_size(kind, outline.box[1], outline.box[2], 0.0, self._report, name)
        first = _centred(start, outline)
        trajectory, sets = node.child("trajectory"), node.child("occupancySet")
        if trajectory is not None:
            states = [start] + [
                read_state(state, self._step_s, self._report, name)
                for state in trajectory.children("state")
            ]
            tracks = [Track(checked_track([_centred(state, outline) for state in states]))]
        elif sets is not None:
            tracks = paths_through_sets(first, size, self._sets(sets, name), horizon_s)
            self._report.assume(
                f"moves along one of {len(tracks)} paths through its sets, all as probable", name
            )
        else:
            tracks = [Track([first])]
        mass = _TRAIN_KG if node.at("type") and _type(node) == "train" else None
        return Body(
            name, node.place, kind, size, tracks, mass_kg=mass, wheelbase_m=outline.wheelbase_m
        )

    def _sets(self, node: Node, name: str) -> list[tuple[float, Ring]]:
        """Return times and corners of what may be occupied, in the file's plane."""
        found: dict[float, Ring] = {}
        for occupancy in node.children("occupancy"):
            step = read_value(occupancy.need("time"), self._report, name, -1e7, 1e7)
            outline = read_outline(occupancy.need("shape"), self._report, name)
            found[step * self._step_s] = outline.corners
        return sorted(found.items())

    def _kind(self, node: Node, outline: Outline, *, moving: bool) -> str:
        stated = _type(node)
        kind = _KINDS.get(stated)
        if stated == "train":
            self._report.assume(f"trains are trucks of {_TRAIN_KG / 1000:g} t")
        if kind is None or (moving and kind in ("barrier", "pole", "building")):
            size = (outline.box[1], outline.box[2], 0.0)
            standing = "pole" if outline.round else "building"
            kind = kind_by_size(size) if moving else standing
            self._report.assume(
                f"{'moves' if moving else 'stands'}, so it is a {kind}", _name(node)
            )
        if kind == "car" and outline.box[1] > LONGEST_CAR_M:
            kind = "truck"
            self._report.assume(f"longer than {LONGEST_CAR_M:g} m, so it is a truck", _name(node))
        return kind

    def areas(self, ego: Pose, reach_m: float) -> list[Ring]:
        """Return the lanelets within reach of the ego, but those for walking."""
        lines: list[tuple[Ring, Ring]] = []
        walked = 0
        for node in self._root.children("lanelet"):
            types = {child.text() for child in node.children("laneletType")}
            if types and types <= {"sidewalk", "crosswalk"}:
                walked += 1
                continue
            left, right = (
                read_points(node.need(side), MAX_POINTS) for side in ("leftBound", "rightBound")
            )
            lines.append((left, right))
        if walked:
            self._report.leave_out(f"{walked} lanelets for walking: no drivable areas")
        return areas_between(lines, ego, reach_m, self._report)


def _name(node: Node) -> str:
    return f"{_type(node) or node.tag} {node.get('id') or ''}".strip()


def _type(node: Node) -> str:
    stated = node.child("type")
    return "" if stated is None else stated.text()


def _stands(node: Node) -> bool:
    if node.tag == "obstacle":
        role = node.child("role")
        return role is not None and role.text() == "static"
    return node.tag == "staticObstacle"


def _centred(state: State, outline: Outline) -> State:
    """Return the state of the middle of the box, which moves as the reference point turns."""
    middle = placed(state.pose, outline.box)
    velocity = state.velocity_mps
    if velocity is not None and state.yaw_rate_radps:
        rate = state.yaw_rate_radps
        velocity = (
            velocity[0] - rate * (middle.y_m - state.pose.y_m),
            velocity[1] + rate * (middle.x_m - state.pose.x_m),
        )
    return State(state.t_s, middle, velocity, state.yaw_rate_radps)
