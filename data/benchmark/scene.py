"""Scenarios of the benchmark in the making: bodies, edges of the road, candidates.

SI units, angles in degrees; the ego starts at the origin with its rear axle and drives along x,
left is y.
"""

from __future__ import annotations

import math
import random
from typing import Any

# Of each model: kind, mass in kg (None: fixed), rear end and front end from the origin, m.
MODELS: dict[str, tuple[str, float | None, float, float]] = {
    "hatch": ("car", 1200, -0.73, 3.41), "sedan": ("car", 1680, -1.09, 3.79),
    "van": ("car", 2500, -1.36, 4.64), "truck": ("truck", 14000, -2.5, 6.97),
    "semitrailer": ("truck", 30000, -4.3, 12.2), "tram": ("bus", 46800, -2.6, 27.4),
    "motorcycle": ("motorcycle", 285, -0.36, 1.73), "bicycle": ("bicycle", 94, -0.34, 1.41),
    "pedestrian": ("pedestrian", 75, -0.37, 0.57), "child": ("pedestrian", 23.4, -0.24, 0.37),
    "wheelchair": ("pedestrian", 93, -0.3, 0.8), "pole": ("pole", None, -0.13, 0.13),
    "tree": ("pole", None, -0.25, 0.25), "jersey_barrier": ("barrier", None, -2, 2),
    "wall": ("building", None, 0, 0.25),
}
EGOS = {"hatch": 2.55, "sedan": 2.8, "van": 3.64}  # wheelbase, m
WORDS = {"hatch": "hatch", "sedan": "saloon", "van": "van", "truck": "lorry",
         "semitrailer": "articulated lorry", "tram": "tram", "motorcycle": "motorcyclist",
         "bicycle": "cyclist", "pedestrian": "pedestrian", "child": "child",
         "wheelchair": "wheelchair user", "jersey_barrier": "barrier"}
GRAVITY = 9.80665


class Scene:
    """A scenario in the making, and where its ego can stop."""

    def __init__(self, situation: str, number: int, speeds: tuple[float, float],
                 grip: float = 0.8, horizon_s: float = 3.0) -> None:
        self.random = random.Random(f"crashrank benchmark 1, {situation} {number}").random
        self.name = f"{situation} {number}"
        self.ego = self.pick("hatch", "sedan", "hatch", "sedan", "van")
        self.speed = self.real(*speeds, digits=1)
        self.grip, self.horizon_s, self.version = grip, horizon_s, 1
        self.actors: list[dict[str, Any]] = []
        self.extra: dict[str, Any] = {}
        self.front = MODELS[self.ego][3]
        self.stop = self.front + self.speed ** 2 / (2 * 0.95 * grip * GRAVITY)
        self.left, self.right = 3.5, 1.5
        """Offsets of swerves, m."""
        self.beside = 1.0
        """Share of the grip that swerves and steering ask for."""

    def real(self, low: float, high: float, digits: int = 2) -> float:
        """Return a number drawn evenly, rounded."""
        return round(low + (high - low) * self.random(), digits)

    def pick(self, *choices: Any) -> Any:
        """Return one of several, each as likely."""
        return choices[int(self.random() * len(choices))]

    def chance(self, probability: float) -> bool:
        """Return true with this probability."""
        return self.random() < probability

    def ahead(self, low: float, high: float) -> float:
        """Return a place on the way in which the ego could stop, shares of that way, m."""
        return self.front + self.real(low, high) * (self.stop - self.front)

    def put(self, model: str, x: float, y: float, yaw: float = 0.0, speed: float = 0.0,
            acceleration: float = 0.0, name: str = "", **more: Any) -> dict[str, Any]:
        """Add a body by the middle of its length and return it."""
        middle = (MODELS[model][2] + MODELS[model][3]) / 2
        if model == "wall":
            middle = 0.0
        turn = math.radians(yaw)
        pose = {"x_m": x - middle * math.cos(turn), "y_m": y - middle * math.sin(turn),
                "yaw_deg": yaw}
        base = name or WORDS.get(model, model)
        names = {actor["name"] for actor in self.actors}
        free = base if name else next(n for n in [base, *(f"{base} {i}" for i in range(2, 99))]
                                      if n not in names)
        actor = {"name": free, "model": model, "pose": short(pose)}
        actor.update(short({"speed_mps": speed, "acceleration_mps2": acceleration}))
        actor.update(more)
        self.actors.append(actor)
        return actor

    def crossing(self, model: str, x: float, y: float, after_s: float, side: int, speed: float,
                 acceleration: float = 0.0) -> dict[str, Any]:
        """Add a body that comes from a side (1: left) and has its middle at y after that time."""
        way = speed * after_s + acceleration * after_s ** 2 / 2
        return self.put(model, x, y + side * way, -90 * side, speed, acceleration)

    def edge(self, side: int, y: float, kind: str, until: float, begin: float = 3.0) -> None:
        """Close a side (1: left) of the road at the distance y, from a place ahead backwards."""
        if kind == "parked":
            x = until
            while x > begin:
                model = self.pick("hatch", "sedan", "hatch", "van")
                half = (MODELS[model][3] - MODELS[model][2]) / 2
                self.put(model, x - half, side * (y + 0.95), self.pick(0, 0, 180), occupants=0,
                         name=f"parked {WORDS[model]} {len(self.actors) + 1}")
                x -= 2 * half + self.real(0.5, 1.1)
            return
        if kind == "barrier":
            for i in range(math.ceil((until - begin) / 4)):
                self.put("jersey_barrier", until - 2 - 4 * i, side * (y + 0.3))
            return
        back = y
        if kind in ("trees", "poles"):
            model, back = kind[:-1], y + 1.6
            x = until - self.real(0, 3)
            while x > begin:
                self.put(model, x, side * (y + 0.25 + self.real(0, 0.4)))
                x -= self.real(4.5, 8)
        if kind == "people":
            back = y + 1.8
            for _ in range(self.pick(1, 2, 2)):
                self.put(self.pick("pedestrian", "pedestrian", "child", "wheelchair"),
                         self.real(0.5, 1.0) * until, side * (y + self.real(0.4, 1.2)),
                         self.pick(0, 180), self.real(0, 1.4))
        for i in range(math.ceil((until - begin) / 10)):
            self.put("wall", until - 5 - 10 * i, side * back, 90 * side)

    def queue(self, x: float, y: float, count: int, models: tuple[str, ...], speed: float = 0.0,
              acceleration: float = 0.0) -> None:
        """Add vehicles one behind the other in a lane, the first with its rear end at x."""
        for _ in range(count):
            model = self.pick(*models)
            length = MODELS[model][3] - MODELS[model][2]
            self.put(model, x + length / 2, y + self.real(-0.2, 0.2), self.real(-2, 2), speed,
                     acceleration)
            x += length + self.real(1.0, 3.5)

    def done(self, description: str) -> dict[str, Any]:
        """Return the scenario."""
        used = sorted({self.ego, *(actor["model"] for actor in self.actors)})
        models: dict[str, dict[str, Any]] = {}
        for name in used:
            kind, mass, _, _ = MODELS[name]
            models[name] = {"mesh": f"../models/{name}.obj", "kind": kind}
            if mass:
                models[name]["mass_kg"] = mass
        return {
            "scenario_version": self.version, "name": self.name,
            "description": f"{round(3.6 * self.speed)} km/h. {description}", "models": models,
            "ego": {"model": self.ego, "speed_mps": self.speed, "wheelbase_m": EGOS[self.ego]},
            "candidates": {"listed": self.candidates()}, "actors": self.actors, **self.extra,
            "horizon_s": self.horizon_s, "grip": self.grip}

    def candidates(self) -> list[dict[str, Any]]:
        """Return braking hard in lane and four to nine of twelve others, in one order."""
        full, beside = self.grip * GRAVITY, -0.5 * self.beside * self.grip * GRAVITY
        left, right = self.left, self.right
        menu: list[dict[str, Any]] = [
            {"name": "brake in lane", "acceleration_mps2": -0.5 * full},
            {"name": "hold speed", "acceleration_mps2": 0},
            self.swerve(f"swerve left {left:g} m", left, 0.0),
            self.swerve(f"swerve right {right:g} m", -right, 0.0),
            self.swerve(f"brake and swerve left {left:g} m", left, beside),
            self.swerve(f"brake and swerve right {right:g} m", -right, beside),
            self.arc("brake hard and steer left", -0.85, 0.35),
            self.arc("brake hard and steer right", -0.85, -0.35),
            self.arc("brake and steer left", -0.6, 0.7),
            self.arc("brake and steer right", -0.6, -0.7),
            self.arc("steer left", 0, 0.85), self.arc("steer right", 0, -0.85)]
        count = 4 + int(self.random() * 6)
        kept = sorted(sorted(range(len(menu)), key=lambda _: self.random())[:count])
        first = {"name": "brake hard in lane", "acceleration_mps2": -0.95 * full}
        return [short(each) for each in (first, *(menu[i] for i in kept))]

    def arc(self, name: str, braking: float, lateral: float) -> dict[str, Any]:
        """Return acceleration and held steering, both as shares of the grip."""
        full = self.beside * self.grip * GRAVITY
        steering = math.atan(EGOS[self.ego] * lateral * full / self.speed ** 2)
        return {"name": name, "acceleration_mps2": braking * full,
                "steering_deg": math.degrees(steering)}

    def swerve(self, name: str, offset: float, acceleration: float) -> dict[str, Any]:
        """Return poses that move the ego aside within 0.85 of the grip and then go straight on."""
        lateral = math.sqrt((0.85 * self.beside * self.grip * GRAVITY) ** 2 - acceleration ** 2)
        within = math.sqrt(2 * math.pi * abs(offset) / lateral)
        stands = self.speed / -acceleration if acceleration < 0 else math.inf
        times = [within * i / 5 for i in range(6)]
        step = 0.5 if acceleration else self.horizon_s
        while times[-1] + step < self.horizon_s - 0.2:
            times.append(times[-1] + step)
        poses = []
        for t in [*(t for t in times if t < self.horizon_s - 0.1), self.horizon_s]:
            moved = min(t, stands)
            x = self.speed * moved + acceleration * moved ** 2 / 2
            phase = 2 * math.pi * min(moved / within, 1)
            y = offset * (phase - math.sin(phase)) / (2 * math.pi)
            speed = self.speed + acceleration * moved
            slope = offset * (1 - math.cos(phase)) / within / speed if speed > 0.5 else 0.0
            poses.append(short({"t_s": t, "x_m": x, "y_m": y,
                                 "yaw_deg": math.degrees(math.atan(slope))}, keep=("t_s",)))
        return {"name": name, "poses": poses}


def short(members: dict[str, Any], keep: tuple[str, ...] = ("acceleration_mps2",)
           ) -> dict[str, Any]:
    """Return members with numbers rounded to hundredths, zeros left out but those to keep."""
    kept = {}
    for key, value in members.items():
        if isinstance(value, (int, float)):
            value = round(value, 2) + 0.0
            value = int(value) if value == int(value) else value
            if value == 0 and (key not in keep or "name" not in members and key != "t_s"):
                continue
        kept[key] = value
    return kept


def a(model: str) -> str:
    """Return a body in words."""
    return f"a{'n' if model == 'semitrailer' else ''} {WORDS[model]}"


def edge_words(kind: str) -> str:
    """Return an edge of the road in words."""
    return {"parked": "parked cars", "wall": "a wall", "barrier": "a concrete barrier",
            "people": "people before a wall"}.get(kind, kind)
