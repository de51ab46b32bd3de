"""`rank_table`: rows as `rank` has them, errors in rows, hashes that follow what they name."""

import json
import shutil
import subprocess
import sys

import crashrank
import pytest
from batch_scenes import environment, make_models, scene
from conftest import DATA, program, run_command
from crashrank.batch import result_hash, result_schema

pa = pytest.importorskip("pyarrow")


def table_of(folder, documents, **columns):
    texts = [each if isinstance(each, str) else json.dumps(each) for each in documents]
    return pa.table(
        {
            "id": [f"row {i}" for i in range(len(texts))],
            "scenario": texts,
            "base": [str(folder)] * len(texts),
            **columns,
        }
    )


def one(folder, document, **options):
    return crashrank.rank_table(table_of(folder, [document]), **options).to_pylist()[0]


def test_a_row_has_what_rank_answers(scenes):
    table = crashrank.rank_table(table_of(scenes, [scene(0), scene(5)]))
    assert table.schema == result_schema()
    for row, document in zip(table.to_pylist(), (scene(0), scene(5)), strict=True):
        ranking = crashrank.rank(document, base=scenes)
        assert row["status"] == "ok"
        assert row["error"] is None
        assert row["version"] == crashrank.__version__
        assert (row["best"], row["best_score"]) == (ranking.best.candidate, ranking.best.score)
        assert (row["measure"], row["measure_unit"]) == ("delta-v", "m/s")
        assert row["complete"]
        assert row["result_hash"] == result_hash(ranking.to_dict())
        expected = ranking.to_arrow().to_pylist()
        contacts = [each.pop("contacts") for each in row["ranking"]]
        assert row["ranking"] == expected
        for found, candidate in zip(contacts, ranking, strict=True):
            assert [(c["first"], c["second"]) for c in found] == [
                c.bodies for c in candidate.contacts
            ]
            assert [c["exposure_first_mps"] for c in found] == [
                c.severity.a.exposure_mps for c in candidate.contacts
            ]
    assert len({row["result_hash"] for row in table.to_pylist()}) == 2


@pytest.mark.parametrize("name", ["oncoming_truck", "pedestrian_or_parked_car"])
def test_a_results_hash_is_that_of_the_commands_answer(name):
    file = DATA / f"scenarios/{name}.json"
    row = one(file.parent, file.read_text(encoding="utf-8"))
    assert row["result_hash"] == result_hash(run_command("rank", file, "--workers", "2"))
    assert row["result_hash"] != result_hash(run_command("rank", file, "--measure", "energy"))


def test_the_division_into_tables_changes_no_row(scenes):
    whole = table_of(scenes, [scene(i) for i in range(6)])
    rows = crashrank.rank_table(whole).to_pylist()
    parts = [crashrank.rank_table(whole.slice(i, 2)).to_pylist() for i in (4, 0, 2)]
    assert parts[1] + parts[2] + parts[0] == rows
    again = crashrank.rank_table(whole.to_batches()[0])
    assert again.to_pylist() == rows


@pytest.mark.parametrize(
    ("document", "code", "words"),
    [
        ("{", "bad_input", "line 1"),
        ("", "bad_input", ""),
        ("[]", "bad_input", ""),
        (scene(0, horizon_s=-1), "bad_input", "horizon_s"),
        (
            scene(0, models={"car": {"mesh": "models/gone.obj", "kind": "car"}}, actors=[]),
            "not_found",
            "gone.obj",
        ),
        (
            scene(0, models={"car": {"mesh": "../../x.obj", "kind": "car"}}, actors=[]),
            "bad_input",
            "outside",
        ),
        ('{"a": "\\ud800"}', "bad_input", ""),
    ],
)
def test_a_bad_row_becomes_its_error(scenes, document, code, words):
    table = crashrank.rank_table(table_of(scenes, [scene(1), document, scene(2)]))
    before, row, after = table.to_pylist()
    assert (before["status"], after["status"]) == ("ok", "ok")
    assert (row["status"], row["error_code"]) == ("error", code), row["error"]
    assert words in row["error"]
    for name in ("best", "best_score", "result_hash", "ranking", "complete"):
        assert row[name] is None


def test_null_rows_and_settings_without_meaning(scenes):
    table = pa.table({"id": pa.array(["a", None]), "scenario": pa.array([None, None], pa.string())})
    rows = crashrank.rank_table(table).to_pylist()
    assert [row["status"] for row in rows] == ["error", "error"]
    assert rows[0]["input_hash"] is None
    row = one(scenes, scene(0), measure="niceness")
    assert (row["status"], row["error_code"]) == ("error", "usage")


def test_wrong_arguments_raise(scenes):
    with pytest.raises(crashrank.ArgumentTypeError) as caught:
        crashrank.rank_table({"id": ["a"]})
    assert caught.value.place == "table"
    with pytest.raises(crashrank.BadInputError, match="no column 'scenario'"):
        crashrank.rank_table(pa.table({"id": ["a"]}))
    with pytest.raises(crashrank.BadInputError, match=r"table\.scenario"):
        crashrank.rank_table(pa.table({"id": ["a"], "scenario": [[1, 2]]}))
    good = table_of(scenes, [scene(0)])
    with pytest.raises(crashrank.ArgumentTypeError):
        crashrank.rank_table(good, ["car.obj"])
    with pytest.raises(crashrank.NotFoundError):
        crashrank.rank_table(good, {"car": scenes / "gone.crm"})
    with pytest.raises(crashrank.NotFoundError):
        crashrank.rank_table(good, profile=scenes / "gone.json")
    with pytest.raises(crashrank.UsageError):
        crashrank.rank_table(good, futures=0)
    with pytest.raises(crashrank.ArgumentTypeError):
        crashrank.rank_table(good, deadline_s=1)


def test_an_empty_table_has_the_schema():
    empty = pa.table({"id": pa.array([], pa.string()), "scenario": pa.array([], pa.string())})
    answer = crashrank.rank_table(empty)
    assert answer.num_rows == 0
    assert answer.schema == result_schema()


def test_other_types_of_text_are_read(scenes):
    table = table_of(scenes, [scene(3)])
    expected = crashrank.rank_table(table).to_pylist()
    for kind in (pa.large_string(), pa.dictionary(pa.int32(), pa.string())):
        schema = pa.schema([("id", kind), ("scenario", kind), ("base", kind)])
        assert crashrank.rank_table(table.cast(schema)).to_pylist() == expected
    numbered = table.set_column(0, "id", pa.array([7]))
    assert crashrank.rank_table(numbered).to_pylist()[0]["id"] == "7"


def test_given_models_stand_for_those_of_every_scenario(scenes):
    file = scenes / "models/car.crm"
    expected = one(scenes, scene(4))
    bare = scene(4)
    del bare["models"]["car"]["mesh"]
    by_path = one(scenes, bare, models={"car": file, "lorry": file})
    by_model = one(scenes, bare, models={"car": crashrank.load_model(file)})
    for row in (by_path, by_model):
        assert row["result_hash"] == expected["result_hash"], row["error"]
    assert by_path["models_hash"] == expected["models_hash"]
    assert one(scenes, bare)["error_code"] == "bad_input"
    pole = one(scenes, scene(4), models={"car": scenes / "models/pole.crm"})
    assert pole["models_hash"] != expected["models_hash"]
    assert pole["result_hash"] != expected["result_hash"]


def test_hashes_follow_what_they_name(scenes):
    first = one(scenes, scene(0))
    text = json.dumps(scene(0), indent=1)
    spaced = one(scenes, text)
    assert spaced["input_hash"] != first["input_hash"]
    assert spaced["result_hash"] == first["result_hash"]
    for options in ({"measure": "energy"}, {"infeasible": "keep"}, {"work_budget": 10**9}):
        other = one(scenes, scene(0), **options)
        assert other["settings_hash"] != first["settings_hash"]
        assert other["input_hash"] == first["input_hash"]
    profile = scenes / "profile.txt"
    hashes = set()
    for people in (1, 2):
        profile.write_text(json.dumps({"profile_version": 1, "people": {"ego": people}}))
        hashes.add(one(scenes, scene(0), profile=profile)["settings_hash"])
    assert len(hashes) == 2


def test_a_model_that_changes_is_read_again(scenes):
    first = one(scenes, scene(0))
    crashrank.load_model(DATA / "models/sedan.obj").save(scenes / "models/car.crm", overwrite=True)
    second = one(scenes, scene(0))
    assert second["models_hash"] != first["models_hash"]
    assert second["input_hash"] == first["input_hash"]
    assert second["result_hash"] == result_hash(crashrank.rank(scene(0), base=scenes).to_dict())
    assert second["result_hash"] != first["result_hash"]


def test_a_table_of_candidates_is_part_of_the_input(scenes):
    document = scene(0, candidates={"table": "planned.csv"})
    header = "candidate,t_s,x_m,y_m,yaw_deg\n"

    def rows(speed):
        return "".join(f"straight,{t},{speed * t},0,0\n" for t in (0, 1, 2))

    hashes = set()
    for speed in (14, 13):
        (scenes / "planned.csv").write_text(header + rows(speed))
        row = one(scenes, document)
        hashes.add(row["input_hash"])
    assert len(hashes) == 2


def test_buffers_of_a_gltf_count_as_the_model(tmp_path):
    from crashrank.batch._hashes import file_hash

    document = {"asset": {"version": "2.0"}, "buffers": [{"uri": "a.bin", "byteLength": 4}]}
    (tmp_path / "a.gltf").write_text(json.dumps(document))
    (tmp_path / "a.bin").write_bytes(b"abcd")
    first = file_hash(str(tmp_path / "a.gltf"))
    (tmp_path / "a.bin").write_bytes(b"abce")
    assert file_hash(str(tmp_path / "a.gltf")) != first
    assert file_hash(str(tmp_path / "gone.gltf")) == "missing"


def test_models_are_loaded_once_and_kept_within_the_limit(scenes):
    from crashrank import _core

    cache = _core.ModelCache(15_000)
    texts = [json.dumps(scene(i)) for i in range(5)]

    def load(text):
        found = _core.read_scenario_text(text, str(scenes / "x.json"), [], {}, cache)
        found.load()
        return found

    kept = [load(text) for text in texts]
    assert cache.loads == 2
    both = cache.triangles
    assert 0 < both <= 15_000
    shutil.copy(scenes / "models/car.crm", scenes / "models/other.crm")
    load(json.dumps(scene(0)).replace("car.crm", "other.crm"))
    assert cache.loads == 3
    assert cache.triangles <= 15_000
    load(texts[0])
    assert cache.loads > 3
    assert len(kept) == 5


def test_a_kept_model_is_checked_against_every_scenario(scenes):
    """What a model file states of the mass has to suit each scenario, kept or not."""
    model = crashrank.load_model(scenes / "models/car.crm")
    stated = scenes / "models/stated.crm"
    subprocess.run(
        [program(), "compile", DATA / "models/hatch.obj", "-o", stated, "--mass-kg", "1200",
         "--yaw-inertia-kgm2", "1900"],
        check=True, capture_output=True,
    )  # fmt: skip
    good, bad = scene(0), scene(0)
    for document, mass in ((good, None), (bad, 60)):
        document["models"]["car"] = {"mesh": "models/stated.crm", "kind": "car"}
        if mass:
            document["models"]["car"]["mass_kg"] = mass
    rows = crashrank.rank_table(table_of(scenes, [good, bad, good])).to_pylist()
    assert [row["status"] for row in rows] == ["ok", "error", "ok"]
    with pytest.raises(crashrank.BadInputError) as caught:
        crashrank.rank(bad, base=scenes)
    assert rows[1]["error"] == str(caught.value)
    assert model.mass_kg is None


def test_importing_the_package_imports_no_extra():
    code = "import crashrank, sys; assert not {'pyarrow', 'ray', 'pandas'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True, env=environment())


def test_without_pyarrow_the_extra_is_named():
    code = (
        "import sys; sys.modules['pyarrow'] = None\n"
        "import crashrank\n"
        "try: crashrank.rank_table(None)\n"
        "except crashrank.NotFoundError as error: print(error.place, error.remedy)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True, env=environment()
    )
    assert done.stdout == "pyarrow pip install '.[arrow]' in the folder of crashrank's source\n"


def test_models_of_a_folder_with_other_rows(tmp_path):
    make_models(tmp_path)
    table = table_of(tmp_path, [scene(0)]).drop_columns(["base"])
    assert crashrank.rank_table(table, base=tmp_path).to_pylist()[0]["status"] == "ok"
    assert crashrank.rank_table(table).to_pylist()[0]["status"] == "error"
