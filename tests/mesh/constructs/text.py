"""Constructs of OBJ, STL, PLY and OFF."""

import struct
from typing import Any

from .row import CORNERS, PLATE, PLATE_OUTLINE, QUADS, TRIANGLES, Point, Row, lines

PLATE_SURFACE: dict[str, Any] = {"triangles": 8, "area": 8.0, "high": (3.0, 3.0, 0.0)}


def obj_faces(faces: list[tuple[int, ...]], style: str = "{0}", count: int = 0) -> str:
    """Lines of faces; with a count of vertices, indices are relative."""
    return "".join(
        "f " + " ".join(style.format(i - count if count else i + 1) for i in face) + "\n"
        for face in faces
    )


def obj_rows() -> list[Row]:
    vertices = lines("v ", CORNERS)
    quads = obj_faces(QUADS)
    second = lines("v ", [(x + 10, y, z) for x, y, z in CORNERS])
    relative = obj_faces(QUADS, count=8)
    continued = quads.replace(" ", " \\\n ")
    return [
        Row("quads.obj", "faces of four corners", vertices + quads),
        Row("relative.obj", "negative indices after each block of vertices",
            "o a\n" + vertices + relative + "o b\n" + second + relative,
            triangles=24, area=56.0, high=(14.0, 2.0, 1.0), parts=2),
        Row("vt_vn.obj", "corners v/vt/vn, v//vn and v/vt",
            vertices + "vt 0 0\nvn 0 0 1\n" + obj_faces(QUADS[:2], "{0}/1/1")
            + obj_faces(QUADS[2:4], "{0}//1") + obj_faces(QUADS[4:], "{0}/1")),
        Row("relative_vt_vn.obj", "negative v/vt/vn",
            vertices + "vt 0 0\nvn 0 0 1\n" + obj_faces(QUADS, "{0}/-1/-1", 8)),
        Row("colours.obj", "v x y z r g b", vertices.replace("\n", " 0.5 0.25 1\n") + quads),
        Row("weights.obj", "v x y z w: the weight of rational curves, 1 for surfaces",
            vertices.replace("\n", " 1\n") + quads),
        Row("continued.obj", "lines continued by a backslash", vertices + continued),
        Row("crlf.obj", "lines that end in CR LF, comments, blanks, tabs",
            ("# box\n\n" + vertices + "\t\n# faces\n" + quads.replace(" ", "\t"))
            .replace("\n", "\r\n")),
        Row("numbers.obj", "exponents, signs, no digits before or after the point",
            vertices.replace("v 4 ", "v +.4E1 ").replace("v 0 ", "v -0.e0 ") + quads),
        Row("groups.obj", "groups of several names, smoothing groups, materials without a library",
            vertices + "g front body\ns 1\n" + obj_faces(QUADS[:3]) + "g rear\ns off\nusemtl m\n"
            + obj_faces(QUADS[3:]), parts=2),
        Row("points_lines.obj", "points and lines beside faces",
            vertices + "v 9 9 9\np 9\nl 1 2 9\n" + quads),
        Row("later.obj", "faces before their vertices", quads + vertices),
        Row("hole.obj", "polygon with a hole joined by an edge there and back",
            lines("v ", PLATE) + obj_faces([PLATE_OUTLINE]), **PLATE_SURFACE),
        Row("indented.obj", "indented lines", (vertices + quads).replace("\n", "\n  "),
            refused="line 2: the vertex is lost"),
    ]


def facets(end: str = "\n", upper: bool = False, normal: str = "0 0 0") -> str:
    text = "".join(
        f" facet normal {normal}\n  outer loop\n"
        + lines("   vertex ", [CORNERS[i] for i in triangle])
        + "  endloop\n endfacet\n"
        for triangle in TRIANGLES
    )
    return (text.upper() if upper else text).replace("\n", end)


def binary_stl(header: bytes, attribute: int = 0) -> bytes:
    body = b"".join(
        struct.pack("<3f", 0, 0, 0)
        + b"".join(struct.pack("<3f", *CORNERS[i]) for i in triangle)
        + struct.pack("<H", attribute)
        for triangle in TRIANGLES
    )
    return header.ljust(80, b"\0") + struct.pack("<I", len(TRIANGLES)) + body


def stl_rows() -> list[Row]:
    second = facets().replace("vertex ", "vertex 1")  # 10 or 14 m to the front
    return [
        Row("text.stl", "text", "solid box\n" + facets() + "endsolid box\n"),
        Row("no_name.stl", "text without a name", "solid\n" + facets() + "endsolid\n"),
        Row("crlf.stl", "text, lines end in CR LF",
            ("solid box\n" + facets() + "endsolid box\n").replace("\n", "\r\n")),
        Row("upper.stl", "text in capitals",
            "SOLID BOX\n" + facets(upper=True) + "ENDSOLID BOX\n", refused="neither a text"),
        Row("two_solids.stl", "two solids in a file",
            "solid a b\n" + facets() + "endsolid a b\nsolid c\n" + second + "endsolid c\n",
            triangles=24, area=56.0, high=(14.0, 2.0, 1.0), parts=2),
        Row("normals.stl", "normals that contradict the corners",
            "solid box\n" + facets(normal="0 0 -1") + "endsolid box\n"),
        Row("binary.stl", "binary", binary_stl(b"box")),
        Row("binary_solid.stl", "binary, header begins with solid", binary_stl(b"solid box")),
        Row("binary_attributes.stl", "binary with attributes (colours)",
            binary_stl(b"COLOR=\xff\xff\xff\xff", 0xffff)),
    ]


def ply(form: str, elements: str, body: bytes | str) -> bytes:
    header = f"ply\nformat {form} 1.0\ncomment by hand\nobj_info none\n{elements}end_header\n"
    return header.encode() + (body.encode() if isinstance(body, str) else body)


def ply_elements(kind: str = "float", before: str = "", after: str = "", count: str = "uchar",
                 index: str = "int", name: str = "vertex_indices") -> str:
    coordinates = "".join(f"property {kind} {axis}\n" for axis in "xyz")
    return (f"element vertex 8\n{before}{coordinates}{after}"
            f"element face 6\nproperty list {count} {index} {name}\n")


def ply_faces(faces: list[tuple[int, ...]]) -> str:
    return "".join(f"{len(face)} {' '.join(map(str, face))}\n" for face in faces)


def ply_binary(order: str, real: str, count: str, index: str) -> bytes:
    return b"".join(struct.pack(f"{order}3{real}", *corner) for corner in CORNERS) + b"".join(
        struct.pack(f"{order}{count}4{index}", 4, *quad) for quad in QUADS)


def ply_rows() -> list[Row]:
    vertices = lines("", CORNERS)
    faces = ply_faces(QUADS)
    normals = "".join(f"property float n{axis}\n" for axis in "xyz")
    colours = "".join(f"property uchar {name}\n" for name in ("red", "green", "blue"))
    half: dict[str, Any] = {"triangles": 2, "area": 8.0, "high": (4.0, 2.0, 0.0)}
    return [
        Row("text.ply", "text, faces of four corners",
            ply("ascii", ply_elements(), vertices + faces)),
        Row("vertex_index.ply", "list named vertex_index",
            ply("ascii", ply_elements(name="vertex_index"), vertices + faces)),
        Row("little.ply", "little-endian floats", ply(
            "binary_little_endian", ply_elements(), ply_binary("<", "f", "B", "i"))),
        Row("big.ply", "big-endian floats", ply(
            "binary_big_endian", ply_elements(), ply_binary(">", "f", "B", "i"))),
        Row("doubles.ply", "little-endian doubles, 16-bit counts and indices", ply(
            "binary_little_endian", ply_elements("double", count="ushort", index="ushort"),
            ply_binary("<", "d", "H", "H"))),
        Row("big_doubles.ply", "big-endian float64, 32-bit counts", ply(
            "binary_big_endian", ply_elements("float64", count="uint32", index="uint32"),
            ply_binary(">", "d", "I", "I"))),
        Row("shorts.ply", "coordinates of 16-bit integers", ply(
            "binary_little_endian", ply_elements("short", index="uchar"),
            b"".join(struct.pack("<3h", *corner) for corner in CORNERS)
            + b"".join(struct.pack("<B4B", 4, *quad) for quad in QUADS))),
        Row("before_after.ply", "normals before and colours after the coordinates", ply(
            "ascii", ply_elements(before=normals, after=colours),
            "".join(f"0 0 1 {line} 9 8 7\n" for line in vertices.splitlines()) + faces)),
        Row("face_properties.ply", "properties of faces before and after the list", ply(
            "ascii",
            ply_elements().replace("property list", "property float q\nproperty list")
            + "property uchar red\n",
            vertices + "".join(f"0.5 {line} 255\n" for line in faces.splitlines()))),
        Row("edges.ply", "another element between vertices and faces", ply(
            "ascii", ply_elements().replace(
                "element face", "element edge 1\nproperty int vertex1\nproperty int vertex2\n"
                "element face"), vertices + "0 1\n" + faces)),
        Row("crlf.ply", "header and lines end in CR LF",
            ply("ascii", ply_elements(), vertices + faces).replace(b"\n", b"\r\n")),
        Row("hole.ply", "polygon with a hole joined by an edge there and back", ply(
            "ascii", ply_elements().replace("element face 6", "element face 1"),
            lines("", PLATE) + ply_faces([PLATE_OUTLINE])), **PLATE_SURFACE),
        Row("strips.ply", "element tristrips, restarted by -1", ply(
            "ascii", "element vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
            "element tristrips 1\nproperty list int int vertex_indices\n",
            vertices + "8 0 1 3 -1 1 2 3 -1\n"), refused="'tristrips' has lists", **half),
        Row("faces_first.ply", "faces before vertices", ply(
            "ascii", "element face 6\nproperty list uchar int vertex_indices\n"
            "element vertex 8\nproperty float x\nproperty float y\nproperty float z\n",
            faces + vertices), refused="'face' stands before"),
    ]


def off(header: str, points: list[Point], faces: str, suffix: str = "") -> str:
    return header + "".join(line + suffix + "\n" for line in lines("", points).splitlines()) + faces


def off_rows() -> list[Row]:
    faces = ply_faces(QUADS)
    ten = ply_faces([PLATE_OUTLINE])
    binary = (b"OFF BINARY\n" + struct.pack(">3i", 8, 6, 0)
              + b"".join(struct.pack(">3f", *corner) for corner in CORNERS)
              + b"".join(struct.pack(">6i", 4, *quad, 0) for quad in QUADS))
    return [
        Row("plain.off", "faces of four corners", off("OFF\n8 6 12\n", CORNERS, faces)),
        Row("one_line.off", "counts in the first line", off("OFF 8 6 12\n", CORNERS, faces)),
        Row("comments.off", "comments and empty lines",
            off("OFF\n# box\n\n8 6 12\n", CORNERS, "\n" + faces)),
        Row("face_comments.off", "comments among the faces",
            off("OFF\n8 6 12\n", CORNERS, "# faces\n" + faces), warned="comments",
            listed="10 triangles"),
        Row("no_header.off", "without the word OFF", off("8 6 12\n", CORNERS, faces)),
        Row("colours.off", "COFF: colours after the coordinates",
            off("COFF\n8 6 12\n", CORNERS, faces, " 255 128 0 255")),
        Row("normals.off", "NOFF: normals after the coordinates",
            off("NOFF\n8 6 12\n", CORNERS, faces, " 0 0 1")),
        Row("textures.off", "STOFF: texture coordinates last",
            off("STOFF\n8 6 12\n", CORNERS, faces, " 0.5 0.5")),
        Row("weights.off", "4OFF: x y z w",
            off("4OFF\n8 6 12\n", CORNERS, faces, " 1")),
        Row("dimension.off", "nOFF: the dimension before the counts",
            off("nOFF\n3\n8 6 12\n", CORNERS, faces)),
        Row("face_colours.off", "colours of faces after their indices",
            off("OFF\n8 6 12\n", CORNERS, faces.replace("\n", " 255 0 0\n"))),
        Row("binary.off", "OFF BINARY, big-endian", binary, refused="binary"),
        Row("ten_corners.off", "face of ten corners", off("OFF\n8 1 0\n", PLATE, ten),
            refused="more than nine corners", **PLATE_SURFACE),
    ]
