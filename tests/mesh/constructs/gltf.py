"""Constructs of glTF 2 and GLB that other readers are held to; gltf_test.cpp has more."""

import base64
import json
import struct
from typing import Any

from .row import CORNERS, TRIANGLES, Row, moved

Json = dict[str, Any]

INDICES = b"".join(struct.pack("<3H", *triangle) for triangle in TRIANGLES)  # 72 bytes
POINTS = b"".join(struct.pack("<3f", *corner) for corner in CORNERS)  # 96 bytes
INSTANCES = struct.pack("<6f", 0, 0, 0, 10, 0, 0)
TWO: dict[str, Any] = {"triangles": 24, "area": 56.0, "high": (14.0, 2.0, 1.0), "parts": 2}
QUANTISED = b"".join(
    struct.pack("<4h", *(round(32767 * x / 4) for x in corner), 0) for corner in CORNERS)


def document(primitive: Json | None = None, node: Json | None = None, data: bytes = b"",
             **more: Any) -> Json:
    """The box, then further data at byte 168; further members replace those of the document."""
    buffer = INDICES + POINTS + data
    whole: Json = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, **(node or {})}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0,
                                    **(primitive or {})}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5123, "count": 36, "type": "SCALAR"},
            {"bufferView": 1, "componentType": 5126, "count": 8, "type": "VEC3",
             "min": [0, 0, 0], "max": [4, 2, 1]}, *more.pop("accessors", [])],
        "bufferViews": [{"buffer": 0, "byteLength": 72},
                        {"buffer": 0, "byteOffset": 72, "byteLength": 96}],
        "buffers": [{"byteLength": len(buffer)}], **more}
    if data:
        whole["bufferViews"].append({"buffer": 0, "byteOffset": 168, "byteLength": len(data)})
    whole["buffers"][0]["data"] = buffer
    return whole


def glb(whole: Json) -> bytes:
    data: bytes = whole["buffers"][0].pop("data")
    data += b"\0" * (-len(data) % 4)
    text = json.dumps(whole).encode()
    text += b" " * (-len(text) % 4)
    chunks = (struct.pack("<I4s", len(text), b"JSON") + text
              + struct.pack("<I4s", len(data), b"BIN\0") + data)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def gltf(whole: Json) -> str:
    data = base64.b64encode(whole["buffers"][0].pop("data")).decode()
    whole["buffers"][0]["uri"] = "data:application/octet-stream;base64," + data
    return json.dumps(whole)


def placed(x: float, **more: Any) -> Json:
    return {"mesh": 0, "translation": [x, 0, 0], **more}


def gltf_rows() -> list[Row]:
    bottom: dict[str, Any] = {"triangles": 2, "area": 8.0, "high": (4.0, 2.0, 0.0)}
    strip = struct.pack("<4H", 0, 1, 3, 2)
    fan = struct.pack("<4H", 0, 1, 2, 3)
    few = [{"bufferView": 2, "componentType": 5123, "count": 4, "type": "SCALAR"}]
    sparse = struct.pack("<H2x3f", 6, 6, 2, 1)  # corner 6 reaches 6 m to the front
    override = document(data=sparse)
    override["bufferViews"][2]["byteLength"] = 2
    override["bufferViews"].append({"buffer": 0, "byteOffset": 172, "byteLength": 12})
    override["accessors"][1]["sparse"] = {
        "count": 1, "indices": {"bufferView": 2, "componentType": 5123},
        "values": {"bufferView": 3}}
    lifted = b"".join(struct.pack("<3f", 0, 0, 1 if corner[2] else 0) for corner in CORNERS)
    morph = document({"targets": [{"POSITION": 2}]}, data=lifted, accessors=[
        {"bufferView": 2, "componentType": 5126, "count": 8, "type": "VEC3",
         "min": [0, 0, 0], "max": [0, 0, 1]}])
    morph["meshes"][0]["weights"] = [1]
    quantised = document(
        {"attributes": {"POSITION": 2}}, {"scale": [4, 4, 4]}, QUANTISED,
        extensionsUsed=["KHR_mesh_quantization"], extensionsRequired=["KHR_mesh_quantization"],
        accessors=[{"bufferView": 2, "componentType": 5122, "count": 8, "type": "VEC3",
                    "normalized": True, "min": [0, 0, 0], "max": [32767, 16384, 8192]}])
    quantised["bufferViews"][2]["byteStride"] = 8
    instanced = document(None, {"extensions": {"EXT_mesh_gpu_instancing": {
        "attributes": {"TRANSLATION": 2}}}}, INSTANCES,
        extensionsUsed=["EXT_mesh_gpu_instancing"],
        extensionsRequired=["EXT_mesh_gpu_instancing"],
        accessors=[{"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}])
    plain = document({"attributes": {"POSITION": 2}}, data=b"".join(
        struct.pack("<3f", *CORNERS[i]) for triangle in TRIANGLES for i in triangle), accessors=[
            {"bufferView": 2, "componentType": 5126, "count": 36, "type": "VEC3",
             "min": [0, 0, 0], "max": [4, 2, 1]}])
    del plain["meshes"][0]["primitives"][0]["indices"]
    hidden = {"extensions": {"KHR_node_visibility": {"visible": False}}}
    turn = [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    return [
        Row("box.glb", "indexed triangles", glb(document())),
        Row("embedded.gltf", "buffer in the text", gltf(document())),
        Row("matrix.glb", "node with a matrix, column by column",
            glb(document(node={"matrix": turn})), low=(-2, 0, 0), high=(0, 4, 1)),
        Row("rotation.glb", "node with translation, rotation and scale", glb(document(
            node={"translation": [1, 0, 0], "rotation": [0, 0, 0.5**0.5, 0.5**0.5],
                  "scale": [2, 1, 1]})), area=52.0, low=(-1, 0, 0), high=(1, 8, 1)),
        Row("mirrored.glb", "mirroring node", glb(document(node={"scale": [-1, 1, 1]})),
            low=(-4, 0, 0), high=(0, 2, 1)),
        Row("nested.glb", "nodes on nodes", glb(document(
            nodes=[{"children": [1], "translation": [1, 0, 0]},
                   {"mesh": 0, "translation": [0, 2, 3]}])), **moved((1, 2, 3))),
        Row("instances.glb", "a mesh of two nodes", glb(document(
            nodes=[placed(0), placed(10)], scenes=[{"nodes": [0, 1]}])), **TWO),
        Row("scenes.glb", "two scenes, the second is the default", glb(document(
            nodes=[placed(0), placed(10)], scenes=[{"nodes": [0, 1]}, {"nodes": [1]}], scene=1)),
            **moved((10, 0, 0))),
        Row("strip.glb", "strip", glb(document({"indices": 2, "mode": 5}, data=strip,
                                                accessors=few)), **bottom),
        Row("fan.glb", "fan", glb(document({"indices": 2, "mode": 6}, data=fan, accessors=few)),
            **bottom),
        Row("unindexed.glb", "triangles without indices", glb(plain)),
        # The corner stretches the top to 10, the side to 5 and bends the front.
        Row("sparse.glb", "sparse accessor", glb(override), area=29 + 5**0.5 + 2**0.5,
            high=(6.0, 2.0, 1.0)),
        Row("morph.glb", "default morph weights", glb(morph), area=40.0, high=(4, 2, 2)),
        Row("quantised.glb", "KHR_mesh_quantization", glb(quantised)),
        Row("instanced.glb", "EXT_mesh_gpu_instancing", glb(instanced), **TWO),
        Row("hidden.glb", "KHR_node_visibility", glb(document(
            nodes=[placed(0), placed(10, **hidden)], scenes=[{"nodes": [0, 1]}],
            extensionsUsed=["KHR_node_visibility"]))),
        Row("required.glb", "unknown extension that is required", glb(document(
            extensionsUsed=["EX_unknown"], extensionsRequired=["EX_unknown"])),
            refused="EX_unknown"),
    ]
