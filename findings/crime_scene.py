"""Cars on one straight lane, as a configuration of CriMe; for crime-*.sh."""

import sys
from importlib.metadata import version

import numpy as np
from commonroad.geometry.shape import Rectangle
from commonroad.prediction.prediction import TrajectoryPrediction
from commonroad.scenario.lanelet import Lanelet, LaneletNetwork
from commonroad.scenario.obstacle import DynamicObstacle, ObstacleType
from commonroad.scenario.scenario import Scenario
from commonroad.scenario.state import CustomState, InitialState
from commonroad.scenario.trajectory import Trajectory
from commonroad_crime.data_structure.configuration import CriMeConfiguration

STEP_S, STEPS = 0.1, 60


def configured(*cars):
    """Return a configuration; of each car x, m, heading, rad, and speed, m/s, at which it drives on."""
    x = np.linspace(-400.0, 400.0, 17)
    lines = (np.stack([x, np.full_like(x, y)], axis=1) for y in (2.0, 0.0, -2.0))
    scenario = Scenario(STEP_S)
    scenario.add_objects(LaneletNetwork.create_from_lanelet_list([Lanelet(*lines, 1000)]))
    for i, (x0, heading, speed) in enumerate(cars):
        states = [{"time_step": k, "orientation": heading, "velocity": speed, "acceleration": 0.0,
                   "position": np.array([x0 + np.cos(heading) * speed * STEP_S * k, 0.0])}
                  for k in range(STEPS + 1)]
        shape = Rectangle(length=4.5, width=1.8)
        path = Trajectory(1, [CustomState(**state) for state in states[1:]])
        scenario.add_objects(DynamicObstacle(
            i + 1, ObstacleType.CAR, shape, InitialState(**states[0], yaw_rate=0.0, slip_angle=0.0),
            TrajectoryPrediction(path, shape)))
    scenario.assign_obstacles_to_lanelets()
    config = CriMeConfiguration()
    config.update(ego_id=1, sce=scenario)
    return config


def conclude(holds):
    """Print the version; end with 1 where the behaviour has changed."""
    print(f"commonroad-crime {version('commonroad-crime')}:", "as described" if holds else "changed")
    sys.exit(not holds)
