"""Rules that choose a manoeuvre from the first contact of each candidate.

Formulas and sources are in docs/evidence/choosers.md. SI units.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

FIXED = frozenset({"barrier", "pole", "building"})
UNPROTECTED = frozenset({"pedestrian", "bicycle", "motorcycle"})

# Coefficients of P(MAIS3+) = 1 / (1 + exp(-(const + per_mps * delta_v + side))), delta_v in m/s:
# TUMFTM/EthicalTrajectoryPlanning, planner/Frenet/configs/harm_parameters.json. LR4S has
# coefficients of the side that is hit, LR1S none; the last is the curve of unprotected persons.
LR4S = {"const": -4.457, "per_mps": 0.177, "front": 0.0, "side": 0.244, "rear": -0.431}
LR1S = {"const": -4.591, "per_mps": 0.185}
PERSON = {"const": -3.164, "per_mps": 0.288}

Pose = tuple[float, float, float]


@dataclass(frozen=True)
class Body:
    """What the rules know of a body; mass in kg, infinite where nothing moves it."""

    name: str
    kind: str
    mass_kg: float
    people: float


@dataclass(frozen=True)
class Impact:
    """First contact of the ego in one future: time in s, closing speed in m/s.

    The sides that are hit are front, side, rear, or None where the poses are not known; so is the
    share of the closing speed along the normal of the two surfaces.
    """

    probability: float
    time_s: float
    closing_mps: float
    ego: Body
    other: Body
    ego_side: str | None = None
    other_side: str | None = None
    normal_mps: float | None = None


@dataclass(frozen=True)
class Candidate:
    """One manoeuvre with crashrank's harm in persons; futures without a contact have no impact."""

    name: str
    order: tuple[int, int, str]
    harm: float
    best_place: int
    impacts: tuple[Impact, ...]
    row: dict[str, Any]


def mass_ratio_delta_v(closing_mps: float, own_kg: float, other_kg: float) -> float:
    """Return a body's change of velocity, m/s, where both stick together: a plastic impact."""
    if math.isinf(own_kg):
        return 0.0
    return closing_mps if math.isinf(other_kg) else closing_mps * other_kg / (own_kg + other_kg)


def delta_v_pair(impact: Impact) -> tuple[float, float]:
    """Return the mass-ratio delta-v of the ego and of the other body, m/s."""
    ego, other = impact.ego.mass_kg, impact.other.mass_kg
    return (mass_ratio_delta_v(impact.closing_mps, ego, other),
            mass_ratio_delta_v(impact.closing_mps, other, ego))


def ego_delta_v(impact: Impact) -> float:
    """Return the mass-ratio delta-v of the ego, m/s."""
    return delta_v_pair(impact)[0]


def worse_delta_v(impact: Impact) -> float:
    """Return the larger mass-ratio delta-v of the two bodies that have people, m/s."""
    pairs = zip(delta_v_pair(impact), (impact.ego, impact.other), strict=True)
    return max((speed for speed, body in pairs if body.people > 0), default=0.0)


def closing_speed(impact: Impact) -> float:
    """Return the closing speed, m/s."""
    return impact.closing_mps


def closing_energy(impact: Impact) -> float:
    """Return half the reduced mass times the square of the closing speed, J."""
    ego, other = impact.ego.mass_kg, impact.other.mass_kg
    reduced = ego if math.isinf(other) else ego * other / (ego + other)
    return 0.5 * reduced * impact.closing_mps**2


def partner_mass(impact: Impact) -> float:
    """Return the mass of the other body, kg; infinite where nothing moves it."""
    return impact.other.mass_kg


def normal_speed(impact: Impact) -> float:
    """Return the closing speed along the normal of the surfaces, else the closing speed, m/s."""
    return impact.closing_mps if impact.normal_mps is None else max(impact.normal_mps, 0.0)


def urgency(impact: Impact) -> float:
    """Return the reciprocal of the time to collision, 1/s; no contact counts 0."""
    return 1.0 / impact.time_s if impact.time_s > 0 else math.inf


def logistic(curve: dict[str, float], delta_v_mps: float, side: str | None = None) -> float:
    """Return the probability of MAIS3+ at this delta-v."""
    z = curve["const"] + curve["per_mps"] * delta_v_mps + (curve[side] if side else 0.0)
    return 1.0 / (1.0 + math.exp(-z))


def tum_harm(impact: Impact) -> float:
    """Return TUM's harm of the ego plus that of the other body, persons with MAIS3+."""
    ego_v, other_v = delta_v_pair(impact)
    if impact.other.kind in FIXED:
        return impact.ego.people * logistic(LR1S, ego_v)
    if impact.other.kind in UNPROTECTED:
        return (impact.ego.people * logistic(LR1S, ego_v)
                + impact.other.people * logistic(PERSON, other_v))
    curve = LR4S if impact.ego_side and impact.other_side else LR1S
    return (impact.ego.people * logistic(curve, ego_v, impact.ego_side)
            + impact.other.people * logistic(curve, other_v, impact.other_side))


@dataclass(frozen=True)
class Rule:
    """A rule: cost of an impact, and how its cost is written."""

    title: str
    cost: Callable[[Impact], float]
    written: Callable[[float], str]


RULES = (
    Rule("delta-v of the ego", ego_delta_v, lambda x: f"{x:.1f} m/s"),
    Rule("delta-v, worse side", worse_delta_v, lambda x: f"{x:.1f} m/s"),
    Rule("closing speed", closing_speed, lambda x: f"{x:.1f} m/s"),
    Rule("normal speed", normal_speed, lambda x: f"{x:.1f} m/s"),
    Rule("time to collision", urgency, lambda x: f"{1 / x:.2f} s" if x > 0 else "none"),
    Rule("TUM harm", tum_harm, lambda x: f"{x:.3f}"),
)

# Rules whose choices data/benchmark stores: some of those above, and two of masses.
BENCHMARK_RULES = (
    Rule("closing energy", closing_energy, lambda x: f"{x / 1000:.1f} kJ"),
    Rule("lightest partner", partner_mass, lambda x: f"{x:.0f} kg"),
    *(rule for rule in RULES if rule.title in ("delta-v of the ego", "closing speed",
                                               "time to collision", "TUM harm")),
)


def expected(rule: Rule, candidate: Candidate) -> float:
    """Return the rule's cost of a candidate, weighted by the probabilities of its futures."""
    return sum(i.probability * rule.cost(i) for i in candidate.impacts)


def choose(rule: Rule, candidates: Sequence[Candidate]) -> list[Candidate]:
    """Return the candidates of least cost; the first in the scenario's order is the choice."""
    costs = {c.name: expected(rule, c) for c in candidates}
    least = min(costs.values())
    return sorted((c for c in candidates
                   if costs[c.name] == least or costs[c.name] - least <= 1e-12 * least),
                  key=lambda c: c.order)


def side_of(angle_rad: float) -> str:
    """Return the side that an angle from the forward axis points to: quadrants about the axes."""
    angle = abs(math.remainder(angle_rad, 2 * math.pi))
    return "front" if angle < math.pi / 4 else "side" if angle < 3 * math.pi / 4 else "rear"


def pose_at(motion: dict[str, Any], t: float, curvature: float | None = None) -> Pose:
    """Return x, y in m and heading in rad at time t of a scenario's motion.

    Parameters
    ----------
    motion : dict
        Timed `poses`, or `pose` with `speed_mps`, `acceleration_mps2` and `yaw_rate_dps`.
    t : float
        Time since the decision, s.
    curvature : float, optional
        Of the path, 1/m, in place of the yaw rate.
    """
    if "poses" in motion:
        poses = motion["poses"]
        after = next((i for i, p in enumerate(poses) if p["t_s"] > t), len(poses))
        a, b = poses[max(after - 1, 0)], poses[min(after, len(poses) - 1)]
        span = b["t_s"] - a["t_s"]
        w = (t - a["t_s"]) / span if span > 0 else 0.0
        x, y, yaw = (a.get(k, 0.0) + w * (b.get(k, 0.0) - a.get(k, 0.0))
                     for k in ("x_m", "y_m", "yaw_deg"))
        return x, y, math.radians(yaw)
    pose = motion.get("pose", {})
    x, y = pose.get("x_m", 0.0), pose.get("y_m", 0.0)
    yaw = math.radians(pose.get("yaw_deg", 0.0))
    speed, acceleration = motion.get("speed_mps", 0.0), motion.get("acceleration_mps2", 0.0)
    rate = math.radians(motion.get("yaw_rate_dps", 0.0))
    if speed * acceleration < 0:
        t = min(t, -speed / acceleration)
    steps = 400
    for i in range(steps):
        middle = (i + 0.5) * t / steps
        way = middle * (speed + 0.5 * acceleration * middle)
        heading = yaw + (rate * middle if curvature is None else curvature * way)
        x += (speed + acceleration * middle) * math.cos(heading) * t / steps
        y += (speed + acceleration * middle) * math.sin(heading) * t / steps
    turn = rate * t if curvature is None else curvature * t * (speed + 0.5 * acceleration * t)
    return x, y, yaw + turn
