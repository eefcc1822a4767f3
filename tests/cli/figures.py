#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Figures as other programs see them: parsed as XML, rasterised by librsvg and poppler, and held against the pictures
of the z-buffer.

    figures.py PROGRAM

A pixel of a figure is a mixture of what lies around it. So every channel of it must lie between the least and the
greatest of the z-buffer's picture within a pixel, twice as fine so as to find what is narrower than one, give or take
a bound. Nothing is left out: at the borders of polygons hairlines would show. Away from the borders of ids the colour
itself must be the same within the bound. Rasterisers that are not installed are skipped, and counted.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

sys.dont_write_bytecode = True
from rasters import Raster, read_ids, read_png, read_pnm  # noqa: E402

WIDTH, HEIGHT = 240, 160
LAYERS = 6  # more than one behind the other
BOUND = 3  # steps of 8 bits: viewers round, and blend twice at rims
TOLERANCE = 6  # what --color-tolerance allows by default
MERGED = "--merge-neighbours"
FLAT = ["--shading", "flat"]


class Case:
    """A view, and what is known of it: by how much its colours vary within a polygon, and which part of the pixels may
    be beyond the bound, by how much at most: things narrower than half a pixel, rims of translucent neighbours, which
    viewers blend both, and details of textures and shadows that are narrower than a piece."""

    def __init__(self, words, varies=0, most=0.001, furthest=50):
        self.words, self.bound, self.most, self.furthest = words, BOUND + varies, most, furthest


CASES = {
    "cubes through each other": Case(["builtin:cubes", "--no-shadows"]),
    "a ring of three": Case(["builtin:cycle", *FLAT]),
    "ids": Case(["builtin:city", "--shading", "ids"]),
    "in parallel": Case(["builtin:cubes", "--view", "iso", "--camera-orthographic", "--shading", "normals"]),
    "tiles": Case(["builtin:gallery", *FLAT], TOLERANCE, 0.02, 64),
    "light and shadow": Case(["builtin:gallery"], TOLERANCE, 0.02, 64),
    "depths": Case(["builtin:spheres", "--shading", "depth"], TOLERANCE, 0.004),
    "normals": Case(["builtin:teapot", "--shading", "normals"], TOLERANCE, 0.005),
    "ids, neighbours merged": Case(["builtin:city", "--shading", "ids", MERGED], furthest=64),
    "cubes, neighbours merged": Case(["builtin:cubes", *FLAT, MERGED]),
    "tiles, neighbours merged": Case(["builtin:gallery", *FLAT, MERGED], TOLERANCE, 0.02, 64),
    "all of glass": Case(["builtin:cubes", *FLAT, "--opacity", "0.5"], 0, 0.025),
}
SVG = "{http://www.w3.org/2000/svg}"


def run(*words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, timeout=120)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: {done.stderr}")
    if done.stderr.strip():
        sys.exit(f"{' '.join(map(str, words))}: has something to say: {done.stderr}")
    return done.stdout


def check_xml(path):
    root = xml.etree.ElementTree.parse(path).getroot()
    allowed = {SVG + tag for tag in ("svg", "title", "g", "path")}
    assert {element.tag for element in root.iter()} <= allowed
    assert len(list(root.iter(SVG + "path"))) > 2, f"{path}: hardly any paths"


def reach(fine, choose):
    """The least or greatest of a picture twice as fine, within a pixel of each pixel."""
    found = []
    for number in range(3):
        across = [[choose(row[max(0, 2 * x - 2) : 2 * x + 4]) for x in range(WIDTH)] for row in fine.channel(number)]
        found.append([[choose(column) for column in zip(*across[max(0, 2 * y - 2) : 2 * y + 4])] for y in range(HEIGHT)])
    return found


def laid_over_each_other(layers):
    """As viewers blend: in the values of the file, where the z-buffer's pictures blend light."""
    picture = Raster(layers[0].width, layers[0].height, 3, [])
    for y in range(picture.height):
        row = bytearray()
        for x in range(picture.width):
            color = [255.0] * 3
            for layer in reversed(layers):
                *front, opacity = layer.rows[y][4 * x : 4 * x + 4]
                color = [(f * opacity + c * (255 - opacity)) / 255 for f, c in zip(front, color)]
            row += bytes(round(c) for c in color)
        picture.rows.append(bytes(row))
    return picture


def inner_pixels(ids):
    """Those whose neighbours all around show the same triangle."""
    return [(x, y) for y in range(1, HEIGHT - 1) for x in range(1, WIDTH - 1)
            if all(ids[y + dy][x + dx] == ids[y][x] for dy in (-1, 0, 1) for dx in (-1, 0, 1))]


def strays(raster, low, high, bound):
    """By how much the pixels that are beyond the bound are beyond."""
    found = {}
    for number in range(3):
        for y, row in enumerate(raster.channel(number)):
            for x, value in enumerate(row):
                excess = max(low[number][y][x] - value, value - high[number][y][x])
                if excess > bound:
                    found[x, y] = max(excess, found.get((x, y), 0))
    return found


def differing(raster, picture, pixels, bound):
    channels = [(raster.channel(number), picture.channel(number)) for number in range(3)]
    return [(x, y) for x, y in pixels if any(abs(a[y][x] - b[y][x]) > bound for a, b in channels)]


def rasters_of(folder):
    found = {}
    if shutil.which("rsvg-convert"):
        run("rsvg-convert", "-w", WIDTH, "-h", HEIGHT, folder / "a.svg", "-o", folder / "svg.png")
        found["librsvg"] = read_png(folder / "svg.png")
    if shutil.which("pdftoppm"):
        run("pdftoppm", "-r", "96", "-singlefile", folder / "a.pdf", folder / "pdf")
        found["poppler"] = read_pnm(folder / "pdf.ppm")
    return found


def check_case(program, name, case, folder):
    """Returns how many rasterisers were there."""
    words = case.words

    def picture(scale, *more):
        def draw(file, *how):
            run(program, "render", *words, "--samples", 1, "--resolution", f"{scale * WIDTH},{scale * HEIGHT}", "-o",
                folder / file, *how, *more)
        if "--opacity" not in words:
            draw("a.png")
            return read_png(folder / "a.png")
        draw("{layer}.png", "--layers", LAYERS, "--background", "transparent")
        return laid_over_each_other([read_png(folder / f"{layer}.png") for layer in range(LAYERS)])

    run(program, "render", *words, "--resolution", f"{WIDTH},{HEIGHT}", "--quiet", "-o", folder / "a.svg", "-o",
        folder / "a.pdf")
    check_xml(folder / "a.svg")
    same = picture(1)
    run(program, "render", *words, "--resolution", f"{WIDTH},{HEIGHT}", "--ids", f"primitive={folder}/ids.npy")
    fine = picture(2)
    low, high = reach(fine, min), reach(fine, max)
    inner = inner_pixels(read_ids(folder / "ids.npy", WIDTH, HEIGHT))
    found = rasters_of(folder)
    for viewer, raster in found.items():
        assert (raster.width, raster.height) == (WIDTH, HEIGHT), (raster.width, raster.height)
        stray, wrong = strays(raster, low, high, case.bound), differing(raster, same, inner, case.bound)
        told = (f"{name}: {viewer}: {len(stray)} of {WIDTH * HEIGHT} pixels stray, by up to "
                f"{max(stray.values(), default=0)}; {len(wrong)} of {len(inner)} inner ones differ")
        print(told)
        assert len(stray) <= case.most * WIDTH * HEIGHT and len(wrong) <= case.most * len(inner), (
            told, sorted(stray.items(), key=lambda e: -e[1])[:5], wrong[:5])
        assert max(stray.values(), default=0) <= case.furthest, told
    return len(found)


def main():
    program, checked = pathlib.Path(sys.argv[1]).resolve(), 0
    with tempfile.TemporaryDirectory() as folder:
        for name, case in CASES.items():
            checked += check_case(program, name, case, pathlib.Path(folder))
    print(f"{len(CASES)} figures, {checked} rasterised, {2 * len(CASES) - checked} skipped for want of a rasteriser")


main()
