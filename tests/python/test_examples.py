# SPDX-License-Identifier: Apache-2.0
"""The programs of examples/python: each runs, is short, and draws the picture that docs/python.md shows."""
import json
import os
import pathlib
import re
import subprocess
import sys

import numpy
import pytest

import frontmost as fm

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples" / "python"


def run(folder, name, *arguments):
    """Runs an example; returns its printed text."""
    command = [sys.executable, EXAMPLES / f"{name}.py", *map(str, arguments)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def same_picture(path, name):
    """Checks that the picture equals the documentation's, pixel by pixel."""
    ours, shown = fm.load_image(path), fm.load_image(ROOT / "docs" / "images" / name)
    return ours.keys() == shown.keys() and all((ours[plane] == shown[plane]).all() for plane in ours)


def is_jpeg(path):
    return path.read_bytes()[:2] == b"\xff\xd8"


def test_they_are_short_and_shown():
    page = (ROOT / "docs" / "python.md").read_text()
    names = sorted(path.stem for path in EXAMPLES.glob("*.py"))
    assert len(names) >= 6
    for name in names:
        assert len((EXAMPLES / f"{name}.py").read_text().splitlines()) <= 40, name
        assert f"(../examples/python/{name}.py)" in page, name
        assert re.search(rf"\(images/python-{name.replace('_', '-')}[.](png|jpg)\)", page), name


def test_bop_data_set(tmp_path, cli):
    run(tmp_path, "bop_data_set", tmp_path / "set")
    files = tmp_path / "set"
    infos = json.loads((files / "scene_gt_info.json").read_text())
    assert len(infos) == 50 and len(list((files / "rgb").iterdir())) == len(list((files / "depth").iterdir())) == 50
    assert len(list((files / "mask").iterdir())) == sum(map(len, infos.values()))
    assert same_picture(files / "bop_data_set.png", "python-bop-data-set.png")
    # One of the example's views is compared with the program's files.
    direction = [numpy.cos(2.4 * 30), -1.2 + 30 / 50, numpy.sin(2.4 * 30)]
    there = cli("report", "builtin:gallery", "--resolution", "320,240", "--camera-direction",
                ",".join(map(repr, map(float, direction))), "--bop", "one") / "one"
    for name in ("scene_camera", "scene_gt"):
        ours = json.loads((files / f"{name}.json").read_text())["30"]
        wanted = json.loads((there / f"{name}.json").read_text())["0"]
        for one, other in zip(*([x] if isinstance(x, dict) else x for x in (ours, wanted)), strict=True):
            assert one.keys() == other.keys() and all(numpy.allclose(one[key], other[key]) for key in one)
    for one, other in zip(infos["30"], json.loads((there / "scene_gt_info.json").read_text())["0"], strict=True):
        assert all(one[key] == other[key] for key in one)
    assert (files / "depth" / "000030.png").read_bytes() == (there / "depth" / "000000.png").read_bytes()
    for kind in ("mask", "mask_visib"):
        for path in (there / kind).iterdir():
            assert path.read_bytes() == (files / kind / path.name.replace("000000_", "000030_", 1)).read_bytes()


def test_faces_of_cameras(tmp_path):
    told = run(tmp_path, "faces_of_cameras")
    seen, every, often = map(int, re.match(r"(\d+) of (\d+) faces are seen; (\d+) by more", told).groups())
    assert every == fm.builtin("city").triangle_count and 0 < often < seen < every
    assert is_jpeg(tmp_path / "faces_of_cameras.jpg")


def test_line_of_sight(tmp_path):
    told = run(tmp_path, "line_of_sight")
    assert 5 < int(re.search(r"(\d+)% of what this picture shows is seen", told)[1]) < 95
    assert is_jpeg(tmp_path / "line_of_sight.jpg")


def test_z_fighting(tmp_path):
    told = run(tmp_path, "z_fighting")
    wrong, covered = map(int, re.match(r"(\d+) of (\d+) pixels show the wrong surface", told).groups())
    assert 0 < wrong < covered and "stage and tiles: " in told and told.endswith(" 0 pixels are wrong\n")
    assert same_picture(tmp_path / "z_fighting.png", "python-z-fighting.png")


def test_calibrated_depth(tmp_path):
    # The photograph shows the same model, from the camera in the calibration file.
    surfaces = fm.Surfaces(fm.builtin("gallery"))
    view = fm.View.look_at((7, 5, 9), (0, 0.8, 0), width=640, height=420, fov=36).enclosing(surfaces).sampled(8)
    photo = surfaces.zbuffer(view).shade(background=(0.8, 0.84, 0.88), ambient_occlusion=0.6, shadows="rays")
    fm.save(photo, tmp_path / "photo.png")
    (tmp_path / "calibration.json").write_text(json.dumps({"K": view.K.tolist(), "pose": view.pose().tolist()}))
    told = run(tmp_path, "calibrated_depth", "photo.png", "builtin:gallery", "calibration.json")
    covered = numpy.isfinite(surfaces.zbuffer(view.sampled(1)).depth).mean()
    assert told.startswith(f"{covered:.0%} of the photograph shows the model, ")
    assert same_picture(tmp_path / "calibrated_depth.png", "python-calibrated-depth.png")


@pytest.mark.skipif("FRONTMOST_SANITIZED" in os.environ, reason="matplotlib is not what a sanitizer is for")
def test_hidden_line_figure(tmp_path):
    pytest.importorskip("matplotlib", reason="no matplotlib (Debian package python3-matplotlib)")
    model = subprocess.run([sys.executable, ROOT / "examples" / "bracket.py"], check=True, capture_output=True).stdout
    (tmp_path / "bracket.obj").write_bytes(model)
    run(tmp_path, "hidden_line_figure", "bracket.obj")
    assert (tmp_path / "hidden_line_figure.pdf").read_bytes().startswith(b"%PDF")
    picture = fm.load_image(tmp_path / "hidden_line_figure.png")["G"]
    shown = fm.load_image(ROOT / "docs" / "images" / "python-hidden-line-figure.png")["G"]
    assert picture.shape == shown.shape and abs(picture - shown).mean() < 0.02  # fonts may differ
