"""The point of decision: against closed forms, mirror images and moments given one by one."""

import dataclasses
import json
import math
import random

import crashrank
import pytest
from conftest import DATA
from crashrank import formats

GRIP_MPS2 = 0.8 * 9.80665
LENGTH, WIDTH = 4.5, 1.8
STEP = 0.05
CROSSING = DATA / "formats/crossing_poses.csv"


def table(tmp_path, ego, others, name="a.csv"):
    """Write a table of poses: of the ego (t, x, y, yaw), and others as lines after their times."""
    lines = ["t_s,id,kind,x_m,y_m,yaw_deg,length_m,width_m,height_m"]
    lines += [f"{t},ego,car,{x},{y},{yaw},{LENGTH},{WIDTH},1.5" for t, x, y, yaw in ego]
    path = tmp_path / name
    path.write_text("\n".join(lines + others) + "\n", encoding="utf-8")
    return path


def straight(speed_mps, seconds=9):
    return [(t, speed_mps * t, 0, 0) for t in range(seconds)]


def wall(distance_m):
    """Return a wall of 200 m across the road, its face that far from the middle of the ego."""
    return [f"0,wall,barrier,{distance_m + 0.5},0,90,200,1,3"]


def approaches():
    seed = 20240611
    print(f"seed {seed}")
    generate = random.Random(seed)
    return [(generate.uniform(9, 20), generate.uniform(50, 70)) for _ in range(2)]


@pytest.mark.parametrize(("speed", "distance"), approaches())
def test_braking_before_a_wall_follows_the_closed_form(tmp_path, speed, distance):
    """Braking with a stops within v/(2a) of the contact; at v/(4a) it has lost half the energy."""
    curve = formats.find_decision_point(
        table(tmp_path, straight(speed), wall(distance)),
        step_s=STEP, before_s=1.6, accelerations=3, steerings=1, measure="closing-energy",
    )  # fmt: skip
    contact = (distance - LENGTH / 2) / speed
    assert curve.contact_time_s == pytest.approx(contact, abs=0.01)
    assert curve.other == "wall"
    for step, limit in (
        (curve.last_avoidable_by_braking, contact - speed / (2 * GRIP_MPS2)),
        (curve.last_avoidable, contact - speed / (2 * GRIP_MPS2)),
        (curve.last_halvable, contact - speed / (4 * GRIP_MPS2)),
    ):
        assert limit - STEP - 0.01 <= step.time_s <= limit + 0.01
        assert step.best.acceleration_mps2 == pytest.approx(-GRIP_MPS2)
    assert curve.last_avoidable_by_steering is None


@pytest.mark.parametrize(("speed", "distance"), approaches())
def test_steering_before_a_wall_follows_the_closed_form(tmp_path, speed, distance):
    """On a circle with all the grip the outer front corner reaches its distance from the middle."""
    curve = formats.find_decision_point(
        table(tmp_path, straight(speed), wall(distance)),
        step_s=0.1, before_s=3.5, after_s=5.0, accelerations=3, steerings=3,
    )  # fmt: skip
    radius = speed**2 / GRIP_MPS2
    reach = math.hypot(0.8 * LENGTH, radius + WIDTH / 2)
    limit = (distance + 0.3 * LENGTH - reach) / speed
    found = curve.last_avoidable_by_steering
    # The corners of a car are round: it reaches up to 0.4 m less.
    assert limit - 0.11 <= found.time_s <= limit + 0.4 / speed + 0.01
    assert abs(found.steering.curvature_per_m) == pytest.approx(1 / radius, rel=1e-3)


def test_the_mirror_image_is_decided_the_other_way(tmp_path):
    found = []
    for side in (1, -1):
        pole = [f"0,pole,pole,60,{0.4 * side},0,0.4,0.4,6"]
        path = table(tmp_path, straight(15), pole, f"{side}.csv")
        curve = formats.find_decision_point(path, accelerations=5, steerings=5, before_s=1.5)
        away = curve.last_avoidable_by_steering.steering
        assert away.curvature_per_m * side < 0
        found.append([(s.time_s, s.best.score, s.best.avoids) for s in curve.steps])
    for one, other in zip(*found, strict=True):
        assert one == pytest.approx(other, abs=1e-6)


def test_no_way_is_better_than_the_best():
    curve = formats.find_decision_point(CROSSING, accelerations=5, steerings=5)
    for step in curve.steps:
        assert step.complete
        assert step.best.score <= step.going_on.score + 1e-9
        for way in (step.braking, step.steering):
            assert step.best.score <= way.score + 1e-9
        if step.avoidable:
            assert step.best.score == 0.0
    # The person's middle is 35 m ahead, the front 2.25 m, its side 0.25 m.
    assert curve.contact_time_s == pytest.approx((35 - 0.25 - 2.25) / 15, abs=0.03)
    limit = curve.contact_time_s - 15 / (2 * GRIP_MPS2)
    assert curve.last_avoidable_by_braking.time_s <= limit + 0.1
    assert curve.last_avoidable.time_s >= curve.last_avoidable_by_braking.time_s


def test_a_recording_that_stops_has_no_contact(tmp_path):
    """The ego brakes evenly from 15 m/s within 20 m: what it recorded goes on, not its speed."""
    slowing = 15**2 / (2 * 20)
    ego = [(0.1 * i, 15 * 0.1 * i - slowing / 2 * (0.1 * i) ** 2, 0, 0) for i in range(27)]
    path = table(tmp_path, [*ego, (2.7, 20, 0, 0), (9, 20, 0, 0)], wall(40))
    curve = formats.find_decision_point(path, step_s=0.5, accelerations=3, steerings=3)
    assert (curve.contact_time_s, curve.other) == (None, "wall")
    for step in curve.steps:
        # It stops with its middle at 20 m, its front half a length ahead, the wall at 40 m.
        assert step.going_on.least_distance_m == pytest.approx(20 - LENGTH / 2, abs=0.02)
        assert step.best.score == step.going_on.score == 0.0
        assert step.avoidable
    # The last centimetre of the approach takes sqrt(2 * 0.01 / slowing), 0.06 s.
    assert curve.steps[-1].time_s == 2.5
    assert (curve.last_avoidable, curve.last_halvable) == (None, None)
    assert (curve.last_avoidable_by_braking, curve.last_avoidable_by_steering) == (None, None)


def test_the_steps_end_at_the_closest_approach(tmp_path):
    """At 10 m/s past a pole 3 m beside the middle, 30 m ahead: closest once the front is there."""
    path = table(tmp_path, straight(10), ["0,pole,pole,30,3,0,0.4,0.4,6"])
    curve = formats.find_decision_point(path, step_s=0.1, accelerations=3, steerings=3)
    assert curve.other == "pole"
    reached = (30 - 0.2 - LENGTH / 2) / 10
    # The corners of a car are round: its side is reached up to 0.4 m behind its front.
    assert reached - 0.15 <= curve.steps[-1].time_s <= reached + 0.05
    assert curve.steps[0].time_s == pytest.approx(max(curve.steps[-1].time_s - 2.9, 0.0), abs=0.11)
    text = str(curve).splitlines()
    assert len(text) == 2 + len(curve.steps)
    assert "ego goes on without a contact, passes 1.9" in text[0]
    assert "nothing to avoid" in text[0]
    assert "last" not in text[1]
    assert all(" m from pole" in line for line in text[2:])
    plain = json.loads(curve.to_json())
    assert plain["contact_time_s"] is None
    assert set(plain["last"].values()) == {None}
    assert plain["note"] in text[0]
    pytest.importorskip("matplotlib")
    (axes,) = curve.plot().axes
    assert len(axes.get_lines()) == 4
    assert "without a contact" in axes.get_xlabel()


def test_nothing_near_leaves_nothing_to_rank(tmp_path):
    path = table(tmp_path, straight(10), ["0,pole,pole,30,80,0,0.4,0.4,6"])
    with pytest.raises(crashrank.BadInputError, match="nothing comes within 50 m"):
        formats.find_decision_point(path)
    alone = formats.read_poses_csv(path)
    with pytest.raises(crashrank.BadInputError, match="nothing comes within 50 m"):
        formats.find_decision_point([alone])


def test_a_contact_at_the_first_moment_leaves_no_choice(tmp_path):
    path = table(tmp_path, straight(15), wall(0))
    with pytest.raises(crashrank.BadInputError, match="at the first moment"):
        formats.find_decision_point(path)


def test_moments_can_be_given_one_by_one():
    options = {"accelerations": 3, "steerings": 3}
    whole = formats.find_decision_point(CROSSING, step_s=0.25, **options)
    moments = [
        formats.read_poses_csv(
            CROSSING, step.time_s, horizon_s=whole.contact_time_s - step.time_s + 2.0
        )
        for step in whole.steps
    ]
    given = formats.find_decision_point(reversed(moments), **options)
    for step, other in zip(given.steps, whole.steps, strict=True):
        assert (step.time_s, step.avoidable) == (other.time_s, other.avoidable)
        assert step.best.candidate == other.best.candidate
        assert step.going_on.score == pytest.approx(other.going_on.score, abs=1e-3)
    assert (given.ego, given.other, given.step_s) == ("ego", "person", 0.25)
    assert given.contact_time_s == pytest.approx(whole.contact_time_s, abs=0.01)
    pairs = [(each.report.time_s, each.scenario) for each in moments]
    held = formats.find_decision_point(pairs, **options)
    assert held.contact_time_s == pytest.approx(whole.contact_time_s, abs=0.01)
    assert held.last_avoidable.time_s == whole.last_avoidable.time_s


def test_a_planning_problem_goes_on_with_its_velocity():
    pytest.importorskip("lxml")
    options = {"step_s": 0.25, "accelerations": 3, "steerings": 3}
    curve = formats.find_decision_point(DATA / "formats/crossing.xml", **options)
    table_ = formats.find_decision_point(CROSSING, **options)
    assert curve.ego == "planning problem 1"
    # Its car is of another size: half its length decides, and both are within 5 mm of each other.
    assert curve.contact_time_s == pytest.approx(table_.contact_time_s, abs=0.01)
    found = formats.read_commonroad(DATA / "formats/crossing.xml", time_s=1.0)
    assert any("is moved on" in text for text in found.report.assumed)


def test_curves_are_text_json_and_plot():
    curve = formats.find_decision_point(CROSSING, step_s=0.5, accelerations=3, steerings=3)
    plain = json.loads(curve.to_json())
    assert plain["contact_time_s"] == curve.contact_time_s
    assert len(plain["steps"]) == len(curve.steps)
    last = plain["last"]["by_braking"]
    assert last["time_s"] == curve.last_avoidable_by_braking.time_s
    assert last["choice"]["acceleration_mps2"] == pytest.approx(-GRIP_MPS2)
    text = str(curve).splitlines()
    assert len(text) == 6 + len(curve.steps)
    assert "ego hits person at 2.1" in text[0]
    assert "wheels that turn and brakes that act at once: the real ones are earlier" in text[0]
    assert plain["note"] in text[0]
    with pytest.raises(dataclasses.FrozenInstanceError):
        curve.file = "other"
    pytest.importorskip("matplotlib")
    (axes,) = curve.plot().axes
    going_on = axes.get_lines()[0]
    assert list(going_on.get_xdata()) == [step.time_s for step in curve.steps]
    assert list(going_on.get_ydata()) == [step.going_on.score for step in curve.steps]


def test_the_least_is_that_of_the_whole_grid():
    """What is not evaluated changes no score, and no way that is named."""
    grid = {"accelerations": 5, "steerings": 5}
    curve = formats.find_decision_point(CROSSING, step_s=0.5, before_s=1.5, **grid)
    for step in curve.steps:
        found = formats.read_poses_csv(
            CROSSING, step.time_s, horizon_s=curve.contact_time_s - step.time_s + 2.0
        )
        ranking = crashrank.rank({**found.scenario, "candidates": {"grid": grid}})
        least = min(ranking.best.score, step.going_on.score)
        assert step.best.score == pytest.approx(least, rel=1e-3)
        straight = [r for r in ranking if not r.curvature_per_m and r.acceleration_mps2 < 0]
        held = [r for r in ranking if r.curvature_per_m and not r.acceleration_mps2]
        for way, rows in ((step.braking, straight), (step.steering, held)):
            assert way.score == pytest.approx(rows[0].score, rel=1e-3)
            assert rows[0].candidate.startswith(way.candidate)


def test_the_command_says_what_it_computes(tmp_path, capsys):
    from crashrank.formats._command import main

    words = ["poses-csv", str(CROSSING), "-o", str(tmp_path / "a.json"), "--decide"]
    assert main([*words, "--step", "1"]) == 0
    lines = capsys.readouterr().err.splitlines()
    assert "searching 3 moments" in lines[0]
    assert any(" m from " in line for line in lines if line.startswith("crashrank: last avoidable"))
    assert main([*words, "--step", "1", "--quiet"]) == 0
    assert not capsys.readouterr().err


def test_a_deadline_leaves_bounds():
    curve = formats.find_decision_point(CROSSING, step_s=0.5, deadline_s=0.0)
    for step in curve.steps:
        assert step.best.least <= step.best.most
    assert str(curve)
    assert curve.to_json()


@pytest.mark.parametrize(
    ("source", "options", "text"),
    [
        (7, {}, "is a int"),
        ({}, {}, "is a dict"),
        ([], {}, "is empty"),
        ([3], {}, "source\\[0\\]: is a int"),
        ("scene.txt", {}, "its format is not known; choose commonroad"),
        (CROSSING, {"format": "nonsense"}, "no reader of 'nonsense'"),
        (CROSSING, {"step_s": 0.0}, "step_s: is 0"),
        (CROSSING, {"accelerations": 0}, "accelerations: is 0"),
        (CROSSING, {"before_s": math.inf}, "before_s: is not finite"),
        (CROSSING, {"step_s": 0.001, "before_s": 60, "horizon_s": 61}, "horizon_s: is 61"),
    ],
)
def test_what_has_no_meaning_is_refused(source, options, text):
    with pytest.raises(crashrank.UsageError, match=text):
        formats.find_decision_point(source, **options)
