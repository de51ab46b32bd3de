"""Models: what goes in comes out, and files hold what was saved."""

import gc
import pickle

import crashrank
import numpy as np
import pytest
from conftest import DATA, box, box_arrays


def obj_arrays(path):
    """Return vertices and faces of an OBJ file of triangles, read line by line."""
    vertices, faces = [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            faces.append([int(word.split("/")[0]) - 1 for word in words[1:]])
    return np.array(vertices, dtype=np.float32), faces


def test_a_loaded_mesh_has_the_triangles_of_its_file(pole):
    vertices, faces = obj_arrays(DATA / "models/pole.obj")
    expected = np.array([vertices[face] for face in faces])
    # The importer reads decimals to the last bit but one.
    np.testing.assert_allclose(pole.vertices[pole.faces], expected, rtol=2e-7, atol=0)


def test_bounds_are_those_of_the_vertices(sedan):
    points = np.asarray(sedan.vertices, dtype=np.float64)
    np.testing.assert_array_equal(sedan.bounds, [points.min(axis=0), points.max(axis=0)])
    np.testing.assert_array_equal(sedan.extents, np.ptp(points, axis=0))


def test_parts_cover_the_faces_in_order(sedan):
    first = 0
    for part in sedan.parts:
        assert part.first_face == first
        assert len(sedan.faces[part.faces]) == part.face_count
        first += part.face_count
    assert first == len(sedan.faces)
    assert len({part.name for part in sedan.parts}) == len(sedan.parts)


def test_the_outline_holds_all_vertices_and_is_convex(sedan):
    outline = sedan.outline
    edges = np.roll(outline, -1, axis=0) - outline
    points = np.asarray(sedan.vertices, dtype=np.float64)[:, None, :2] - outline[None]
    cross = edges[:, 0] * points[..., 1] - edges[:, 1] * points[..., 0]
    assert cross.min() > -1e-9


def test_arrays_are_copied():
    vertices, faces = box_arrays()
    vertices = vertices.astype(np.float32)
    faces = faces.astype(np.uint32)
    model = crashrank.Model(vertices, faces)
    before = model.vertices.copy(), model.faces.copy()
    vertices[:] = 9
    faces[:] = 0
    np.testing.assert_array_equal(model.vertices, before[0])
    np.testing.assert_array_equal(model.faces, before[1])


def test_arrays_outlive_the_model():
    model = box(2.0)
    vertices, expected = model.vertices, model.vertices.copy()
    del model
    gc.collect()
    np.testing.assert_array_equal(vertices, expected)
    assert not vertices.flags.writeable


@pytest.mark.parametrize(
    "change", ["reversed", "fortran", "big-endian", "read-only", "int", "list"]
)
def test_any_layout_gives_the_same_model(change):
    vertices, faces = box_arrays()
    want = crashrank.Model(vertices, faces)
    if change == "reversed":
        vertices, faces = vertices[::-1][::-1], np.ascontiguousarray(faces[:, ::-1])[:, ::-1]
    elif change == "fortran":
        vertices, faces = np.asfortranarray(vertices), np.asfortranarray(faces)
    elif change == "big-endian":
        vertices, faces = vertices.astype(">f8"), faces.astype(">i2")
    elif change == "read-only":
        vertices.setflags(write=False)
        faces.setflags(write=False)
    elif change == "int":
        vertices = vertices.astype(int)
    else:
        vertices, faces = vertices.tolist(), faces.tolist()
    made = crashrank.Model(vertices, faces)
    np.testing.assert_array_equal(made.vertices, want.vertices)
    np.testing.assert_array_equal(made.faces, want.faces)


def test_saved_models_load_as_they_were(tmp_path):
    vertices, faces = box_arrays()
    model = crashrank.Model(vertices, faces, {"front": 5, "rear": 7})
    file = tmp_path / "box.crm"
    model.save(file, mass_kg=12.5)
    loaded = crashrank.load_model(file)
    np.testing.assert_array_equal(loaded.vertices, model.vertices)
    np.testing.assert_array_equal(loaded.faces, model.faces)
    assert [(part.name, part.face_count) for part in loaded.parts] == [("front", 5), ("rear", 7)]
    assert loaded.mass_kg == 12.5
    assert model.mass_kg is None
    with pytest.raises(crashrank.UsageError) as error:
        model.save(file)
    assert error.value.file == str(file)
    model.save(file, overwrite=True)
    assert crashrank.load_model(file).mass_kg is None


def test_pickled_models_are_the_same(pole):
    copy = pickle.loads(pickle.dumps(pole))
    np.testing.assert_array_equal(copy.vertices, pole.vertices)
    np.testing.assert_array_equal(copy.faces, pole.faces)
    assert copy.parts == pole.parts


def test_files_are_scaled_and_turned(pole):
    turned = crashrank.load_model(DATA / "models/pole.obj", scale=2.0, forward="-x")
    want = np.asarray(pole.vertices) * np.array([-2, -2, 2], dtype=np.float32)
    np.testing.assert_array_equal(turned.vertices, want)


def test_trimesh_objects_are_models():
    trimesh = pytest.importorskip("trimesh")
    sphere = trimesh.creation.icosphere(subdivisions=2)
    model = crashrank.Model(sphere)
    np.testing.assert_array_equal(model.faces, sphere.faces)
    np.testing.assert_array_equal(model.vertices, np.asarray(sphere.vertices, dtype=np.float32))
    scene = trimesh.Scene()
    scene.add_geometry(sphere, node_name="left")
    moved = trimesh.transformations.translation_matrix([5, 0, 0])
    scene.add_geometry(trimesh.creation.box(), node_name="right", transform=moved)
    model = crashrank.Model(scene)
    assert [part.name for part in model.parts] == ["left", "right"]
    np.testing.assert_allclose(model.bounds, scene.bounds, atol=1e-6)
