"""Inputs of ``crashrank-batch``: what is read, and what ends a run or a row with one line."""

import json
import os
import shutil
import subprocess

import pytest
from batch_scenes import (
    command,
    one_line,
    results,
    run_batch,
    scene,
    write_scene,
    write_table,
)

pa = pytest.importorskip("pyarrow")
pq = pytest.importorskip("pyarrow.parquet")


def test_parquet_is_read_in_parts(scenes, tmp_path):
    documents = [scene(i) for i in range(10)]
    write_table(scenes / "all.parquet", documents)
    for i in range(10, 12):
        (scenes / f"scene-{i:02}.json").unlink()
    by_table = run_batch(scenes / "all.parquet", "-o", tmp_path / "a", "--rows-per-part", 4)
    (scenes / "all.parquet").rename(tmp_path / "all.parquet")
    by_file = run_batch(scenes, "-o", tmp_path / "b", "--rows-per-part", 4)
    assert by_table["results"] == by_file["results"]
    assert (by_table["rows"], by_table["parts"]) == (10, 3)
    # Elsewhere a column says where the models are.
    write_table(tmp_path / "all.parquet", documents, base=[str(scenes)] * 10)
    by_base = run_batch(tmp_path / "all.parquet", "-o", tmp_path / "c", "--sequential")
    assert by_base["results"] == by_table["results"]


def test_inputs_below_a_folder_and_beside_it(scenes, tmp_path):
    (scenes / "below/_hidden").mkdir(parents=True)
    shutil.move(scenes / "scene-00.json", scenes / "below/scene-00.json")
    shutil.copytree(scenes / "models", scenes / "below/models")
    write_scene(scenes / "below/_hidden", "other", "{")
    out = scenes / "out"
    done = run_batch(scenes, "-o", out, "--sequential")
    assert (done["rows"], done["errors"]) == (12, 0)
    assert run_batch(scenes, "-o", out, "--sequential")["found_rows"] == 12
    ids = [row[0] for row in results(out)]
    assert "below/scene-00.json" in ids
    again = run_batch(scenes, scenes / "scene-01.json", "-o", tmp_path / "x", code=2)
    assert (
        f"{scenes / 'scene-01.json'}: is named twice by the inputs; name it once"
        in (again["messages"])
    )


def test_an_input_that_is_named_twice(scenes, tmp_path):
    write_table(tmp_path / "all.parquet", [scene(i) for i in range(2)], base=[str(scenes)] * 2)
    for twice in (scenes, tmp_path / "all.parquet"):
        done = run_batch(twice, twice, "-o", tmp_path / "x", "--sequential", code=2)
        assert "is named twice by the inputs; name it once" in done["messages"]
    other = shutil.copytree(scenes, tmp_path / "other")
    done = run_batch(scenes, other, "-o", tmp_path / "x", "--sequential", code=2)
    for text in (str(other), "the same id 'scene-00.json'", "name the folder above both instead"):
        assert text in done["messages"]


@pytest.mark.usefixtures("scenes")
@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (["gone", "-o", "out"], 3, "gone: is not there"),
        (["empty", "-o", "out"], 3, "holds no scenario"),
        (["scenes", "-o", "file/out"], 2, "cannot be written"),
        (["scenes", "-o", "out", "--model", "car=gone.crm"], 3, "gone.crm: --model: is not there"),
        (["scenes", "-o", "out", "--model", "car"], 2, "NAME=FILE"),
        (["scenes", "-o", "out", "--profile", "gone.json"], 3, "gone.json"),
        (["scenes", "-o", "out", "--address", "x:1"], 2, "--engine ray"),
        (["", "-o", "out"], 2, "INPUT: is empty"),
        (["scenes", "-o", ""], 2, "-o: is empty"),
        (["scenes", "-o", "scenes"], 2, "is an input, too"),
        (["scenes", "-o", os.fsdecode(b"out\xff")], 2, "-o: is a path that is not UTF-8"),
        (["scenes", "-o", "out", "--model", "a=file", "--model", "a=file"], 2, "'a' twice"),
        (["/dev/null", "-o", "out"], 3, "is neither a file nor a folder"),
        (["gone\nline", "-o", "out"], 3, "gone\\nline: is not there"),
        (["pipes", "-o", "out"], 3, "pipe.parquet: is no file"),
        (["links", "-o", "out"], 3, "link.parquet: cannot be read: No such file"),
        (["bad.parquet", "-o", "out"], 3, "is no parquet file"),
        (["damaged.parquet", "-o", "out"], 3, "damaged.parquet: is damaged: "),
        (["lists.parquet", "-o", "out"], 3, "lists.parquet: table.scenario: is a column of list"),
        (["bytes.parquet", "-o", "out"], 3, "bytes.parquet: table.id: holds text that is not UTF"),
        (["twice.parquet", "-o", "out"], 3, "twice.parquet: has 2 columns 'id'"),
        (["other.parquet", "-o", "out"], 3, "no column 'scenario'"),
        (["scenes", "-o", "out", "--workers", "0"], 2, "--workers"),
        (["scenes"], 2, "-o"),
        (["nothing.json", "-o", "out"], 3, "1 scenes have an error"),
    ],
)
def test_what_is_wrong_is_one_line(tmp_path, words, code, message):
    (tmp_path / "empty").mkdir()
    (tmp_path / "file").touch()
    (tmp_path / "bad.parquet").write_bytes(b"PAR1")
    (tmp_path / "nothing.json").write_text("{}")
    pq.write_table(pa.table({"id": ["a"]}), tmp_path / "other.parquet")
    for name in ("pipes", "links"):
        (tmp_path / name).mkdir()
    os.mkfifo(tmp_path / "pipes/pipe.parquet")
    (tmp_path / "links/link.parquet").symlink_to("gone")
    pq.write_table(pa.table({"id": ["a"], "scenario": [[1]]}), tmp_path / "lists.parquet")
    damaged = tmp_path / "damaged.parquet"
    pq.write_table(pa.table({"id": ["a"], "scenario": ["{}"]}), damaged)
    damaged.write_bytes(b"PAR1" + bytes(60) + damaged.read_bytes()[64:])
    column = pa.array(["a"])
    raw = pa.Array.from_buffers(pa.string(), 1, [None, column.buffers()[1], pa.py_buffer(b"\xff")])
    pq.write_table(pa.table({"id": raw, "scenario": ["{}"]}), tmp_path / "bytes.parquet")
    twice = pa.Table.from_arrays([column, column, column], names=["id", "id", "scenario"])
    pq.write_table(twice, tmp_path / "twice.parquet")
    done = subprocess.run(
        command(*words), capture_output=True, text=True, check=False, cwd=tmp_path
    )  # fmt: skip
    assert done.returncode == code, done.stderr
    assert message in done.stderr
    assert "Traceback" not in done.stderr
    if "usage:" not in done.stderr:
        one_line(done)


@pytest.mark.parametrize(
    ("first", "second", "place", "words"),
    [
        (["a", "b", "a"], ["c"], "a.parquet: row 3", "same id 'a' as row 1;"),
        (["a", "b"], ["c", "b"], "b.parquet: row 2", "same id 'b' as row 2 of "),
        (["a", "b"], ["c", "scene-07.json"], "b.parquet: row 2", "scene-07.json; give"),
        (["a", "a", "b"], ["b", "b"], "a.parquet: row 2", "(3 rows in all repeat an id)"),
        (["a", None], ["c"], "a.parquet: row 2", "has no id"),
        (["a", "b"], [""], "b.parquet: row 1", "has no id"),
        ([7, 8], [7], "b.parquet: row 1", "same id '7' as row 1 of "),
    ],
)
def test_ids_that_repeat_or_lack_end_the_run_before_it_begins(
    scenes, tmp_path, first, second, place, words
):
    for name, ids in (("a", first), ("b", second)):
        write_table(scenes / f"{name}.parquet", [scene(0)] * len(ids), ids)
    done = run_batch(scenes, "-o", tmp_path / "out", "--sequential", code=3)
    message = done["messages"]
    assert len(message.splitlines()) == 1
    assert f"{scenes / place}: has" in message
    assert words in message
    assert "give every row an id of its own" in message
    assert not (tmp_path / "out").exists()


def test_odd_ids_name_no_files(scenes, tmp_path):
    ids = [
        "a/b",
        "x\ny",
        "..",
        "../../etc",
        "/",
        "z" * 300,
        "\u2603\U0001f600",
        "\0",
        "\x1b[2J",
        " ",
    ]
    write_table(tmp_path / "odd.parquet", [scene(0)] * 9 + ["{"], ids, base=[str(scenes)] * 10)
    out = tmp_path / "out"
    done = run_batch(tmp_path / "odd.parquet", "-o", out, "--sequential", "--reports", 10)
    assert [row[0] for row in results(out)] == sorted(ids, key=lambda each: str((each,)))
    assert (done["errors"], len(done["messages"].splitlines())) == (1, 1)
    assert sorted(each.name for each in tmp_path.iterdir()) == ["odd.parquet", "out", "scenes"]


def test_files_that_cannot_be_read_are_rows(scenes, tmp_path):
    os.mkfifo(scenes / "pipe.json")
    (scenes / "link.json").symlink_to("gone")
    (scenes / os.fsdecode(b"bad\xff.json")).write_text(json.dumps(scene(0)))
    (scenes / "a\nb.json").write_text(json.dumps(scene(0)))
    os.mkfifo(scenes / "models/pipe.crm")
    models = scene(0)["models"] | {"car": {"mesh": "models/pipe.crm", "kind": "car"}}
    write_scene(scenes, "model", scene(0, models=models))
    write_scene(scenes, "table", scene(0, candidates={"table": "models/pipe.crm"}))
    out = tmp_path / "out"
    done = run_batch(scenes, "-o", out, "--workers", 1)
    assert (done["rows"], done["errors"]) == (18, 5)
    errors = {row["id"]: row["error"] for row in pq.read_table(out).to_pylist() if row["error"]}
    for name, words in (
        ("pipe.json", "is no file"),
        ("link.json", "No such file"),
        ("bad\\udcff.json", "rename the file"),
        ("model.json", "is not a file"),
        ("table.json", "is not a file"),
    ):
        assert words in errors[name]
    assert run_batch(scenes, "-o", out, "--sequential")["found_rows"] == 18


def test_a_folder_that_cannot_be_read_is_not_left_out(scenes, tmp_path, monkeypatch):
    scandir = os.scandir

    def refuse(path):
        if str(path).endswith("closed"):
            raise PermissionError(13, "Permission denied", str(path))
        return scandir(path)

    (scenes / "closed").mkdir()
    monkeypatch.setattr(os, "scandir", refuse)
    done = run_batch(scenes, "-o", tmp_path / "out", "--sequential", code=3)
    assert f"{scenes / 'closed'}: cannot be read: Permission denied" in done["messages"]
