"""CommonRoad: shapes, values, states, predictions and who decides."""

import math

import crashrank
import format_scenes as scenes
import pytest

pytest.importorskip("lxml")
from crashrank.formats import read_commonroad

CIRCLE = "<shape><circle><radius>0.4</radius></circle></shape>"


def read(tmp_path, text, **options):
    path = tmp_path / "a.xml"
    path.write_text(text, encoding="utf-8")
    return read_commonroad(path, **options)


def obstacle(shape, pose=(20.0, 3.0, 0.5), kind="car", mps=8.0, tag="dynamicObstacle", more=""):
    state = scenes.cr_state("initialState", pose, 0, mps if tag == "dynamicObstacle" else None)
    return f'<{tag} id="7"><type>{kind}</type>{shape}{state}{more}</{tag}>'


def actor(tmp_path, body, **options):
    """Return the only actor of a scene with this obstacle, and its model."""
    found = read(tmp_path, scenes.commonroad(body), **options)
    (each,) = found.scenario["actors"]
    return each, found.scenario["models"][each["model"]], found.report


def middle(each, model, share):
    """Return the middle of the box of an actor from its origin."""
    pose = each["pose"] if "pose" in each else each["poses"][0]
    yaw = math.radians(pose["yaw_deg"])
    ahead = (0.5 - share) * model["box"][0]
    return pose["x_m"] + ahead * math.cos(yaw), pose["y_m"] + ahead * math.sin(yaw)


def test_a_rectangle_with_center_and_orientation_turns_with_the_heading(tmp_path):
    more = "<orientation>0.2</orientation><center><x>1.0</x><y>0.5</y></center>"
    each, model, _ = actor(tmp_path, obstacle(scenes.rectangle((4.0, 2.0), more)))
    expected = (
        20 + math.cos(0.5) * 1.0 - math.sin(0.5) * 0.5,
        3 + math.sin(0.5) * 1.0 + math.cos(0.5) * 0.5,
    )
    assert middle(each, model, 0.2) == pytest.approx(expected, abs=1e-3)
    # It moves along its heading, askew to its box: that needs poses.
    assert each["poses"][0]["yaw_deg"] == pytest.approx(math.degrees(0.7), abs=1e-4)
    assert model["box"] == [4.0, 2.0, 1.5]


def test_an_origin_shift_moves_the_box_the_other_way(tmp_path):
    shape = scenes.rectangle((4.0, 2.0), "<originXShift>-1.3</originXShift>")
    each, model, _ = actor(tmp_path, obstacle(shape))
    expected = (20 + 1.3 * math.cos(0.5), 3 + 1.3 * math.sin(0.5))
    assert middle(each, model, 0.2) == pytest.approx(expected, abs=1e-3)


TRUCK = (
    "<truckShape><truckDims><length>5.1</length><width>2.55</width><wheelbase>3.6</wheelbase>"
    "<distFromRearToRearAxle>0.5</distFromRearToRearAxle><cabinLength>2.5</cabinLength>"
    "<distFromRearAxleToHitch>0.45</distFromRearAxleToHitch></truckDims>"
    "<originXShift>-2.05</originXShift></truckShape>"
)
TRAILER = (
    f"<semiTrailerTruckShape>{TRUCK}<trailerDims><length>13.6</length><width>2.55</width>"
    "<wheelbase>7.8</wheelbase><distFromFrontToHitch>0.9</distFromFrontToHitch></trailerDims>"
    "</semiTrailerTruckShape>"
)


def test_trucks_are_placed_by_their_rear_axle(tmp_path):
    each, model, _ = actor(tmp_path, obstacle(f"<shape>{TRUCK}</shape>", kind="truck"))
    assert model == {"box": [5.1, 2.55, 3.5], "kind": "truck"}
    expected = (20 + 2.05 * math.cos(0.5), 3 + 2.05 * math.sin(0.5))
    assert middle(each, model, 0.25) == pytest.approx(expected, abs=1e-3)


def test_a_tractor_and_its_trailer_are_one_box(tmp_path):
    each, model, report = actor(tmp_path, obstacle(f"<shape>{TRAILER}</shape>", kind="truck"))
    # Front of the tractor 4.6 m ahead of its rear axle, rear of the trailer 12.7 m behind the
    # hitch, which is 0.45 m ahead of the axle.
    assert model["box"] == pytest.approx([4.6 + 12.7 - 0.45, 2.55, 3.5])
    ahead = (4.6 + 0.45 - 12.7) / 2
    expected = (20 + ahead * math.cos(0.5), 3 + ahead * math.sin(0.5))
    assert middle(each, model, 0.25) == pytest.approx(expected, abs=1e-3)
    assert any("one box" in text for text in report.assumed)


def test_a_circle_has_the_stated_radius(tmp_path):
    each, model, _ = actor(tmp_path, obstacle(CIRCLE, kind="pedestrian"))
    assert model["box"] == [0.8, 0.8, 1.75]
    assert (each["pose"]["x_m"], each["pose"]["y_m"]) == (20, 3)


def test_a_polygon_that_moves_is_its_rectangle_along_the_heading(tmp_path):
    corners = ((-2, -1), (2.5, -0.8), (2.5, 0.8), (-2, 1), (-2, -1))
    polygon = "".join(scenes.point(x, y) for x, y in corners)
    each, model, report = actor(tmp_path, obstacle(f"<shape><polygon>{polygon}</polygon></shape>"))
    assert model["box"] == [4.5, 2.0, 1.5]
    expected = (20 + 0.25 * math.cos(0.5), 3 + 0.25 * math.sin(0.5))
    assert middle(each, model, 0.2) == pytest.approx(expected, abs=1e-3)
    assert report.assumed


def test_an_outline_that_stands_is_walls(tmp_path):
    corners = ((0, 0), (8, 0), (8, 2), (2, 2), (2, 8), (0, 8))
    polygon = "".join(scenes.point(x + 70, y + 60) for x, y in corners)
    body = (
        '<environmentObstacle id="9"><type>building</type>'
        f"<shape><polygon>{polygon}</polygon></shape></environmentObstacle>"
    )
    found = read(tmp_path, scenes.commonroad(body))
    assert len(found.scenario["actors"]) == 6
    assert {found.scenario["models"][a["model"]]["kind"] for a in found.scenario["actors"]} == {
        "building"
    }


def test_format_2018b(tmp_path):
    state = scenes.cr_state("initialState", (30, 3, 0), 0)
    body = (
        f'<obstacle id="5"><role>static</role><type>parkedVehicle</type>'
        f"{scenes.rectangle(scenes.CAR)}{state}</obstacle>"
    )
    moving = scenes.cr_trajectory(
        6, "car", scenes.rectangle(scenes.CAR), [(50 + i, 3, 0) for i in range(4)], 2.0
    )
    moving = moving.replace("dynamicObstacle", "obstacle").replace(
        "<type>car", "<role>dynamic</role><type>car"
    )
    found = read(tmp_path, scenes.commonroad(body + moving, version="2018b"))
    parked, driven = found.scenario["actors"]
    assert "speed_mps" not in parked
    assert [pose["t_s"] for pose in driven["poses"]] == [0, 0.5, 1.0, 1.5, 4.0]


@pytest.mark.parametrize("version", ["2017a", "2024a", ""])
def test_other_versions_are_refused(tmp_path, version):
    with pytest.raises(crashrank.BadInputError, match="commonroad-io"):
        read(tmp_path, scenes.commonroad(version=version))


def test_intervals_are_read_as_their_middles(tmp_path):
    body = obstacle(scenes.rectangle(scenes.CAR)).replace(
        "<orientation><exact>0.5</exact>",
        "<orientation><intervalStart>0.4</intervalStart><intervalEnd>0.6</intervalEnd>",
    )
    each, _, report = actor(tmp_path, body)
    assert each["pose"]["yaw_deg"] == pytest.approx(math.degrees(0.5), abs=1e-4)
    assert any("intervals" in text for text in report.assumed)


def test_point_masses_have_their_heading_from_the_velocity(tmp_path):
    body = obstacle(scenes.rectangle(scenes.CAR), pose=(20, 3, 0), mps=3.0)
    body = body.replace(
        "<orientation><exact>0</exact></orientation>", "<velocityY><exact>4</exact></velocityY>"
    )
    each, _, _ = actor(tmp_path, body)
    assert each["speed_mps"] == pytest.approx(5)
    assert each["pose"]["yaw_deg"] == pytest.approx(math.degrees(math.atan2(4, 3)), abs=1e-4)


def sets(first, count):
    rows = []
    for i in range(first, first + count):
        x, half = 20.0 + 4 * i, 0.4 * i
        inner = "".join(
            scenes.point(x + a * (2.25 + half), 3 + b * (0.9 + half))
            for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1))
        )
        rows.append(
            f"<occupancy><shape><polygon>{inner}</polygon></shape>{scenes.exact('time', i)}"
            "</occupancy>"
        )
    return f"<occupancySet>{''.join(rows)}</occupancySet>"


def test_sets_are_paths_of_equal_probability(tmp_path):
    each, _, report = actor(
        tmp_path, obstacle(scenes.rectangle(scenes.CAR), pose=(20, 3, 0), more=sets(1, 8))
    )
    chances = [prediction["probability"] for prediction in each["predictions"]]
    assert chances == pytest.approx([0.2] * 5)
    last = [prediction["poses"][-1] for prediction in each["predictions"]]
    # The middle of the last set is 52 m, its room ahead and behind 3.2 m, left and right too.
    ahead = 0.3 * 4.5
    assert sorted(round(p["x_m"] + ahead - 52, 2) for p in last) == [-3.2, 0, 0, 0, 3.2]
    assert sorted(round(p["y_m"] - 3, 2) for p in last) == [-3.2, 0, 0, 0, 3.2]
    assert any("paths" in text for text in report.assumed)


def late(first, count=6):
    poses = [(60.0 + 2 * i, 3.0, 0.0) for i in range(count)]
    return scenes.cr_trajectory(8, "car", scenes.rectangle(scenes.CAR), poses, 4.0, first)


def test_bodies_that_appear_late_are_moved_back(tmp_path):
    each, _, report = actor(tmp_path, late(3))
    assert each["poses"][0]["x_m"] == pytest.approx(60 - 6 - 0.3 * 4.5)
    assert "1.5 s after" in report.warnings[0]
    assert read(tmp_path, scenes.commonroad(late(20))).scenario["actors"] == []


def test_time_steps_that_start_late(tmp_path):
    """An ego that is recorded from step 10 on decides there unless told otherwise."""
    text = scenes.commonroad(late(10, 9), problem=False)
    first = read(tmp_path, text, ego=8)
    assert first.report.time_s == 5.0
    later = read(tmp_path, text, ego="8", time_step=14)
    assert later.report.time_s == 7.0
    assert later.scenario["ego"]["pose"]["x_m"] == pytest.approx(68 - 0.3 * 4.5)
    assert later.scenario["ego"]["speed_mps"] == 4.0
    for step in (9, 19):
        with pytest.raises(crashrank.BadInputError, match="from 5 to 9 s"):
            read(tmp_path, text, ego=8, time_step=step)


def test_times_between_steps_are_interpolated(tmp_path):
    found = read(tmp_path, scenes.commonroad(late(0), problem=False), ego=8, time_s=0.6)
    assert found.scenario["ego"]["pose"]["x_m"] == pytest.approx(60 + 2.4 - 0.3 * 4.5)


def test_the_recording_of_the_ego_itself_is_left_out(tmp_path):
    own = scenes.cr_trajectory(
        4, "car", scenes.rectangle(scenes.CAR), [scenes.ego(i) for i in range(5)], scenes.EGO_MPS
    )
    found = read(tmp_path, scenes.commonroad(own))
    assert found.scenario["actors"] == []
    assert "own recording" in found.report.left_out[0]


def test_recorded_overlaps_are_said(tmp_path):
    two = [
        f'<staticObstacle id="{i}"><type>parkedVehicle</type>{scenes.rectangle(scenes.CAR)}'
        f"{scenes.cr_state('initialState', (120 + 3 * i, 70, 0), 0)}</staticObstacle>"
        for i in range(2)
    ]
    assert not read(tmp_path, scenes.commonroad("".join(two))).report.warnings
    moving = late(0).replace('id="8"', 'id="11"') + late(0)
    warnings = read(tmp_path, scenes.commonroad(moving)).report.warnings
    assert "overlap as the file has them" in warnings[0]


@pytest.mark.parametrize(("track", "place_m"), [(late(0, 3), 71.0), (late(4, 3), 53.0)])
def test_overlaps_are_of_what_is_recorded(tmp_path, track, place_m):
    """A car that is carried on into a parked one, or back out of one, never touched it."""
    parked = obstacle(scenes.rectangle(scenes.CAR), (place_m, 3, 0), tag="staticObstacle")
    found = read(tmp_path, scenes.commonroad(parked + track))
    assert len(found.scenario["actors"]) == 2
    assert not any("overlap" in each for each in found.report.warnings)
    text = scenes.commonroad(parked.replace("<x>" + scenes.number(place_m), "<x>61") + track)
    assert any("overlap" in each for each in read(tmp_path, text).report.warnings)


def test_phantoms_are_left_out(tmp_path):
    body = f'<phantomObstacle id="5">{sets(1, 3)}</phantomObstacle>'
    found = read(tmp_path, scenes.commonroad(body))
    assert found.scenario["actors"] == []
    assert "phantom" in found.report.left_out[0]


def test_far_places_are_counted_from_near_the_ego(tmp_path):
    poses = [(5_000_000.0 + 2 * i, 300_000.0, 0.0) for i in range(9)]
    body = scenes.cr_trajectory(8, "car", scenes.rectangle(scenes.CAR), poses, 4.0)
    found = read(tmp_path, scenes.commonroad(body, problem=False), ego=8)
    assert abs(found.scenario["ego"]["pose"]["x_m"]) < 10
    assert any("counted from" in text for text in found.report.assumed)


def test_the_ego_has_to_be_named_without_a_planning_problem(tmp_path):
    text = scenes.commonroad(problem=False)
    with pytest.raises(crashrank.UsageError, match="choose an ego: 2"):
        read(tmp_path, text)
    with pytest.raises(crashrank.BadInputError, match="not a vehicle"):
        read(tmp_path, text, ego=2)


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ("<length>4.5</length>", "", "rectangle"),
        ("<length>4.5</length>", "<length>long</length>", "length"),
        ("<length>4.5</length>", "<length>nan</length>", "length"),
        ("<width>1.8</width>", "<width>-1</width>", "width"),
        ("<orientation><exact>0.4</exact></orientation>", "", "initialState"),
        ("rectangle>", "hexagon>", "shape"),
        ('timeStepSize="0.5"', 'timeStepSize="0"', "commonRoad"),
        ("<initialState>", "<initialStat>", ""),
    ],
)
def test_refusals_name_the_element_and_its_line(tmp_path, old, new, place):
    text = scenes.commonroad()
    assert old in text
    with pytest.raises(crashrank.BadInputError) as caught:
        read(tmp_path, text.replace(old, new))
    assert place in caught.value.place
    assert "line" in caught.value.place
    assert caught.value.file.endswith("a.xml")
