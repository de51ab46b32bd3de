"""Rankings have the bits of the command's, for every shipped scenario."""

import copy
import json
import multiprocessing
import os
import pickle
import re
import signal
import subprocess
import sys
import threading
import time

import crashrank
import jsonschema
import numpy as np
import pytest
from conftest import DATA, ROOT, SCENARIOS, box_arrays, run_command

# These take a minute each without a budget. CRASHRANK_PYTHON_LONG ranks them in full.
LONG = () if os.environ.get("CRASHRANK_PYTHON_LONG") else ("crossing_traffic", "motorway_pile_up")


def without_times(document):
    document = json.loads(json.dumps(document))
    document.pop("elapsed_s")
    for key in [key for key in document.get("effort", {}) if key.endswith("_s")]:
        document["effort"].pop(key)
    return document


@pytest.mark.parametrize("path", SCENARIOS, ids=lambda path: path.stem)
def test_answers_are_those_of_the_command(path):
    budget = {"work_budget": 200_000} if path.stem in LONG else {}
    words = [f"--{key.replace('_', '-')}={value}" for key, value in budget.items()]
    told = run_command("rank", path, "--workers", 2, *words)
    mine = crashrank.rank(path, workers=2, **budget).to_dict()
    assert without_times(mine) == without_times(told)


@pytest.mark.parametrize("measure", ["delta-v", "energy", "polygons", "area", "closing-energy"])
def test_measures_are_those_of_the_command(measure):
    path = DATA / "scenarios/oncoming_truck.json"
    told = run_command("rank", path, "--measure", measure, "--infeasible", "keep")
    mine = crashrank.rank(path, measure=measure, infeasible="keep")
    assert without_times(mine.to_dict()) == without_times(told)


def test_risk_profile_futures_and_order_reach_the_engine():
    path = DATA / "scenarios/oncoming_may_turn.json"
    profile = DATA / "profiles/everybody_alike.json"
    words = [
        "--risk",
        "cvar:0.8",
        "--profile",
        profile,
        "--futures",
        32,
        "--order",
        "upper",
        "--smooth",
    ]
    told = run_command("rank", path, *words)
    mine = crashrank.rank(
        path, risk="cvar:0.8", profile=profile, futures=32, order="upper", smooth=True
    )
    assert without_times(mine.to_dict()) == without_times(told)


def test_all_ways_to_give_a_scenario_are_one():
    path = DATA / "scenarios/oncoming_truck.json"
    text = path.read_text()
    base = path.parent
    want = without_times(crashrank.rank(str(path)).to_dict())
    scenario = crashrank.Scenario.load(path)
    for answer in (
        crashrank.rank(json.loads(text), base=base),
        crashrank.rank(text, base=base),
        crashrank.rank(scenario, workers=2),
        crashrank.rank(scenario),
        crashrank.rank(crashrank.Scenario.from_json(text, base=base)),
    ):
        assert without_times(answer.to_dict()) == want


def test_a_scenario_built_in_code_is_that_of_its_file():
    path = DATA / "scenarios/pedestrian_or_parked_car.json"
    document = json.loads(path.read_text())
    document.pop("$schema")
    bodies = {
        name: crashrank.Body(**{**body, "mesh": crashrank.load_model(path.parent / body["mesh"])})
        for name, body in document.pop("models").items()
        if "scale" not in body
    }
    ego = crashrank.Ego(**document.pop("ego"))
    actors = [crashrank.Actor(**actor) for actor in document.pop("actors")]
    document["scenario_version"] = 1
    built = crashrank.Scenario.build(models=bodies, ego=ego, actors=actors, **document)
    mine, want = crashrank.rank(built).to_dict(), crashrank.rank(path).to_dict()
    assert mine["ranking"] == want["ranking"]


def test_a_body_may_be_a_box_of_a_kind():
    def scene(**body):
        return crashrank.Scenario.build(
            models={"seen": crashrank.Body(**body)},
            ego=crashrank.Ego(model="seen", speed_mps=15.0),
            actors=[crashrank.Actor("ahead", model="seen", pose=crashrank.Pose(x_m=12.0))],
            candidates=[crashrank.Candidate("on", acceleration_mps2=0.0)],
        )

    ranking = crashrank.rank(scene(kind="car", box=(4.6, 1.8, 1.5)))
    assert ranking["on"].score > 0.0
    assert any("models.seen is a car of 4.6 x 1.8 x 1.5 m" in w for w in ranking.warnings)
    for body, key in (
        ({"box": [4.6, 1.8, 1.5]}, "kind"),
        ({"kind": "car"}, "mesh"),
        ({"kind": "car", "box": [4.6, 0, 1.5]}, "box[1]"),
        ({"kind": "car", "box": [4.6, 1.8, 1.5], "mesh": "car.obj"}, "mesh"),
    ):
        with pytest.raises(crashrank.BadInputError) as error:
            scene(**body)
        assert error.value.place == f"models.seen.{key}"
        assert error.value.remedy


def test_members_of_a_scenario_are_those_of_its_schema():
    import dataclasses

    definitions = json.loads((DATA / "scenario.schema.json").read_text())["$defs"]

    def keys(name):
        entry = definitions[name]
        branches = [entry, *entry.get("oneOf", [])]
        return {key for branch in branches for key in branch.get("properties", {})}

    for kind, name in (
        (crashrank.Body, "model"),
        (crashrank.Ego, "ego"),
        (crashrank.Actor, "actor"),
        (crashrank.Candidate, "candidate"),
        (crashrank.Pose, "pose"),
    ):
        assert {field.name for field in dataclasses.fields(kind)} == keys(name)


def test_attributes_are_named_as_in_the_answer(truck_ranking):
    document = truck_ranking.to_dict()
    schema = json.loads((DATA / "schemas/rank.schema.json").read_text())
    jsonschema.validate(document, schema)
    assert len(truck_ranking) == len(document["ranking"])
    for row, mine in zip(document["ranking"], truck_ranking, strict=True):
        for key, value in row.items():
            given = getattr(mine, key)
            assert given == mine[key]
            if isinstance(value, (str, int, float, type(None))):
                assert given == value
    assert truck_ranking.best.delta_v_mps.ego == document["ranking"][0]["delta_v_mps"]["ego"]
    assert truck_ranking.best is not None
    assert truck_ranking[-1].rank == 5
    assert [c.rank for c in truck_ranking[:2]] == [1, 2]
    assert truck_ranking["brake in lane"].candidate == "brake in lane"
    with pytest.raises(crashrank.UsageError):
        truck_ranking["no such candidate"]
    rows = [line for line in str(truck_ranking).splitlines() if line[:4].strip().isdigit()]
    assert all(c.candidate in row for c, row in zip(truck_ranking, rows, strict=True))
    with pytest.raises(AttributeError):
        truck_ranking.best.no_such_key  # noqa: B018
    with pytest.raises(AttributeError):
        truck_ranking.best.score = 0.0
    assert pickle.loads(pickle.dumps(truck_ranking.best)) == truck_ranking.best


KINDS = {"number": "float", "integer": "int", "boolean": "bool", "string": "str", "null": "None"}


def kinds_in_schema(entry, definitions):
    """Return the Python types of a member: all arrays are "tuple", all objects "Record"."""
    if "$ref" in entry:
        return kinds_in_schema(definitions[entry["$ref"].removeprefix("#/$defs/")], definitions)
    if "oneOf" in entry:
        return set().union(*(kinds_in_schema(one, definitions) for one in entry["oneOf"]))
    kinds = entry.get("type", "string" if "enum" in entry else None)
    return {
        KINDS.get(kind, "tuple" if kind == "array" else "Record")
        for kind in ([kinds] if isinstance(kinds, str) else kinds)
    }


def kinds_declared(annotation):
    return {re.sub(r"\[.*\]", "", kind) for kind in annotation.split(" | ")}


def test_declared_types_are_those_of_the_schema():
    schema = json.loads((DATA / "schemas/rank.schema.json").read_text())
    definitions = schema["$defs"]
    # Motions are arrays, where they were recorded.
    candidate = {k: v for k, v in definitions["candidate"]["properties"].items() if k != "motion"}
    for kind, members in (
        (crashrank.RankedCandidate, candidate),
        (crashrank.Ranking, {k: v for k, v in schema["properties"].items() if k != "ranking"}),
    ):
        declared = {k: v for k, v in kind.__annotations__.items() if not k.startswith("_")}
        assert {key: kinds_declared(text) for key, text in declared.items()} == {
            key: kinds_in_schema(entry, definitions) for key, entry in members.items()
        }


def test_tables_have_a_row_for_each_candidate(truck_ranking):
    pyarrow = pytest.importorskip("pyarrow")
    pandas = pytest.importorskip("pandas")
    table = truck_ranking.to_arrow()
    assert isinstance(table, pyarrow.Table)
    assert table.column("candidate").to_pylist() == [c.candidate for c in truck_ranking]
    assert table.column("score").to_pylist() == [c.score for c in truck_ranking]
    assert table.schema.metadata[b"measure_unit"] == b"persons"
    partial = crashrank.rank(DATA / "scenarios/oncoming_truck.json", work_budget=0)
    assert partial.to_arrow().schema.equals(table.schema)
    assert partial.to_arrow().column("score").null_count == len(partial)
    frame = truck_ranking.to_pandas()
    assert isinstance(frame, pandas.DataFrame)
    assert list(frame.columns) == table.column_names
    assert frame.attrs["scenario"] == truck_ranking.scenario


def test_the_report_is_that_of_the_command(tmp_path, truck_ranking):
    truck_ranking.report(tmp_path / "mine.html")
    path = DATA / "scenarios/oncoming_truck.json"
    run_command("rank", path, "--report", tmp_path / "theirs.html")
    mine, theirs = ((tmp_path / name).read_text() for name in ("mine.html", "theirs.html"))
    different = [
        (a, b) for a, b in zip(mine.split("\n"), theirs.split("\n"), strict=True) if a != b
    ]
    assert len(different) <= 3  # the time that it took
    inside = truck_ranking._repr_html_()
    assert inside.startswith('<iframe sandbox="allow-scripts"')
    assert "allow-same-origin" not in inside
    assert len(inside) < 200_000
    assert '"motion"' in mine
    with pytest.raises(crashrank.NotFoundError) as error:
        truck_ranking.report(tmp_path / "none/here.html")
    assert error.value.file.endswith("none/here.html")


def test_plots_show_the_candidates(tmp_path, truck_ranking):
    pytest.importorskip("matplotlib")
    figure = truck_ranking.plot()
    plan, scores = figure.axes
    assert truck_ranking.best.candidate in plan.get_title()
    assert len(scores.get_yticklabels()) == len(truck_ranking)
    assert plan.get_xlabel() == "x [m]"
    figure.savefig(tmp_path / "plot.png")
    assert (tmp_path / "plot.png").stat().st_size > 10_000
    assert figure._repr_png_().startswith(b"\x89PNG")
    assert (
        "no contact"
        in crashrank.rank(DATA / "scenarios/room_to_spare.json", work_budget=200_000)
        .plot(top=3)
        .axes[0]
        .get_title()
    )
    last = truck_ranking[-1].candidate
    for place in (-1, len(truck_ranking) - 1, last):
        assert truck_ranking.plot(candidate=place).axes[0].get_title().startswith(last)
    for wrong in ("none", len(truck_ranking), -1 - len(truck_ranking), 1.0, True):
        with pytest.raises(crashrank.UsageError):
            truck_ranking.plot(candidate=wrong)


def test_rankings_are_copied_and_pickled(truck_ranking, tmp_path):
    assert copy.copy(truck_ranking) is truck_ranking
    assert copy.deepcopy([truck_ranking])[0] is truck_ranking
    for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
        again = pickle.loads(pickle.dumps(truck_ranking, protocol))
        assert again.to_json() == truck_ranking.to_json()
        assert str(again) == str(truck_ranking)
        assert list(again) == list(truck_ranking)
        assert again.interrupted is truck_ranking.interrupted
    twice = pickle.loads(pickle.dumps(again))
    assert twice.best == truck_ranking.best
    for draw in (twice.plot, lambda: twice.report(tmp_path / "report.html"), twice._repr_html_):
        with pytest.raises(crashrank.UsageError, match="was pickled"):
            draw()
    assert not (tmp_path / "report.html").exists()


def scores(answer):
    return [(row.candidate, row.score, row.score_interval) for row in answer]


def rank_in_a_process(scenario):
    return crashrank.rank(scenario)


def test_scenarios_are_copied_pickled_and_ranked_by_processes(truck_ranking, monkeypatch, tmp_path):
    monkeypatch.chdir(ROOT)
    relative = "data/scenarios/oncoming_truck.json"
    document = json.loads((ROOT / relative).read_text())
    sedan = crashrank.load_model(DATA / "models/sedan.obj")
    name = document["ego"]["model"]
    scenarios = [
        crashrank.Scenario.load(relative),
        crashrank.Scenario(document, base="data/scenarios", allow=["data"]),
        crashrank.Scenario.from_json(
            json.dumps(document), base="data/scenarios", models={name: sedan}, allow=["data"]
        ),
    ]
    expected = [scores(crashrank.rank(scenario)) for scenario in scenarios]
    assert expected[0] == expected[1] == scores(truck_ranking)
    assert all(copy.copy(each) is each is copy.deepcopy(each) for each in scenarios)
    pickled = [pickle.dumps(scenario) for scenario in scenarios]
    monkeypatch.chdir(tmp_path)  # relative paths lead nowhere now
    again = [pickle.loads(each) for each in pickled]
    assert [scores(crashrank.rank(scenario)) for scenario in again] == expected
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        answers = pool.map(rank_in_a_process, scenarios[:2])
    assert [scores(answer) for answer in answers] == expected[:2]


@pytest.mark.parametrize("deadline_s", [-1, -1e-9, -float("inf")])
def test_negative_deadlines_are_refused(deadline_s):
    with pytest.raises(crashrank.UsageError) as error:
        crashrank.rank(DATA / "scenarios/oncoming_truck.json", deadline_s=deadline_s)
    assert error.value.place == "deadline_s"
    assert "\n" not in str(error.value)


def test_progress_is_told_and_may_end_the_ranking():
    path = DATA / "scenarios/crossing_traffic.json"
    told = []

    def stop(done, candidates):
        told.append((done, candidates))
        return done < 3

    partial = crashrank.rank(path, workers=2, progress=stop)
    assert not partial.complete
    assert not partial.interrupted
    assert any(c.score is None and c.score_interval[1] > 0 for c in partial)
    assert told == sorted(told)
    assert {candidates for _, candidates in told} == {len(partial)}
    assert any("candidates are evaluated" in warning for warning in partial.warnings)

    def fail(*_):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        crashrank.rank(path, progress=fail)


INTERRUPTED = """
import signal, sys, crashrank
# A shell's background process would ignore it.
signal.signal(signal.SIGINT, signal.default_int_handler)
scenario = crashrank.Scenario.load(sys.argv[1]).load_models()
print("ready", flush=True)
ranking = crashrank.rank(scenario, workers=2, **eval(sys.argv[2]))
print(ranking.interrupted, ranking.complete, len(ranking), flush=True)
"""


@pytest.mark.parametrize("budget", ["{}", "{'deadline_s': 60.0}"])
def test_ctrl_c_ends_with_the_partial_answer(budget):
    path = DATA / "scenarios/motorway_pile_up.json"
    words = [sys.executable, "-c", INTERRUPTED, path, budget]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout.readline() == "ready\n"
        time.sleep(1.0)
        sent = time.monotonic()
        child.send_signal(signal.SIGINT)
        line = child.stdout.readline()
        took = time.monotonic() - sent
    assert line == "True False 225\n"
    print(f"ended {took:.3f} s after Ctrl-C")


def test_threads_share_a_scenario():
    scenario = crashrank.Scenario.load(DATA / "scenarios/oncoming_truck.json")
    answers = []
    threads = [
        threading.Thread(target=lambda: answers.append(crashrank.rank(scenario).to_dict()))
        for _ in range(6)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(answers) == 6
    assert all(without_times(answer) == without_times(answers[0]) for answer in answers)


def rear_end():
    """Return a scene in which a saloon, wheels released, runs into the rear of another."""
    car = {"mesh": str(DATA / "models/sedan.obj"), "kind": "car", "mass_kg": 1500}
    return {
        "scenario_version": 1,
        "models": {"car": car, "lighter": {**car, "mass_kg": 1100}},
        "ego": {"model": "car", "speed_mps": 14},
        "actors": [{"name": "ahead", "model": "lighter", "pose": {"x_m": 9}, "speed_mps": 4}],
        "candidates": {
            "listed": [{"name": "roll"}],
            "grid": False,
            "add_straight_braking": False,
        },
        "harm": {"after_contact": "releases"},
    }


def greatest_change_mps(motion):
    """Return the greatest change of velocity within 0.3 s."""
    time, velocity = motion.t_s, np.stack([motion.vx_mps, motion.vy_mps], axis=1)
    within = (time[None, :] - time[:, None] >= 0) & (time[None, :] - time[:, None] <= 0.3)
    changes = np.linalg.norm(velocity[None, :] - velocity[:, None], axis=2)
    return changes[within].max()


def test_motions_give_the_exposure():
    # Released wheels roll freely and the plans have no acceleration: velocities change by contact
    # forces alone.
    ranking = crashrank.rank(rear_end(), base=DATA, motion=True)
    ego, ahead = ranking.best.motion
    assert (ego.body, ahead.body) == ("ego", "ahead")
    exposures = {each.body: each.exposure_mps for each in ranking.best.people}
    for motion in (ego, ahead):
        assert exposures[motion.body] > 3.0
        assert greatest_change_mps(motion) == pytest.approx(exposures[motion.body], rel=0.01)
    # Nothing else acts on the two.
    momentum = 1500 * (ego.vx_mps[-1] - ego.vx_mps[0]) + 1100 * (ahead.vx_mps[-1] - ahead.vx_mps[0])
    assert abs(momentum) < 0.01 * 1500 * 14


def test_motions_are_those_of_the_command():
    path = DATA / "scenarios/oncoming_truck.json"
    told = run_command("rank", path, "--motion")
    mine = crashrank.rank(path, motion=True)
    assert without_times(mine.to_dict()) == without_times(told)
    for row, candidate in zip(told["ranking"], mine, strict=True):
        for wanted, motion in zip(row["motion"], candidate.motion, strict=True):
            assert motion.body == wanted.pop("body")
            for key, values in wanted.items():
                assert getattr(motion, key).tolist() == values
            assert motion.pressed.dtype == bool
    assert crashrank.rank(path).best.motion is None


@pytest.mark.parametrize(
    "budget", [{"deadline_s": 1.0}, {"work_budget": 1000}, {"first_place_only": True}]
)
def test_motions_are_not_recorded_within_a_budget(budget):
    with pytest.raises(crashrank.UsageError) as error:
        crashrank.rank(DATA / "scenarios/oncoming_truck.json", motion=True, **budget)
    assert error.value.place == "motion"
    assert "leave out" in error.value.remedy


def test_bodies_in_memory_are_ranked():
    vertices, faces = box_arrays()
    car = crashrank.Model(vertices * [4, 1.8, 1.5] - [1, 0.9, 0], faces)
    scenario = crashrank.Scenario(
        {
            "scenario_version": 1,
            "models": {"car": {"kind": "car"}},
            "ego": {"model": "car", "speed_mps": np.float32(15)},
            "actors": [{"name": "other", "model": "car", "pose": {"x_m": 12}}],
            "candidates": {"listed": [{"name": "go"}], "grid": False},
        },
        models={"car": car},
    )
    assert scenario.actors == ("other",)
    assert scenario.candidates[0] == "go"
    ranking = crashrank.rank(scenario)
    # 12 m between origins, 4 m of length: the surfaces are 8 m apart.
    assert ranking["go"].time_of_impact_s == pytest.approx(8 / 15, abs=1e-3)
    assert str(ROOT) not in json.dumps(ranking.to_dict())
