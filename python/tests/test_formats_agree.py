"""The same scene in every format becomes the same scenario, and can be ranked."""

import csv
import json
import os
import re
import subprocess
import sys

import crashrank
import format_scenes as scenes
import pytest
from conftest import DATA, ROOT, program
from crashrank import formats

FORMATS = ("commonroad", "openscenario", "osi", "mcap", "esmini", "poses", "bag")
NEEDS = {
    "commonroad": "lxml",
    "openscenario": "lxml",
    "osi": "osi3",
    "mcap": "mcap",
    "bag": "rosbags",
}


def read(name, folder):
    """Return the scene of data/formats in a format; of two of them it is written first."""
    if name in NEEDS:
        pytest.importorskip(NEEDS[name])
    if name == "mcap":
        pytest.importorskip("osi3")
        scenes.write_osi_mcap(folder / "crossing.mcap")
        return formats.read_osi(folder / "crossing.mcap")
    if name == "bag":
        return formats.read_bag(scenes.write_bag(folder / "bag"))
    reader, file = {
        "commonroad": (formats.read_commonroad, "crossing.xml"),
        "openscenario": (formats.read_openscenario, "crossing.xosc"),
        "osi": (formats.read_osi, "crossing.osi"),
        "esmini": (formats.read_esmini_csv, "crossing_esmini.csv"),
        "poses": (formats.read_poses_csv, "crossing_poses.csv"),
    }[name]
    return reader(DATA / "formats" / file)


@pytest.mark.parametrize("name", FORMATS)
def test_formats_agree(name, tmp_path):
    found = read(name, tmp_path).scenario
    expected = formats.read_poses_csv(DATA / "formats/crossing_poses.csv").scenario
    close = {"abs": 2e-3}
    for actor, other in zip(found["actors"], expected["actors"], strict=True):
        if "poses" in other:
            for pose, there in zip(actor["poses"], other["poses"], strict=True):
                assert pose == pytest.approx(there, **close)
        else:
            assert actor["pose"] == pytest.approx(other["pose"], **close)
        model, there = found["models"][actor["model"]], expected["models"][other["model"]]
        assert (model["box"], model["kind"]) == (pytest.approx(there["box"]), there["kind"])
    assert found["ego"]["speed_mps"] == pytest.approx(15)
    if name == "commonroad":  # a planning problem states no vehicle: another length
        assert found["models"][found["ego"]["model"]]["kind"] == "car"
    else:
        assert found["ego"]["pose"] == pytest.approx(expected["ego"]["pose"], **close)


@pytest.mark.parametrize("name", FORMATS)
def test_what_is_read_is_valid_and_ranks(name, tmp_path):
    jsonschema = pytest.importorskip("jsonschema")
    found = read(name, tmp_path)
    schema = json.loads((DATA / "scenario.schema.json").read_text())
    jsonschema.validate(found.scenario, schema)
    json.dumps(found.scenario, allow_nan=False)
    ranking = crashrank.rank(found.scenario, deadline_s=20)
    assert len(ranking) >= 225
    assert not ranking.best.collides
    assert found.report.bodies == 2
    road = "road" in found.scenario
    assert road == (name in ("commonroad", "osi", "mcap"))


def test_the_ego_hits_what_it_is_driven_into():
    """Straight on at 15 m/s, 0.9 m of half width: the person is reached where both paths cross."""
    found = formats.read_poses_csv(DATA / "formats/crossing_poses.csv")
    ready = found.scenario
    ready["candidates"] = {"listed": [{"name": "hold", "acceleration_mps2": 0}], "grid": False}
    first = crashrank.rank(ready).to_dict()["ranking"]
    hold = next(each for each in first if each["candidate"] == "hold")
    assert hold["other"] == "person"
    # The person's middle is 35 m ahead and -4 + 1.5 t to the left; the front is 2.25 m ahead.
    assert hold["time_of_impact_s"] == pytest.approx((35 - 0.25 - 2.25) / 15, abs=0.02)


def run(*words, cwd=None):
    return subprocess.run(
        [sys.executable, "-m", "crashrank", *map(str, words)],
        capture_output=True, text=True, check=False, cwd=cwd, env=os.environ,
    )  # fmt: skip


def test_the_command_writes_a_scenario(tmp_path):
    file = DATA / "formats/crossing_poses.csv"
    done = run("import", "poses-csv", file, "-o", tmp_path / "s.json", "--time", "0.5")
    assert done.returncode == 0, done.stderr
    assert "2 other bodies" in done.stderr
    written = json.loads((tmp_path / "s.json").read_text())
    assert written == formats.read_poses_csv(file, 0.5).scenario
    done = run("import", "poses-csv", file, "-o", "-", "--json")
    assert json.loads(done.stdout)["scenario_version"] == 2
    assert json.loads(done.stderr)["bodies"] == 2


def test_the_command_decides(tmp_path):
    file = DATA / "formats/crossing_poses.csv"
    done = run("import", "poses-csv", file, "-o", tmp_path / "s.json", "--decide", "--json")
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stderr)
    last = report["decision"]["last"]["avoidable"]
    assert report["time_s"] == last["time_s"]
    written = json.loads((tmp_path / "s.json").read_text())
    assert written == formats.read_poses_csv(file, last["time_s"]).scenario


def test_the_command_surveys_a_folder():
    pytest.importorskip("lxml")
    pytest.importorskip("osi3")
    done = run("import", "survey", DATA / "formats", "-o", "-")
    assert done.returncode == 0, done.stderr
    rows = list(csv.DictReader(done.stdout.splitlines()))
    assert [row["format"] for row in rows] == [
        "osi", "commonroad", "openscenario", "esmini-csv", "poses-csv",
    ]  # fmt: skip
    for row in rows:
        assert row["read"] == "True"
        assert row["hits"].endswith(("person", "2"))
        assert float(row["contact_time_s"]) == pytest.approx(2.17, abs=0.03)
        assert float(row["least_harm_persons"]) == 0  # braking at once
        assert row["proved"] == "True"
    done = run("import", "survey", "no-folder", "-o", "-")
    assert done.returncode == 3
    assert "is no folder" in done.stderr


@pytest.mark.parametrize(
    ("words", "code", "text"),
    [
        (("import", "nonsense", "x", "-o", "y"), 2, "there is no reader of 'nonsense'"),
        (("import", "nonsense", "x", "-o", "y"), 2, "ros-bag, crashrank, survey"),
        (("import", "poses-csv", "none.csv", "-o", "y"), 3, "none.csv: cannot be read"),
        (("import", "poses-csv", "{}", "-o", "y", "--ego", "who"), 2, "choose of ego, person"),
        (("import", "poses-csv", "{}", "-o", "no/where"), 1, "cannot be written"),
        (("import", "poses-csv", "{}", "-o", "y", "--time", "99"), 3, "is not there at 99 s"),
        (("import", "poses-csv", "{}", "-o", "y", "--horizon", "0"), 2, "horizon_s"),
    ],
)
def test_the_command_refuses_with_one_line(words, code, text, tmp_path):
    file = str(DATA / "formats/crossing_poses.csv")
    done = run(*(file if word == "{}" else word for word in words), cwd=tmp_path)
    assert done.returncode == code
    assert text in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert not (tmp_path / "y").exists()


def test_the_program_says_where_readers_are():
    done = subprocess.run(
        [program(), "import", "commonroad", "x.xml"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert "import" in done.stderr


def test_code_of_the_guide_runs():
    text = (ROOT / "docs/guide/scenarios.md").read_text(encoding="utf-8")
    code = "\n".join(re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL))
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False, cwd=ROOT
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("15.0 2\n")
    assert len(text.split()) <= 1500


def test_public_names_are_documented():
    for name in formats.__all__:
        assert getattr(formats, name).__doc__, name
