"""Scenes as scenarios: models, ego, actors, road, and checks that need all of them."""

from __future__ import annotations

import json
import math
import os
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._boxes import overlap_depths
from ._refusals import MAX_HORIZON_S, refuse
from ._road import near_areas
from ._scene import (
    FIXED,
    MAX_POSITION_M,
    ORIGIN_SHARE,
    VEHICLES,
    Body,
    Pose,
    Report,
    Scene,
    moved,
    origin_of_box,
    wrapped,
)
from ._tracks import Motion, forward_speed, motions, state_at

MAX_ACTORS = 1_000
MAX_MODELS = 256
MAX_PREDICTIONS = 32
MAX_SIDE_M = 100.0
LEAST_SIDE_M = 0.02
LEVEL_M = 3.0
_GRADE = 0.1
# How long before an ego's only state its velocity is taken to hold, s; after it MAX_HORIZON_S.
_EARLIER_S = 1.0
_MOST_WARNINGS = 20
_MOST_PAIRS = 50_000


@dataclass
class Imported:
    """A scenario that a reader made, and its report.

    Attributes
    ----------
    scenario : dict
        With the keys of a scenario file; `crashrank.Scenario` and `crashrank.rank` take it.
    report : Report
        What was assumed and left out.
    going_on : dict
        The candidate, without its name, that goes on as the file has it: the ego's recorded motion,
        and its last velocity after that; else its speed and curvature held.
    last_s : float
        Until when the file has the ego, on its clock.
    """

    scenario: dict[str, Any]
    report: Report
    going_on: dict[str, Any]
    last_s: float = math.inf

    def to_json(self) -> str:
        """Return the text of the scenario's file."""
        return json.dumps(self.scenario, ensure_ascii=False, indent=1, allow_nan=False) + "\n"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the scenario as a file."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.to_json())


def make_document(scene: Scene) -> Imported:
    """Return the scenario of a scene, its report completed.

    Raises `BadInputError` where the ego is not there at the moment of decision, or is no vehicle.
    """
    report = scene.report
    ego = scene.ego
    if ego.kind not in VEHICLES:
        refuse(report.file, ego.place, f"is a {ego.kind}, not a vehicle", "choose another ego")
    states = ego.tracks[0].states
    first_s, last_s = states[0].t_s, states[-1].t_s
    if len(states) == 1:  # moved on with its velocity
        first_s, last_s = first_s - _EARLIER_S, last_s + MAX_HORIZON_S
    if not first_s - 1e-6 <= scene.time_s <= last_s + 1e-6:
        refuse(
            report.file, ego.place, f"is not there at {scene.time_s:g} s",
            f"choose a time from {first_s:g} to {last_s:g} s, or another ego",
        )  # fmt: skip
    if len(states) == 1 and abs(states[0].t_s - scene.time_s) > 1e-6:
        report.assume(f"its only state, at {states[0].t_s:g} s, is moved on", ego.name)
    # Only where it begins counts: its candidates take the place of what it did.
    found = motions(ego, scene.time_s, scene.horizon_s, Report("", ""))
    own = found[0]
    others = _others(scene, own)
    shift = _shift(own.start, report)
    models = _Models(report)
    document: dict[str, Any] = {
        "scenario_version": 2,
        "name": _name(scene.name) or "imported",
        "description": f"Read from {scene.report.format}, ego {_name(ego.name)} at "
        f"{scene.time_s:g} s of the file.",
        "models": {},
        "ego": _ego(ego, own, models, shift),
        "actors": [],
        "candidates": {"grid": True},
        "horizon_s": scene.horizon_s,
    }
    taken = {"ego"}
    for body, body_motions in others:
        name = _unique(_name(body.name) or "body", taken)
        document["actors"].append(_actor(name, body, body_motions, models, shift))
    document["models"] = models.entries()
    areas = near_areas(scene.areas, own.start, _wheels(ego, own.start), report)
    if areas:
        document["road"] = {
            "drivable": [
                {"outer": [[_place(x - shift[0]), _place(y - shift[1])] for x, y in ring]}
                for ring in areas
            ]
        }
    report.time_s, report.ego = scene.time_s, ego.name
    report.bodies, report.areas = len(others), len(areas)
    _report_overlaps(ego, own, others, scene.horizon_s, report)
    held = {"acceleration_mps2": 0.0}
    going_on = _written(own, ego, shift) if own.poses else held
    return Imported(document, report, going_on, last_s)


def _others(scene: Scene, own: Motion) -> list[tuple[Body, list[Motion]]]:
    """Return the bodies that are there, nearest first if there are too many."""
    report = scene.report
    found: list[tuple[float, int, Body, list[Motion]]] = []
    for i, body in enumerate(scene.bodies):
        body_motions = motions(body, scene.time_s, scene.horizon_s, report)
        if not body_motions:
            continue
        start = body_motions[0].start
        away = math.hypot(start.x_m - own.start.x_m, start.y_m - own.start.y_m)
        up = body.ground_m - scene.ego.ground_m
        if abs(up) > LEVEL_M + _GRADE * away:
            report.leave_out(f"{body.name} stands {up:.3g} m above the ego: another level")
        elif not body.stands and _is_own_recording(scene.ego, body):
            report.leave_out(f"{body.name} is the ego's own recording: the same place and speed")
        else:
            found.append((away, i, body, body_motions))
    if len(found) > MAX_ACTORS:
        report.warn(f"only the {MAX_ACTORS} nearest of {len(found)} bodies are read")
        found = sorted(found, key=lambda each: each[0])[:MAX_ACTORS]
        found.sort(key=lambda each: each[1])
    if any(body.ground_m != scene.ego.ground_m for _, _, body, _ in found):
        report.assume("the ground is flat: all bodies stand on the ego's level")
    return [(body, body_motions) for _, _, body, body_motions in found]


def _wheels(ego: Body, centre: Pose) -> list[Pose]:
    """Return about where the wheels of the ego stand."""
    length, width, _ = ego.size_m
    behind = (0.5 - ORIGIN_SHARE[ego.kind]) * length
    return [moved(centre, a * behind, b * 0.4 * width) for a in (1, -1) for b in (1, -1)]


def _is_own_recording(ego: Body, body: Body) -> bool:
    """Return whether a recorded body is the vehicle that a planning problem starts from."""
    if not ego.place.startswith("planningProblem") or body.kind != ego.kind:
        return False
    own = ego.tracks[0].states[0]
    other = state_at(body.tracks[0], own.t_s)
    return (
        math.dist(other.pose[:2], own.pose[:2]) < 2.5
        and abs(wrapped(other.pose.yaw_rad - own.pose.yaw_rad)) < 0.2
        and abs(forward_speed(other) - forward_speed(own)) < 2.0
    )


def _shift(start: Pose, report: Report) -> tuple[float, float]:
    """Return what positions are counted from: the file's origin, or a point near the ego."""
    if max(abs(start.x_m), abs(start.y_m)) < 0.9 * MAX_POSITION_M:
        return 0.0, 0.0
    shift = float(round(start.x_m)), float(round(start.y_m))
    report.assume(f"positions are counted from ({shift[0]:.0f}, {shift[1]:.0f}) m of the file")
    return shift


class _Models:
    """Models of boxes, shared by bodies of one kind and size."""

    def __init__(self, report: Report) -> None:
        self._report = report
        self._names: dict[tuple[Any, ...], str] = {}

    def name_of(self, body: Body) -> str:
        """Return the model of a body, made where there is none yet."""
        size = tuple(self._side(side, body) for side in body.size_m)
        mass = None if body.mass_kg is None or body.kind in FIXED else round(body.mass_kg, 1)
        key = (body.kind, *size, mass)
        if key not in self._names and len(self._names) == MAX_MODELS:
            key = self._nearest(key)
            self._report.warn(
                f"more than {MAX_MODELS} different sizes: {body.name} has the size of another body"
            )
        return self._names.setdefault(key, f"{body.kind} {len(self._names) + 1}")

    def _side(self, side_m: float, body: Body) -> float:
        if side_m < LEAST_SIDE_M or side_m > MAX_SIDE_M:
            self._report.warn(f"{body.name} has a side of {side_m:.3g} m: read as within limits")
        return round(min(max(side_m, LEAST_SIDE_M), MAX_SIDE_M), 3)

    def _nearest(self, key: tuple[Any, ...]) -> tuple[Any, ...]:
        def difference(other: tuple[Any, ...]) -> tuple[bool, float]:
            return other[0] != key[0], sum(abs(other[i] - key[i]) for i in (1, 2, 3))

        return min(self._names, key=difference)

    def entries(self) -> dict[str, Any]:
        """Return the models as a scenario has them."""
        entries = {}
        for (kind, length, width, height, mass), name in self._names.items():
            entries[name] = {"box": [length, width, height], "kind": kind}
            if mass is not None:
                entries[name]["mass_kg"] = mass
        return entries


def _ego(ego: Body, own: Motion, models: _Models, shift: tuple[float, float]) -> dict[str, Any]:
    written: dict[str, Any] = {
        "model": models.name_of(ego),
        "pose": _pose(own.start, ego, shift),
        "speed_mps": round(min(max(own.speed_mps, -150.0), 150.0), 6),
    }
    rate = math.degrees(own.yaw_rate_radps)
    if abs(rate) > 1e-3 and abs(own.speed_mps) > 0.5:
        written["yaw_rate_dps"] = round(min(max(rate, -180.0), 180.0), 6)
    if ego.wheelbase_m is not None and 0.1 <= ego.wheelbase_m <= 30.0:
        written["wheelbase_m"] = round(ego.wheelbase_m, 4)
    return written


def _actor(
    name: str, body: Body, found: list[Motion], models: _Models, shift: tuple[float, float]
) -> dict[str, Any]:
    actor: dict[str, Any] = {"name": name, "model": models.name_of(body)}
    if body.existence_probability < 1.0:
        actor["existence_probability"] = body.existence_probability
    if body.kind in FIXED:
        return {**actor, "pose": _pose(found[0].start, body, shift)}
    if len(found) == 1:
        return {**actor, **_written(found[0], body, shift)}
    likely = found
    if len(found) > MAX_PREDICTIONS:
        likely = sorted(found, key=lambda each: -each.probability)[:MAX_PREDICTIONS]
    total = sum(each.probability for each in likely)
    actor["predictions"] = [
        {"probability": round(each.probability / total, 9), **_written(each, body, shift)}
        for each in likely
    ]
    return actor


def _written(motion: Motion, body: Body, shift: tuple[float, float]) -> dict[str, Any]:
    if motion.poses:
        return {
            "poses": [{"t_s": round(t, 6), **_pose(pose, body, shift)} for t, pose in motion.poses]
        }
    written: dict[str, Any] = {"pose": _pose(motion.start, body, shift)}
    if motion.speed_mps:
        written["speed_mps"] = round(min(max(motion.speed_mps, -150.0), 150.0), 6)
        if motion.yaw_rate_radps:
            written["yaw_rate_dps"] = round(math.degrees(motion.yaw_rate_radps), 6)
    return written


def _pose(centre: Pose, body: Body, shift: tuple[float, float]) -> dict[str, float]:
    origin = origin_of_box(centre, body.kind, body.size_m[0])
    return {
        "x_m": _place(origin.x_m - shift[0]),
        "y_m": _place(origin.y_m - shift[1]),
        "yaw_deg": round(math.degrees(wrapped(origin.yaw_rad)), 6),
    }


def _place(metres: float) -> float:
    """Return a coordinate to a tenth of a millimetre, within the limits of a scenario."""
    return round(min(max(metres, -MAX_POSITION_M), MAX_POSITION_M), 4)


def _name(text: str) -> str:
    """Return text as a name of a scenario: no control characters, at most 120 characters."""
    kept = "".join(
        c for c in text if ord(c) >= 32 and ord(c) != 127 and not 0xD800 <= ord(c) < 0xE000
    )
    return kept.strip()[:120]


def _unique(name: str, taken: set[str]) -> str:
    found, i = name, 2
    while found in taken:
        found = f"{name} ({i})"
        i += 1
    taken.add(found)
    return found


def _report_overlaps(
    ego: Body,
    own: Motion,
    others: list[tuple[Body, list[Motion]]],
    horizon_s: float,
    report: Report,
) -> None:
    """Warn of bodies whose boxes overlap where the file has both: no crash, but what it states."""
    times = np.arange(0.0, horizon_s + 1e-9, 0.1)
    paths = [(ego.name, ego.size_m, _sampled(own, times))]
    paths += [(body.name, body.size_m, _sampled(found[0], times)) for body, found in others]
    spans = [(0.0, 0.0)] + [found[0].recorded_s for _, found in others]
    stands = [True] + [body.stands for body, _ in others]
    halves = [math.hypot(*size[:2]) / 2 for _, size, _ in paths]
    lows = np.array(
        [path[:, :2].min(0) - half for (_, _, path), half in zip(paths, halves, strict=True)]
    )
    highs = np.array(
        [path[:, :2].max(0) + half for (_, _, path), half in zip(paths, halves, strict=True)]
    )
    found = pairs = 0
    for i, (name, size, path) in enumerate(paths):
        meeting = ((lows <= highs[i]) & (lows[i] <= highs)).all(axis=1)
        for j in np.flatnonzero(meeting[i + 1 :]) + i + 1:
            if i and stands[i] and stands[j]:
                continue
            pairs += 1
            if pairs > _MOST_PAIRS:
                report.warn(f"overlaps were searched for in {_MOST_PAIRS} pairs of bodies only")
                return
            other_name, other_size, other = paths[j]
            begin, end = max(spans[i][0], spans[j][0]), min(spans[i][1], spans[j][1])
            both = (times >= begin - 1e-6) & (times <= end + 1e-6)
            depths = overlap_depths(path[both], size[:2], other[both], other_size[:2])
            if depths.max(initial=0.0) <= 1e-3:
                continue
            found += 1
            if found > _MOST_WARNINGS:
                report.warn("more pairs of bodies overlap")
                return
            first = times[both][int(np.argmax(depths > 1e-3))]
            report.warn(
                f"{name} and {other_name} overlap as the file has them, from {first:.2g} s on and "
                f"by up to {depths.max():.2g} m"
            )


def _sampled(motion: Motion, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the middles and headings of a motion at some times, shape (T, 3)."""
    if motion.poses:
        stamps = np.array([t for t, _ in motion.poses])
        poses = np.array([pose for _, pose in motion.poses])
        poses[:, 2] = np.unwrap(poses[:, 2])
        return np.stack([np.interp(times, stamps, poses[:, i]) for i in range(3)], axis=1)
    yaw = motion.start.yaw_rad + motion.yaw_rate_radps * times
    middle = motion.start.yaw_rad + motion.yaw_rate_radps * times / 2
    # The chord of an arc: its length is that of the arc times sin(a) / a.
    way = motion.speed_mps * times * np.sinc(motion.yaw_rate_radps * times / (2 * np.pi))
    x = motion.start.x_m + way * np.cos(middle)
    y = motion.start.y_m + way * np.sin(middle)
    return np.stack([x, y, yaw], axis=1)
