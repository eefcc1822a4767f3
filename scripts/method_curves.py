#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the cost of the visibility methods as triangles, pixels and layers grow, and draws it for docs/methods.md.

    method_curves.py measure PROGRAM ROWS.json     runs frontmost compare on made-up models
    method_curves.py draw ROWS.json DRAWING.svg
"""
import array
import json
import math
import pathlib
import random
import struct
import subprocess
import sys
import tempfile

METHODS = [("zbuffer", "Z-buffer", "#2e6f95", ""), ("raycast", "Ray casting", "#b4521b", ""),
           ("raycast view", "Ray casting, index at hand", "#b4521b", "5 4"), ("abuffer", "A-buffer", "#4c8c4a", "")]
# axis -> (title, what is held, values)
AXES = {
    "triangles": ("triangles", "sphere, 1920 x 1080", [1_000, 4_000, 16_000, 64_000, 250_000, 1_000_000]),
    "pixels": ("pixels", "sphere of 100,000 triangles", [240, 480, 960, 1920, 3840]),
    "layers": ("translucent layers", "1280 x 720", [1, 2, 4, 8, 16, 32, 64]),
}


def sphere(path, triangles):
    """A sphere of about `triangles` triangles, as binary STL."""
    rows = max(2, round(math.sqrt(triangles / 4)))
    columns = 2 * rows

    def point(i, j):
        polar, around = math.pi * i / rows, 2 * math.pi * (j % columns) / columns
        return (math.sin(polar) * math.cos(around), math.sin(polar) * math.sin(around), math.cos(polar))

    facets = []
    for i in range(rows):
        for j in range(columns):
            a, b, c, d = point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)
            facets += [(a, b, c)] * (i + 1 < rows) + [(a, c, d)] * (i > 0)
    with open(path, "wb") as file:
        file.write(b"sphere".ljust(80) + struct.pack("<I", len(facets)))
        for corners in facets:
            array.array("f", [0, 0, 0, *corners[0], *corners[1], *corners[2]]).tofile(file)
            file.write(b"\0\0")


def sheets(path, layers):
    """Translucent sheets one behind the other, of 200 triangles each, in a random order, as OBJ."""
    path.with_suffix(".mtl").write_text("newmtl glass\nd 0.5\n")
    lines, side = [f"mtllib {path.with_suffix('.mtl').name}", "usemtl glass"], 10
    order = list(range(layers))
    random.Random(1).shuffle(order)
    for number, layer in enumerate(order):
        lines += [f"v {x} {y} {-0.1 * layer}" for y in range(side + 1) for x in range(side + 1)]
        first = 1 + number * (side + 1) ** 2
        for y in range(side):
            for x in range(side):
                a = first + y * (side + 1) + x
                lines += [f"f {a} {a + 1} {a + side + 2}", f"f {a} {a + side + 2} {a + side + 1}"]
    path.write_text("\n".join(lines) + "\n")


def arguments(axis, value, folder):
    """The model and view of one point of a curve."""
    if axis == "layers":
        sheets(folder / "sheets.obj", value)
        return ["sheets.obj", "--resolution", "1280,720", "--view", "front", "--camera-zoom-factor", "2.5"]
    sphere(folder / "sphere.stl", value if axis == "triangles" else 100_000)
    width = value if axis == "pixels" else 1920
    return ["sphere.stl", "--resolution", f"{width},{width * 9 // 16}"]


def measure(program, folder):
    rows = []
    for axis, (_, _, values) in AXES.items():
        for value in values:
            command = [program, "compare", *arguments(axis, value, folder), "--threads", "1", "--runs", "5", "--json", "-q"]
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"{' '.join(command)}: {done.stderr}")
            report = json.loads(done.stdout)
            assert all(method["unexplained"] == 0 for method in report["methods"]), command
            at = report["width"] * report["height"] if axis == "pixels" else value
            for method in report["methods"]:
                times = {name: time["median"] for name, time in method["timings_ms"].items() if isinstance(time, dict)}
                row = {"axis": axis, "at": at, "method": method["method"], "bytes": method["peak_bytes"]}
                rows.append({**row, "ms": round(times["visible"] + times.get("index", 0), 3)})
                if "index" in times:
                    rows.append({**row, "method": row["method"] + " view", "ms": round(times["visible"], 3), "bytes": None})
            print(axis, at, {m["method"]: m["timings_ms"]["visible"]["median"] for m in report["methods"]}, flush=True)
    return rows


def short(number):
    for unit, name in ((1e6, " M"), (1e3, " k")):
        if number >= unit:
            return f"{number / unit:g}{name}"
    return f"{number:g}"


class Panel:
    """One small drawing with logarithmic axes."""

    WIDTH, HEIGHT = 240, 190

    def __init__(self, left, top, xs, ys):
        self.left, self.top = left, top
        self.x_low, self.x_high = math.log10(min(xs)), math.log10(max(xs))
        self.y_low, self.y_high = math.floor(math.log10(min(ys))), math.ceil(math.log10(max(ys)))

    def place(self, x, y):
        return (self.left + self.WIDTH * (math.log10(x) - self.x_low) / (self.x_high - self.x_low),
                self.top + self.HEIGHT * (self.y_high - math.log10(y)) / (self.y_high - self.y_low))

    def frame(self, unit):
        parts = []
        for power in range(self.y_low, self.y_high + 1):
            y = self.place(10 ** self.x_low, 10.0 ** power)[1]
            parts.append(f'<path d="M{self.left} {y:.1f}h{self.WIDTH}" class="grid"/>'
                         f'<text x="{self.left - 8}" y="{y + 4:.1f}" text-anchor="end">{10.0 ** power:g} {unit}</text>')
        bottom = self.top + self.HEIGHT
        for power in range(math.ceil(self.x_low), math.floor(self.x_high) + 1):
            x = self.place(10.0 ** power, 10.0 ** self.y_low)[0]
            parts.append(f'<path d="M{x:.1f} {self.top}v{self.HEIGHT}" class="grid"/>'
                         f'<text x="{x:.1f}" y="{bottom + 18}" text-anchor="middle">{short(10.0 ** power)}</text>')
        return "".join(parts)

    def curve(self, points, color, dashes):
        places = [self.place(*point) for point in sorted(points)]
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
        dots = "" if dashes else "".join(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{color}"/>' for x, y in places)
        return f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="2" stroke-dasharray="{dashes}"/>{dots}'


def draw(rows):
    parts = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1000 580" font-family="system-ui, sans-serif" font-size="12">',
             '<style>text{fill:#444}.grid{stroke:#ddd;fill:none}.head{font-size:14px;font-weight:600;fill:#222}</style>',
             '<rect width="1000" height="580" rx="10" fill="#fff"/>']
    for x, (_, title, color, dashes) in zip((80, 230, 380, 640), METHODS):
        parts.append(f'<path d="M{x} 30h28" stroke="{color}" stroke-width="2" stroke-dasharray="{dashes}"/>'
                     f'<text x="{x + 36}" y="34">{title}</text>')
    for row, (key, unit, scale) in enumerate((("ms", "ms", 1), ("bytes", "MiB", 2 ** 20))):
        everything = [r[key] / scale for r in rows if r[key]]
        for column, (axis, (title, held, _)) in enumerate(AXES.items()):
            mine = [r for r in rows if r["axis"] == axis and r[key]]
            panel = Panel(80 + 318 * column, 84 + 256 * row, [r["at"] for r in mine], everything)
            if row == 0:
                parts.append(f'<text x="{panel.left}" y="68" class="head">{title}<tspan font-weight="400" font-size="12" dx="8">{held}</tspan></text>')
            parts.append(panel.frame(unit))
            for method, _, color, dashes in METHODS:
                points = [(r["at"], r[key] / scale) for r in mine if r["method"] == method]
                if points:
                    parts.append(panel.curve(points, color, dashes))
    return "\n".join(parts + ["</svg>"]) + "\n"


def main():
    words = sys.argv[1:]
    if len(words) != 3 or words[0] not in ("measure", "draw"):
        sys.exit(__doc__)
    if words[0] == "measure":
        with tempfile.TemporaryDirectory() as folder:
            rows = measure(str(pathlib.Path(words[1]).resolve()), pathlib.Path(folder))
        pathlib.Path(words[2]).write_text("[\n" + ",\n".join(json.dumps(row) for row in rows) + "\n]\n")
    else:
        pathlib.Path(words[2]).write_text(draw(json.loads(pathlib.Path(words[1]).read_text())))


main()
