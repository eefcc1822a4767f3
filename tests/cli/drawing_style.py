#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The style of drawings, measured as ink: rasterised by librsvg at 20 pixels per millimetre.

    drawing_style.py PROGRAM

Outlines are heavier than creases by the ratio in the reference. Hatching is on visible surfaces away from the light.
Nothing is hatched or dotted without being asked for.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
from rasters import read_ids, read_picture  # noqa: E402

WIDTH, HEIGHT = 60, 50  # millimetres
FINE = 20  # pixels per millimetre
CUBE = """v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
"""


def run(*words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, timeout=900)
    if done.returncode != 0 or done.stderr:
        sys.exit(f"{' '.join(map(str, words))}: {done.stderr}")


class Ink:
    """A drawing as rows of darkness, 0 to 1."""

    def __init__(self, program, folder, *words, lowest_alone=False):
        drawing, picture = folder / "ink.svg", folder / "ink.png"
        run(program, "lines", *words, "--page", f"{WIDTH},{HEIGHT}", "-o", drawing)
        if lowest_alone:
            text = drawing.read_text()
            drawing.write_text(text[: text.index('<g id="layer2"')] + "</svg>\n")
        run("rsvg-convert", "-w", WIDTH * FINE, "-h", HEIGHT * FINE, "-b", "white", drawing, "-o", picture)
        self.rows = read_picture(picture)[:, :, 0]

    def runs(self, y):
        """Widths of the dark runs along a row, in millimetres, with their places."""
        found, start = [], None
        for x, value in enumerate([*self.rows[int(y * FINE)], 255]):
            if value < 128 and start is None:
                start = x
            elif value >= 128 and start is not None:
                found.append(((x - start) / FINE, (x + start) / 2 / FINE))
                start = None
        return found

    def share(self, x, y, reach):
        """Share of ink in a square about a place."""
        (top, bottom), (left, right) = ([int((at - reach) * FINE), int((at + reach) * FINE)] for at in (y, x))
        return 1 - self.rows[top:bottom, left:right].mean() / 255


def check_pens(program, folder, cube):
    """Seen from a corner, the cube is a hexagon with upright sides; its middle edge runs down from the centre."""
    figure = Ink(program, folder, *cube, "--style", "figure")
    technical = Ink(program, folder, *cube)
    below = HEIGHT / 2 + 6
    left, middle, right = figure.runs(below)
    assert abs(left[0] - 0.7) < 0.06 and abs(right[0] - 0.7) < 0.06, (left, right)
    assert abs(middle[0] - 0.18) < 0.06 and abs(middle[1] - WIDTH / 2) < 0.06, middle
    assert all(abs(width - 0.5) < 0.06 for width, _ in technical.runs(below)), technical.runs(below)
    assert len(figure.runs(HEIGHT / 2 - 6)) == 4  # two sides, and the upper face's two nearer edges
    return figure


def check_tones(program, folder, cube, plain):
    left, right, top = (WIDTH / 2 - 7, HEIGHT / 2 + 3.5), (WIDTH / 2 + 7, HEIGHT / 2 + 3.5), (WIDTH / 2, HEIGHT / 2 - 8)
    for place in (left, right, top):
        assert plain.share(*place, 3) == 0, "ink that nobody asked for"
    for tone in (("--hatch", "1"), ("--stipple", "0.6")):
        shares = {}
        for side, light in (("left", "-1,0.2,0.3"), ("right", "1,0.2,0.3"), ("top", "0,1,0.1")):
            drawing = Ink(program, folder, *cube, "--style", "figure", *tone, "--light", light)
            shares[side] = [drawing.share(*place, 3) for place in (left, right, top)]
            # Ink is on the two sides away from the light, and none beside the cube.
            assert drawing.share(3, 3, 3) == 0 == drawing.share(WIDTH - 3, HEIGHT - 3, 3)
        assert shares["left"][0] + 0.05 < shares["left"][1], (tone, shares)
        assert shares["right"][1] + 0.05 < shares["right"][0], (tone, shares)
        assert shares["top"][2] == 0 and min(shares["top"][:2]) > 0.05, (tone, shares)


def check_hatched_is_seen(program, folder):
    """Hatching is where the z-buffer sees something dark, and not where it sees nothing."""
    camera = ["builtin:gallery", "--tessellation-error", "1", "--resolution", f"{WIDTH * FINE},{HEIGHT * FINE}"]
    run(program, "render", *camera, "--ids", f"object={folder}/ids.npy")
    ids = read_ids(folder / "ids.npy")
    hatched = Ink(program, folder, *camera, "--margin", "0", "--hatch", "0.5", "--pen", "0.2", lowest_alone=True)
    nothing = 2**32 - 1
    dark = hatched.rows < 128
    ink, beside = dark.sum(), (dark & (ids == nothing)).sum()
    assert ink > 20000 and beside < 0.01 * ink, (ink, beside)  # half a pen's width


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    if not shutil.which("rsvg-convert"):
        sys.exit(77)  # skipped
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "cube.obj").write_text(CUBE)
        cube = [folder / "cube.obj", "--view", "iso", "--camera-orthographic"]
        check_tones(program, folder, cube, check_pens(program, folder, cube))
        check_hatched_is_seen(program, folder)
    print("pens, light and what is seen: as the reference says")


main()
