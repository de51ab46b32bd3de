"""Files of others, where a folder of them lies beside the project: ../shared/scenarios, or the
folder that CRASHRANK_SHARED_SCENARIOS names. None of them is part of the project.
"""

import json
import math
import os
import pathlib
import random

import crashrank
import pytest
from conftest import DATA, ROOT
from crashrank import formats
from test_formats_hostile import accepted, mutated

FOLDER = pathlib.Path(
    os.environ.get("CRASHRANK_SHARED_SCENARIOS") or ROOT.parent / "shared/scenarios"
)
COMMONROAD = sorted(FOLDER.glob("commonroad/*.xml"))
OPENSCENARIO = sorted(FOLDER.glob("openscenario/*.xosc"))
OSI = sorted(FOLDER.glob("osi/*.*"))
RANKED = ("DEU_Test-1_1_T-1", "ZAM_Over-1_1", "OSC_CutIn-1_2_T-1", "ZAM_Tjunction-1_97_T-1")
PEDESTRIAN = FOLDER / "commonroad/OSC_PedestrianCollision-1_1_T-1.xml"


def files(found):
    """Return parameters for files, or one that is skipped and says why."""
    if found:
        return [pytest.param(path, id=path.stem) for path in found]
    reason = f"{FOLDER} is not there: no files of others are read"
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


@pytest.mark.parametrize("path", files([p for p in COMMONROAD if p.stem in RANKED]))
def test_commonroad_files_rank(path):
    ranking = crashrank.rank(read_commonroad(path).scenario, deadline_s=1.0)
    assert len(ranking) >= 225


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
