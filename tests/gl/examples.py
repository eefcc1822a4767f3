#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The programs of examples/opengl that open a window: their pictures are those of docs/opengl.md, and show what is said.

    examples.py FRONTMOST FOLDER          checks the programs in the folder
    examples.py FRONTMOST FOLDER update   writes the pictures of the documentation
"""
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from rasters import read_picture  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Of each program, in the order of the script: keys, and the picture after them.
PROGRAMS = {
    "interpolated_depth": (("c", "greater"), ("o", "less"), ("z", "eye")),
    "painter": (("1", "red-last"), ("2", "green-last"), ("3", "blue-last"), ("d", "tested")),
    "cubes": (("d", "untested"), ("d", "tested"), ("cb", "back"), ("f", "front")),
}


def draw(folder):
    """Draws the pictures into the folder. Returns them by name."""
    pictures = {}
    for program, views in PROGRAMS.items():
        lines = []
        for keys, name in views:
            pictures[f"{program}-{name}"] = folder / f"opengl-{program}-{name}.png"
            lines += [f"key {key}" for key in keys] + [f"write {pictures[f'{program}-{name}']}"]
        (folder / "script.txt").write_text("\n".join(lines) + "\n")
        subprocess.run([frontmost, "gl", programs / f"example_{program}", "--script", folder / "script.txt"], check=True,
                       timeout=600)
    return pictures


def expect(holds, what):
    global failures
    if not holds:
        failures += 1
        print("expected:", what)


frontmost, programs = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
failures = 0
page = (ROOT / "docs" / "opengl.md").read_text()
if sys.argv[3:] == ["update"]:
    for picture in draw(ROOT / "docs" / "images").values():
        if picture.name not in page:
            picture.unlink()
    (ROOT / "docs" / "images" / "script.txt").unlink()
    sys.exit()
with tempfile.TemporaryDirectory() as name:
    files = draw(pathlib.Path(name))
    pictures = {key: read_picture(path)[..., :3] for key, path in files.items()}
    shown = {key for key in pictures if f"(images/{files[key].name})" in page}
    expect(len(shown) >= 8, "the pictures in docs/opengl.md")
    for key in shown:
        expect((read_picture(ROOT / "docs/images" / files[key].name)[..., :3] == pictures[key]).all(), f"the same {key}")
    greater, less, eye = (pictures[f"interpolated_depth-{key}"] for key in ("greater", "less", "eye"))
    expect((greater == less).all(), "the same picture by both conventions")
    is_blue = greater[..., 2] > greater[..., 0]
    expect(is_blue[10:89, 60:180].all() and not is_blue[91:, 60:180].any(), "a wall above, a floor below")
    expect((eye[90:170, 60:180, 2] > eye[90:170, 60:180, 0]).mean() > 0.99, "no floor by interpolated z")
    painted = [pictures[f"painter-{key}"] for key in ("red-last", "green-last", "blue-last")]
    wrong = [int((picture != pictures["painter-tested"]).any(2).sum()) for picture in painted]
    expect(min(wrong) > 300, f"each order wrong, not {wrong}")
    cubes = {key: pictures[f"cubes-{key}"] for key in ("untested", "tested", "back", "front")}
    expect((cubes["untested"] != cubes["tested"]).any(2).mean() > 0.05, "hidden surfaces without a test")
    expect((cubes["back"] != cubes["tested"]).any(2).mean() > 0.02, "the open cube without its inside")
    expect((cubes["front"] != cubes["tested"]).any(2).mean() > 0.2, "insides of both cubes")
sys.exit(failures != 0)
