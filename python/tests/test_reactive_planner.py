"""The cost function for commonroad-reactive-planner, in an environment that has it."""

import importlib
import importlib.util

import pytest
from conftest import SHARED, expect_extra_named, needs_file

OVER = SHARED / "commonroad/ZAM_Over-1_1.xml"
THERE = importlib.util.find_spec("commonroad_rp") is not None
needs_planner = pytest.mark.skipif(
    not THERE, reason="commonroad-reactive-planner is not installed: it takes an own environment"
)
with_file = needs_file(OVER)


@pytest.mark.skipif(THERE, reason="commonroad-reactive-planner is installed")
def test_the_error_names_the_extra():
    expect_extra_named("crashrank.reactive_planner", "commonroad-reactive-planner", "planner")


def blocked_planner(blocked):
    """Return a planner of two seconds; a lorry stands close ahead across the road if blocked."""
    import numpy as np
    from commonroad.common.file_reader import CommonRoadFileReader
    from commonroad.geometry.shape import Rectangle
    from commonroad.scenario.obstacle import ObstacleType, StaticObstacle
    from commonroad.scenario.state import InitialState
    from commonroad_rp.reactive_planner import ReactivePlanner
    from commonroad_rp.utility.config import ReactivePlannerConfiguration
    from commonroad_rp.utility.utils_coordinate_system import (
        create_coordinate_system,
        create_initial_ref_path,
    )

    scenario, problems = CommonRoadFileReader(str(OVER)).open()
    problem = next(iter(problems.planning_problem_dict.values()))
    start = problem.initial_state
    if blocked:
        ahead = 8.0 * np.array([np.cos(start.orientation), np.sin(start.orientation)])
        state = InitialState(
            position=start.position + ahead, orientation=start.orientation + np.pi / 2,
            velocity=0.0, time_step=0,
        )  # fmt: skip
        scenario.add_objects(
            StaticObstacle(
                scenario.generate_object_id(), ObstacleType.TRUCK, Rectangle(30.0, 2.5), state
            )
        )
    config = ReactivePlannerConfiguration()
    config.planning.time_steps_computation = 20
    config.debug.multiproc = False
    config.update(scenario=scenario, planning_problem=problem)
    path = create_initial_ref_path(scenario.lanelet_network, problem)
    planner = ReactivePlanner(config)
    planner.set_reference_path(coordinate_system=create_coordinate_system(path))
    planner.set_desired_velocity(current_speed=start.velocity)
    return planner


@needs_planner
@with_file
def test_the_least_harmful_is_planned_once_none_is_free():
    from crashrank.reactive_planner import HarmCost

    assert blocked_planner(True).plan() is None
    planner = blocked_planner(True)
    cost = HarmCost(planner)
    trajectory, _, _ = planner.plan()
    assert len(trajectory.state_list) == 21
    best, worst = cost.ranking.best, cost.ranking[-1]
    assert 0 < best.score < worst.score
    assert best.other.startswith("truck")
    assert planner.optimal_cost == best.score
    assert best.time_of_impact_s < 2.0


@needs_planner
@with_file
def test_a_free_road_is_planned_as_before():
    from crashrank.reactive_planner import HarmCost

    alone = blocked_planner(False).plan()
    planner = blocked_planner(False)
    cost = HarmCost(planner)
    found = planner.plan()
    assert cost.ranking is None
    for one, other in zip(alone[0].state_list, found[0].state_list, strict=True):
        assert one.position == pytest.approx(other.position)
