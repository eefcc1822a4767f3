#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Models that lie far from zero, compared with the same models at home.

    far_models.py PROGRAM          each format moved once
    far_models.py PROGRAM long     each format moved elsewhere

Random models with coordinates that fit floats are written as text STL, OBJ, OFF, PLY (text, doubles of both byte
orders) and glTF, at home and moved by survey-like distances. Cameras are moved alike. Pictures, depths, ids, layers,
polygons, lines, sight, scans and streams must be the same to the byte. Points in world coordinates must differ by the
move. Binary STL far away has coarser floats, so its model at home is rounded to what those floats hold.
"""
import base64
import json
import pathlib
import random
import struct
import subprocess
import sys
import tempfile

PROGRAM = sys.argv[1]
MOVES = [(1e8, -1e8, 1e8), (500000, 5400000, 0), (0, 5.4e6, 0), (-2e9, 0, 3e5), (1e12, 1e6, -1e7)]
GRID = 1 / 256  # grid of coordinates: even the farthest doubles hold it
SIZE = "96,72"


def run(*words, fails=False):
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, timeout=900)
    if (done.returncode != 0) != fails:
        sys.exit(f"{' '.join(map(str, words))}: status {done.returncode}: {done.stderr.decode()}")
    return done.stdout


def check(what, home, away):
    if home != away:
        sys.exit(f"{what}: away {str(away)[:300]} is not as at home {str(home)[:300]}")


class Model:
    """Flat polygons of three to five vertices, all within 40 units of zero."""

    def __init__(self, seed, grid=GRID):
        self.random = random.Random(seed)
        self.grid = grid
        self.points, self.faces = [], []
        for _ in range(40):
            corner = [self.number(-40, 30) for _ in range(3)]
            along, across = [[self.number(-8, 8) for _ in range(3)] for _ in range(2)]
            outline = [(0, 0), (1, 0), (1, 1), (0.5, 1.5), (0, 1)][: self.random.choice([3, 4, 4, 5])]
            first = len(self.points)
            for a, b in outline:
                self.points.append([self.on_grid(c + a * u + b * v) for c, u, v in zip(corner, along, across)])
            self.faces.append(list(range(first, len(self.points))))

    def on_grid(self, value):
        return round(value / self.grid) * self.grid

    def number(self, low, high):
        return self.on_grid(self.random.uniform(low, high))

    def moved(self, move):
        return [[c + m for c, m in zip(point, move)] for point in self.points]


def text(point):
    return " ".join(f"{c:.17g}" for c in point)


def triangles(model):
    """Triangulates by fans, alike at home and away, so that text STL is alike too."""
    return [(f[0], f[k], f[k + 1]) for f in model.faces for k in range(1, len(f) - 1)]


def write_stl(path, model, points):
    lines = ["solid s"]
    for triangle in triangles(model):
        corners = "".join(f"vertex {text(points[i])}\n" for i in triangle)
        lines.append(f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet")
    path.write_text("\n".join(lines) + "\nendsolid s\n")


def write_binary_stl(path, model, points):
    rows = [struct.pack("<12fH", 0, 0, 0, *(c for i in t for c in points[i]), 0) for t in triangles(model)]
    path.write_bytes(bytes(80) + struct.pack("<I", len(rows)) + b"".join(rows))


def write_obj(path, model, points):
    path.write_text("".join(f"v {text(p)}\n" for p in points) +
                    "".join(f"f {' '.join(str(i + 1) for i in f)}\n" for f in model.faces))


def write_off(path, model, points):
    path.write_text(f"OFF\n{len(points)} {len(model.faces)} 0\n" + "".join(f"{text(p)}\n" for p in points) +
                    "".join(f"{len(f)} {' '.join(map(str, f))}\n" for f in model.faces))


def ply_header(encoding, model, points):
    return (f"ply\nformat {encoding} 1.0\nelement vertex {len(points)}\nproperty double x\nproperty double y\n"
            f"property double z\nelement face {len(model.faces)}\nproperty list uchar int vertex_indices\nend_header\n")


def write_text_ply(path, model, points):
    path.write_text(ply_header("ascii", model, points) + "".join(f"{text(p)}\n" for p in points) +
                    "".join(f"{len(f)} {' '.join(map(str, f))}\n" for f in model.faces))


def write_binary_ply(path, model, points, order="<"):
    encoding = "binary_little_endian" if order == "<" else "binary_big_endian"
    path.write_bytes(ply_header(encoding, model, points).encode() +
                     b"".join(struct.pack(order + "3d", *p) for p in points) +
                     b"".join(struct.pack(f"{order}B{len(f)}i", len(f), *f) for f in model.faces))


def write_big_ply(path, model, points):
    write_binary_ply(path, model, points, ">")


def write_gltf(path, model, points):
    """The mesh at home, below two nodes that move it; only these hold doubles."""
    move = [a - b for a, b in zip(points[0], model.points[0])]
    corners = [c for t in triangles(model) for i in t for c in model.points[i]]
    data = struct.pack(f"<{len(corners)}f", *corners)
    rows = [corners[k::3] for k in range(3)]
    scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
             "nodes": [{"translation": [m / 2 for m in move], "children": [1, 2]},
                       {"translation": [m / 2 for m in move], "mesh": 0},
                       {"translation": [m / 2 + t for m, t in zip(move, (8, 4, 120))], "camera": 0}],
             "cameras": [{"type": "perspective", "perspective": {"yfov": 0.75, "znear": 1}}],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
             "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(corners) // 3, "type": "VEC3",
                            "min": [min(r) for r in rows], "max": [max(r) for r in rows]}],
             "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
             "buffers": [{"byteLength": len(data),
                          "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}
    path.write_text(json.dumps(scene))


FORMATS = {"text.stl": write_stl, "obj.obj": write_obj, "off.off": write_off, "text.ply": write_text_ply,
           "little.ply": write_binary_ply, "big.ply": write_big_ply, "node.gltf": write_gltf}


def vector(point):
    return ",".join(f"{c:.17g}" for c in point)


def cameras(move):
    """Cameras: the default, one placed by options, one placed by a pose, and one inside the model."""
    at = lambda *p: vector([c + m for c, m in zip(p, move)])  # noqa: E731
    pose = [1, 0, 0, 3 + move[0], 0, -1, 0, 2 + move[1], 0, 0, -1, 100.5 + move[2], 0, 0, 0, 1]
    return [[], ["--view", "iso", "--camera-orthographic"], ["--up", "+z", "--camera-zoom-factor", "8"],
            ["--camera-position=" + at(70, 35.5, 90.25), "--camera-focal-point=" + at(1, 2, 3)],
            ["--pose=" + vector(pose), "--pose-convention", "opencv-camera-to-world"],
            ["--camera-position=" + at(0.5, -3.25, 4), "--camera-direction", "-y", "--camera-view-angle", "90"]]


def outputs(folder, model, camera, name):
    """Files of the picture commands: bytes by name."""
    made = {}
    files = {kind: folder / f"{name}.{kind}.npy" for kind in ("picture", "depth", "primitive", "object", "normals")}
    common = [model, "--resolution", SIZE, "--quiet", *camera]
    for method in ("zbuffer", "raycast", "abuffer"):
        run("render", *common, "--method", method, "-o", files["picture"], "--depth", files["depth"],
            "--ids", f"primitive={files['primitive']}", "--ids", f"object={files['object']}",
            "--normals", files["normals"])
        made.update({f"{method} {kind}": path.read_bytes() for kind, path in files.items()})
    made["rays"] = run("render", *common, "--shadows", "rays", "--opacity", "0.5", "-o", "-", "--format", "npy")
    figure = folder / f"{name}.svg"
    run("render", *common, "-o", figure)
    made["figure"] = figure.read_bytes()
    run("lines", model, *camera, "--quiet", "--hidden", "dashed", "--hatch", "2", "-o", figure)
    made["lines"] = figure.read_bytes()
    lenses = ("--camera-orthographic", "--camera-view-angle", "--camera-zoom-factor", "--camera-index")
    if any(lens in camera for lens in lenses):
        return made
    run("render", model, "--quiet", *camera, "--camera-model", "panorama", "--resolution", "64,32", "-o", files["picture"])
    made["panorama"] = files["picture"].read_bytes()
    return made


def compare_pictures(folder, home, away, move):
    own = [["--camera-index", "0"]] if away.suffix == ".gltf" else []
    for number, (at_home, moved) in enumerate(zip(cameras((0, 0, 0)) + own, cameras(move) + own)):
        one, other = outputs(folder, home, at_home, "home"), outputs(folder, away, moved, "away")
        for kind in one:
            check(f"{away.name} moved by {move}, camera {number}: {kind}", one[kind], other[kind])


def compare_points(folder, home, away, move):
    """Reports in world coordinates, moved back home."""
    back = lambda p: [c - m for c, m in zip(p, move)]  # noqa: E731
    pairs = [[(-60.5, y, z), (60.25, y + 1, z - 2)] for y in range(-30, 31, 6) for z in range(-30, 31, 6)]
    answers = []
    for model, by in ((home, (0, 0, 0)), (away, move)):
        lines = "".join(" ".join(text([c + m for c, m in zip(p, by)]) for p in pair) + "\n" for pair in pairs)
        (folder / "pairs.txt").write_text(lines)
        answers.append(json.loads(run("sight", model, "--pairs", folder / "pairs.txt", "--json", "--quiet"))["pairs"])
    blocked = 0
    for a, b, pair in zip(*answers, pairs):
        check(f"{away.name} moved by {move}: sight", [a["clear"], a.get("triangle"), a.get("distance")],
              [b["clear"], b.get("triangle"), b.get("distance")])
        check("from", list(pair[0]), back(b["from"]))
        if not a["clear"]:
            blocked += 1
            near(f"{away.name} moved by {move}: sight, point", a["point"], back(b["point"]), move)
    if blocked < 5:
        sys.exit("sight: too few pairs are blocked to say anything")
    boxes = [json.loads(run("info", m, "--json", "--quiet"))["bounds"] for m in (home, away)]
    check("bounds", boxes[0], {side: back(p) for side, p in boxes[1].items()})
    looks = [json.loads(run("camera", m, "--json", "--quiet"))["look_at"] for m in (home, away)]
    for what in ("eye", "target"):
        near(f"camera: {what}", looks[0][what], back(looks[1][what]), move)
    clouds = []
    for model, by in ((home, (0, 0, 0)), (away, move)):
        run("lidar", model, "--from=" + vector([0.5 + by[0], 60 + by[1], 1.25 + by[2]]), "--elevations=-80,10",
            "--steps", 64, "-o", folder / "points.ply", "--quiet")
        clouds.append(read_points(folder / "points.ply"))
    check("lidar: rays", [row[3:] for row in clouds[0]], [row[3:] for row in clouds[1]])
    for one, other in zip(*clouds):
        near("lidar: point", one[:3], back(other[:3]), move, 1e-5)


def near(what, home, away, move, least=0):
    """Checks coordinates up to the precision of doubles at their place."""
    for one, other, by in zip(home, away, move):
        if abs(one - other) > max(least, abs(by) * 2.0 ** -51, 1e-12):
            sys.exit(f"{what}: {away} is not {home}")


def read_points(path):
    header, body = path.read_bytes().split(b"end_header\n", 1)
    double = b"property double x" in header
    row = struct.Struct("<3df4If" if double else "<3ff4If")
    return list(row.iter_unpack(body))


def compare_streams(folder, away):
    hashes = []
    for extra in ([], ["--stream"]):
        run("render", away, *extra, "--resolution", SIZE, "--samples", "1", "--quiet", "-o", folder / "s.npy")
        hashes.append((folder / "s.npy").read_bytes())
    check(f"{away.name}: stream", *hashes)


def check_wide(folder):
    """One part at zero and one far away: no origin helps, and info reports the loss."""
    wide = folder / "wide.obj"
    wide.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 100000000.5 0 0\nv 100000001 0 0\nv 1e8 1 0\nf 1 2 3\nf 4 5 6\n")
    report = json.loads(run("info", wide, "--json", "--quiet"))
    check("wide: origin and rounding", [[0, 0, 0], 4], [report["origin"], report["rounding"]])
    check("wide: said", True, b"rounding   4 at most" in run("info", wide, "--quiet"))


def main():
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for number, (name, write) in enumerate(FORMATS.items()):
            model = Model(number)
            home, away = folder / name, folder / "away" / name
            away.parent.mkdir(exist_ok=True)
            write(home, model, model.points)
            move = MOVES[(number + (sys.argv[2:] == ["long"])) % len(MOVES)]
            write(away, model, model.moved(move))
            compare_pictures(folder, home, away, move)
            compare_points(folder, home, away, move)
            if name.startswith(("little", "big")):
                compare_streams(folder, away)
        check_wide(folder)
        coarse = Model(99, 8)
        home, away = folder / "floats.stl", folder / "away" / "floats.stl"
        write_binary_stl(home, coarse, coarse.points)
        write_binary_stl(away, coarse, coarse.moved(MOVES[0]))
        compare_pictures(folder, home, away, MOVES[0])
        compare_streams(folder, away)


if __name__ == "__main__":
    main()
