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
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree
import zlib

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


def rows_of_png(path):
    """Grey values of an 8-bit PNG: rows of bytes."""
    data, at, packed = path.read_bytes(), 8, b""
    width = height = channels = 0
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        if kind == b"IHDR":
            width, height, bits, color = struct.unpack(">IIBB", data[at + 8 : at + 18])
            assert bits == 8
            channels = {0: 1, 2: 3, 4: 2, 6: 4}[color]
        if kind == b"IDAT":
            packed += data[at + 8 : at + 8 + size]
        at += size + 12
    raw, rows, above = zlib.decompress(packed), [], bytearray(width * channels)
    for y in range(height):
        start = y * (width * channels + 1)
        kind, row = raw[start], bytearray(raw[start + 1 : start + 1 + width * channels])
        for i in range(len(row)):
            left = row[i - channels] if i >= channels else 0
            corner = above[i - channels] if i >= channels else 0
            if kind == 1:
                row[i] = (row[i] + left) & 255
            elif kind == 2:
                row[i] = (row[i] + above[i]) & 255
            elif kind == 3:
                row[i] = (row[i] + (left + above[i]) // 2) & 255
            elif kind == 4:
                guess = left + above[i] - corner
                near = min((abs(guess - left), 0, left), (abs(guess - above[i]), 1, above[i]),
                           (abs(guess - corner), 2, corner))
                row[i] = (row[i] + near[2]) & 255
        rows.append(bytes(row[::channels]))
        above = row
    return rows


def rows_of_pgm(path):
    data = path.read_bytes()
    fields, at = [], 0
    while len(fields) < 4:
        end = at
        while data[end : end + 1] not in (b" ", b"\n", b"\t"):
            end += 1
        fields.append(data[at:end])
        at = end + 1
    width, height = int(fields[1]), int(fields[2])
    return [data[at + y * width : at + (y + 1) * width] for y in range(height)]


def ids_of(path):
    data = path.read_bytes()
    at = 10 + struct.unpack("<H", data[8:10])[0]
    values = struct.unpack(f"<{WIDTH * HEIGHT}I", data[at:])
    return [values[y * WIDTH : (y + 1) * WIDTH] for y in range(HEIGHT)]


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
    outlines = borders(ids_of(folder / "objects.npy"), ends)
    edges = grown(borders(ids_of(folder / "primitives.npy")))
    inks = {}
    if shutil.which("rsvg-convert"):
        run("rsvg-convert", "-w", WIDTH, "-h", HEIGHT, "-b", "white", folder / "a.svg", "-o", folder / "svg.png")
        inks["librsvg"] = ink_of(rows_of_png(folder / "svg.png"))
    if shutil.which("pdftoppm"):
        run("pdftoppm", "-r", "25.4", "-gray", "-singlefile", folder / "a.pdf", folder / "pdf")
        inks["poppler"] = ink_of(rows_of_pgm(folder / "pdf.pgm"))
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
