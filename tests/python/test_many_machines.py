# SPDX-License-Identifier: Apache-2.0
"""The programs of docs/many-machines.md that use Debian's engines: mpi4py's ranks and Dask's workers."""
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys

import numpy
import pytest

import frontmost as fm

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"
DRAW_PARTS, RENDER_VIEWS = EXAMPLES / "mpi4py" / "draw_parts.py", EXAMPLES / "dask" / "render_views.py"
LEAST = numpy.array([[-1, -2, -3], [4, 5, 6]], dtype=numpy.float32)


def run(folder, command):
    variables = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    return subprocess.run([*map(str, command)], cwd=folder, env=variables, capture_output=True, text=True, timeout=900)


def needs(*modules):
    missing = [name for name in modules if not importlib.util.find_spec(name)]
    return pytest.mark.skipif(bool(missing), reason=f"not installed: {', '.join(missing)}")


def strip(part):
    """Triangles one behind the other; some lie at the same place as another part's."""
    count = 0 if part == 1 else 40 + part
    rows = numpy.arange(count)[:, None]
    corners = numpy.array([[0, 0], [1, 0], [0, 1]], dtype=numpy.float32)
    vertices = numpy.zeros((count, 3, 3), dtype=numpy.float32)
    vertices[..., :2] = corners + 0.1 * rows[:, :, None] + 0.3 * (part % 3)
    vertices[..., 2] = 0.01 * (rows % 7)
    return vertices.reshape(-1, 3), numpy.arange(3 * count).reshape(-1, 3)


def test_programs_are_short_and_shown():
    page = (EXAMPLES.parent / "docs" / "many-machines.md").read_text()
    for path, lines in ((DRAW_PARTS, 30), (RENDER_VIEWS, 40)):
        assert len(path.read_text().splitlines()) <= lines
        assert f"(../{path.relative_to(EXAMPLES.parent)})" in page


def test_frame_of_bounds():
    vertices = numpy.array([[x, y, z] for x in (-1, 4) for y in (-2, 5) for z in (-3, 6)], dtype=numpy.float32)
    corners = fm.Scene.from_arrays(vertices, numpy.array([[0, 1, 2], [3, 4, 5], [6, 7, 0]]))
    assert fm.frame(LEAST, 64, 48, samples=4) == fm.frame(corners, 64, 48, samples=4)
    assert fm.frame(LEAST.tolist()) == fm.frame(LEAST)
    nothing = numpy.array([[numpy.inf] * 3, [-numpy.inf] * 3], dtype=numpy.float32)
    assert fm.frame(nothing) == fm.frame(fm.Scene.from_arrays(numpy.zeros((0, 3)), numpy.zeros((0, 3), dtype=int)))
    for wrong in (3, "teapot", LEAST[0], None):
        with pytest.raises((TypeError, ValueError), match="scene"):
            fm.frame(wrong)


@needs("mpi4py")
@pytest.mark.skipif(not shutil.which("mpirun"), reason="not installed: mpirun")
@pytest.mark.parametrize("count", [1, 2, 3, 8])
def test_mpi4py_draws_the_bytes_of_the_whole(tmp_path, count):
    parts = [strip(part) for part in range(count)]
    for part, (vertices, faces) in enumerate(parts):
        fm.Scene.from_arrays(vertices, faces).save(tmp_path / f"part-{part}.ply")
    done = run(tmp_path, ["mpirun", "--oversubscribe", "-n", count, sys.executable, DRAW_PARTS, "part-{rank}.ply"])
    assert done.returncode == 0, done.stderr
    first = numpy.cumsum([0] + [len(vertices) for vertices, _ in parts])
    whole = fm.Surfaces(fm.Scene.from_arrays(numpy.concatenate([vertices for vertices, _ in parts]),
                                             numpy.concatenate([f + n for (_, f), n in zip(parts, first)])))
    seen = whole.zbuffer(fm.frame(whole.bounds, 640, 480))
    assert len(numpy.unique(seen.primitive)) > 20
    assert numpy.load(tmp_path / "ids.npy").tobytes() == seen.primitive.tobytes()
    assert numpy.load(tmp_path / "depth.npy").tobytes() == seen.depth.tobytes()


@needs("distributed", "dask")
def test_dask_renders_what_is_not_there_yet(tmp_path):
    vertices, faces = strip(0)
    fm.Scene.from_arrays(vertices, faces).save(tmp_path / "model.ply")
    folder = tmp_path / "views"
    folder.mkdir()
    command = [sys.executable, RENDER_VIEWS, tmp_path / "model.ply", 6, folder]
    done = run(tmp_path, command)
    assert done.returncode == 0 and "6 views" in done.stdout, done.stderr
    files = {path.name: path.read_bytes() for path in folder.iterdir()}
    assert sorted(files) == [f"{number}.exr" for number in range(6)] and len(set(files.values())) == 6
    surfaces = fm.Surfaces(fm.load(tmp_path / "model.ply"))
    seen = surfaces.zbuffer(fm.frame(surfaces, 320, 240, forward=(0.0, -0.4, -1.0)))
    assert (fm.load_image(folder / "0.exr")["Z"] == seen.depth).all()
    # A repeated run makes missing files, and leaves existing ones alone.
    (folder / "3.exr").unlink()
    (folder / "4.exr").write_text("finished before")
    done = run(tmp_path, command)
    assert done.returncode == 0, done.stderr
    assert (folder / "3.exr").read_bytes() == files["3.exr"]
    assert (folder / "4.exr").read_text() == "finished before"
    # A view that fails in every try makes the run fail with its error.
    done = run(tmp_path, [*command[:2], tmp_path / "missing.ply", *command[3:]])
    assert done.returncode == 0, "all views are there, and the model is not looked at"
    (folder / "0.exr").unlink()
    done = run(tmp_path, [*command[:2], tmp_path / "missing.ply", *command[3:]])
    assert done.returncode != 0 and "missing.ply: cannot open" in done.stderr
