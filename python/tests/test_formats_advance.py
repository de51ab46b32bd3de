"""A scenario at another moment: against the engine's own motions, and the crash that follows."""

import copy
import json
import random

import crashrank
import numpy as np
import pytest
from conftest import DATA
from crashrank import formats

BOX = {"box": [4.5, 1.8, 1.5], "kind": "car"}
SCENES = DATA / "scenarios"
HOLD = {"name": "hold"}


def scene(actors, ego=None, **more):
    return {
        "scenario_version": 2,
        "models": {"car": BOX, "wall": {"box": [30, 1, 3], "kind": "barrier"}},
        "ego": {"model": "car", "speed_mps": 12.0, "yaw_rate_dps": 6.0, **(ego or {})},
        "actors": [{"name": f"a{i}", "model": "car", **each} for i, each in enumerate(actors)],
        "horizon_s": 5.0,
        **more,
    }


def drawn(generate):
    """Return motions of all kinds, none a contact of the ego."""
    found = []
    for _ in range(6):
        pose = {
            "x_m": generate.uniform(200, 900), "y_m": generate.uniform(-500, 500),
            "yaw_deg": generate.uniform(-180, 180),
        }  # fmt: skip
        found.append({
            "pose": pose, "speed_mps": generate.choice([0.0, generate.uniform(-15, 25)]),
            "acceleration_mps2": generate.choice([0.0, generate.uniform(-9, 5)]),
            "yaw_rate_dps": generate.choice([0.0, generate.uniform(-40, 40)]),
        })  # fmt: skip
    poses, t = [], 0.0
    for _ in range(5):
        poses.append({
            "t_s": t, "x_m": 400 + 9 * t, "y_m": generate.uniform(-3, 3),
            "yaw_deg": generate.uniform(-180, 180),
        })  # fmt: skip
        t += generate.uniform(0.3, 1.2)
    return [*found, {"poses": poses}]


def paths(document, times, listed=HOLD):
    """Return the paths that the engine moves ego and actors along, (body, time, x y heading)."""
    candidates = {"listed": [listed], "grid": False, "add_straight_braking": False}
    ranked = crashrank.rank({**document, "candidates": candidates})._ranked
    return np.concatenate([ranked.candidate_paths(times)[:1], ranked.actor_paths(times)])


def differences(a, b):
    """Return the greatest differences of places, m, and headings, rad."""
    turned = np.angle(np.exp(1j * (a[..., 2] - b[..., 2])))
    return np.abs(a[..., :2] - b[..., :2]).max(), np.abs(turned).max()


@pytest.mark.parametrize("seed", range(4))
def test_bodies_move_on_as_the_engine_moves_them(seed):
    generate = random.Random(seed)
    document = scene(drawn(generate))
    kept = copy.deepcopy(document)
    times = np.linspace(0.0, 2.0, 41)
    for time_s in (0.0, 0.7, 1.9, 3.0):
        later = formats.scenario_at(document, time_s)
        assert later["horizon_s"] == pytest.approx(5.0 - time_s)
        metres, radians = differences(paths(later, times), paths(document, times + time_s))
        assert metres < 1e-6
        assert radians < 1e-8
    assert document == kept


@pytest.mark.parametrize("seed", range(4))
def test_bodies_come_straight_and_then_move_as_stated(seed):
    document = scene(drawn(random.Random(seed)))
    times = np.linspace(0.0, 5.0, 101)
    earlier = formats.scenario_at(document, -1.2)
    metres, radians = differences(paths(earlier, times + 1.2), paths(document, times))
    assert metres < 1e-3  # a chord of 0.02 s is at most a t² / 8 from its arc
    assert radians < 1e-2
    came, now = paths(earlier, np.array([0.0, 0.6, 1.2])), paths(document, np.array([0.0, 1e-4]))
    velocity = (now[1:, 1, :2] - now[1:, 0, :2]) / 1e-4
    assert came[1:, 0, 2] == pytest.approx(came[1:, 2, 2])
    assert came[1:, 2, :2] - came[1:, 0, :2] == pytest.approx(1.2 * velocity, abs=2e-3)
    assert came[1:, 1, :2] == pytest.approx((came[1:, 0, :2] + came[1:, 2, :2]) / 2, abs=1e-6)


def test_a_slope_is_climbed():
    pose = {"x_m": 300.0, "z_m": 2.0, "yaw_deg": 30.0, "pitch_deg": -10.0}
    document = scene([{"pose": pose, "speed_mps": 10.0}])
    found = formats.scenario_at(document, 2.0)["actors"][0]["pose"]
    up, level = np.sin(np.radians(10)), np.cos(np.radians(10))
    assert found["z_m"] == pytest.approx(2.0 + 20 * up)
    assert found["x_m"] == pytest.approx(300 + 20 * level * np.cos(np.radians(30)))
    assert found["pitch_deg"] == pytest.approx(-10.0)
    back = formats.scenario_at(formats.scenario_at(document, 2.0), -2.0, horizon_s=5.0)
    assert back["actors"][0]["pose"] == pytest.approx(pose)


def test_the_crash_of_the_whole_manoeuvre_is_that_of_its_rest():
    """Hold for t, then brake to the left: the poses of both parts, or the second part alone."""
    actors = [
        {"pose": {"x_m": 34.0, "y_m": 2.0}, "speed_mps": 4.0, "acceleration_mps2": -3.0},
        {"pose": {"x_m": 20.0, "y_m": -30.0, "yaw_deg": 90.0}, "speed_mps": 6.0},
    ]
    document = scene(actors, ego={"speed_mps": 16.0, "yaw_rate_dps": 0.0})
    turn = {"name": "then", "acceleration_mps2": -4.0, "steering_deg": 1.0}
    for time_s in (0.4, 1.1):
        later = formats.scenario_at(document, time_s)
        alone = {"grid": False, "add_straight_braking": False}
        rest = crashrank.rank({**later, "candidates": {"listed": [turn], **alone}}).best
        times = np.arange(0.0, 5.0 - time_s, 0.005)
        path = paths(later, times, turn)[0]
        poses = [{"t_s": 0.0}] + [
            {"t_s": time_s + t, "x_m": x, "y_m": y, "yaw_deg": np.degrees(yaw)}
            for t, (x, y, yaw) in zip(times.tolist(), path.tolist(), strict=True)
        ]
        both = {"listed": [{"name": "both", "poses": poses}], **alone}
        whole = crashrank.rank({**document, "candidates": both}).best
        assert whole.other == rest.other is not None
        assert whole.time_of_impact_s == pytest.approx(time_s + rest.time_of_impact_s, abs=1e-3)
        assert whole.closing_speed_mps == pytest.approx(rest.closing_speed_mps, abs=0.03)


@pytest.mark.parametrize("name", ["crossing_traffic", "oncoming_may_turn", "pushed_onto_crossing"])
def test_going_on_leads_to_one_crash_at_every_step(name):
    """Its least harm is constant; the motion that begins at 0 is sampled before that."""
    path = SCENES / f"{name}.json"
    curve = formats.find_decision_point(
        path, time_s=-0.8, step_s=0.2, accelerations=3, steerings=3, before_s=9.0
    )
    assert curve.steps[0].time_s == -0.8
    (start,) = [step for step in curve.steps if step.time_s == 0.0]
    for step in curve.steps:
        sampled = step.time_s < 0.0
        impact = step.time_s + step.going_on.time_of_impact_s
        assert impact == pytest.approx(curve.contact_time_s, abs=2e-3 if sampled else 1e-6)
        assert step.going_on.score == pytest.approx(
            start.going_on.score, rel=0.05 if sampled else 1e-4
        )
        assert step.best.most <= step.going_on.score + 1e-9
    ranking = crashrank.rank(
        {**json.loads(path.read_text()), "candidates": {"listed": [HOLD], "grid": False}},
        base=SCENES,
    )
    assert curve.contact_time_s == pytest.approx(
        min(each.time_of_impact_s for each in (ranking["hold"], *ranking["hold"].futures)
            if each.time_of_impact_s is not None), abs=1e-6,
    )  # fmt: skip


def test_probabilities_and_futures_stay():
    prediction = {"probability": 0.25, "speed_mps": 3.0, "yaw_rate_dps": 20.0}
    document = scene([
        {"pose": {"x_m": 300.0}, "speed_mps": 5.0, "existence_probability": 0.5,
         "perception": {"position_m": 0.1},
         "predictions": [prediction, {"probability": 0.75, "acceleration_mps2": -10.0}]},
    ])  # fmt: skip
    found = formats.scenario_at(document, 1.0)["actors"][0]
    turns, stops = found["predictions"]
    assert (turns["probability"], turns["speed_mps"]) == (0.25, 3.0)
    assert turns["yaw_rate_dps"] == pytest.approx(20.0)
    assert stops == {"probability": 0.75, "pose": {"x_m": 301.25}}
    assert (found["existence_probability"], found["perception"]) == (0.5, {"position_m": 0.1})
    crashrank.rank(formats.scenario_at(document, 1.0), deadline_s=1.0)
    joint = scene(
        [{"pose": {"x_m": 300.0}}],
        futures=[{"probability": 1.0, "motions": {"a0": {"speed_mps": 2.0}}}],
    )
    (future,) = formats.scenario_at(joint, 1.5)["futures"]
    assert future == {
        "probability": 1.0,
        "motions": {"a0": {"pose": {"x_m": 3.0}, "speed_mps": 2.0}},
    }


def test_the_command_decides_a_scenario(tmp_path, capsys):
    from crashrank.formats._command import main

    out = tmp_path / "a.json"
    file = SCENES / "crossing_traffic.json"
    words = ["crashrank", str(file), "-o", str(out), "--decide", "--time", "-0.6", "--step", "0.5"]
    assert main(words) == 0
    text = capsys.readouterr().err
    assert "the others have held their speed and course" in text
    assert "ego hits " in text
    written = json.loads(out.read_text())
    at_s = float(
        next(s for s in text.splitlines() if "ego ego at" in s).split(" at ")[1].split()[0]
    )
    assert written == formats.read_scenario(file, at_s).scenario
    assert crashrank.rank(written, base=SCENES, deadline_s=1.0)


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"time_s": 3.0}, "time_s: is 3, the horizon ends at 3 s"),
        ({"time_s": float("nan")}, "time_s: is not a number"),
        ({"ego": 3}, "ego: is '3'; leave it out"),
        ({"horizon_s": 0.0}, "horizon_s: is 0"),
    ],
)
def test_moments_without_meaning_are_refused(options, text):
    with pytest.raises(crashrank.UsageError) as caught:
        formats.read_scenario(SCENES / "crossing_traffic.json", **options)
    assert text in str(caught.value)


@pytest.mark.parametrize("text", ["", "[]", "{}", "{", '{"scenario_version": 7}', "[" * 100_000])
def test_what_is_no_scenario_is_refused(tmp_path, text):
    path = tmp_path / "a.json"
    path.write_text(text)
    with pytest.raises(crashrank.BadInputError, match=r"a\.json"):
        formats.read_scenario(path)
