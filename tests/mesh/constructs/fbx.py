"""Constructs of FBX, as text and binary."""

import struct
import zlib
from collections.abc import Callable, Sequence
from typing import Any

from .row import CORNERS, PLATE, PLATE_OUTLINE, QUADS, Point, Row, moved

Node = tuple[str, list[Any], list[Any]]  # name, properties, nodes in it


class Long(int):
    """A whole number of 64 bits."""


def vector(name: str, kind: str, *values: float) -> Node:
    return ("P", [name, kind, "", "A", *(float(value) for value in values)], [])


def lcl(name: str, *values: float) -> Node:
    return vector(f"Lcl {name}", f"Lcl {name}", *values)


def model(number: int, *properties: Node) -> Node:
    return ("Model", [Long(number), f"Model::n{number}", "Mesh"],
            [("Version", [232], []), ("Properties70", [], list(properties))])


def geometry(points: list[Point], faces: Sequence[tuple[int, ...]]) -> Node:
    ends = [i for face in faces for i in (*face[:-1], -face[-1] - 1)]
    return ("Geometry", [Long(1), "Geometry::g", "Mesh"], [
        ("Vertices", [tuple(float(x) for point in points for x in point)], []),
        ("PolygonVertexIndex", [tuple(ends)], []), ("GeometryVersion", [124], [])])


def scene(models: list[Node], links: Sequence[tuple[int, int]], unit: float = 100.0,
          shape: Node | None = None, version: int = 7400) -> list[Node]:
    return [
        ("FBXHeaderExtension", [], [
            ("FBXHeaderVersion", [1003], []), ("FBXVersion", [version], [])]),
        ("GlobalSettings", [], [("Version", [1000], []), ("Properties70", [], [
            ("P", ["UnitScaleFactor", "double", "Number", "", unit], [])])]),
        ("Objects", [], [shape or geometry(CORNERS, QUADS), *models]),
        ("Connections", [], [("C", ["OO", Long(a), Long(b)], []) for a, b in links])]


def text_node(node: Node, indent: str = "") -> str:
    name, properties, nodes = node
    words = []
    for value in properties:
        if isinstance(value, tuple):
            numbers = ",".join(f"{x:.17g}" for x in value)
            return f"{indent}{name}: *{len(value)} {{\n{indent}  a: {numbers}\n{indent}}}\n"
        words.append(f'"{value}"' if isinstance(value, str) else f"{value:.17g}")
    line = f"{indent}{name}: {','.join(words)}"
    if not nodes and properties:
        return line + "\n"
    inside = "".join(text_node(inner, indent + "  ") for inner in nodes)
    return f"{line} {{\n{inside}{indent}}}\n"


def text(nodes: list[Node]) -> str:
    return "; FBX 7.4.0 project file\n" + "".join(map(text_node, nodes))


def binary_value(value: Any, packed: Callable[[bytes], bytes] | None) -> bytes:
    if isinstance(value, str):
        name = b"\0\x01".join(reversed(value.encode().split(b"::")))
        return b"S" + struct.pack("<I", len(name)) + name
    if isinstance(value, tuple):
        kind, form = (b"d", "d") if isinstance(value[0], float) else (b"i", "i")
        data = struct.pack(f"<{len(value)}{form}", *value)
        stored = packed(data) if packed else data
        return kind + struct.pack("<III", len(value), 1 if packed else 0, len(stored)) + stored
    if isinstance(value, Long):
        return b"L" + struct.pack("<q", value)
    return b"D" + struct.pack("<d", value) if isinstance(value, float) else (
        b"I" + struct.pack("<i", value))


def binary(nodes: list[Node], version: int,
           packed: Callable[[bytes], bytes] | None = None) -> bytes:
    """A binary file: sizes have 64 bits from version 7500 on; `packed` compresses arrays."""
    head = "<QQQB" if version >= 7500 else "<IIIB"
    null = b"\0" * struct.calcsize(head)

    def write(node: Node, at: int) -> bytes:
        name, properties, inner = node
        values = b"".join(binary_value(value, packed) for value in properties)
        body = name.encode() + values
        start = at + struct.calcsize(head)
        for child in inner:
            body += write(child, start + len(body))
        if inner:
            body += null
        return struct.pack(head, start + len(body), len(properties), len(values),
                           len(name)) + body

    whole = b"Kaydara FBX Binary  \0\x1a\0" + struct.pack("<I", version)
    for node in nodes:
        whole += write(node, len(whole))
    return whole + null + b"\0" * 160


def placed(*properties: Node) -> str:
    return text(scene([model(2, *properties)], [(2, 0), (1, 2)]))


def fbx_rows() -> list[Row]:
    turned: dict[str, Any] = {"low": (-2.0, 0.0, 0.0), "high": (0.0, 4.0, 1.0)}
    plain = [(2, 0), (1, 2)]
    two: dict[str, Any] = {"triangles": 24, "area": 56.0, "parts": 2}
    zero = scene([model(2)], plain, version=7500)
    one = scene([model(2)], plain)
    return [
        Row("text.fbx", "text, faces of four corners", placed()),
        Row("binary.fbx", "binary, version 7400", binary(one, 7400)),
        Row("packed.fbx", "binary with compressed arrays", binary(one, 7400, zlib.compress)),
        Row("wide.fbx", "binary, version 7500 (64-bit sizes)", binary(zero, 7500)),
        Row("inches.fbx", "UnitScaleFactor 2.54", text(scene([model(2)], plain, 2.54)),
            area=28 * 0.0254**2, high=(4 * 0.0254, 2 * 0.0254, 0.0254)),
        Row("translation.fbx", "Lcl Translation", placed(lcl("Translation", 1, 2, 3)),
            **moved((1, 2, 3))),
        Row("rotation.fbx", "Lcl Rotation about z", placed(lcl("Rotation", 0, 0, 90)), **turned),
        Row("rotation_xyz.fbx", "Lcl Rotation, x before z", placed(lcl("Rotation", 90, 0, 90)),
            high=(1, 4, 2)),
        Row("rotation_order.fbx", "RotationOrder 5: z before x", placed(
            ("P", ["RotationOrder", "enum", "", "", 5], []), lcl("Rotation", 90, 0, 90)),
            low=(-2, -1, 0), high=(0, 0, 4)),
        Row("scaling.fbx", "Lcl Scaling", placed(lcl("Scaling", 2, 1, 1)), area=52.0,
            high=(8, 2, 1)),
        Row("mirrored.fbx", "mirroring Lcl Scaling", placed(lcl("Scaling", -1, 1, 1)),
            low=(-4, 0, 0), high=(0, 2, 1)),
        Row("pre_rotation.fbx", "PreRotation", placed(
            ("P", ["RotationActive", "bool", "", "", 1], []),
            vector("PreRotation", "Vector3D", 0, 0, 90)), **turned),
        Row("rotation_pivot.fbx", "RotationPivot", placed(
            vector("RotationPivot", "Vector3D", 4, 0, 0), lcl("Rotation", 0, 0, 90)),
            low=(2, -4, 0), high=(4, 0, 1)),
        Row("scaling_pivot.fbx", "ScalingPivot", placed(
            vector("ScalingPivot", "Vector3D", 4, 0, 0), lcl("Scaling", 2, 1, 1)), area=52.0,
            low=(-4, 0, 0), high=(4, 2, 1)),
        Row("geometric.fbx", "GeometricTranslation", placed(
            vector("GeometricTranslation", "Vector3D", 0, 0, 5)), **moved((0, 0, 5))),
        Row("geometric_child.fbx", "GeometricTranslation does not move what hangs on the node",
            text(scene([model(2, vector("GeometricTranslation", "Vector3D", 0, 0, 5)),
                        model(3)], [(2, 0), (3, 2), (1, 2), (1, 3)])), high=(4, 2, 6), **two),
        Row("nested.fbx", "models on models", text(scene(
            [model(2, lcl("Translation", 1, 0, 0)), model(3, lcl("Translation", 0, 2, 3))],
            [(2, 0), (3, 2), (1, 3)])), **moved((1, 2, 3))),
        Row("instances.fbx", "a geometry of two models", text(scene(
            [model(2), model(3, lcl("Translation", 10, 0, 0))],
            [(2, 0), (3, 0), (1, 2), (1, 3)])), high=(14, 2, 1), **two),
        Row("hole.fbx", "polygon with a hole joined by an edge there and back", text(scene(
            [model(2)], plain, shape=geometry(PLATE, [PLATE_OUTLINE]))), triangles=8, area=8.0,
            high=(3, 3, 0)),
    ]
