#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Figures as other programs see them: parsed as XML, rasterised by librsvg and poppler, and compared with the
z-buffer's pictures.

    figures.py PROGRAM          the figures that take little time
    figures.py PROGRAM long     the others

A pixel of a figure is a mixture of its surroundings. So each of its channels must lie, up to a bound, between the least
and the greatest value of the z-buffer's picture within a pixel. That picture is twice as fine, to find parts narrower
than a pixel. Nothing is left out: at the borders of polygons hairlines would show. Away from the borders of ids, the
colour itself must be equal within the bound. Some figures are also checked at half and at twice their size, as pages
are, and in a browser. Rasterisers that are not installed are skipped, and counted.
"""
import base64
import json
import math
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree
import zlib

sys.dont_write_bytecode = True
from rasters import near, numpy, read_ids, read_picture  # noqa: E402

WIDTH, HEIGHT = 240, 160
NOTHING = 0xFFFFFFFF
LAYERS = 12  # more than one behind the other
BOUND = 3  # steps of 8 bits: viewers round, and blend twice at rims
TOLERANCE = 6  # what --color-tolerance allows by default
MERGED = "--merge-neighbours"
FLAT = ["--shading", "flat"]


class Case:
    """A view with its tolerances: how much colours vary within a polygon, the share of pixels that may exceed the
    bound, and by how much at most. Such pixels show things narrower than half a pixel, rims of translucent neighbours,
    which viewers blend twice, or details of textures and shadows narrower than a piece. `browser`: the share for a
    browser, whose coverage is less exact; None: not checked by a browser."""

    def __init__(self, words, varies=0, most=0.001, furthest=50, scales=(), browser=None):
        self.words, self.bound, self.most, self.furthest = words, BOUND + varies, most, furthest
        self.scales, self.browser = (1, *scales), browser


CASES = {
    "cubes through each other": Case(["builtin:cubes", "--no-shadows"], scales=(0.5, 2), browser=0.001),
    "a ring of three": Case(["builtin:cycle", *FLAT], scales=(0.5, 2)),
    "ids": Case(["builtin:cubes", "--shading", "ids"], browser=0.001),
    "ids of a city": Case(["builtin:city", "--shading", "ids"], most=0.002, browser=0.06),
    "in parallel": Case(["builtin:cubes", "--view", "iso", "--camera-orthographic", "--shading", "normals"]),
    "tiles": Case(["builtin:gallery", *FLAT], TOLERANCE, 0.02, 64, browser=0.06),
    "light and shadow": Case(["builtin:gallery"], TOLERANCE, 0.02, 64),
    "depths": Case(["builtin:spheres", "--shading", "depth"], TOLERANCE, 0.0001),
    "normals": Case(["builtin:teapot", "--shading", "normals"], TOLERANCE, 0.005),
    "ids, neighbours merged": Case(["builtin:city", "--shading", "ids", MERGED], furthest=64),
    "cubes, neighbours merged": Case(["builtin:cubes", *FLAT, MERGED]),
    "tiles, neighbours merged": Case(["builtin:gallery", *FLAT, MERGED], TOLERANCE, 0.02, 64),
    "all of glass": Case(["builtin:cubes", *FLAT, "--opacity", "0.5"], 0, 0.012, 20, browser=0.012),
    "a teapot of glass": Case(["builtin:teapot", *FLAT, "--opacity", "0.4"], 0, 0.006, browser=0.006),
    "leaves": Case(["leaves.gltf", *FLAT]),
}
LONG = {"tiles", "light and shadow", "normals", "ids of a city", "ids, neighbours merged", "tiles, neighbours merged",
        "a teapot of glass"}
LET_THROUGH = 5  # steps of 8 bits, 2 %: how much of the background viewers may show within a plate
LET_THROUGH_BETWEEN_COLOURS = 25  # 10 %: the same within scenes of textures and shadows
SVG = "{http://www.w3.org/2000/svg}"


def run(*words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, timeout=900)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: {done.stderr}")
    if done.stderr.strip():
        sys.exit(f"{' '.join(map(str, words))}: has something to say: {done.stderr}")
    return done.stdout


def png_of(rows):
    """A PNG of rows of RGBA bytes."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">IIBBBBB", len(rows[0]) // 4, len(rows), 8, 6, 0, 0, 0)
    packed = zlib.compress(b"".join(b"\0" + row for row in rows))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", packed) + chunk(b"IEND", b"")


def write_leaves(path):
    """Two walls, one behind the other: the front one is a checkerboard 6 wide with squares of one colour cut out."""
    def embedded(data, kind="application/octet-stream"):
        return f"data:{kind};base64," + base64.b64encode(data).decode()
    leaf, hole = bytes([30, 140, 60, 255]), bytes([30, 140, 60, 0])
    board = [b"".join(leaf if (x + y) % 2 else hole for x in range(6)) for y in range(6)]
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    data = b"".join(struct.pack("<3f", 1.1 * x, 1.1 * y, -0.3) for x, y in corners)
    data += b"".join(struct.pack("<3f", x, y, 0.3 * y) for x, y in corners)
    data += b"".join(struct.pack("<2f", (x + 1) / 2, (1 - y) / 2) for x, y in corners)
    data += struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    views = [(0, 48), (48, 48), (96, 32), (128, 12)]
    kinds = [(5126, 4, "VEC3"), (5126, 4, "VEC3"), (5126, 4, "VEC2"), (5123, 6, "SCALAR")]
    limits = [{"min": [-1.1, -1.1, -0.3], "max": [1.1, 1.1, -0.3]}, {"min": [-1, -1, -0.3], "max": [1, 1, 0.3]}, {}, {}]
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "buffers": [{"byteLength": len(data), "uri": embedded(data)}],
        "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": size} for at, size in views],
        "accessors": [{"bufferView": i, "componentType": kind, "count": count, "type": name, **limits[i]}
                      for i, (kind, count, name) in enumerate(kinds)],
        "images": [{"uri": embedded(png_of(board), "image/png")}], "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"magFilter": 9728, "minFilter": 9728}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.6, 0.3, 1]}},
                      {"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 3, "material": 0},
                                   {"attributes": {"POSITION": 1, "TEXCOORD_0": 2}, "indices": 3, "material": 1}]}]}))


def write_plate(path, columns, rows, corners, radius=0.36):
    """A plate full of holes with triangles around each: many triangles meet in a pixel."""
    places, faces, numbers = [], [], {}

    def number(at):
        return numbers.setdefault(at, len(numbers) + 1)
    for i in range(columns):
        for j in range(rows):
            ring = [(i + 0.5 + radius * math.cos(a), j + 0.5 + radius * math.sin(a))
                    for a in (2 * math.pi * (k + 0.3) / corners for k in range(corners))]
            square = [(i + 1, j + 1), (i, j + 1), (i, j), (i + 1, j)]
            quarters = [int(4 * ((k + 0.8) / corners % 1)) for k in range(corners)]
            for k in range(corners):
                after, quarter, next_quarter = (k + 1) % corners, quarters[k], quarters[(k + 1) % corners]
                faces.append((square[quarter], ring[after], ring[k]))
                if next_quarter != quarter:
                    faces.append((square[quarter], square[next_quarter], ring[after]))
    faces = [[number(at) for at in face] for face in faces]
    places = "".join(f"v {x - columns / 2:.7g} {y - rows / 2:.7g} 0\n" for x, y in numbers)
    path.write_text(places + "".join("f {} {} {}\n".format(*face) for face in faces))


def check_solid(program, name, folder, words, bound, most=0):
    """Away from rims the background must not show through, except in a share of the pixels: black and white backgrounds
    give the same picture."""
    pictures = {}
    for color in ("black", "white"):
        run(program, "render", *words, "--quiet", "--resolution", f"{WIDTH},{HEIGHT}", "--background", color, "-o",
            folder / "a.svg", "-o", folder / "a.pdf")
        pictures[color] = {scale: rasters_of(folder, scale, False) for scale in (0.5, 1, 2)}
    for scale, found in pictures["black"].items():
        width, height = int(scale * WIDTH), int(scale * HEIGHT)
        run(program, "render", *words, "--quiet", "--resolution", f"{4 * width},{4 * height}", "--ids",
            f"primitive={folder}/ids.npy")
        covered = read_ids(folder / "ids.npy") != NOTHING
        inner = numpy.zeros((height, width), bool)
        inner[1:-1, 1:-1] = near(covered, 4, 4, 12).all((-2, -1))[1:-1, 1:-1]
        assert inner.sum() > 100 * scale, f"{name}: {inner.sum()} pixels are within"
        for viewer, black in found.items():
            let_through = differing(black, pictures["white"][scale][viewer], inner, bound)
            told = (f"{name} at {scale:.0%}: {viewer}: {len(let_through)} of {inner.sum()} pixels let more than "
                    f"{bound / 255:.0%} of the background through")
            print(told)
            assert len(let_through) <= most * inner.sum(), (told, let_through[:5])
    return len(pictures["black"][1]) * 3, 6 - len(pictures["black"][1]) * 3


def check_plates(program, folder):
    counts = []
    for corners, view in ((12, []), (24, ["--camera-orthographic", "--camera-azimuth-angle", 20])):
        write_plate(folder / "plate.obj", 7, 5, corners)
        counts.append(check_solid(program, f"a plate with holes of {corners} corners", folder,
                                  [folder / "plate.obj", *view], LET_THROUGH))
    return counts


def check_scenes(program, folder):
    return [check_solid(program, scene, folder, [f"builtin:{scene}"], LET_THROUGH_BETWEEN_COLOURS, most)
            for scene, most in (("gallery", 0.0002), ("city", 0))]


def check_xml(path):
    root = xml.etree.ElementTree.parse(path).getroot()
    allowed = {SVG + tag for tag in ("svg", "title", "g", "path")}
    assert {element.tag for element in root.iter()} <= allowed
    assert len(list(root.iter(SVG + "path"))) > 2, f"{path}: hardly any paths"


def laid_over_each_other(layers):
    """Blends layers as viewers do: in the file's values, whereas the z-buffer's pictures blend light."""
    picture = numpy.full((*layers[0].shape[:2], 3), 255.0)
    for layer in reversed(layers):
        opacity = layer[:, :, 3:] / 255
        picture = layer[:, :, :3] * opacity + picture * (1 - opacity)
    return picture.round().astype(int)


def inner_pixels(ids):
    """Pixels whose neighbours all show the same triangle."""
    inner = numpy.zeros(ids.shape, bool)
    inner[1:-1, 1:-1] = (near(ids, 1, 1, 3) == ids[:, :, None, None]).all((-2, -1))[1:-1, 1:-1]
    return inner


def excess_of(picture, fine):
    """How far each pixel lies outside the range of the twice as fine picture within a pixel."""
    around = near(fine[:, :, :3], 2, 2, 6)
    picture = picture[:, :, :3]
    return numpy.maximum(around.min((-2, -1)) - picture, picture - around.max((-2, -1))).max(2)


def differing(a, b, pixels, bound):
    """Positions of the selected pixels whose colours differ by more than the bound."""
    return numpy.argwhere(pixels & (abs(a[:, :, :3] - b[:, :, :3]).max(2) > bound))


def browser():
    names = ["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"]
    return next((found for found in map(shutil.which, names) if found), None)


def screenshot(folder, width, height):
    """Rasterises by a browser, the only viewer that most people have. None if it does not start, as in some containers."""
    page, shot = folder / "page.html", folder / "page.png"
    page.write_text(f'<!doctype html><style>body{{margin:0}}img{{display:block;width:{width}px;height:{height}px}}</style>'
                    '<img src="a.svg">')
    shot.unlink(missing_ok=True)
    words = [browser(), "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--force-device-scale-factor=1",
             f"--user-data-dir={folder}/profile", f"--window-size={width},{height}", f"--screenshot={shot}", page.as_uri()]
    try:
        subprocess.run([str(word) for word in words], capture_output=True, timeout=900)
    except subprocess.TimeoutExpired:
        return None
    return read_picture(shot) if shot.exists() else None


def rasters_of(folder, scale, by_browser):
    width, height, found = int(scale * WIDTH), int(scale * HEIGHT), {}
    if shutil.which("rsvg-convert"):
        run("rsvg-convert", "-w", width, "-h", height, folder / "a.svg", "-o", folder / "svg.png")
        found["librsvg"] = read_picture(folder / "svg.png")
    if shutil.which("pdftoppm"):
        run("pdftoppm", "-r", 96 * scale, "-singlefile", folder / "a.pdf", folder / "pdf")
        found["poppler"] = read_picture(folder / "pdf.ppm")
    if by_browser and browser():
        shot = screenshot(folder, width, height)
        if shot is not None:
            found["Chromium"] = shot
    return found


def check_scale(program, name, case, folder, scale):
    """Returns how many rasterisers were installed, and how many were not."""
    words, width, height = case.words, int(scale * WIDTH), int(scale * HEIGHT)

    def picture(by, *more):
        def draw(file, *how):
            run(program, "render", *words, "--samples", 1, "--resolution", f"{by * width},{by * height}", "-o",
                folder / file, *how, *more)
        if "--opacity" not in words:
            draw("a.png")
            return read_picture(folder / "a.png")
        draw("{layer}.png", "--layers", LAYERS, "--background", "transparent")
        return laid_over_each_other([read_picture(folder / f"{layer}.png") for layer in range(LAYERS)])

    same = picture(1)
    run(program, "render", *words, "--resolution", f"{width},{height}", "--ids", f"primitive={folder}/ids.npy")
    fine = picture(2)
    inner = inner_pixels(read_ids(folder / "ids.npy"))
    by_browser = case.browser is not None and scale == 1
    found = rasters_of(folder, scale, by_browser)
    for viewer, raster in found.items():
        assert raster.shape[:2] == (height, width), raster.shape
        excess, wrong = excess_of(raster, fine), differing(raster, same, inner, case.bound)
        stray = (excess > case.bound).sum()
        told = (f"{name} at {scale:.0%}: {viewer}: {stray} of {width * height} pixels stray, by up to "
                f"{max(excess.max(), 0)}; {len(wrong)} of {inner.sum()} inner ones differ")
        print(told)
        share = case.browser if viewer == "Chromium" else case.most
        most = share / min(scale, 1)  # a smaller picture has a larger share of rims
        assert stray <= most * width * height and len(wrong) <= most * inner.sum(), (
            told, numpy.argwhere(excess > case.bound)[:5], wrong[:5])
        assert stray == 0 or excess.max() <= case.furthest, told
    return len(found), 2 + by_browser - len(found)


def check_case(program, name, case, folder):
    if case.words[0] == "leaves.gltf":
        write_leaves(folder / "leaves.gltf")
        case.words[0] = str(folder / "leaves.gltf")
    run(program, "render", *case.words, "--resolution", f"{WIDTH},{HEIGHT}", "--quiet", "-o", folder / "a.svg", "-o",
        folder / "a.pdf")
    check_xml(folder / "a.svg")
    return [check_scale(program, name, case, folder, scale) for scale in case.scales]


def main():
    program, is_long, counts = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:] == ["long"], []
    assert LONG < CASES.keys()
    chosen = {name: case for name, case in CASES.items() if (name in LONG) == is_long}
    with tempfile.TemporaryDirectory() as folder:
        for name, case in chosen.items():
            counts += check_case(program, name, case, pathlib.Path(folder))
        counts += (check_scenes if is_long else check_plates)(program, pathlib.Path(folder))
    print(f"{len(chosen) + 2} figures, {sum(c[0] for c in counts)} rasterised, {sum(c[1] for c in counts)} skipped for want "
          "of a rasteriser")


main()
