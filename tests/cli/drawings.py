#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Drawings as other programs see them: parsed as XML, rasterised by librsvg and poppler, and held against the pictures
of the z-buffer.

    drawings.py PROGRAM

With one millimetre to the pixel, every border between something and nothing in the id map must have ink beside it, and
all ink must lie beside a border between two triangles. Rasterisers that are not installed are skipped, and counted.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

sys.dont_write_bytecode = True
from rasters import read_ids, read_png, read_pnm  # noqa: E402

WIDTH, HEIGHT = 480, 270
VIEWS = [["builtin:cubes"], ["builtin:cycle"], ["builtin:gallery", "--tessellation-error", "1"], ["builtin:teapot", "--tessellation-error", "1", "--crease-angle", "0"],
         ["builtin:cubes", "--view", "iso", "--camera-orthographic"]]
NOTHING = 0xFFFFFFFF
REACH = 2  # pixels: half a pixel of rounding, half of a line, and smoothing
INK = 235
SVG = "{http://www.w3.org/2000/svg}"
LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"


def run(*words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, timeout=120)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: {done.stderr}")
    return done.stdout


def borders(ids, counts=lambda a, b: a != b):
    return {(x, y) for y in range(HEIGHT) for x in range(WIDTH)
            if (x + 1 < WIDTH and counts(ids[y][x], ids[y][x + 1]))
            or (y + 1 < HEIGHT and counts(ids[y][x], ids[y + 1][x]))}


def ends(a, b):
    """Something on one side alone."""
    return (a == NOTHING) != (b == NOTHING)


def grown(points):
    return {(x + dx, y + dy) for x, y in points for dx in range(-REACH, REACH + 1) for dy in range(-REACH, REACH + 1)}


def ink_of(rows):
    assert len(rows) == HEIGHT and len(rows[0]) == WIDTH, (len(rows[0]), len(rows))
    return {(x, y) for y in range(HEIGHT) for x in range(WIDTH) if rows[y][x] < INK}


def check_xml(path):
    root = xml.etree.ElementTree.parse(path).getroot()
    assert root.get("width") == f"{WIDTH}mm" and root.get("viewBox") == f"0 0 {WIDTH} {HEIGHT}", root.attrib
    layers = root.findall(SVG + "g")
    assert [layer.get(LABEL) for layer in layers] == ["1 hidden", "2 visible"], [layer.get(LABEL) for layer in layers]
    allowed = {SVG + tag for tag in ("svg", "title", "g", "path")}
    assert {element.tag for element in root.iter()} <= allowed


def check_view(program, view, folder):
    """Returns how many rasterisers were there."""
    size = ["--resolution", f"{WIDTH},{HEIGHT}"]
    page = ["--page", f"{WIDTH},{HEIGHT}", "--margin", "0"]
    run(program, "lines", *view, *size, *page, "--hidden", "dashed", "-o", folder / "hidden.svg")
    check_xml(folder / "hidden.svg")
    run(program, "lines", *view, *size, *page, "-o", folder / "a.svg", "-o", folder / "a.pdf")
    camera = [word for word in view if word not in ("--crease-angle", "0")]
    run(program, "render", *camera, *size, "--ids", f"object={folder}/objects.npy", "--ids",
        f"primitive={folder}/primitives.npy")
    outlines = borders(read_ids(folder / "objects.npy", WIDTH, HEIGHT), ends)
    edges = grown(borders(read_ids(folder / "primitives.npy", WIDTH, HEIGHT)))
    inks = {}
    if shutil.which("rsvg-convert"):
        run("rsvg-convert", "-w", WIDTH, "-h", HEIGHT, "-b", "white", folder / "a.svg", "-o", folder / "svg.png")
        inks["librsvg"] = ink_of(read_png(folder / "svg.png").channel(0))
    if shutil.which("pdftoppm"):
        run("pdftoppm", "-r", "25.4", "-gray", "-singlefile", folder / "a.pdf", folder / "pdf")
        inks["poppler"] = ink_of(read_pnm(folder / "pdf.pgm").rows)
    for name, ink in inks.items():
        missing, stray = outlines - grown(ink), ink - edges
        assert len(ink) > 500, f"{view}: {name}: hardly any ink"
        assert not missing, f"{view}: {name}: {len(missing)} border pixels without ink, such as {min(missing)}"
        assert not stray, f"{view}: {name}: {len(stray)} ink pixels beside no border, such as {min(stray)}"
    return len(inks)


def main():
    program, checked = pathlib.Path(sys.argv[1]).resolve(), 0
    with tempfile.TemporaryDirectory() as folder:
        for view in VIEWS:
            checked += check_view(program, view, pathlib.Path(folder))
    print(f"{len(VIEWS)} drawings, {checked} rasterised, {2 * len(VIEWS) - checked} skipped for want of a rasteriser")


main()
