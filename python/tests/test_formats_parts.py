"""Parts that all readers share: conversion of poses, boxes, areas, tracks."""

import math

import crashrank
import format_scenes as scenes
import numpy as np
import pytest
from crashrank.formats._boxes import boxes_of_outline, least_box, overlap_depths, ring_area
from crashrank.formats._commonroad_shapes import corners_of
from crashrank.formats._road import (
    areas_between,
    between_lines,
    contains,
    is_simple,
    near_areas,
    simplified,
)
from crashrank.formats._scene import (
    ORIGIN_SHARE,
    Body,
    Pose,
    Report,
    State,
    Track,
    moved,
    origin_of_box,
)
from crashrank.formats._sets import paths_through_sets
from crashrank.formats._tracks import motions
from hypothesis import given, settings
from hypothesis import strategies as st

ANGLES = st.floats(-10, 10)
PLACES = st.floats(-1000, 1000)


@settings(max_examples=100, deadline=None, database=None, derandomize=True)
@given(
    x=PLACES,
    y=PLACES,
    yaw=ANGLES,
    length=st.floats(0.1, 20),
    kind=st.sampled_from(list(ORIGIN_SHARE)),
)
def test_the_origin_lies_on_the_axis_behind_the_middle(x, y, yaw, length, kind):
    origin = origin_of_box(Pose(x, y, yaw), kind, length)
    rear = moved(origin, -ORIGIN_SHARE[kind] * length, 0.0)
    front = moved(origin, (1 - ORIGIN_SHARE[kind]) * length, 0.0)
    assert (rear.x_m + front.x_m) / 2 == pytest.approx(x, abs=1e-9)
    assert (rear.y_m + front.y_m) / 2 == pytest.approx(y, abs=1e-9)
    assert math.cos(origin.yaw_rad - yaw) == pytest.approx(1)


@pytest.mark.parametrize("kind", ORIGIN_SHARE)
def test_the_origin_of_a_box_is_that_of_the_ranked_body(kind):
    size = (4.5, 1.8, 1.5)
    scenario = {
        "scenario_version": 2, "models": {"a": {"box": size, "kind": kind}},
        "ego": {"model": "a", "speed_mps": 5},
        "candidates": {"listed": [{"name": "hold", "acceleration_mps2": 0}], "grid": False},
        "actors": [],
    }  # fmt: skip
    outline = crashrank.rank(scenario)._ranked.outline(-1)
    low, high = outline.min(axis=0), outline.max(axis=0)
    assert high - low == pytest.approx(size[:2], abs=1e-3)
    middle = (low + high) / 2
    origin = origin_of_box(Pose(middle[0], middle[1], 0.0), kind, size[0])
    assert (origin.x_m, origin.y_m) == pytest.approx((0, 0), abs=1e-3)


def test_poles_and_persons_have_their_origin_in_the_middle():
    for kind in ("pedestrian", "pole", "barrier", "building"):
        assert origin_of_box(Pose(3, 4, 1), kind, 5.0) == pytest.approx((3, 4, 1))


@settings(max_examples=60, deadline=None, database=None, derandomize=True)
@given(yaw=st.floats(-3, 3), length=st.floats(1, 20), width=st.floats(0.5, 0.9))
def test_the_least_box_of_a_rectangle_is_itself(yaw, length, width):
    pose, long, wide = least_box(corners_of((Pose(5, -7, yaw), length, width)))
    assert (pose.x_m, pose.y_m) == pytest.approx((5, -7), abs=1e-6)
    assert (long, wide) == pytest.approx((length, width), abs=1e-6)
    assert abs(math.sin(pose.yaw_rad - yaw)) < 1e-6


def test_an_angular_outline_stands_as_walls_inside_it():
    ring = [(0, 0), (10, 0), (10, 4), (4, 4), (4, 10), (0, 10)]
    for outline in (ring, ring[::-1]):
        walls = boxes_of_outline(outline)
        assert len(walls) == 6
        for pose, length, width in walls:
            for x, y in corners_of((pose, length - 1e-6, width - 1e-6)):
                assert contains(ring, x, y)
    assert len(boxes_of_outline([(0, 0), (4, 0), (4, 2), (0, 2)])) == 1


@settings(max_examples=100, deadline=None, database=None, derandomize=True)
@given(x=st.floats(-6, 6), y=st.floats(-6, 6), yaw=ANGLES, a=st.floats(0.5, 5), b=st.floats(0.5, 5))
def test_overlaps_of_boxes_are_those_of_sampled_points(x, y, yaw, a, b):
    one, two = (Pose(0, 0, 0.3), 4.0, 2.0), (Pose(x, y, yaw), a, b)
    depth = overlap_depths(np.array([one[0]]), one[1:], np.array([two[0]]), two[1:])[0]
    steps = np.linspace(-0.5, 0.5, 41)
    inside = any(
        abs(math.cos(0.3) * px + math.sin(0.3) * py) <= 2.0
        and abs(math.cos(0.3) * py - math.sin(0.3) * px) <= 1.0
        for i in steps
        for j in steps
        for px, py, _ in [moved(two[0], i * a, j * b)]
    )
    if inside:
        assert depth >= -1e-9
    if depth > 0.3:
        assert inside


def test_areas_between_lines_have_no_crossing_edges():
    left, right = [(0, 2), (5, 2), (10, 2)], [(0, 0), (5, 0), (10, 0)]
    assert between_lines(left, right) == [[(0, 2), (10, 2), (10, 0), (0, 0)]]
    crossed = between_lines([(0, 2), (5, 2), (10, -2)], [(0, 0), (5, 0), (10, 0)])
    assert crossed
    assert all(is_simple(ring) for ring in crossed)
    assert between_lines([(0, 0), (1, 0)], [(0, 0), (1, 0)]) == []


@pytest.mark.parametrize(
    ("ring", "simple"),
    [
        ([(0, 0), (4, 0), (4, 4), (0, 4)], True),
        ([(0, 0), (4, 4), (4, 0), (0, 4)], False),
        ([(0, 0), (4, 0), (2, 0), (2, 4)], False),
        ([(0, 0), (4, 0), (4, 4), (2, 0), (0, 4)], False),
    ],
)
def test_simple_rings(ring, simple):
    assert is_simple(ring) is simple


def test_simplified_rings_keep_their_area():
    ring = [(x, 0.0) for x in range(11)] + [(x, 3.0) for x in range(10, -1, -1)]
    assert len(simplified(ring)) == 4
    assert abs(ring_area(simplified(ring))) == pytest.approx(30)
    assert simplified([(0, 0), (0, 0), (1, 0)]) == []


def test_an_ego_beside_all_areas_has_no_road():
    report = Report("x", "y")
    ring = [(0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (0.0, 4.0)]
    inside, outside = Pose(5, 2, 0), Pose(5, 5, 0)
    assert near_areas([ring], inside, [inside], report) == [ring]
    assert not report.warnings
    assert near_areas([ring], inside, [inside, outside], report) == []
    assert "beside" in report.warnings[0]


def test_only_lanes_within_reach_are_read():
    report = Report("x", "y")
    near = ([(0.0, 4.0), (10.0, 4.0)], [(0.0, 0.0), (10.0, 0.0)])
    far = ([(x + 1000, y) for x, y in near[0]], [(x + 1000, y) for x, y in near[1]])
    found = areas_between([far, near], Pose(5, 2, 0), 50, report)
    assert [sorted(ring) for ring in found] == [[(0, 0), (0, 4), (10, 0), (10, 4)]]
    long = [(0.01 * i, 0.0) for i in range(20_000)]
    many = [(long, [(x, 3.0) for x, _ in long])] * 10
    assert len(areas_between(many, Pose(5, 2, 0), 50, report)) < 10
    assert "nearest lanes" in report.warnings[0]


def body(states, **more):
    return Body("b", "place", "car", (4.5, 1.8, 1.5), [Track(states)], **more)


def straight(times, speed=10.0, **more):
    return [State(t, Pose(speed * t, 0.0, 0.0), **more) for t in times]


def one_motion(states, at=0.0, horizon=4.0):
    report = Report("x", "y")
    found = motions(body(states), at, horizon, report)
    return (found[0] if found else None), report


@pytest.mark.parametrize("at", [0.0, 0.05, 1.0, 1.23])
def test_poses_begin_at_the_moment_of_decision_and_end_at_the_horizon(at):
    motion, report = one_motion(straight(np.arange(0, 8, 0.1)), at, 3.0)
    assert motion.start.x_m == pytest.approx(10 * at)
    assert motion.speed_mps == pytest.approx(10)
    assert motion.poses[0][0] == 0
    assert motion.poses[-1][0] == pytest.approx(3.0, abs=0.006)
    for t, pose in motion.poses:
        assert pose.x_m == pytest.approx(10 * (at + t))
    assert not report.lines()[1:]


def test_a_track_that_ends_goes_on():
    motion, report = one_motion(straight([0, 0.5, 1.0]))
    assert motion.poses[-1] == (4.0, pytest.approx((40.0, 0.0, 0.0)))
    assert "goes on" in report.assumed[0]


def test_a_track_that_begins_late_is_moved_back():
    motion, report = one_motion(straight(np.arange(2, 8, 0.5)))
    assert motion.start == pytest.approx((0, 0, 0), abs=1e-9)
    assert "2 s after" in report.warnings[0]
    assert one_motion(straight([5.0, 6.0]))[0] is None
    missing, report = one_motion(straight([0.0, 1.0]), at=2.0)
    assert missing is None
    assert "ends" in report.left_out[0]


def test_jumps_and_spins_are_reported():
    states = straight(np.arange(0, 3, 0.1))
    states[15:] = [State(s.t_s, Pose(s.pose.x_m + 500, 0, 0)) for s in states[15:]]
    motion, report = one_motion(states)
    assert "jumps" in report.warnings[0]
    assert motion.poses[-1][1].x_m == pytest.approx(40)
    states = straight(np.arange(0, 3, 0.1))
    states[10] = State(1.0, Pose(10, 0, math.pi))
    motion, report = one_motion(states)
    assert any("turns" in each for each in report.warnings)
    for (t, pose), (u, after) in zip(motion.poses, motion.poses[1:], strict=False):
        turn = abs(math.remainder(after.yaw_rad - pose.yaw_rad, math.tau))
        assert math.degrees(turn) / (u - t) < 720


@pytest.mark.parametrize(("kind", "leap_m"), [("pedestrian", 0.92), ("bicycle", 2.6)])
def test_persons_faster_than_they_can_be_are_reported(kind, leap_m):
    def warnings(ahead_m):
        states = straight(np.arange(0, 3, 0.1), 1.4)
        states[15:] = [State(s.t_s, Pose(s.pose.x_m + ahead_m, 0, 0)) for s in states[15:]]
        report = Report("x", "y")
        person = Body("b", "place", kind, (0.5, 0.5, 1.75), [Track(states)])
        (motion,) = motions(person, 0.0, 2.5, report)
        assert motion.poses[-1][1].x_m == pytest.approx(1.4 * 2.5 + ahead_m)
        return report.warnings

    assert "b jumps at 1.5 s, faster than" in warnings(leap_m - 0.14)[0]
    assert not warnings(0.8 * leap_m - 0.14)


def test_one_state_moves_on_with_its_velocity():
    ahead = State(0.0, Pose(0, 0, 0), (8.0, 0.0), 0.1)
    motion, _ = one_motion([ahead])
    assert (motion.poses, motion.speed_mps, motion.yaw_rate_radps) == ([], 8.0, 0.1)
    sideways, _ = one_motion([State(0.0, Pose(0, 0, 0), (0.0, 2.0))])
    assert sideways.poses[-1] == (4.0, pytest.approx((0, 8, 0)))
    later, _ = one_motion([ahead], at=1.0)
    assert later.start.x_m == pytest.approx(8.0)


def test_paths_through_sets_keep_the_box_inside():
    start = State(0.0, Pose(0, 0, 0), (10.0, 0.0))
    size = (4.5, 1.8, 1.5)
    sets = []
    for i in range(1, 6):
        t = 0.5 * i
        half = (2.25 + t, 0.9 + 0.5 * t)
        ring = corners_of((Pose(10 * t, 0, 0), 2 * half[0], 2 * half[1]))
        sets.append((t, ring))
    tracks = paths_through_sets(start, size, sets, 4.0)
    assert len(tracks) == 5
    assert sum(track.probability for track in tracks) == pytest.approx(1)
    for track in tracks:
        for state, (t, ring) in zip(track.states[1:], sets, strict=True):
            assert state.t_s == t
            for x, y in corners_of((state.pose, size[0] - 1e-6, size[1] - 1e-6)):
                assert contains(ring, x, y)


def test_the_files_of_the_project_are_what_the_program_writes():
    from conftest import DATA

    for name, text in scenes.TEXTS.items():
        assert (DATA / "formats" / name).read_text(encoding="utf-8") == text(), name
