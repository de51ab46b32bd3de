"""The measure for CommonRoad CriMe, in an environment that has it (scripts/comparison)."""

import importlib
import importlib.util
import math
import sys

import crashrank
import pytest
from conftest import ROOT, SHARED, expect_extra_named, needs_file
from crashrank import formats

PEDESTRIAN = SHARED / "commonroad/OSC_PedestrianCollision-1_1_T-1.xml"
THERE = importlib.util.find_spec("commonroad_crime") is not None
needs_crime = pytest.mark.skipif(
    not THERE, reason="commonroad-crime is not installed: scripts/comparison runs this test"
)
with_file = needs_file(PEDESTRIAN)


@pytest.mark.skipif(THERE, reason="commonroad-crime is installed")
def test_the_error_names_the_extra():
    expect_extra_named("crashrank.crime", "commonroad-crime", "crime")


def test_the_package_alone_does_not_import_it():
    assert "crashrank.crime" not in sys.modules or THERE


def settings(path, ego, lanelet_assignment=True):
    from commonroad.common.file_reader import CommonRoadFileReader
    from commonroad_crime.data_structure.configuration import CriMeConfiguration

    scenario, _ = CommonRoadFileReader(str(path)).open(lanelet_assignment=lanelet_assignment)
    config = CriMeConfiguration()
    config.update(ego_id=ego, sce=scenario)
    return config


@needs_crime
@with_file
def test_the_interface_evaluates_it():
    from commonroad_crime.data_structure.crime_interface import CriMeInterface
    from crashrank.crime import LeastHarm

    crime = CriMeInterface(settings(PEDESTRIAN, 34))
    steps = (40, 50, 54, 55)
    for step in steps:
        crime.evaluate_scene([LeastHarm], step, verbose=False)
    name = LeastHarm.measure_name.value
    values = [crime.criticality_dict[step][name] for step in steps]
    assert values == sorted(values)
    assert values[0] == 0 < values[-1]
    # The pedestrian is hit at 5.6 s.
    curve = formats.find_decision_point(PEDESTRIAN, ego=34, step_s=0.1, after_s=2.0)
    assert curve.contact_time_s == pytest.approx(5.6, abs=0.1)
    for step, value in zip(steps, values, strict=True):
        there = next(s for s in curve.steps if s.time_s == pytest.approx(step / 10))
        # The curve counts contacts until 2 s after the contact, the measure for 4 s.
        assert value == pytest.approx(there.best.most, rel=1e-6, abs=1e-9), step


@needs_crime
@with_file
def test_the_last_avoidable_step_is_that_of_the_decision_curve():
    from crashrank.crime import LeastHarm

    measure = LeastHarm(settings(PEDESTRIAN, 34))
    curve = formats.find_decision_point(PEDESTRIAN, ego=34, step_s=0.1, before_s=1.5, after_s=2.5)
    last = round(curve.last_avoidable.time_s * 10)
    assert measure.compute(last, verbose=False) == 0
    assert measure.compute(last + 1, verbose=False) > 0
    assert measure.visualize().axes


@needs_crime
@with_file
def test_an_ego_without_lanelets_or_trajectory_is_one_error():
    from crashrank.crime import LeastHarm

    with pytest.raises(crashrank.UsageError, match="lanelet_assignment=True"):
        LeastHarm(settings(PEDESTRIAN, 34, lanelet_assignment=False))
    with pytest.raises(crashrank.UsageError, match="no obstacle with a trajectory"):
        LeastHarm(settings(PEDESTRIAN, 4711))


def standing_car_ahead():
    """Return settings: at 15 m/s towards a car that stands 30 m ahead, for two seconds."""
    sys.path.insert(0, str(ROOT / "scripts"))
    import crime_scenario as crime
    import numpy as np
    from commonroad.geometry.shape import Rectangle

    times = crime.steps_until(2.0)
    ego, other = (
        crime.moving(
            identity, "car", Rectangle(4.5, 1.8),
            np.stack([x + speed * times, 0 * times, 0 * times], axis=1),
        )
        for identity, x, speed in ((crime.EGO_ID, 0.0, 15.0), (crime.EGO_ID + 1, 30.0, 0.0))
    )  # fmt: skip
    scenario = crime.scenario_of(ego, [other])
    return crime.configured(scenario, crime.EGO_ID, 1500.0, 1500.0), crime.STEP_S


@needs_crime
def test_braking_alone_follows_the_closed_form():
    """Braking straight with all the grip stops within v^2 / 2a, and no later."""
    from crashrank.crime import LeastHarm

    class Braking(LeastHarm):
        accelerations = 3
        steerings = 1

    config, step_s = standing_car_ahead()
    measure = Braking(config)
    gap, speed, grip = 30.0 - 4.5, 15.0, 0.8 * 9.80665
    latest = (gap - speed**2 / (2 * grip)) / speed
    last = int(latest / step_s)
    values = [measure.compute(step, verbose=False) for step in range(last - 2, last + 6)]
    # Fronts and rears of cars are round: contact is up to a step later than of the boxes.
    assert values[:3] == [0, 0, 0]
    assert values[-1] > 0
    assert values == sorted(values)


@needs_crime
def test_no_state_is_nan_and_settings_can_be_changed():
    from crashrank.crime import LeastHarm

    class Coarse(LeastHarm):
        accelerations = 3
        steerings = 1

    measure = Coarse(standing_car_ahead()[0])
    assert math.isnan(measure.compute(100_000, verbose=False))
    assert measure.compute(0, verbose=False) == 0
    # Braking straight ahead is added to every grid.
    assert len(measure.ranking) <= 4
