"""What a report plays: meshes, poses over time and contacts, read from its page.

Other viewers show the scene of the report. Lengths are m, times s from the decision, angles rad.
"""

from __future__ import annotations

import base64
import functools
import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._errors import usage

EGO = -1
# Poses between contacts are sampled at this interval, s: a metre and a half at 270 km/h.
STEP_S = 0.02
# Metres of an arrow for a change of velocity of 1 m/s, as in the report.
ARROW_S = 0.3
# Red, green and blue, 0 to 255.
EGO_COLOUR, OTHER_COLOUR, FUTURE_COLOUR = (47, 102, 173), (176, 138, 74), (138, 63, 176)
CONTACT_COLOUR, ROAD_COLOUR, TEXT_COLOUR = (207, 42, 23), (128, 135, 143), (29, 33, 38)
_DAMAGE = (217, 23, 13)
_OPENING = "id='page-data'>"

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class PlayedMesh:
    """Mesh of one body, body axes; fine meshes are coarser here, as they are in the report."""

    corners: Floats
    """(N, 3)."""
    triangles: NDArray[np.int64]
    """(M, 3) indices of corners."""
    colours: NDArray[np.uint8]
    """(M, 3), of each triangle without damage."""

    def painted(self, damage: NDArray[np.bool_] | None) -> NDArray[np.uint8]:
        """Return the colours with damaged triangles in red."""
        if damage is None:
            return self.colours
        return np.where(damage[:, None], np.array(_DAMAGE, np.uint8), self.colours)


@dataclass(frozen=True)
class PlayedContact:
    """One contact of a candidate's crash in the likeliest future."""

    time_s: float
    bodies: tuple[int, int]
    point_m: Floats
    closing_speed_mps: float
    kicks_mps: tuple[Floats, Floats]
    """Change of the velocity of each body, (x, y, 0), world axes."""


class PlayedCandidate:
    """One candidate: where every body is at a time, and what is damaged by then."""

    def __init__(self, scene: PlayedScene, members: dict[str, Any]) -> None:
        self._scene = scene
        self._members = members
        self._bodies = {each["body"]: each for each in members["bodies"]}
        self.row: int = members["row"]
        row = scene.data["rows"][self.row]
        self.place, self.name, self.contact_words = row[0], row[2], row[9]
        interval = f" ({row[5]})" if row[5] else ""
        self.score_words = f"{row[4]} {scene.data['unit']}{interval}"
        self.end_s: float = members["end"]
        self.contacts = tuple(_contact(each) for each in members["contacts"])
        moves = any("motion" in each for each in members["bodies"])
        # Without a simulated motion the scene ends at the first contact.
        self._frozen_s = self.contacts[0].time_s if self.contacts and not moves else np.inf

    @property
    def title(self) -> str:
        """Place, name and score, in words."""
        return f"{self.place}. {self.name}: {self.score_words}"

    @property
    def state_times(self) -> list[float]:
        """Times at which the damage of a body changes, 0 first."""
        return [0.0, *sorted({each.time_s for each in self.contacts} - {0.0})]

    @property
    def times(self) -> Floats:
        """Times at which poses are sampled, contacts among them."""
        steps = np.linspace(0.0, self.end_s, 1 + max(1, round(self.end_s / STEP_S)))
        return np.union1d(steps, [each for each in self.state_times if each <= self.end_s])

    def poses(self, body: int, times: Floats) -> tuple[Floats, Floats]:
        """Return the origin of a body, (T, 3), and its rotation as x, y, z, w, (T, 4)."""
        now = np.minimum(times, self._frozen_s)
        plan = self._members["plan"] if body == EGO else self._scene.data["actors"][body]["plan"]
        columns = _columns(plan, now)
        motion = self._bodies.get(body, {}).get("motion")
        if motion:
            is_simulated = 1000.0 * now >= motion["t"][0]
            columns = np.where(is_simulated, _columns(motion, now), columns)
        half = 0.5 * columns[3]
        turns = np.stack([0 * half, 0 * half, np.sin(half), np.cos(half)], axis=1)
        return columns[:3].T.copy(), _product(turns, self._scene.tilt(body))

    def way(self) -> Floats:
        """Return the ego's planned way to its first contact, (T, 3)."""
        end_s = self.contacts[0].time_s if self.contacts else self.end_s
        return _columns(self._members["plan"], np.linspace(0.0, end_s, 60))[:3].T.copy()

    def damage(self, body: int, time_s: float) -> NDArray[np.bool_] | None:
        """Return which triangles of a body are damaged by then; None before its first contact."""
        runs = self._bodies.get(body, {}).get("damage")
        if not runs or not any(body in each.bodies for each in self.contacts_by(time_s)):
            return None
        return _flags(runs, len(self._scene.mesh(body).triangles))

    def contacts_by(self, time_s: float) -> tuple[PlayedContact, ...]:
        """Return the contacts until then."""
        return tuple(each for each in self.contacts if each.time_s <= time_s)


class PlayedScene:
    """The scene of a report."""

    def __init__(self, page: str) -> None:
        """Read the data of a page; raise `UsageError` where it has no candidate to play."""
        begin = page.find(_OPENING)
        if begin < 0:
            raise usage("", "there is no candidate to play", "rank a scenario that has candidates")
        begin += len(_OPENING)
        self.data: dict[str, Any] = json.loads(page[begin : page.index("</script>", begin)])
        actors = enumerate(self.data["actors"])
        self.bodies = (EGO, *(i for i, actor in actors if actor["exists"]))
        self.candidates = tuple(PlayedCandidate(self, each) for each in self.data["candidates"])
        self.mesh = functools.cache(self._mesh)

    def _of(self, body: int) -> Any:
        return self.data["ego"] if body == EGO else self.data["actors"][body]

    def name(self, body: int) -> str:
        """Return the name of a body."""
        return "ego" if body == EGO else str(self.data["actors"][body]["name"])

    def road(self) -> list[Floats]:
        """Return the borders of drivable areas, closed, (T, 3) each."""
        rings = (ring for area in self.data["road"] for ring in area)
        return [np.array([[*point, 0.0] for point in [*ring, ring[0]]]) for ring in rings]

    def tilt(self, body: int) -> Floats:
        """Return how a body leans beside its heading, as x, y, z, w."""
        rows = self._of(body)["tilt"]
        return _quaternion(np.reshape(rows, (3, 3)) if rows else np.eye(3))

    def _mesh(self, body: int) -> PlayedMesh:
        mesh = self.data["models"][self._of(body)["model"]]["mesh"]
        steps = np.frombuffer(base64.b64decode(mesh["positions"]), "<u2").reshape(-1, 3)
        corners = np.array(mesh["origin"]) + np.array(mesh["step"]) * steps
        triangles = np.frombuffer(base64.b64decode(mesh["indices"]), "<u2").reshape(-1, 3)
        paint = 2 if body == EGO else 3
        colours = [(part[1], list(bytes.fromhex(part[paint][1:]))) for part in mesh["parts"]]
        counts, rgb = zip(*colours, strict=True) if colours else ((), ())
        painted = np.repeat(np.reshape(rgb, (-1, 3)), counts, axis=0).astype(np.uint8)
        return PlayedMesh(corners, triangles.astype(np.int64), painted)

    def contact_words(self, contact: PlayedContact) -> str:
        """Return who hits whom, and how fast."""
        a, b = (self.name(body) for body in contact.bodies)
        return f"{a} hits {b} at {3.6 * contact.closing_speed_mps:.0f} km/h"

    def label_point(self, body: int) -> Floats:
        """Return where the name of a body stands, over its middle, body axes."""
        forward = self.mesh(body).corners[:, 0]
        height = self.data["models"][self._of(body)["model"]]["height"]
        return np.array([(forward.min() + forward.max()) / 2, 0.0, height + 0.4])

    def elsewhere(self) -> list[tuple[str, Floats]]:
        """Return label and way of actors in futures that are not the likeliest."""
        times = np.linspace(0.0, self.data["horizon"], 60)
        return [
            (f"{actor['name']}: {other['p']:.0%}", _columns(other["plan"], times)[:3].T.copy())
            for actor in self.data["actors"]
            for other in actor["others"]
        ]


def _contact(members: dict[str, Any]) -> PlayedContact:
    first, second = (np.array([*kick, 0.0]) for kick in members["kicks"])
    a, b = members["bodies"]
    point = np.array(members["at"], dtype=float)
    return PlayedContact(members["t"], (a, b), point, members["closing"], (first, second))


def _columns(track: dict[str, Any], times: Floats) -> Floats:
    """Return x, y, z and heading, (4, T): linear between the samples of a track."""
    at = 1000.0 * times
    zero = [0.0] * len(track["t"])
    units = (("x", 1e-3), ("y", 1e-3), ("z", 1e-3), ("a", 1e-4))
    return np.stack([unit * np.interp(at, track["t"], track.get(key, zero)) for key, unit in units])


def _flags(runs: str, count: int) -> NDArray[np.bool_]:
    """Return a flag for each triangle from lengths of intact and damaged runs in turn."""
    lengths, length, shift = [], 0, 0
    for byte in base64.b64decode(runs):
        length |= (byte & 127) << shift
        shift += 7
        if not byte & 128:
            lengths.append(length)
            length = shift = 0
    flags = np.repeat(np.arange(len(lengths)) % 2 == 1, lengths)
    return np.pad(flags, (0, count - len(flags)))


def _product(p: Floats, q: Floats) -> Floats:
    """Return quaternions, (T, 4), each multiplied by another from the right; x, y, z, w."""
    vector = p[:, 3:] * q[:3] + q[3] * p[:, :3] + np.cross(p[:, :3], q[:3])
    scalar = p[:, 3] * q[3] - p[:, :3] @ q[:3]
    return np.concatenate([vector, scalar[:, None]], axis=1)


def _quaternion(matrix: Floats) -> Floats:
    """Return a rotation as x, y, z, w.

    It is the eigenvector to the largest eigenvalue of a symmetric matrix, for every angle
    (Bar-Itzhack, 2000).
    """
    m = matrix
    k = np.array(
        [
            [m[0, 0] - m[1, 1] - m[2, 2], m[1, 0] + m[0, 1], m[2, 0] + m[0, 2], m[2, 1] - m[1, 2]],
            [m[1, 0] + m[0, 1], m[1, 1] - m[0, 0] - m[2, 2], m[2, 1] + m[1, 2], m[0, 2] - m[2, 0]],
            [m[2, 0] + m[0, 2], m[2, 1] + m[1, 2], m[2, 2] - m[0, 0] - m[1, 1], m[1, 0] - m[0, 1]],
            [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], np.trace(m)],
        ]
    )
    return np.asarray(np.linalg.eigh(k)[1][:, -1])
