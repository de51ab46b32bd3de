"""OSI traces and ROS 2 bags: what the shared scene does not have."""

import math
import struct

import crashrank
import format_scenes as scenes
import pytest
from conftest import DATA
from crashrank.formats import read_bag, read_osi, read_poses_csv, to_markers


def write(tmp_path, messages, name="a.osi"):
    path = tmp_path / name
    data = [message.SerializeToString() for message in messages]
    path.write_bytes(b"".join(struct.pack("<I", len(each)) + each for each in data))
    return path


class TestOsi:
    @pytest.fixture(autouse=True)
    def _needs(self):
        pytest.importorskip("osi3")

    def test_the_ego_has_to_be_known(self, tmp_path):
        messages = scenes.osi_messages()
        for message in messages:
            message.ClearField("host_vehicle_id")
        path = write(tmp_path, messages)
        with pytest.raises(crashrank.UsageError, match="choose of 1, 3"):
            read_osi(path)
        assert read_osi(path, ego=1).report.ego == "car 1"
        with pytest.raises(crashrank.UsageError, match="no moving object '9'"):
            read_osi(path, ego="9")
        with pytest.raises(crashrank.BadInputError, match="not a vehicle"):
            read_osi(path, ego=2)

    def test_seconds_count_from_the_first_message(self, tmp_path):
        messages = scenes.osi_messages()
        for message in messages:
            message.timestamp.seconds += 1_700_000_000
        found = read_osi(write(tmp_path, messages), 1.0)
        x, y, _ = scenes.rear_axle(scenes.ego(2))
        assert found.scenario["ego"]["pose"]["x_m"] == pytest.approx(x, abs=2e-3)
        assert found.scenario["ego"]["pose"]["y_m"] == pytest.approx(y, abs=2e-3)
        assert "road" in found.scenario  # of the first message
        with pytest.raises(crashrank.BadInputError, match="0 to 4 s"):
            read_osi(write(tmp_path, messages), 20.0)

    def test_standing_objects_hold_for_all_times(self, tmp_path):
        from osi3.osi_object_pb2 import StationaryObject

        messages = scenes.osi_messages()
        tree = messages[0].stationary_object.add()
        tree.id.value = 50
        tree.classification.type = StationaryObject.Classification.TYPE_TREE
        base = tree.base
        base.dimension.length = base.dimension.width = 0.4
        base.dimension.height, base.position.x, base.position.z = 8.0, 140.0, 4.0
        found = read_osi(write(tmp_path, messages), 2.0)
        each = found.scenario["actors"][-1]
        assert each["name"] == "stationary object 50"
        assert found.scenario["models"][each["model"]] == {"box": [0.4, 0.4, 8.0], "kind": "pole"}

    def test_bodies_on_a_bridge_are_left_out(self, tmp_path):
        messages = scenes.osi_messages()
        for message in messages:
            message.moving_object[2].base.position.z += 8.0
        found = read_osi(write(tmp_path, messages))
        assert len(found.scenario["actors"]) == 1
        assert any("another level" in each for each in found.report.left_out)

    def test_types_that_are_not_known_are_read_by_size(self, tmp_path):
        messages = scenes.osi_messages()
        for message in messages:
            message.moving_object[2].ClearField("vehicle_classification")
        found = read_osi(write(tmp_path, messages))
        assert found.scenario["models"][found.scenario["actors"][1]["model"]]["kind"] == "car"
        assert any("by its size" in each for each in found.report.assumed)

    @pytest.mark.parametrize("value", [float("nan"), float("inf"), 1e300])
    def test_poses_that_are_not_finite_are_refused(self, tmp_path, value):
        messages = scenes.osi_messages()
        messages[3].moving_object[1].base.position.x = value
        with pytest.raises(crashrank.BadInputError, match="message 4, moving object 2"):
            read_osi(write(tmp_path, messages))

    def test_traces_that_are_cut_off_are_refused(self, tmp_path):
        path = write(tmp_path, scenes.osi_messages())
        data = path.read_bytes()
        path.write_bytes(data[:-3])
        with pytest.raises(crashrank.BadInputError, match="message 9: is cut off"):
            read_osi(path)
        path.write_bytes(data + b"\1\0")
        with pytest.raises(crashrank.BadInputError, match="message 10: is cut off"):
            read_osi(path)

    @pytest.mark.parametrize(
        ("change", "text"),
        [
            (lambda _, m: m.ClearField("timestamp"), "messages of one time alone"),
            (lambda i, m: setattr(m.timestamp, "seconds", 9 - i), "message 2: is of -1 s"),
            (lambda _, m: m.moving_object.add().CopyFrom(m.moving_object[0]), "is there twice"),
            (lambda _, m: m.moving_object[0].ClearField("base"), "object 1: has no finite pose"),
        ],
    )
    def test_what_would_be_read_wrong_is_refused(self, tmp_path, change, text):
        messages = scenes.osi_messages()
        for i, message in enumerate(messages):
            message.timestamp.nanos = 0
            change(i, message)
        with pytest.raises(crashrank.BadInputError, match=text):
            read_osi(write(tmp_path, messages))

    def test_times_before_the_trace_are_refused(self):
        with pytest.raises(crashrank.BadInputError, match="the trace has 0 to 4 s"):
            read_osi(DATA / "formats/crossing.osi", -1.0)

    def test_mcap_files_begin_and_end_as_such(self, tmp_path):
        pytest.importorskip("mcap")
        path = tmp_path / "a.mcap"
        scenes.write_osi_mcap(path)
        data = path.read_bytes()
        for damaged, text in ((data[:-3], "is cut off"), (data[1:], "is no MCAP file")):
            path.write_bytes(damaged)
            with pytest.raises(crashrank.BadInputError, match=text):
                read_osi(path)

    def test_sensor_views_hold_ground_truth(self, tmp_path):
        from osi3.osi_sensorview_pb2 import SensorView

        views = []
        for message in scenes.osi_messages():
            view = SensorView()
            view.global_ground_truth.CopyFrom(message)
            views.append(view)
        found = read_osi(write(tmp_path, views, "a_sv_371.osi"))
        assert len(found.scenario["actors"]) == 2


class TestBag:
    @pytest.fixture(autouse=True)
    def _needs(self):
        pytest.importorskip("rosbags")

    def test_several_paths_are_predictions(self, tmp_path):
        import dataclasses

        def change(objects, _types):
            paths = objects.objects[0].kinematics.predicted_paths
            stopping = dataclasses.replace(paths[0], path=[paths[0].path[0]] * 9, confidence=3.0)
            paths.append(stopping)
            return objects

        found = read_bag(scenes.write_bag(tmp_path / "bag", change))
        each = found.scenario["actors"][0]
        assert [p["probability"] for p in each["predictions"]] == pytest.approx([0.25, 0.75])
        assert each["existence_probability"] == 0.75
        assert "poses" in each["predictions"][0]
        assert "poses" not in each["predictions"][1]

    def test_what_is_missing_is_said(self, tmp_path):
        folder = scenes.write_bag(tmp_path / "bag")
        with pytest.raises(crashrank.UsageError, match="choose of /localization/kinematic_state"):
            read_bag(folder, ego="/odometry")
        with pytest.raises(crashrank.NotFoundError):
            read_bag(tmp_path / "none")
        (tmp_path / "empty").mkdir()
        with pytest.raises(crashrank.NotFoundError, match=r"metadata\.yaml"):
            read_bag(tmp_path / "empty")
        with pytest.raises(crashrank.UsageError, match="no Odometry on ''"):
            read_bag(folder, ego="")

    def test_the_ego_of_a_snapshot_moves_on(self, tmp_path):
        folder = scenes.write_bag(tmp_path / "bag")
        x, y, _ = scenes.rear_axle(scenes.ego(6))
        pose = read_bag(folder, 3.0).scenario["ego"]["pose"]
        assert (pose["x_m"], pose["y_m"]) == pytest.approx((x, y), abs=2e-3)
        for time_s in (-5.0, 1e6):
            with pytest.raises(crashrank.BadInputError, match="a time from -1 to 60 s"):
                read_bag(folder, time_s)

    def test_cylinders_and_footprints(self, tmp_path):
        def change(objects, types):
            point = types["geometry_msgs/msg/Point32"]
            objects.objects[0].shape.type = 1
            objects.objects[1].shape.type = 2
            objects.objects[1].shape.footprint.points = [
                point(x=x, y=y, z=0.0) for x, y in ((-1, -1), (3, -1), (3, 1), (-1, 1))
            ]
            return objects

        found = read_bag(scenes.write_bag(tmp_path / "bag", change))
        boxes = [found.scenario["models"][a["model"]]["box"] for a in found.scenario["actors"]]
        assert boxes == [[0.5, 0.5, 1.75], [4.0, 2.0, 1.5]]

    def test_other_frames_than_that_of_the_odometry_are_refused(self, tmp_path):
        def change(objects, _types):
            objects.header.frame_id = "base_link"
            return objects

        with pytest.raises(crashrank.BadInputError) as caught:
            read_bag(scenes.write_bag(tmp_path / "bag", change))
        assert caught.value.place == "/localization/kinematic_state, message 1"
        assert "in frame 'map', /objects, message 1 in 'base_link'" in caught.value.reason
        assert "transform both to one frame" in caught.value.remedy

    @pytest.mark.parametrize(
        ("change", "place", "reason"),
        [
            (lambda k: setattr(k.predicted_paths[0].time_step, "sec", -1), "path 1", "-0.5 s"),
            (lambda k: setattr(k.predicted_paths[0].time_step, "nanosec", 0), "path 1", "of 0 s"),
            (lambda k: setattr(k.predicted_paths[0], "confidence", math.nan), "path 1", "nan"),
            (
                lambda k: setattr(k.initial_pose_with_covariance.pose.orientation, "w", 0.0),
                "(number 1)", "unit quaternion",
            ),
            (
                lambda k: setattr(k.predicted_paths[0].path[3].orientation, "w", 0.0),
                "path 1", "unit quaternion",
            ),
        ],
    )  # fmt: skip
    def test_what_would_be_read_wrong_is_refused(self, tmp_path, change, place, reason):
        def changed(objects, _types):
            change(objects.objects[0].kinematics)
            return objects

        with pytest.raises(crashrank.BadInputError) as caught:
            read_bag(scenes.write_bag(tmp_path / "bag", changed))
        assert caught.value.place.startswith("/objects, message 1, object 02020202 (number 1)")
        assert caught.value.place.endswith(place)
        assert reason in caught.value.reason

    def test_paths_of_no_confidence_are_left_out(self, tmp_path):
        def change(objects, _types):
            objects.objects[0].kinematics.predicted_paths[0].confidence = 0.0
            return objects

        found = read_bag(scenes.write_bag(tmp_path / "bag", change))
        assert "poses" not in found.scenario["actors"][0]
        assert "object 02020202: predicted paths of confidence 0" in found.report.left_out


class TestMarkers:
    @pytest.fixture(autouse=True)
    def _needs(self):
        pytest.importorskip("rosbags")

    def test_markers_show_the_first_contact(self, tmp_path):
        """The person is hit where both paths cross: its box and the ego's touch there."""
        from rosbags.highlevel import AnyReader

        found = read_poses_csv(DATA / "formats/crossing_poses.csv")
        listed = [{"name": "hold", "acceleration_mps2": 0}, {"name": "b", "acceleration_mps2": -7}]
        scenario = {**found.scenario, "candidates": {"listed": listed, "grid": False}}
        ranking = crashrank.rank(scenario)
        to_markers(ranking, tmp_path / "bag", candidate="hold", frame="world")
        with AnyReader([tmp_path / "bag"]) as bag:
            ((connection, _, data),) = bag.messages()
            assert connection.topic == "/crashrank/markers"
            markers = bag.deserialize(data, connection.msgtype).markers
        assert {each.header.frame_id for each in markers} == {"world"}
        by_name = {(each.ns, each.id): each for each in markers}
        assert len(by_name) == len(markers) == len(ranking) + 2 * 3
        hold = [row.candidate for row in ranking].index("hold")
        worst, best = by_name["paths", hold].color, by_name["paths", 0].color
        assert (worst.r, worst.g, best.r, best.g) == (1, 0, 0, 1)
        end = by_name["paths", hold].points[-1]
        x, y, _ = scenes.rear_axle(scenes.world(15 * 4, 0))
        assert (end.x, end.y) == pytest.approx((x, y), abs=0.01)
        ego, person = by_name["bodies", 0], by_name["bodies", 1]
        at_s = (35 - 0.25 - 2.25) / 15
        for box, size, (x, y, yaw) in (
            (ego, scenes.CAR, scenes.world(15 * at_s, 0)),
            (person, scenes.PERSON, scenes.world(35, -4 + 1.5 * at_s, 1.5708)),
        ):
            assert (box.pose.position.x, box.pose.position.y) == pytest.approx((x, y), abs=0.4)
            assert 2 * math.atan2(box.pose.orientation.z, box.pose.orientation.w) == pytest.approx(
                yaw, abs=1e-3
            )
            assert (box.scale.x, box.scale.y, box.scale.z) == pytest.approx(size, abs=0.1)
        assert by_name["text", 0].text.startswith("hold: 0.5")
        assert by_name["text", 1].text == "person"
        with pytest.raises(crashrank.UsageError, match="is there already"):
            to_markers(ranking, tmp_path / "bag")
        with pytest.raises(crashrank.UsageError, match="no candidate 'x'"):
            to_markers(ranking, tmp_path / "other", candidate="x")
        with pytest.raises(crashrank.NotFoundError, match="cannot be written"):
            to_markers(ranking, tmp_path / "bag/metadata.yaml/x")


@pytest.mark.parametrize(
    ("reader", "file", "module", "extra"),
    [
        ("read_commonroad", "crossing.xml", "lxml.etree", "formats"),
        ("read_osi", "crossing.osi", "osi3", "osi"),
        ("read_bag", "", "rosbags.highlevel", "ros"),
    ],
)
def test_missing_packages_name_the_extra(monkeypatch, reader, file, module, extra):
    import sys

    from crashrank import formats

    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(crashrank.NotFoundError, match=rf"\.\[{extra}\]"):
        getattr(formats, reader)(DATA / "formats" / file)
