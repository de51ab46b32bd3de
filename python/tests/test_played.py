"""Scenes for other viewers: MCAP files and rerun's recordings, read by their own tools."""

import json
import subprocess
import sys

import crashrank
import numpy as np
import pytest
from conftest import DATA, run_command
from crashrank._played import EGO, PlayedScene

TRUCK = DATA / "scenarios/oncoming_truck.json"
MAY_TURN = DATA / "scenarios/oncoming_may_turn.json"


@pytest.fixture(scope="module")
def moving():
    return crashrank.rank(TRUCK, motion=True)


@pytest.fixture(scope="module")
def scene(moving):
    return PlayedScene(moving._ranked.html(0))


def test_bodies_move_as_they_were_simulated(moving, scene):
    names = {scene.name(body): body for body in scene.bodies}
    for ranked, played in zip(moving, scene.candidates, strict=True):
        assert played.name == ranked.candidate
        assert ranked.motion
        for motion in ranked.motion:
            # The track is of the body's origin; the centre of mass stays where it is in the body.
            points, turns = played.poses(names[motion.body], motion.t_s)
            heading = 2 * np.unwrap(np.arctan2(turns[:, 2], turns[:, 3]))
            yaw = np.radians(motion.yaw_deg)
            assert np.abs(np.angle(np.exp(1j * (heading - yaw)))).max() < 0.006
            away = (motion.x_m + 1j * motion.y_m - points[:, 0] - 1j * points[:, 1]) * np.exp(
                -1j * yaw
            )
            assert np.abs(away - away[0]).max() < 0.05


def test_damage_and_contacts_are_those_of_the_ranking(moving, scene):
    for ranked, played in zip(moving, scene.candidates, strict=True):
        assert len(played.contacts) == len(ranked.contacts)
        if not ranked.contacts:
            continue
        first = played.contacts[0]
        assert first.time_s == pytest.approx(ranked.time_of_impact_s, abs=1e-3)
        assert first.closing_speed_mps == pytest.approx(ranked.closing_speed_mps, abs=1e-3)
        assert played.damage(EGO, first.time_s - 0.01) is None
        damage = played.damage(EGO, first.time_s)
        assert damage.shape == (len(scene.mesh(EGO).triangles),)
        assert damage.any()
        assert not damage.all()
        assert first.time_s in played.times


def test_a_body_that_leans_keeps_its_lean():
    scenario = json.loads(TRUCK.read_text())
    lean = scenario["actors"][0]["pose"]
    lean.update(pitch_deg=2.0, roll_deg=-3.0)
    yaw = np.radians(lean["yaw_deg"])
    ranking = crashrank.rank(scenario, base=TRUCK.parent, work_budget=10_000)
    played = PlayedScene(ranking._ranked.html(1))
    _, turns = played.candidates[0].poses(0, np.zeros(1))
    x, y, z, w = turns[0]
    matrix = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    expected = crashrank.pose_matrix(yaw_deg=np.degrees(yaw), pitch_deg=2.0, roll_deg=-3.0)[:3, :3]
    assert matrix == pytest.approx(expected, abs=2e-3)


def test_what_is_missing_names_its_extra(moving, tmp_path, monkeypatch):
    for module in ("rerun", "mcap_protobuf"):
        monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(crashrank.NotFoundError, match=r"rerun-sdk.*\[rerun\]"):
        moving.to_rerun()
    with pytest.raises(crashrank.NotFoundError, match=r"mcap-protobuf-support.*\[mcap\]"):
        moving.to_mcap(tmp_path / "a.mcap")
    assert not list(tmp_path.iterdir())


class TestMcap:
    @pytest.fixture(autouse=True)
    def _needs(self):
        for package in ("mcap_protobuf", "foxglove_schemas_protobuf"):
            pytest.importorskip(package, reason=f"{package} of the extra mcap is not installed")

    def read(self, path):
        """Return by topic the messages, [(time in s, decoded)], as mcap's reader finds them."""
        from mcap.reader import make_reader
        from mcap_protobuf.decoder import DecoderFactory

        topics = {}
        with open(path, "rb") as file:
            reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
            for _, channel, message, decoded in reader.iter_decoded_messages():
                topics.setdefault(channel.topic, []).append((1e-9 * message.log_time, decoded))
        return topics

    @pytest.mark.parametrize("path", [TRUCK, MAY_TURN], ids=lambda path: path.stem)
    def test_every_candidate_has_its_scene(self, path, tmp_path):
        ranking = crashrank.rank(path)
        ranking.to_mcap(tmp_path / "out.mcap")
        topics = self.read(tmp_path / "out.mcap")
        scene = PlayedScene(ranking._ranked.html(24))
        states = {name: each for name, each in topics.items() if name.startswith("/candidates/")}
        assert len(states) == len(ranking)
        for (name, messages), played in zip(sorted(states.items()), scene.candidates, strict=True):
            assert [time for time, _ in messages] == pytest.approx(played.state_times)
            for time, update in messages:
                entities = {each.id: each for each in update.entities}
                assert set(entities) == {"ways", "contacts", *map(scene.name, scene.bodies)}
                known = {each.key: each.value for each in entities["ego"].metadata}
                assert known["candidate"] == played.name
                assert len(entities["contacts"].spheres) == len(played.contacts_by(time))
                for body in scene.bodies:
                    entity = entities[scene.name(body)]
                    count = sum(len(each.indices) for each in entity.triangles)
                    assert count == scene.mesh(body).triangles.size
                    for each in entity.triangles:
                        assert max(each.indices) == len(each.points) - 1
                    red = any(each.color.r > 0.8 > 0.2 > each.color.g for each in entity.triangles)
                    assert red == (played.damage(body, time) is not None)
            assert name.startswith(f"/candidates/{played.row + 1}_")

    def test_frames_follow_the_simulated_motion(self, moving, scene, tmp_path):
        moving.to_mcap(tmp_path / "out.mcap")
        found = {}
        for time, message in self.read(tmp_path / "out.mcap")["/transforms"]:
            for each in message.transforms:
                assert each.parent_frame_id == "world"
                at, turn = each.translation, each.rotation
                row = [time, at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w]
                found.setdefault(each.child_frame_id, []).append(row)
        for played in scene.candidates:
            for body in scene.bodies:
                rows = np.array(found[f"{played.row + 1}/{scene.name(body)}"])
                # As a viewer does, from those that are there to every time.
                points, turns = played.poses(body, played.times)
                for column, wanted in enumerate([*points.T, *turns.T], 1):
                    shown = np.interp(played.times, rows[:, 0], rows[:, column])
                    assert shown == pytest.approx(wanted, abs=1e-6)

    def test_places_and_contacts_are_in_words(self, moving, tmp_path):
        moving.to_mcap(tmp_path / "out.mcap")
        lines = [log.message for _, log in self.read(tmp_path / "out.mcap")["/ranking"]]
        for each in moving:
            assert sum(
                line.startswith(f"{each.rank}. {each.candidate}: ") for line in lines
            ) == 1 + len(each.contacts)
        assert any("ego hits barrier 4 at 77 km/h" in line for line in lines)

    def test_the_layout_shows_the_first_candidate(self, moving, tmp_path):
        moving.to_mcap(tmp_path / "out.mcap")
        layout = json.loads((tmp_path / "out.layout.json").read_text(encoding="utf-8"))
        shown = layout["configById"]["3D!scene"]["topics"]
        topics = self.read(tmp_path / "out.mcap")
        assert set(shown) <= set(topics)
        visible = [name for name in shown if shown[name]["visible"]]
        assert sorted(visible) == ["/candidates/1_coast_into_the_barrier", "/road"]
        assert layout["configById"]["RosOut!ranking"]["topicToRender"] in topics

    def command(self, *words):
        return subprocess.run(
            [sys.executable, "-m", "crashrank", "rank", *map(str, words)],
            capture_output=True, text=True, check=False,
        )  # fmt: skip

    def test_the_command_writes_the_same(self, moving, tmp_path):
        done = self.command(TRUCK, "--json", "--mcap", tmp_path / "a.mcap")
        assert done.returncode == 0, done.stderr
        assert json.loads(done.stdout)["ranking"] == run_command("rank", TRUCK)["ranking"]
        moving.to_mcap(tmp_path / "b.mcap")
        # Messages of two readers have classes of their own: they are compared as text.
        a, b = (str(self.read(tmp_path / name)) for name in ("a.mcap", "b.mcap"))
        assert a == b
        page = tmp_path / "page.html"
        done = self.command(TRUCK, "--report", page, f"--mcap={tmp_path / 'c.mcap'}")
        assert done.returncode == 0, done.stderr
        assert page.is_file()
        assert (tmp_path / "c.layout.json").is_file()

    def test_a_budget_leaves_a_scene_to_the_first_contacts(self, tmp_path):
        done = self.command(TRUCK, "--work-budget", 1000, "--mcap", tmp_path / "a.mcap")
        assert done.returncode == 4, done.stderr
        assert "/candidates/" in "".join(self.read(tmp_path / "a.mcap"))

    def test_what_cannot_be_written_is_refused(self, moving, tmp_path):
        for words in (["--mcap", "-"], ["--mcap"], ["--mcap=a", "--mcap=b"]):
            assert self.command(TRUCK, *words).returncode == 2
        out = tmp_path / "a.mcap"
        assert self.command(TRUCK, "--mcap", out, "--report", "-").returncode == 2
        assert self.command(tmp_path / "none.json", "--mcap", out).returncode == 3
        assert not out.exists()
        with pytest.raises(crashrank.NotFoundError, match="cannot be written"):
            moving.to_mcap(tmp_path / "no/folder.mcap")


class TestRerun:
    @pytest.fixture(autouse=True)
    def _needs(self):
        pytest.importorskip("rerun", reason="rerun-sdk of the extra rerun is not installed")

    @pytest.fixture
    def file(self, moving, tmp_path):
        moving.to_rerun().save(tmp_path / "out.rrd")
        return tmp_path / "out.rrd"

    def test_its_tool_verifies_the_file(self, file):
        done = subprocess.run(
            [sys.executable, "-m", "rerun_cli", "rrd", "verify", str(file)],
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        assert "verified without error" in done.stdout + done.stderr

    def test_bodies_move_in_its_data_frames(self, file, scene):
        pytest.importorskip("datafusion", reason="rerun-sdk[catalog] is not installed")
        import rerun

        with rerun.server.Server(host="127.0.0.1", datasets={"crash": [str(file)]}) as server:
            crash = server.client().get_dataset("crash")
            entities = set(crash.schema().entity_paths())
            for played in scene.candidates:
                root = ["candidates", f"{played.row + 1} {played.name}"]
                for each in ("ways", *map(scene.name, scene.bodies)):
                    assert rerun.new_entity_path([*root, each]) in entities
                ego = rerun.new_entity_path([*root, "ego"])
                frame = crash.filter_contents([ego]).reader(index="decision").to_pandas()
                times = frame["decision"].dt.total_seconds().to_numpy()
                points = np.stack([each[0] for each in frame[f"{ego}:Transform3D:translation"]])
                order = np.argsort(times)
                expected, _ = played.poses(EGO, times[order])
                assert points[order] == pytest.approx(expected, abs=1e-3)
                assert times.max() == pytest.approx(played.end_s)
