"""Constructs of Collada, 3DS and AC3D."""

import struct
from collections.abc import Iterable
from typing import Any

from .row import CORNERS, PLATE, PLATE_OUTLINE, QUADS, TRIANGLES, Point, Row, moved

TURNED: dict[str, Any] = {"low": (-2.0, 0.0, 0.0), "high": (0.0, 4.0, 1.0)}  # by 90 degrees about z
TWO: dict[str, Any] = {"triangles": 24, "area": 56.0, "parts": 2}
BOTTOM: dict[str, Any] = {"triangles": 2, "area": 8.0, "high": (4.0, 2.0, 0.0)}


def join(numbers: Iterable[Iterable[float]]) -> str:
    return " ".join(f"{x:g}" for point in numbers for x in point)


VERTEX = '<input semantic="VERTEX" source="#v" offset="0"/>'
INDICES = join(TRIANGLES)
FACES = f'<triangles count="12">{VERTEX}<p>{INDICES}</p></triangles>'
XYZ = "".join(f'<param name="{axis}" type="float"/>' for axis in "XYZ")


def source(points: list[Point], accessor: str = "", numbers: str = "") -> str:
    numbers = numbers or join(points)
    count = len(points)
    accessor = accessor or f'<accessor source="#a" count="{count}" stride="3">{XYZ}</accessor>'
    return (f'<source id="p"><float_array id="a" count="{len(numbers.split())}">{numbers}'
            f"</float_array><technique_common>{accessor}</technique_common></source>")


GEOMETRY = '<instance_geometry url="#g"/>'


def dae(faces: str = FACES, nodes: str = f'<node id="n">{GEOMETRY}</node>', asset: str = "",
        libraries: str = "", points: str = "", scenes: str = "", version: str = "1.4.1") -> str:
    schema = "2008/03" if version == "1.5.0" else "2005/11"
    scenes = scenes or f'<visual_scene id="s">{nodes}</visual_scene>'
    return f"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/{schema}/COLLADASchema" version="{version}">
<asset>{asset}</asset><library_geometries><geometry id="g"><mesh>{points or source(CORNERS)}
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>{faces}</mesh></geometry>
</library_geometries>{libraries}<library_visual_scenes>{scenes}</library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
"""


def dae_node(transform: str) -> str:
    return dae(nodes=f'<node id="n">{transform}{GEOMETRY}</node>')


def collada_rows() -> list[Row]:
    quads = f'<vcount>{" ".join("4" * 6)}</vcount><p>{join(QUADS)}</p>'
    loops = "".join(f"<p>{' '.join(map(str, quad))}</p>" for quad in QUADS)
    shared = ('<input semantic="VERTEX" source="#v" offset="1"/>'
              '<input semantic="TEXCOORD" source="#p" offset="0"/>')
    twice = " ".join(f"0 {i}" for i in INDICES.split())
    padded = "9 " + " ".join(join([point]) + " 7" for point in CORNERS)
    stride = f'<accessor source="#a" count="8" offset="1" stride="4">{XYZ}</accessor>'
    unnamed = ('<accessor source="#a" count="8" stride="4"><param type="float"/>'
               f"{XYZ}</accessor>")
    lookat = "<lookat>1 2 3 1 2 2 0 1 0</lookat>"
    group = f'<library_nodes><node id="b">{GEOMETRY}</node></library_nodes>'
    instances = ('<node id="n"><instance_node url="#b"/></node><node id="m">'
                 '<translate>10 0 0</translate><instance_node url="#b"/></node>')
    skin = """<library_controllers><controller id="c"><skin source="#g">
<source id="j"><Name_array id="ja" count="1">n</Name_array><technique_common>
<accessor source="#ja" count="1" stride="1"><param name="JOINT" type="name"/></accessor>
</technique_common></source><source id="b"><float_array id="ba" count="16">
1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</float_array><technique_common>
<accessor source="#ba" count="1" stride="16"><param name="TRANSFORM" type="float4x4"/></accessor>
</technique_common></source><source id="w"><float_array id="wa" count="1">1</float_array>
<technique_common><accessor source="#wa" count="1" stride="1"><param name="WEIGHT" type="float"/>
</accessor></technique_common></source><joints><input semantic="JOINT" source="#j"/>
<input semantic="INV_BIND_MATRIX" source="#b"/></joints><vertex_weights count="8">
<input semantic="JOINT" source="#j" offset="0"/><input semantic="WEIGHT" source="#w" offset="1"/>
<vcount>1 1 1 1 1 1 1 1</vcount><v>0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0</v></vertex_weights></skin>
</controller></library_controllers>"""
    return [
        Row("triangles.dae", "triangles", dae()),
        Row("polylist.dae", "polylist",
            dae(f'<polylist count="6">{VERTEX}{quads}</polylist>')),
        Row("polygons.dae", "polygons", dae(f'<polygons count="6">{VERTEX}{loops}</polygons>')),
        Row("holes.dae", "polygons with holes (ph, h)", dae(
            f'<polygons count="1">{VERTEX}<ph><p>0 1 2 3</p><h>4 5 6 7</h></ph></polygons>',
            points=source(PLATE)), triangles=8, area=8.0, high=(3.0, 3.0, 0.0), refused="hole"),
        Row("joined_hole.dae", "polygon with a hole joined by an edge there and back", dae(
            f'<polylist count="1">{VERTEX}<vcount>10</vcount><p>'
            f"{' '.join(map(str, PLATE_OUTLINE))}</p></polylist>", points=source(PLATE)),
            triangles=8, area=8.0, high=(3.0, 3.0, 0.0)),
        Row("strips.dae", "tristrips", dae(
            f'<tristrips count="1">{VERTEX}<p>0 1 3 2</p></tristrips>'), **BOTTOM),
        Row("fans.dae", "trifans", dae(
            f'<trifans count="1">{VERTEX}<p>0 1 2 3</p></trifans>'), **BOTTOM),
        Row("two_strips.dae", "several strips in one element", dae(
            f'<tristrips count="2">{VERTEX}<p>0 1 3</p><p>1 2 3</p></tristrips>'), **BOTTOM),
        Row("lines.dae", "lines and linestrips beside triangles", dae(
            f'<lines count="1">{VERTEX}<p>0 6</p></lines>{FACES}'
            f'<linestrips count="1">{VERTEX}<p>0 1 6</p></linestrips>')),
        Row("offsets.dae", "several indices a corner", dae(
            f'<triangles count="12">{shared}<p>{twice}</p></triangles>')),
        Row("stride.dae", "accessor with offset and stride",
            dae(points=source(CORNERS, stride, padded))),
        Row("unnamed.dae", "accessor that skips an unnamed parameter",
            dae(points=source(CORNERS, unnamed, padded[:-2]))),
        Row("groups.dae", "two groups of triangles in a mesh", dae(
            f'<triangles count="6">{VERTEX}<p>{join(TRIANGLES[:6])}</p></triangles>'
            f'<triangles count="6">{VERTEX}<p>{join(TRIANGLES[6:])}</p></triangles>'), parts=2),
        Row("inches.dae", "unit of 0.0254 m", dae(asset='<unit name="inch" meter="0.0254"/>'),
            area=28 * 0.0254**2, high=(4 * 0.0254, 2 * 0.0254, 0.0254)),
        Row("translate.dae", "translate", dae_node("<translate>1 2 3</translate>"),
            **moved((1, 2, 3))),
        Row("rotate.dae", "rotate", dae_node("<rotate>0 0 1 90</rotate>"), **TURNED),
        Row("order.dae", "translate, rotate, scale, translate in their order", dae_node(
            "<translate>1 0 0</translate><rotate>0 0 1 90</rotate><scale>2 1 1</scale>"
            "<translate>0 1 0</translate>"), area=52.0, low=(-2, 0, 0), high=(0, 8, 1)),
        Row("matrix.dae", "matrix", dae_node(
            "<matrix>0 -1 0 0 1 0 0 0 0 0 1 0 0 0 0 1</matrix>"), **TURNED),
        Row("lookat.dae", "lookat", dae_node(lookat), **moved((1, 2, 3))),
        Row("skew.dae", "skew", dae_node("<skew>45 1 0 0 0 1 0</skew>"), refused="skew"),
        Row("mirrored.dae", "mirroring scale", dae_node("<scale>-1 1 1</scale>"),
            low=(-4, 0, 0), high=(0, 2, 1)),
        Row("nested.dae", "nodes in nodes", dae(
            nodes='<node id="o"><translate>1 0 0</translate><node id="n"><translate>0 2 3'
            f"</translate>{GEOMETRY}</node></node>"), **moved((1, 2, 3))),
        Row("instances.dae", "a geometry of two nodes", dae(
            nodes=f'<node id="n">{GEOMETRY}</node><node id="m"><translate>10 0 0</translate>'
            f"{GEOMETRY}</node>"), high=(14, 2, 1), **TWO),
        Row("library_nodes.dae", "instance_node", dae(nodes=instances, libraries=group),
            high=(14, 2, 1), **TWO),
        Row("scenes.dae", "two scenes, the first is instanced", dae(
            scenes=f'<visual_scene id="t"><node id="m">{GEOMETRY}{GEOMETRY}</node></visual_scene>'
            f'<visual_scene id="s"><node id="n">{GEOMETRY}</node></visual_scene>')),
        Row("unused.dae", "a geometry of no node", dae(nodes='<node id="n"/>'), refused="triangle"),
        Row("up.dae", "up_axis Y_UP: axes stay", dae(asset="<up_axis>Y_UP</up_axis>")),
        Row("skin.dae", "skin of one joint that does not move", dae(
            nodes='<node id="n" sid="n" type="JOINT"/><node id="m"><instance_controller url="#c">'
            "<skeleton>#n</skeleton></instance_controller></node>", libraries=skin)),
        Row("version15.dae", "version 1.5.0", dae(version="1.5.0")),
    ]


def chunk(number: int, content: bytes) -> bytes:
    return struct.pack("<HI", number, 6 + len(content)) + content


def track(number: int, *values: float) -> bytes:
    key = struct.pack("<IH", 0, 0) + struct.pack(f"<{len(values)}f", *values)
    return chunk(number, struct.pack("<HIII", 0, 0, 0, 1) + key)


IDENTITY = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)


def object_3ds(name: str, points: list[Point], matrix: tuple[float, ...] = ()) -> bytes:
    mesh = chunk(0x4110, struct.pack("<H", len(points))
                 + b"".join(struct.pack("<3f", *point) for point in points))
    if matrix:
        mesh += chunk(0x4160, struct.pack("<12f", *matrix))
    mesh += chunk(0x4120, struct.pack("<H", len(TRIANGLES))
                  + b"".join(struct.pack("<4H", *triangle, 7) for triangle in TRIANGLES))
    return chunk(0x4000, name.encode() + b"\0" + chunk(0x4100, mesh))


def node_3ds(name: str, number: int, parent: int = 0xFFFF, tracks: bytes = b"",
             pivot: Point = (0, 0, 0)) -> bytes:
    head = chunk(0xB030, struct.pack("<H", number))
    head += chunk(0xB010, name.encode() + b"\0" + struct.pack("<HHH", 0, 0, parent))
    return chunk(0xB002, head + chunk(0xB013, struct.pack("<3f", *pivot)) + tracks)


def file_3ds(objects: bytes, nodes: bytes = b"", unit: float = 0.0) -> bytes:
    scale = chunk(0x0100, struct.pack("<f", unit)) if unit else b""
    frames = chunk(0xB000, nodes) if nodes else b""
    return chunk(0x4D4D, chunk(0x3D3D, scale + objects) + frames)


def rows_3ds() -> list[Row]:
    box = object_3ds("box", CORNERS)
    placed = object_3ds("box", CORNERS, (*IDENTITY, 5.0, 0.0, 0.0))
    here = node_3ds("box", 0, tracks=track(0xB020, 5, 0, 0))
    parent = node_3ds("box", 0, tracks=track(0xB020, 1, 0, 0))
    other = object_3ds("other", [(x + 10, y, z) for x, y, z in CORNERS])
    return [
        Row("plain.3ds", "mesh without keyframer", file_3ds(box)),
        Row("two.3ds", "two objects", file_3ds(box + other), high=(14, 2, 1), **TWO),
        Row("scale.3ds", "master scale 25.4 (no unit of coordinates)", file_3ds(box, unit=25.4)),
        Row("matrix.3ds", "mesh matrix, undone by the keyframer's place", file_3ds(placed, here)),
        Row("matrix_alone.3ds", "mesh matrix without keyframer", file_3ds(placed)),
        Row("key.3ds", "keyframer's place beside the mesh matrix's", file_3ds(
            placed, node_3ds("box", 0, tracks=track(0xB020, 7, 0, 3))), **moved((2, 0, 3))),
        Row("pivot.3ds", "pivot", file_3ds(
            box, node_3ds("box", 0, tracks=track(0xB020, 0, 0, 0), pivot=(1, 2, 0))),
            **moved((-1, -2, 0))),
        Row("hierarchy.3ds", "keyframer's nodes on each other", file_3ds(
            box + object_3ds("other", CORNERS),
            parent + node_3ds("other", 1, 0, track(0xB020, 0, 0, 3))),
            low=(1, 0, 0), high=(5, 2, 4), **TWO),
    ]


def ac3d(objects: str, kids: int = 1) -> str:
    return ('AC3Db\nMATERIAL "m" rgb 1 1 1  amb 1 1 1  emis 0 0 0  spec 0 0 0  shi 1  trans 0\n'
            f"OBJECT world\nkids {kids}\n{objects}")


def refs(corners: tuple[int, ...]) -> str:
    return f"mat 0\nrefs {len(corners)}\n" + "".join(f"{i} 0 0\n" for i in corners)


def object_ac(name: str = "box", extra: str = "", flags: str = "0x20", more: str = "",
              count: int = 6, kids: str = "kids 0\n", points: list[Point] = CORNERS,
              faces: list[tuple[int, ...]] = QUADS) -> str:
    surfaces = "".join(f"SURF {flags}\n{refs(face)}" for face in faces)
    return (f'OBJECT poly\nname "{name}"\n{extra}numvert {len(points)}\n'
            + "".join(join([point]) + "\n" for point in points)
            + f"numsurf {count}\n{surfaces}{more}{kids}")


def rows_ac3d() -> list[Row]:
    group = f'OBJECT group\nname "g"\nloc 1 2 3\nkids 1\n{object_ac()}'
    turn = "rot 0 -1 0 1 0 0 0 0 1\n"
    inner = object_ac("inner", "loc 0 0 3\n")
    extras = 'data 4\nnote\ntexture "t.png"\ntexrep 1 1\ncrease 45.0\n'
    return [
        Row("poly.ac", "faces of four corners", ac3d(object_ac())),
        Row("flags.ac", "faces with two sides, shaded", ac3d(object_ac(flags="0x30"))),
        Row("extras.ac", "data, texture, crease", ac3d(object_ac(extra=extras))),
        Row("lines.ac", "closed and open lines beside faces", ac3d(object_ac(
            more=f"SURF 0x21\n{refs((0, 1, 6))}SURF 0x22\n{refs((0, 6))}", count=8))),
        Row("loc.ac", "loc", ac3d(object_ac(extra="loc 1 2 3\n")), **moved((1, 2, 3))),
        Row("rot.ac", "rot", ac3d(object_ac(extra=turn)), **TURNED),
        Row("rot_loc.ac", "rot and loc of a poly", ac3d(object_ac(extra=turn + "loc 1 0 0\n")),
            low=(-1, 0, 0), high=(1, 4, 1), refused="loc"),
        Row("rot_group.ac", "rot and loc of a group", ac3d(
            group.replace("kids 1", turn + "kids 1", 1)), low=(-1, 2, 3), high=(1, 6, 4)),
        Row("material.ac", "surfaces of a material that is not there",
            ac3d(object_ac()).replace("mat 0", "mat 1", 1), refused="no material 1"),
        Row("group.ac", "group", ac3d(group), **moved((1, 2, 3))),
        Row("kids.ac", "kids move with their parent", ac3d(object_ac(
            extra="loc 1 0 0\n", kids="kids 1\n" + inner)), low=(1, 0, 0), high=(5, 2, 4),
            refused="loc", **TWO),
        Row("strip.ac", "triangle strip (AC3Dc, type 4)", ac3d(
            object_ac(flags="0x24", count=1, faces=[(0, 1, 3, 2)])).replace("AC3Db", "AC3Dc"),
            **BOTTOM),
        Row("hole.ac", "polygon with a hole joined by an edge there and back", ac3d(
            object_ac(points=PLATE, faces=[PLATE_OUTLINE], count=1)),
            triangles=8, area=8.0, high=(3.0, 3.0, 0.0)),
    ]

