"""Bodies: a mesh with the trees over it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._checks import (
    MAX_FACES,
    MAX_VERTICES,
    as_array,
    as_count,
    as_flag,
    as_number,
    as_path,
    as_text,
    as_triple,
    check_size,
    contiguous,
)
from ._errors import bad_input, checked_call, usage, wrong_type

MAX_PARTS = 100_000


class Part(NamedTuple):
    """A named run of consecutive triangles: a bumper, a door."""

    name: str
    """Unique within the model."""
    first_face: int
    """Index of its first triangle."""
    face_count: int
    """Number of its triangles."""

    @property
    def faces(self) -> slice:
        """Its triangles: ``model.faces[part.faces]``."""
        return slice(self.first_face, self.first_face + self.face_count)


class Model:
    """A body's surface and the trees over it, ready for queries.

    A model never changes. Any number of threads may use it at the same time.

    Parameters
    ----------
    vertices : array_like, shape (V, 3)
        Body coordinates in m: x forward, y left, z up. Copied, and rounded to float32.
        A ``trimesh.Trimesh`` or ``trimesh.Scene`` stands for vertices, faces and, of a scene, a
        part for each of its nodes.
    faces : array_like of int, shape (F, 3)
        Indices of the corners of each triangle. Copied. Their order is kept: a triangle's index
        in every result is its row here. Degenerate and duplicate triangles keep their places.
    parts : mapping or iterable, optional
        Names and numbers of triangles, in the order of the faces: ``{"body": 120, "wheel": 40}``
        or pairs. The numbers sum to F. Default: one part, ``body``.

    Raises
    ------
    BadInputError
        For wrong shapes, indices without a vertex and coordinates that are not finite.
    LimitError
        For more than 60 million vertices or 20 million faces.

    Examples
    --------
    >>> import crashrank
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> crashrank.Model(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    Model(4 vertices, 4 faces, 1 part)
    """

    __slots__ = ("__weakref__", "_body")

    _body: _core.Body

    @checked_call
    def __init__(
        self,
        vertices: ArrayLike | Any,
        faces: ArrayLike | None = None,
        parts: Mapping[str, int] | Iterable[tuple[str, int]] | None = None,
    ) -> None:
        if faces is None:
            vertices, faces, found = _from_trimesh(vertices)
            parts = parts if parts is not None else found
        points = _as_vertices(vertices)
        corners = _as_faces(faces, len(points))
        self._body = _core.make_body(points, corners, _as_parts(parts, len(corners)))

    @classmethod
    def _of(cls, body: _core.Body) -> Model:
        model = cls.__new__(cls)
        model._body = body
        return model

    @property
    def vertices(self) -> NDArray[np.float32]:
        """Vertices in body coordinates, m; (V, 3), read-only, not copied."""
        return self._body.vertices

    @property
    def faces(self) -> NDArray[np.uint32]:
        """Corner indices of the triangles; (F, 3), read-only, not copied."""
        return self._body.faces

    @property
    def bounds(self) -> NDArray[np.float64]:
        """Lowest and highest corner of the axis-aligned box, body coordinates, m; (2, 3)."""
        return np.array(self._body.bounds, dtype=np.float64)

    @property
    def extents(self) -> NDArray[np.float64]:
        """Length, width and height of the box, m; (3,)."""
        bounds = self.bounds
        return np.asarray(bounds[1] - bounds[0], dtype=np.float64)

    @property
    def parts(self) -> tuple[Part, ...]:
        """Named parts in the order of their triangles; they cover all faces without overlap."""
        return tuple(Part(*part) for part in self._body.parts)

    @property
    def outline(self) -> NDArray[np.float64]:
        """Convex hull seen from above, counter-clockwise, body coordinates, m; (K, 2)."""
        return self._body.outline

    @property
    def mass_kg(self) -> float | None:
        """Mass in kg that the model file states; None where it states none."""
        return self._body.mass_kg

    @property
    def warnings(self) -> tuple[str, ...]:
        """What was found in the file that the model was loaded from, one sentence each."""
        return tuple(self._body.warnings)

    @checked_call
    def save(
        self,
        path: object,
        *,
        overwrite: bool = False,
        mass_kg: float | None = None,
    ) -> None:
        """Write a model file: mesh, trees and outlines in one checked file.

        The file is written as a whole or not at all. It is accepted wherever a mesh is, and loads
        without the importer.

        Parameters
        ----------
        path : path
            The file to write, by custom ``*.crm``.
        overwrite : bool
            Replace a file of that name. Default: raise `UsageError`.
        mass_kg : float, optional
            Mass with all aboard, kg, stored in the file for scenarios that give none.
        """
        mass = None if mass_kg is None else as_number(mass_kg, "mass_kg", "kg")
        _core.save_body(self._body, as_path(path, "path"), as_flag(overwrite, "overwrite"), mass)

    def __repr__(self) -> str:
        """Return sizes."""
        parts = len(self._body.parts)
        return (
            f"Model({len(self.vertices)} vertices, {len(self.faces)} faces, "
            f"{parts} part{'s' if parts != 1 else ''})"
        )

    def __reduce__(self) -> tuple[object, tuple[object, ...]]:
        """Pickle vertices, faces and parts; the trees are built again."""
        parts = [(part.name, part.face_count) for part in self.parts]
        return Model, (np.array(self.vertices), np.array(self.faces), parts)


@checked_call
def load_model(
    path: object,
    *,
    scale: float = 1.0,
    up: str = "+z",
    forward: str = "+x",
    origin_m: ArrayLike = (0.0, 0.0, 0.0),
) -> Model:
    """Load a mesh file or a compiled model file.

    Meshes may be OBJ, STL, PLY, OFF, glTF/GLB, Collada, FBX, 3DS or AC3D. They are parsed in a
    process of its own with limits on memory, time and files. File coordinates are turned so that
    `forward` is +x and `up` is +z, scaled, then `origin_m` is subtracted.

    Parameters
    ----------
    path : path
        The file.
    scale : float
        Metres per unit of the file.
    up, forward : {'+x', '-x', '+y', '-y', '+z', '-z'}
        Axes of the file that point up and forward.
    origin_m : array_like, shape (3,)
        Point in body axes, after scaling, that becomes 0; m.

    Returns
    -------
    Model

    Raises
    ------
    NotFoundError, BadInputError, LimitError
        For a file that is missing, damaged or too large.
    UsageError
        For a transform that is none, or one given for a model file, which is in body coordinates
        already.
    """
    body = _core.load_body(
        as_path(path, "path"),
        as_number(scale, "scale", "metres per unit of the file"),
        as_text(up, "up"),
        as_text(forward, "forward"),
        as_triple(origin_m, "origin_m"),
    )
    return Model._of(body)


def _as_vertices(value: object) -> NDArray[np.float32]:
    array = as_array(value, "vertices", "fiu", "numbers")
    if array.ndim != 2 or array.shape[1] != 3:
        raise bad_input("vertices", f"has the shape {array.shape}", "give the shape (V, 3)")
    check_size(array.shape[0], MAX_VERTICES, "vertices", "rows")
    points = contiguous(array, np.float32, "vertices")
    finite = np.isfinite(points).all(axis=1)
    if not bool(finite.all()):
        row = int(np.argmin(finite))
        raise bad_input(f"vertices[{row}]", "is not finite in float32", "repair the mesh")
    return points


def _as_faces(value: object, vertices: int) -> NDArray[np.uint32]:
    array = as_array(value, "faces", "iu", "integers")
    if array.ndim != 2 or array.shape[1] != 3:
        raise bad_input("faces", f"has the shape {array.shape}", "give the shape (F, 3)")
    check_size(array.shape[0], MAX_FACES, "faces", "rows")
    if array.shape[0] == 0:
        raise bad_input("faces", "holds no triangle", "give at least one")
    low, high = int(array.min()), int(array.max())
    if low < 0 or high >= vertices:
        raise bad_input(
            "faces",
            f"names vertex {low if low < 0 else high}, there are {vertices}",
            "number vertices from 0",
        )
    return contiguous(array, np.uint32, "faces")


def _as_parts(value: object, faces: int) -> list[tuple[str, int, int]]:
    if value is None:
        return [("body", 0, faces)]
    try:
        pairs = list(value.items() if isinstance(value, Mapping) else value)  # type: ignore[call-overload]
        named = [(name, count) for name, count in pairs]
    except (TypeError, ValueError):
        raise wrong_type(
            "parts", "are no pairs of a name and a number of triangles", "give a dict"
        ) from None
    check_size(len(named), MAX_PARTS, "parts", "names")
    parts: list[tuple[str, int, int]] = []
    first = 0
    names: set[str] = set()
    for i, (name, count) in enumerate(named):
        text = as_text(name, f"parts[{i}]")
        if text in names or not text or len(text.encode()) > 256:
            raise bad_input(
                f"parts[{i}]",
                "has no name, a long one or that of another part",
                "give different names of 1 to 256 bytes",
            )
        names.add(text)
        size = as_count(count, f"parts[{i}]", 0, faces)
        parts.append((text, first, size))
        first += size
    if first != faces:
        raise bad_input("parts", f"have {first} triangles, the model {faces}", "cover all faces")
    return parts


def _from_trimesh(value: Any) -> tuple[Any, Any, list[tuple[str, int]] | None]:
    """Vertices, faces and parts of a Trimesh, or of a Scene with one part for each node."""
    if hasattr(value, "graph") and hasattr(value, "geometry"):
        return _from_scene(value)
    if hasattr(value, "vertices") and hasattr(value, "faces"):
        return value.vertices, value.faces, None
    raise usage("faces", "are missing", "give vertices and faces, or a trimesh object")


def _from_scene(scene: Any) -> tuple[Any, Any, list[tuple[str, int]]]:
    vertices: list[NDArray[np.float64]] = []
    faces: list[NDArray[np.int64]] = []
    parts: list[tuple[str, int]] = []
    count = 0
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        mesh = scene.geometry[name]
        if not hasattr(mesh, "faces"):
            continue  # a path or a cloud of points
        turned = np.asarray(mesh.vertices) @ np.asarray(transform)[:3, :3].T
        vertices.append(turned + np.asarray(transform)[:3, 3])
        corners = np.asarray(mesh.faces, dtype=np.int64)
        if np.linalg.det(np.asarray(transform)[:3, :3]) < 0:
            corners = corners[:, ::-1]  # a mirrored mesh keeps its outside
        faces.append(corners + count)
        count += len(turned)
        parts.append((str(node), len(corners)))
    if not faces:
        raise bad_input("vertices", "is a scene without a mesh", "add a mesh to it")
    return np.concatenate(vertices), np.concatenate(faces), parts
