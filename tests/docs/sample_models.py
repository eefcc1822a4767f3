# SPDX-License-Identifier: Apache-2.0
"""The files that the documentation's examples name, as small as possible: a block of 2 x 1 x 1 units."""
import json
import pathlib
import shutil
import struct

CORNERS = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 2)]
TRIANGLES = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4),
             (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]


def stl():
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *(c for i in t for c in CORNERS[i]), 0) for t in TRIANGLES)
    return b"a block".ljust(80) + struct.pack("<I", len(TRIANGLES)) + body


def ply():
    head = f"""ply
format ascii 1.0
element vertex {len(CORNERS)}
property float x
property float y
property float z
element face {len(TRIANGLES)}
property list uchar int vertex_indices
end_header
"""
    lines = [" ".join(map(str, c)) for c in CORNERS] + ["3 " + " ".join(map(str, t)) for t in TRIANGLES]
    return (head + "\n".join(lines) + "\n").encode()


def glb(lamp=False):
    positions = b"".join(struct.pack("<3f", *c) for c in CORNERS)
    indices = b"".join(struct.pack("<3H", *t) for t in TRIANGLES)
    pose = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]  # a camera before the block, looking down -z at it
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [{"name": "block", "mesh": 0}, {"name": "far block", "mesh": 0, "translation": [0.5, 0.5, -3]},
                  {"name": "eye", "camera": 0, "matrix": pose + [1, 0.5, 6, 1]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}}],
        "materials": [{"name": "red", "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.1, 0.1, 1]}}],
        "meshes": [{"name": "block", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(CORNERS), "type": "VEC3",
                       "min": [0, 0, 0], "max": [2, 1, 1]},
                      {"bufferView": 1, "componentType": 5123, "count": 3 * len(TRIANGLES), "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": len(positions)},
                        {"buffer": 0, "byteOffset": len(positions), "byteLength": len(indices)}],
        "buffers": [{"byteLength": len(positions) + len(indices)}]}
    if lamp:  # above the block, shining down
        document["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "spot", "intensity": 20}]}}
        document["nodes"].append({"name": "lamp", "translation": [1, 3, 0.5], "rotation": [-0.7071068, 0, 0, 0.7071068],
                                  "extensions": {"KHR_lights_punctual": {"light": 0}}})
        document["scenes"][0]["nodes"].append(3)
        document["extensionsUsed"] = ["KHR_lights_punctual"]
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data = positions + indices
    data += b"\0" * (-len(data) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


EXAMPLES = pathlib.Path(__file__).resolve().parent.parent.parent / "examples"


def write(folder):
    shutil.copy(EXAMPLES / "cad" / "fixture.step", folder)
    (folder / "part.stl").write_bytes(stl())
    (folder / "object.ply").write_bytes(ply())
    (folder / "engine.glb").write_bytes(glb())
    (folder / "lamp.glb").write_bytes(glb(lamp=True))
    (folder / "tour.txt").write_text("frames 5\nkey a\nmouse left down 100 50\nwrite view.png\n")
    (folder / "pose.txt").write_text("1 0 0 -1\n0 1 0 -0.5\n0 0 1 6\n0 0 0 1\n")
