"""The Ranker against `rank`, and a planner's loop."""

import json
import subprocess
import sys
import threading
import time

import crashrank
import numpy as np
import pytest
from conftest import DATA

TRUCK = DATA / "scenarios/oncoming_truck.json"
MOTORWAY = DATA / "scenarios/motorway_pile_up.json"
MOTION_KEYS = ("pose", "speed_mps", "acceleration_mps2", "yaw_rate_dps")


def test_without_a_deadline_it_is_rank():
    with crashrank.Ranker(TRUCK, workers=2) as ranker:
        answer = ranker.rank()
    want = crashrank.rank(TRUCK)
    assert answer.complete
    assert [c.candidate for c in answer] == [c.candidate for c in want]
    assert [c.score for c in answer] == [c.score for c in want]
    assert [c.other for c in answer] == [c.other for c in want]
    assert [c.contact_without_force for c in answer] == [
        any(f.contact_without_force for f in c.futures) for c in want
    ]
    assert answer.best.time_of_impact_s == want.best.time_of_impact_s
    np.testing.assert_array_equal(answer.score, [c.score for c in want])
    assert answer[1:3] == (answer[1], answer[2])
    assert answer[-1] == answer[4]


def test_an_explained_answer_is_the_ranking():
    with crashrank.Ranker(TRUCK) as ranker:
        answer = ranker.rank()
        told = answer.explain().to_dict()
        partial = ranker.rank(work_budget=2000)
        assert not partial.complete
        some = partial.explain()
        assert not some.complete
        ranker.update(ego={"speed_mps": 22.0})
        with pytest.raises(crashrank.UsageError, match="updated"):
            answer.explain()
    assert told["ranking"] == crashrank.rank(TRUCK).to_dict()["ranking"]


def test_work_budgets_give_the_same_answer_on_any_number_of_workers():
    hashes = set()
    for workers in (1, 2, 3):
        with crashrank.Ranker(MOTORWAY, workers=workers) as ranker:
            answer = ranker.rank(work_budget=100_000)
            assert (answer.lowest <= answer.highest).all()
            hashes.add(answer.hash)
    assert len(hashes) == 1


def test_an_update_is_the_scenario_that_says_the_same():
    document = json.loads(TRUCK.read_text())
    with crashrank.Ranker(TRUCK) as ranker:
        ranker.update(
            ego={"pose": {"x_m": 1.5, "y_m": 0.1, "yaw_deg": 1.0}, "speed_mps": 21.0},
            actors={"lorry": {"pose": {"x_m": 55, "yaw_deg": 180}, "speed_mps": 18.0}},
        )
        told = ranker.rank().explain().to_dict()["ranking"]
        assert ranker.ego_pose == pytest.approx((1.5, 0.1, np.radians(1.0)))
    document["ego"].update({"pose": {"x_m": 1.5, "y_m": 0.1, "yaw_deg": 1.0}, "speed_mps": 21.0})
    document["actors"][0].update({"pose": {"x_m": 55, "yaw_deg": 180}, "speed_mps": 18.0})
    del document["actors"][0]["acceleration_mps2"]
    assert told == crashrank.rank(document, base=TRUCK.parent).to_dict()["ranking"]


def test_bodies_enter_and_leave():
    document = json.loads(TRUCK.read_text())
    lorry = dict(document["actors"][0])
    document["scenario_version"] = 2
    document["actors"][0].update({"model": "sedan", "existence_probability": 0})
    document["actors"][0].pop("acceleration_mps2", None)
    empty = crashrank.rank(document, base=TRUCK.parent).to_dict()["ranking"]
    motion = {key: value for key, value in lorry.items() if key in MOTION_KEYS}
    with crashrank.Ranker(document, base=TRUCK.parent) as ranker:
        for _ in range(2):
            ranker.enter(lorry["name"], lorry["model"], motion)
            told = ranker.rank().explain().to_dict()["ranking"]
            assert told == crashrank.rank(TRUCK).to_dict()["ranking"]
            with pytest.raises(crashrank.UsageError, match="taken"):
                ranker.enter(lorry["name"], lorry["model"], motion)
            ranker.leave(lorry["name"])
            assert ranker.rank().explain().to_dict()["ranking"] == empty
        for actor, model in (("nobody", "truck"), (lorry["name"], "wall"), (lorry["name"], "?")):
            with pytest.raises(crashrank.UsageError):
                ranker.enter(actor, model, motion)
        with pytest.raises(crashrank.UsageError, match="place"):
            ranker.leave("saloon")


def posed(count, times):
    """Return ways of braking that end further and further left; speed 22.2 m/s."""
    paths = np.zeros((count, len(times), 3))
    for i in range(count):
        paths[i, :, 0] = 22.2 * times - (1 + 0.5 * i) * times**2
        paths[i, :, 1] = 0.15 * i * times**2
        paths[i, :, 2] = np.arctan2(np.gradient(paths[i, :, 1]), np.gradient(paths[i, :, 0]))
        paths[i, 0, 2] = 0
    return paths


def test_posed_candidates_are_those_of_a_scenario_that_lists_them():
    times = np.linspace(0, 3, 16)
    paths = posed(6, times)
    with crashrank.Ranker(TRUCK) as ranker:
        answer = ranker.rank(paths[:, ::1], times_s=times)
        again = ranker.rank(np.asfortranarray(paths), times_s=list(times), names=list("abcdef"))
    np.testing.assert_array_equal(answer.score, again.score)
    assert {c.candidate for c in again} == set("abcdef")
    document = json.loads(TRUCK.read_text())
    document["candidates"] = {
        "add_straight_braking": False,
        "grid": False,
        "listed": [
            {
                "name": str(i),
                "poses": [
                    {"t_s": t, "x_m": x, "y_m": y, "yaw_deg": np.degrees(yaw)}
                    for t, (x, y, yaw) in zip(times, path, strict=True)
                ],
            }
            for i, path in enumerate(paths)
        ],
    }
    want = {c.candidate: c.score for c in crashrank.rank(document, base=TRUCK.parent)}
    for one in answer:
        assert one.score == pytest.approx(want[one.candidate], rel=1e-9)


def test_actors_follow_poses():
    times = np.linspace(0, 3, 31)
    path = np.stack(
        [58 - 19.4 * times + 2.5 * times**2, 0.4 + 0 * times, np.pi + 0 * times], axis=1
    )
    with crashrank.Ranker(TRUCK) as ranker:
        before = ranker.rank()
        ranker.update(actors={"lorry": path}, times_s=times)
        after = ranker.rank()
    mine = {c.candidate: c for c in after}
    for one in before:
        other = mine[one.candidate]
        assert other.other == one.other
        if one.other == "lorry":
            # A braking plan of straight stretches is at most 1.3 cm off the parabola.
            assert other.time_of_impact_s == pytest.approx(one.time_of_impact_s, abs=2e-3)


def test_predictions_and_their_probabilities_are_updated():
    scenario = DATA / "scenarios/oncoming_may_turn.json"
    with crashrank.Ranker(scenario) as ranker:
        plans = [a for a in json.loads(scenario.read_text())["actors"] if a.get("predictions")]
        name, count = plans[0]["name"], len(plans[0]["predictions"])
        first = ranker.rank()
        others = {a["name"]: [1.0] for a in plans[1:]}
        ranker.update(
            probabilities={name: [1 - 0.01 * (count - 1)] + [0.01] * (count - 1), **others}
        )
        second = ranker.rank()
        assert first.hash != second.hash
        with pytest.raises(crashrank.Error):
            ranker.update(probabilities={name: [2.0] * count})
        with pytest.raises(crashrank.UsageError):
            ranker.update(actors={name: {"speed_mps": 3}})


def test_errors_change_nothing():
    with crashrank.Ranker(TRUCK) as ranker:
        before = ranker.rank().hash
        for wrong in (
            {"ego": {"speed_mps": float("nan")}},
            {"ego": {"speed": 3}},
            {"ego": {"speed_mps": 1e9}},
            {"ego": 3},
            {"actors": {"nobody": {}}},
            {"actors": {"lorry": 3}, "times_s": [0]},
            {"actors": {"lorry": np.zeros((3, 3))}},
            {"actors": {"lorry": np.full((2, 3), np.nan)}, "times_s": [0, 1]},
            {"actors": {"lorry": np.zeros((2, 3))}, "times_s": [0, np.inf]},
            {"probabilities": {"lorry": [0.5]}},
        ):
            with pytest.raises(crashrank.Error):
                ranker.update(**wrong)
        for wrong in (
            {"candidates": np.zeros((2, 3))},
            {"candidates": np.zeros((2, 3, 3))},
            {"candidates": np.zeros((2, 3, 3)), "times_s": [0, 1]},
            {"candidates": np.zeros((2, 3, 3)), "times_s": [0, 2, 1]},
            {"candidates": np.full((2, 3, 3), 50.0), "times_s": [0, 1, 2]},
            {"candidates": np.full((2, 3, 3), np.nan), "times_s": [0, 1, 2]},
            {"candidates": np.broadcast_to(np.zeros(3), (10**9, 3, 3)), "times_s": [0, 1, 2]},
            {"candidates": np.zeros((2, 3, 3)), "times_s": [0, 1, 2], "names": ["a", "a"]},
            {"deadline_s": float("nan")},
            {"deadline_s": "soon"},
            {"progress": 3},
        ):
            with pytest.raises(crashrank.Error):
                ranker.rank(**wrong)
        assert ranker.rank().hash == before
    with pytest.raises(crashrank.UsageError, match="closed"):
        ranker.rank()
    with pytest.raises(crashrank.UsageError, match="closed"):
        ranker.update()


def test_no_candidates_are_an_answer():
    with crashrank.Ranker(TRUCK) as ranker:
        assert len(ranker.rank(np.empty((0, 2, 3)), times_s=[0, 1])) == 0


def test_another_thread_is_refused_not_kept_waiting():
    with crashrank.Ranker(MOTORWAY) as ranker:
        begun, told = threading.Event(), []

        def work():
            begun.set()
            told.append(ranker.rank(deadline_s=1.0))

        thread = threading.Thread(target=work)
        thread.start()
        begun.wait()
        time.sleep(0.2)
        with pytest.raises(crashrank.UsageError, match="another thread"):
            ranker.rank(deadline_s=0.01)
        thread.join()
        assert len(told[0]) == 225


def test_progress_rises_and_may_end_the_call():
    told = []

    def look(known, candidates):
        told.append(known)
        assert candidates == 225
        return known < 20

    with crashrank.Ranker(MOTORWAY, workers=2) as ranker:
        answer = ranker.rank(progress=look)
    assert not answer.complete
    assert told == sorted(told)
    assert np.isfinite(answer.score).sum() >= 20

    def fail(*_):
        raise KeyError("mine")

    with crashrank.Ranker(MOTORWAY) as ranker, pytest.raises(KeyError, match="mine"):
        ranker.rank(progress=fail)


INTERRUPTED = """
import os, signal, sys, threading, time, crashrank

# A shell's background process would ignore it.
signal.signal(signal.SIGINT, signal.default_int_handler)

def interrupt():
    global sent
    sent = time.monotonic()
    os.kill(os.getpid(), signal.SIGINT)

with crashrank.Ranker(sys.argv[1], workers=2) as ranker:
    threading.Timer(0.1, interrupt).start()
    answer = ranker.rank()
    took = time.monotonic() - sent
    print(answer.interrupted, answer.complete, len(answer))
    print(f"ended {took:.3f} s after Ctrl-C")
"""


def test_ctrl_c_ends_with_the_partial_answer():
    done = subprocess.run(
        [sys.executable, "-c", INTERRUPTED, MOTORWAY], capture_output=True, text=True, check=False
    )
    assert done.stdout.startswith("True False 225\n"), done.stderr
    print(done.stdout)
