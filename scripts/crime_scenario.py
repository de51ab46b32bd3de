"""CommonRoad scenarios in memory, for CriMe: one candidate of a ranking and all actors.

Needs commonroad-crime (python/requirements-comparison.txt). SI units, angles in rad.
"""

from __future__ import annotations

import logging
import os
from collections.abc import Sequence
from typing import Any

os.environ.setdefault("MPLBACKEND", "Agg")

import numpy as np
from commonroad.geometry.shape import Rectangle
from commonroad.prediction.prediction import TrajectoryPrediction
from commonroad.scenario.lanelet import Lanelet, LaneletNetwork, LineMarking
from commonroad.scenario.obstacle import DynamicObstacle, ObstacleType
from commonroad.scenario.scenario import Scenario
from commonroad.scenario.state import CustomState, InitialState
from commonroad.scenario.trajectory import Trajectory
from commonroad_crime.data_structure.configuration import CriMeConfiguration
from numpy.typing import NDArray

logging.disable(logging.WARNING)

STEP_S = 0.05
"""Time step of the scenarios."""
FIXED_KG = 1e9
"""Mass that stands for a body that nothing moves: CriMe divides by the sum of both masses."""
EGO_ID = 1
_LANELET_ID = 100_000
# CriMe counts leaving the road as a collision; the benchmark's edges are bodies. One lane on which
# every body of every scene stays, ends included: half its length and half its width, m.
_REACH_M = 400.0
_KINDS = {
    "car": ObstacleType.CAR, "truck": ObstacleType.TRUCK, "bus": ObstacleType.BUS,
    "motorcycle": ObstacleType.MOTORCYCLE, "bicycle": ObstacleType.BICYCLE,
    "pedestrian": ObstacleType.PEDESTRIAN, "pole": ObstacleType.PILLAR,
    "barrier": ObstacleType.MEDIAN_STRIP, "building": ObstacleType.BUILDING,
}

Array = NDArray[np.float64]


def steps_until(end_s: float) -> Array:
    """Return the times of all whole steps up to a time."""
    return np.arange(int(end_s / STEP_S + 1e-9) + 1) * STEP_S


def boxed(outline: Array, path: Array) -> tuple[Rectangle, Array]:
    """Return the rectangle around an outline, and its middle along a path of x, y, heading.

    CommonRoad's pose is that of the shape's centre; crashrank's origin lies on the body's axis.
    """
    low, high = outline.min(axis=0), outline.max(axis=0)
    cx, cy = (low + high) / 2
    x, y, yaw = path.T
    moved = np.stack([x + cx * np.cos(yaw) - cy * np.sin(yaw),
                      y + cx * np.sin(yaw) + cy * np.cos(yaw), yaw], axis=1)
    return Rectangle(length=float(high[0] - low[0]), width=float(high[1] - low[1])), moved


def moving(identity: int, kind: str, shape: Rectangle, path: Array) -> DynamicObstacle:
    """Return a body that moves along poses, one each step.

    The speed is that of the middle along the heading, from differences of the positions: central
    ones, at both ends one-sided. Bodies that stand are dynamic ones too: CriMe's delta-v refuses
    static obstacles as the ego.
    """
    times = np.arange(len(path)) * STEP_S
    vx, vy = np.gradient(path[:, 0], times), np.gradient(path[:, 1], times)
    speed = vx * np.cos(path[:, 2]) + vy * np.sin(path[:, 2])
    common = [{"time_step": i, "position": path[i, :2].copy(), "orientation": float(path[i, 2]),
               "velocity": float(speed[i])} for i in range(len(path))]
    first = InitialState(**common[0], acceleration=0.0, yaw_rate=0.0, slip_angle=0.0)
    states = [CustomState(**members) for members in common[1:]]
    prediction = TrajectoryPrediction(Trajectory(1, states), shape)
    return DynamicObstacle(identity, _KINDS[kind], shape, first, prediction)


def scenario_of(ego: DynamicObstacle, others: Sequence[DynamicObstacle]) -> Scenario:
    """Return a scenario of these bodies on one wide lane, lanes assigned."""
    x = np.linspace(-_REACH_M, _REACH_M, 17)
    left, middle, right = (np.stack([x, np.full_like(x, y)], axis=1)
                           for y in (_REACH_M, 0.0, -_REACH_M))
    lanelet = Lanelet(left, middle, right, _LANELET_ID,
                      line_marking_left_vertices=LineMarking.SOLID,
                      line_marking_right_vertices=LineMarking.SOLID)
    scenario = Scenario(STEP_S)
    scenario.add_objects(LaneletNetwork.create_from_lanelet_list([lanelet]))
    scenario.add_objects([ego, *others])
    scenario.assign_obstacles_to_lanelets()
    return scenario


def configured(scenario: Scenario, ego_id: int, ego_kg: float, other_kg: float
               ) -> CriMeConfiguration:
    """Return CriMe's settings: its defaults, and the masses of two bodies."""
    config: Any = CriMeConfiguration()
    config.update(ego_id=ego_id, sce=scenario)
    config.vehicle.dynamic.parameters.m = ego_kg
    config.velocity.m_b = other_kg
    return config
