"""Files of others, where a folder of them lies beside the project: ../shared/scenarios, or the
folder that CRASHRANK_SHARED_SCENARIOS names. None of them is part of the project.
"""

import json
import math
import pathlib
import random

import crashrank
import pytest
from conftest import DATA, SHARED
from crashrank import formats
from test_formats_hostile import accepted, mutated

COMMONROAD = sorted(SHARED.glob("commonroad/*.xml"))
OPENSCENARIO = sorted(SHARED.glob("openscenario/*.xosc"))
OSI = sorted(SHARED.glob("osi/*.*"))
PEDESTRIAN = SHARED / "commonroad/OSC_PedestrianCollision-1_1_T-1.xml"


def files(found):
    """Return parameters for files, or one that is skipped and says why."""
    if found:
        return [pytest.param(path, id=path.stem) for path in found]
    reason = f"{SHARED} is not there: no files of others are read"
    return [pytest.param(None, id="missing", marks=pytest.mark.skip(reason=reason))]


def read_commonroad(path, **options):
    pytest.importorskip("lxml")
    if path.stem == "test_reading_obstacles":  # it has no planning problem
        options = {"ego": "1", **options}
    return formats.read_commonroad(path, **options)


@pytest.mark.parametrize("path", files(COMMONROAD))
def test_commonroad_files_are_read(path):
    found = read_commonroad(path)
    accepted(json.loads(json.dumps(found.scenario, allow_nan=False)))
    assert found.report.bodies == len(found.scenario["actors"])
    assert found.report.bodies + len(found.report.left_out) > 0
    jsonschema = pytest.importorskip("jsonschema")
    jsonschema.validate(found.scenario, json.loads((DATA / "scenario.schema.json").read_text()))


@pytest.mark.parametrize("path", files([PEDESTRIAN] if PEDESTRIAN.exists() else []))
def test_a_recorded_crash_is_found(path):
    """The recording hits the person at step 56, at 9 m/s: so does its ego if it goes on."""
    found = read_commonroad(path, ego=34, time_step=48)
    ready = found.scenario
    ready["candidates"] = {"listed": [{"name": "hold", "acceleration_mps2": 0}], "grid": False}
    rows = crashrank.rank(ready, deadline_s=20).to_dict()["ranking"]
    hold = next(row for row in rows if row["candidate"] == "hold")
    assert hold["other"] == "pedestrian 35"
    assert hold["time_of_impact_s"] == pytest.approx(0.8, abs=0.15)
    assert hold["closing_speed_mps"] == pytest.approx(9.0, abs=1.0)


@pytest.mark.parametrize("path", files(OPENSCENARIO))
def test_openscenario_files_need_an_engine(path):
    """None of these is a recording: each is refused with the element, its line and a remedy."""
    pytest.importorskip("lxml")
    with pytest.raises(crashrank.BadInputError) as caught:
        formats.read_openscenario(path)
    assert "line" in caught.value.place
    assert "engine" in caught.value.reason or "catalogue" in caught.value.reason
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize("path", files(OSI))
def test_osi_traces_are_read_and_rank(path):
    pytest.importorskip("osi3")
    pytest.importorskip("mcap")
    ego = None if path.suffix == ".mcap" else "0"
    for time_s in (0.0, 3.0):
        found = formats.read_osi(path, time_s, ego)
        ego_speed = found.scenario["ego"]["speed_mps"]
        assert 5 < ego_speed < 40
        assert found.scenario["actors"]
    assert len(crashrank.rank(found.scenario, deadline_s=1.0)) >= 225


@pytest.mark.parametrize("path", files([p for p in OSI if p.name == "pedestrian.osi"]))
def test_two_formats_of_one_scene_agree(path):
    """The trace and the CommonRoad file come from one scenario of esmini."""
    pytest.importorskip("osi3")
    trace = formats.read_osi(path, 0.0, 0).scenario["ego"]["pose"]
    scene = read_commonroad(PEDESTRIAN, ego=34).scenario["ego"]["pose"]
    assert math.dist((trace["x_m"], trace["y_m"]), (scene["x_m"], scene["y_m"])) < 1.5
    assert trace["yaw_deg"] == pytest.approx(scene["yaw_deg"], abs=2)


@pytest.mark.parametrize("path", files([p for p in COMMONROAD if p.stat().st_size < 70_000] + OSI))
def test_damaged_files_of_others(path, tmp_path):
    generate = random.Random(path.name)
    target = tmp_path / path.name
    data = path.read_bytes()
    for _ in range(15):
        target.write_bytes(mutated(data, generate))
        try:
            if path.suffix == ".xml":
                found = read_commonroad(target)
            else:
                pytest.importorskip("osi3")
                found = formats.read_osi(target, 1.0, None if path.suffix == ".mcap" else 0)
        except crashrank.Error as error:
            assert error.code in ("bad_input", "limit_exceeded", "usage")
            assert len(str(error).splitlines()) == 1
        else:
            accepted(json.loads(json.dumps(found.scenario, allow_nan=False)))


@pytest.mark.parametrize("path", files(COMMONROAD + OSI))
def test_every_file_that_is_read_ranks_within_a_deadline(path):
    options = {"ego": 0} if path.suffix == ".osi" else {}
    pytest.importorskip("lxml" if path.suffix == ".xml" else "osi3")
    found = (read_commonroad if path.suffix == ".xml" else formats.read_osi)(path, **options)
    with crashrank.Ranker(found.scenario) as ranker:
        answer = ranker.rank(deadline_s=1.0)
    assert len(answer) >= 225
    assert (answer.lowest <= answer.highest).all()


@pytest.mark.parametrize(
    "path", files(sorted(SHARED.glob("commonroad/OSC_PedestrianCollision-1_1_T-*.xml")))
)
def test_when_the_persons_could_last_be_spared(path):
    """The recording collides at step 56; its successors begin 26, 38 and 47 steps later.

    The sets of the second still lead along the pavement: no contact is predicted there, and the
    ego passes.
    """
    pytest.importorskip("lxml")
    options = {"ego": 34, "step_s": 0.2, "accelerations": 5, "steerings": 5, "deadline_s": 1.0}
    begin = int(path.stem.rpartition("-")[2])
    curve = formats.find_decision_point(path, before_s=1.2, **options)
    assert curve.other == "pedestrian 35"
    if begin == 26:
        assert curve.contact_time_s is None
        assert len(curve.steps) >= 5
        for step in curve.steps:
            assert step.going_on.avoids
            assert 0.0 < step.going_on.least_distance_m < 3.0
            assert step.best.score == 0.0
        assert curve.last_avoidable is None
        return
    recorded = 5.6 - (begin / 10 if begin > 1 else 0)
    assert curve.contact_time_s == pytest.approx(recorded, abs=0.3)
    assert all(step.best.most <= step.going_on.most for step in curve.steps)
    # Braking straight ahead from 9 m/s takes v / (2a) of the way's time.
    found = curve.last_avoidable_by_braking
    if found is not None:
        assert found.time_s <= curve.contact_time_s - 9 / (2 * 0.8 * 9.80665) + 0.01


def test_the_survey_names_every_file():
    if not SHARED.is_dir():
        pytest.skip(f"{SHARED} is not there: no survey of the files of others")
    pytest.importorskip("lxml")
    pytest.importorskip("osi3")
    from crashrank.formats._survey import survey

    rows = list(survey(SHARED))
    expected = COMMONROAD + OSI + sorted(SHARED.glob("openscenario/**/*.xosc"))
    assert sorted(row["file"] for row in rows) == sorted(map(str, expected))
    for row in rows:
        assert row["read"] or row["reason"]
    hit = {pathlib.Path(row["file"]).stem for row in rows if row.get("hits")}
    assert {"DEU_Test-1_1_T-1", "DEU_Crit-1_1_T-1"} <= hit  # recorded overlaps
