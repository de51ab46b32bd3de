"""The guide's recipes for other engines, run as the guide has them."""

import importlib.util
import json
import re
import shutil
import subprocess
import sys

import crashrank
import pytest
from batch_scenes import command, environment, scene
from conftest import ROOT

pa = pytest.importorskip("pyarrow")
pq = pytest.importorskip("pyarrow.parquet")

GUIDE = ROOT / "docs/guide/batch.md"


def recipe(name):
    pattern = rf"^<!-- recipe: {name} -->\n```python\n(.*?)^```"
    found = re.search(pattern, GUIDE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    assert found, name
    return found[1]


@pytest.mark.parametrize(("name", "module"), [("dask", "distributed"), ("spark", "pyspark")])
def test_a_recipe_ranks_as_rank_table_does(scenes, name, module):
    if importlib.util.find_spec(module) is None:
        pytest.skip(f"{module} is not installed: see scripts/ray")
    if name == "spark" and not shutil.which("java"):
        pytest.skip("Java is not installed")
    documents = [*(json.dumps(scene(i)) for i in range(20)), "{"]
    table = pa.table(
        {
            "id": [f"row {i:02}" for i in range(21)],
            "scenario": documents,
            "base": [str(scenes)] * 21,
        }
    )
    folder = scenes.parent
    pq.write_table(table, folder / "scenes.parquet")
    (folder / "recipe.py").write_text(recipe(name))
    done = subprocess.run(
        [sys.executable, "recipe.py"], capture_output=True, text=True, check=False, cwd=folder,
        env=environment(PYSPARK_PYTHON=sys.executable), timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-3000:]
    ranked = pq.read_table(folder / f"ranked-{name}").to_pylist()
    ranked.sort(key=lambda row: row["id"])
    expected = crashrank.rank_table(table).to_pylist()
    assert [row["result_hash"] for row in ranked] == [row["result_hash"] for row in expected]
    for found, wanted in zip(ranked, expected, strict=True):
        assert {name: found[name] for name in wanted} == wanted


def test_the_first_lines_of_the_guide_run(tmp_path):
    text = GUIDE.read_text(encoding="utf-8")
    words = re.search(r"^crashrank-batch (.*)$", text, re.MULTILINE)[1].split()
    folder = tmp_path / words[0]
    folder.mkdir(parents=True)
    for name in ("cyclist_ahead", "roundabout_entry"):  # all ten take ten seconds
        shutil.copy(ROOT / words[0] / f"{name}.json", folder)
    shutil.copytree(ROOT / "data/models", tmp_path / "data/models")
    (tmp_path / "data/crashrank.root").touch()
    done = subprocess.run(
        command(*words), capture_output=True, text=True, check=False, cwd=tmp_path
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    code = re.search(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)[1]
    pytest.importorskip("pandas")
    shown = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=tmp_path
    )
    assert ".json" in shown.stdout
    assert (tmp_path / "ranked/_summary.html").is_file()
    contacts = [
        contact
        for row in pq.read_table(tmp_path / "ranked").to_pylist()
        for candidate in row["ranking"]
        for contact in candidate["contacts"]
    ]
    assert any("ego" not in (each["first"], each["second"]) for each in contacts)
