"""Pairs and hashes against the command, brute force in numpy, and FCL."""

import threading

import crashrank
import numpy as np
import pytest
from conftest import DATA, box, random_poses, run_command


def write_poses(path, poses):
    path.write_text("\n".join(" ".join(repr(float(x)) for x in p.ravel()) for p in poses) + "\n")


def test_hashes_are_those_of_the_command(tmp_path, sedan, pole):
    poses = random_poses(1, 12, 1.5)
    write_poses(tmp_path / "poses.txt", poses)
    pairs_file = tmp_path / "pairs.csv"
    told = run_command(
        "collide",
        DATA / "models/sedan.obj",
        DATA / "models/pole.obj",
        "--poses",
        tmp_path / "poses.txt",
        "--pairs",
        pairs_file,
    )
    written = np.loadtxt(pairs_file, delimiter=",", skiprows=1, dtype=np.int64, ndmin=2)
    pairs, offsets = crashrank.collide_all(sedan, pole, poses)
    for i, query in enumerate(told["queries"]):
        mine = crashrank.collide(sedan, pole, poses[i])
        assert mine.dtype == np.int32
        np.testing.assert_array_equal(mine, written[written[:, 0] == i, 1:])
        np.testing.assert_array_equal(mine, pairs[offsets[i] : offsets[i + 1]])
        assert crashrank.pairs_hash(mine) == query["hash"]
    touching = [query["intersecting"] for query in told["queries"]]
    assert 0 < sum(touching) < len(touching)
    np.testing.assert_array_equal(crashrank.collide_any(sedan, pole, poses), touching)
    states = [query["state"] for query in told["queries"]]
    assert crashrank.collide_state(sedan, pole, poses, workers=2) == states


def test_states_of_boxes():
    large, small = box(4.0), box(1.0, (1.5, 1.5, 1.5))
    poses = np.stack([np.eye(4), np.eye(4)])
    poses[1, 0, 3] = 50.0
    assert crashrank.collide_state(large, small, poses) == ["b_inside_a", "separate"]
    assert crashrank.collide_state(small, large, poses) == ["a_inside_b", "separate"]
    opened = crashrank.Model(large.vertices, large.faces[:-2])
    assert crashrank.collide_state(opened, small, poses) == ["unknown_open", "separate"]


def separated(p, q):
    """Return by pair of triangles whether a plane separates them, by the axes of both."""
    edges = [np.roll(t, -1, axis=-2) - t for t in (p, q)]
    normals = [np.cross(e[..., 0, :], e[..., 1, :]) for e in edges]
    cross = np.cross(edges[0][..., :, None, :], edges[1][..., None, :, :])
    axes = np.concatenate([np.stack(normals, axis=-2), cross.reshape(*cross.shape[:-3], 9, 3)], -2)
    a = np.einsum("...ij,...kj->...ki", p, axes)
    b = np.einsum("...ij,...kj->...ki", q, axes)
    return ((a.max(-1) < b.min(-1)) | (b.max(-1) < a.min(-1))).any(-1)


def test_pairs_of_random_boxes_are_those_of_brute_force():
    a, b = box(1.0), box(0.8, (0.1, 0.05, 0.02))
    for pose in random_poses(2, 40, 1.2):
        first = np.asarray(a.vertices, dtype=float)[a.faces]
        second = (np.asarray(b.vertices, dtype=float) @ pose[:3, :3].T + pose[:3, 3])[b.faces]
        apart = separated(*np.broadcast_arrays(first[:, None], second[None]))
        want = np.argwhere(~apart)
        np.testing.assert_array_equal(crashrank.collide(a, b, pose), want)


def test_answers_agree_with_fcl(sedan, pole):
    fcl = pytest.importorskip("fcl")

    def object_of(model):
        body = fcl.BVHModel()
        body.beginModel(len(model.vertices), len(model.faces))
        body.addSubModel(np.asarray(model.vertices, float), np.asarray(model.faces, np.int64))
        body.endModel()
        return fcl.CollisionObject(body)

    one, two = object_of(sedan), object_of(pole)
    poses = random_poses(3, 200, 3.0)
    told = []
    for pose in poses:
        two.setTransform(fcl.Transform(pose[:3, :3], pose[:3, 3]))
        told.append(fcl.collide(one, two, fcl.CollisionRequest(), fcl.CollisionResult()) > 0)
    mine = crashrank.collide_any(sedan, pole, poses)
    assert 20 < sum(told) < 180
    np.testing.assert_array_equal(mine, told)


def test_workers_change_nothing(sedan, pole):
    poses = random_poses(4, 400, 2.5)
    alone = crashrank.collide_all(sedan, pole, poses)
    shared = crashrank.collide_all(sedan, pole, poses, workers=3)
    for one, other in zip(alone, shared, strict=True):
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(
        crashrank.collide_any(sedan, pole, poses, workers=3), np.diff(alone[1]) > 0
    )


def test_many_python_threads_get_the_same_answers(sedan, pole):
    poses = random_poses(5, 60, 2.0)
    want = [crashrank.pairs_hash(crashrank.collide(sedan, pole, pose)) for pose in poses]
    got = {}

    def work(number):
        got[number] = [crashrank.pairs_hash(crashrank.collide(sedan, pole, p)) for p in poses]

    threads = [threading.Thread(target=work, args=(i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert list(got.values()) == [want] * 8


def test_the_lock_is_released(sedan):
    """A thread that counts goes on while one long query runs."""
    poses = np.repeat(crashrank.pose_matrix(0.3, 0.2)[None], 100, axis=0)
    count = 0
    ended = threading.Event()

    def work():
        crashrank.collide_any(sedan, sedan, poses)
        crashrank.collide_all(sedan, sedan, poses)
        ended.set()

    thread = threading.Thread(target=work)
    thread.start()
    while not ended.is_set():
        count += 1
    thread.join()
    assert count > 1000


def test_angles_are_those_of_the_command(tmp_path):
    matrix = crashrank.pose_matrix(1, 2, 3, 30, -20, 10)
    for name, model in (("a", box(1.0)), ("b", box(1.0))):
        model.save(tmp_path / f"{name}.crm")
    yaw, pitch, roll = np.radians([30, -20, 10])
    rz = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    ry = np.array(
        [[np.cos(pitch), 0, np.sin(pitch)], [0, 1, 0], [-np.sin(pitch), 0, np.cos(pitch)]]
    )
    rx = np.array([[1, 0, 0], [0, np.cos(roll), -np.sin(roll)], [0, np.sin(roll), np.cos(roll)]])
    np.testing.assert_allclose(matrix[:3, :3], rz @ ry @ rx, atol=1e-15)
    np.testing.assert_array_equal(matrix[:, 3], [1, 2, 3, 1])
    told = run_command(
        "collide", tmp_path / "a.crm", tmp_path / "b.crm", "--pose", "0.5,0.2,0.1,30,-20,10"
    )
    mine = crashrank.collide(box(1.0), box(1.0), crashrank.pose_matrix(0.5, 0.2, 0.1, 30, -20, 10))
    assert told["queries"][0]["hash"] == crashrank.pairs_hash(mine)


def test_no_poses_give_no_answers(pole):
    none = np.empty((0, 4, 4))
    assert crashrank.collide_any(pole, pole, none).shape == (0,)
    pairs, offsets = crashrank.collide_all(pole, pole, none)
    assert pairs.shape == (0, 2)
    np.testing.assert_array_equal(offsets, [0])


def test_the_hash_does_not_depend_on_the_order():
    pairs = np.array([[3, 1], [0, 2], [0, 1]], dtype=np.int32)
    assert crashrank.pairs_hash(pairs) == crashrank.pairs_hash(pairs[::-1])
    assert crashrank.pairs_hash(np.empty((0, 2), dtype=np.int32)) == "e3b0c44298fc1c14"
