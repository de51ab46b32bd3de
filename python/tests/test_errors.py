"""Every error is a crashrank.Error that says where, what and what to do; nothing prints."""

import json
import pickle

import crashrank
import numpy as np
import pytest
from conftest import DATA, box, box_arrays

EYE = np.eye(4)
CUBE = box_arrays()


class Hostile:
    def __array__(self, *_, **__):
        raise RuntimeError("no")


class BadPath:
    def __fspath__(self):
        return 3


CALLS = {
    "missing file": (lambda: crashrank.load_model("none.obj"), "not_found"),
    "path of a number": (lambda: crashrank.load_model(3), "usage"),
    "path of a liar": (lambda: crashrank.load_model(BadPath()), "usage"),
    "path with null": (lambda: crashrank.load_model("a\0b"), "usage"),
    "path with half a pair": (lambda: crashrank.load_model("\ud800"), "usage"),
    "folder": (lambda: crashrank.load_model(DATA), "*"),
    "axis": (lambda: crashrank.load_model(DATA / "models/pole.obj", up="w"), "usage"),
    "one axis twice": (
        lambda: crashrank.load_model(DATA / "models/pole.obj", up="+x"),
        "usage",
    ),
    "scale": (lambda: crashrank.load_model(DATA / "models/pole.obj", scale=-1), "usage"),
    "infinite scale": (
        lambda: crashrank.load_model(DATA / "models/pole.obj", scale=float("inf")),
        "usage",
    ),
    "no faces": (lambda: crashrank.Model(CUBE[0]), "usage"),
    "faces of floats": (lambda: crashrank.Model(CUBE[0], CUBE[1] * 1.0), "usage"),
    "faces of bools": (lambda: crashrank.Model(CUBE[0], CUBE[1] > 3), "usage"),
    "faces beyond": (lambda: crashrank.Model(CUBE[0], CUBE[1] + 1), "bad_input"),
    "faces below": (lambda: crashrank.Model(CUBE[0], CUBE[1] - 1), "bad_input"),
    "faces far beyond": (lambda: crashrank.Model(CUBE[0], CUBE[1] + 2**40), "bad_input"),
    "flat vertices": (lambda: crashrank.Model(CUBE[0].ravel(), CUBE[1]), "bad_input"),
    "two columns": (lambda: crashrank.Model(CUBE[0][:, :2], CUBE[1]), "bad_input"),
    "nothing": (lambda: crashrank.Model(np.empty((0, 3)), np.empty((0, 3), int)), "bad_input"),
    "not finite": (lambda: crashrank.Model(CUBE[0] * np.nan, CUBE[1]), "bad_input"),
    "beyond float32": (lambda: crashrank.Model(CUBE[0] * 1e200, CUBE[1]), "bad_input"),
    "complex": (lambda: crashrank.Model(CUBE[0] * 1j, CUBE[1]), "usage"),
    "objects": (lambda: crashrank.Model(CUBE[0].astype(object), CUBE[1]), "usage"),
    "texts": (lambda: crashrank.Model([["a", "b", "c"]], [[0, 0, 0]]), "usage"),
    "ragged": (lambda: crashrank.Model([[0, 1], [2]], [[0, 0, 0]]), "usage"),
    "hostile array": (lambda: crashrank.Model(Hostile(), CUBE[1]), "usage"),
    "huge by strides": (
        lambda: crashrank.Model(np.broadcast_to(np.zeros(3), (10**12, 3)), CUBE[1]),
        "limit_exceeded",
    ),
    "parts too few": (lambda: crashrank.Model(*CUBE, {"a": 3}), "bad_input"),
    "parts twice": (lambda: crashrank.Model(*CUBE, [("a", 6), ("a", 6)]), "bad_input"),
    "parts of numbers": (lambda: crashrank.Model(*CUBE, [3, 4]), "usage"),
    "parts below 0": (lambda: crashrank.Model(*CUBE, {"a": -1, "b": 13}), "usage"),
    "no model": (lambda: crashrank.collide(1, box()), "usage"),
    "pose of three": (lambda: crashrank.collide(box(), box(), np.eye(3)), "bad_input"),
    "pose that scales": (lambda: crashrank.collide(box(), box(), 2 * EYE), "bad_input"),
    "pose that mirrors": (
        lambda: crashrank.collide(box(), box(), np.diag([1, 1, -1, 1])),
        "bad_input",
    ),
    "pose of nan": (lambda: crashrank.collide(box(), box(), EYE * np.nan), "bad_input"),
    "one pose": (lambda: crashrank.collide_any(box(), box(), EYE), "bad_input"),
    "huge poses": (
        lambda: crashrank.collide_any(box(), box(), np.broadcast_to(EYE, (10**9, 4, 4))),
        "limit_exceeded",
    ),
    "no workers": (lambda: crashrank.collide_any(box(), box(), EYE[None], workers=0), "usage"),
    "half a worker": (
        lambda: crashrank.collide_any(box(), box(), EYE[None], workers=0.5),
        "usage",
    ),
    "pairs of three": (lambda: crashrank.pairs_hash(np.zeros((2, 3), int)), "bad_input"),
    "pairs beyond": (lambda: crashrank.pairs_hash(np.full((2, 2), 2**40)), "bad_input"),
    "angle of text": (lambda: crashrank.pose_matrix(yaw_deg="left"), "usage"),
    "angle of nan": (lambda: crashrank.pose_matrix(yaw_deg=float("nan")), "usage"),
    "no arguments": (lambda: crashrank.rank(), "usage"),
    "unknown argument": (lambda: crashrank.rank("x.json", speed=3), "usage"),
    "too many arguments": (lambda: crashrank.rank("x.json", "harm"), "usage"),
    "no scenario": (lambda: crashrank.rank(3), "usage"),
    "missing scenario": (lambda: crashrank.rank("none.json"), "not_found"),
    "empty scenario": (lambda: crashrank.rank({}), "bad_input"),
    "scenario with nan": (lambda: crashrank.rank({"horizon_s": float("nan")}), "bad_input"),
    "scenario of sets": (lambda: crashrank.rank({"models": {1, 2}}), "usage"),
    "scenario of numbers": (lambda: crashrank.rank({1: 2}), "usage"),
    "broken JSON": (lambda: crashrank.rank("{nonsense"), "bad_input"),
    "JSON as bytes": (lambda: crashrank.rank(b" {}"), "bad_input"),
    "JSON in Latin-1": (lambda: crashrank.rank('{"name": "ü"}'.encode("latin-1")), "bad_input"),
    "text of a number": (lambda: crashrank.Scenario.from_json(3), "usage"),
    "no text": (lambda: crashrank.Scenario.from_json(), "usage"),
    "nothing to build": (lambda: crashrank.Scenario.build(), "usage"),
    "no file": (lambda: crashrank.Scenario.load(), "usage"),
    "base of a number": (lambda: crashrank.Scenario({}, base=3), "usage"),
    "Ranker of nothing": (lambda: crashrank.Ranker(), "usage"),
    "Ranker of a number": (lambda: crashrank.Ranker(3), "usage"),
    "measure": (
        lambda: crashrank.rank(DATA / "scenarios/oncoming_truck.json", measure="x"),
        "usage",
    ),
    "risk": (lambda: crashrank.rank(DATA / "scenarios/oncoming_truck.json", risk="x"), "usage"),
    "infeasible": (
        lambda: crashrank.rank(DATA / "scenarios/oncoming_truck.json", infeasible="x"),
        "usage",
    ),
    "profile": (
        lambda: crashrank.rank(DATA / "scenarios/oncoming_truck.json", profile="none.json"),
        "not_found",
    ),
    "deadline of nan": (
        lambda: crashrank.rank(DATA / "scenarios/oncoming_truck.json", deadline_s=float("nan")),
        "usage",
    ),
    "budget below 0": (
        lambda: crashrank.rank(DATA / "scenarios/oncoming_truck.json", work_budget=-1),
        "usage",
    ),
    "progress of text": (
        lambda: crashrank.rank(DATA / "scenarios/oncoming_truck.json", progress="x"),
        "usage",
    ),
    "allow of one text": (
        lambda: crashrank.rank(DATA / "scenarios/oncoming_truck.json", allow="/tmp"),
        "usage",
    ),
    "bodies of no model": (
        lambda: crashrank.Scenario({"models": {}}, models={"a": box()}),
        "*",
    ),
    "bodies of text": (lambda: crashrank.Scenario({}, models={"a": "b"}), "usage"),
}


@pytest.mark.parametrize("name", CALLS)
def test_what_is_wrong_is_said(name, capfd):
    call, code = CALLS[name]
    with pytest.raises(crashrank.Error) as caught:
        call()
    error = caught.value
    assert code in (error.code, "*")
    assert error.reason
    assert error.remedy
    assert all(isinstance(text, str) for text in (error.file, error.place, error.remedy))
    assert error.reason in str(error)
    assert capfd.readouterr() == ("", "")


def test_classes_fit_the_codes():
    with pytest.raises(crashrank.NotFoundError) as caught:
        crashrank.load_model("none.obj")
    assert caught.value.file == "none.obj"
    assert isinstance(caught.value, LookupError)
    with pytest.raises(ValueError, match="rigid"):
        crashrank.collide(box(), box(), 2 * EYE * [[1], [1], [1], [0.5]])
    with pytest.raises(TypeError):
        crashrank.collide(1, 2)
    copy = pickle.loads(pickle.dumps(caught.value))
    assert (copy.code, copy.file, str(copy)) == ("not_found", "none.obj", str(caught.value))


def test_places_name_the_element():
    poses = np.repeat(EYE[None], 5, axis=0)
    poses[3] *= 2
    with pytest.raises(crashrank.BadInputError) as caught:
        crashrank.collide_any(box(), box(), poses)
    assert caught.value.place == "poses[3]"
    vertices, faces = box_arrays()
    vertices[5, 1] = np.inf
    with pytest.raises(crashrank.BadInputError) as caught:
        crashrank.Model(vertices, faces)
    assert caught.value.place == "vertices[5]"
    with pytest.raises(crashrank.BadInputError) as caught:
        crashrank.rank({"scenario_version": 1, "models": {"a": {"mesh": "a.obj", "kind": "ship"}}})
    assert caught.value.place == "models.a.kind"


def test_errors_of_meshes_name_the_scenario(tmp_path):
    document = {
        "scenario_version": 1,
        "models": {"flat": {"mesh": "flat.obj", "kind": "car"}},
        "ego": {"model": "flat", "speed_mps": 1},
    }
    path = tmp_path / "scenario.json"
    path.write_text(json.dumps(document))
    with pytest.raises(crashrank.NotFoundError) as missing:
        crashrank.rank(path)
    assert missing.value.file == str(tmp_path / "flat.obj")
    assert f"(it is models.flat.mesh of {path})" in missing.value.reason
    (tmp_path / "flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")
    for given, file in ((path, str(path)), (document, "")):
        with pytest.raises(crashrank.BadInputError) as flat:
            crashrank.rank(given, base=None if given is path else tmp_path)
        assert (flat.value.file, flat.value.place) == (file, "models.flat.mesh")
        assert flat.value.reason.startswith(f"{tmp_path / 'flat.obj'} has no material")


def test_cyclic_and_deep_scenarios_are_refused():
    cyclic: dict = {}
    cyclic["models"] = cyclic
    with pytest.raises(crashrank.BadInputError):
        crashrank.rank(cyclic)
    with pytest.raises(crashrank.BadInputError):
        crashrank.Scenario.from_json("[" * 100_000)


def test_meshes_outside_the_folder_are_refused(tmp_path, monkeypatch):
    document = {
        "scenario_version": 1,
        "models": {"a": {"mesh": "../../etc/passwd.obj", "kind": "car"}},
        "ego": {"model": "a", "speed_mps": 1},
    }
    with pytest.raises(crashrank.BadInputError) as caught:
        crashrank.Scenario(document, base=tmp_path)
    assert caught.value.place == "models.a.mesh"
    assert "base=" not in caught.value.remedy
    monkeypatch.chdir(tmp_path)
    for given in (document, json.dumps(document), json.dumps(document).encode()):
        with pytest.raises(crashrank.BadInputError) as caught:
            crashrank.rank(given)
        assert caught.value.place == "models.a.mesh"
        assert "base=" in caught.value.remedy


def test_latin_1_is_told_as_such(tmp_path):
    text = '{\n "name": "München"}'.encode("latin-1")
    (tmp_path / "scenario.json").write_bytes(text)
    with pytest.raises(crashrank.BadInputError, match="UTF-8") as caught:
        crashrank.rank(tmp_path / "scenario.json")
    assert caught.value.place == "line 2, column 12"
    with pytest.raises(crashrank.BadInputError, match="UTF-8") as caught:
        crashrank.rank(text)
    assert caught.value.place == "byte 14"


def test_errors_without_a_remedy_get_that_of_their_code():
    for code in ("usage", "bad_input", "not_found", "limit_exceeded", "out_of_budget", "other"):
        assert crashrank.Error(code, reason="x").remedy
