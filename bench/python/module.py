#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what the Python module costs beside the library: ./dev bench python.

    PYTHONPATH=BUILD/python module.py BUILD/bench/library_views

Times are processor times, so that other work on the machine counts little.
"""
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

import numpy

import frontmost as fm

ROUNDS, VIEWS = 7, 100


def globe(rows, columns):
    """A unit sphere of 2 * rows * columns triangles."""
    v, u = numpy.meshgrid(numpy.linspace(0, numpy.pi, rows + 1), numpy.arange(columns) / columns * 2 * numpy.pi,
                          indexing="ij")
    vertices = numpy.stack([numpy.sin(v) * numpy.cos(u), numpy.cos(v), numpy.sin(v) * numpy.sin(u)], -1).reshape(-1, 3)
    at = numpy.arange((rows + 1) * columns).reshape(rows + 1, columns)
    a, b, c, d = at[:-1], numpy.roll(at[:-1], -1, 1), at[1:], numpy.roll(at[1:], -1, 1)
    faces = numpy.concatenate([numpy.stack(t, -1).reshape(-1, 3) for t in ((a, b, c), (b, d, c))])
    return vertices, faces


def milliseconds(work, times):
    begin = time.process_time()
    for _ in range(times):
        work()
    return (time.process_time() - begin) / times * 1000


def against_the_library(program, folder):
    """Measures depths and ids of 20 thousand triangles; the rounds take turns."""
    scene = fm.Scene.from_arrays(*globe(100, 100))
    path = pathlib.Path(folder) / "globe.ply"
    scene.save(path)
    surfaces = fm.Surfaces(fm.load(path))
    view = fm.frame(surfaces, 640, 480)

    def draw():
        return surfaces.zbuffer(view, threads=1).primitive

    def draw_with_depth():
        seen = surfaces.zbuffer(view, threads=1)
        return seen.primitive, seen.depth

    milliseconds(draw, 20)
    theirs, ours = [], []
    for _ in range(ROUNDS):
        told = subprocess.run([program, str(path), str(VIEWS)], check=True, capture_output=True, text=True).stdout.split()
        theirs.append([float(told[0]), float(told[1])])
        ours.append([milliseconds(draw, VIEWS), milliseconds(draw_with_depth, VIEWS)])
    for i, name in enumerate(("ids", "ids and depth")):
        library, module = (statistics.median(row[i] for row in rows) for rows in (theirs, ours))
        print(f"{name + ' of 20,000 triangles':34} library {library:7.3f} ms  module {module:7.3f} ms  "
              f"ratio {module / library:5.2f}  more {module - library:6.3f} ms")


def overhead():
    scene = fm.Scene.from_arrays([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    surfaces = fm.Surfaces(scene)
    view = fm.frame(surfaces, 8, 8)
    print(f"{'a call of 8x8 pixels':34} {min(milliseconds(lambda: surfaces.zbuffer(view, threads=1), 2000) for _ in range(ROUNDS)) * 1000:.1f} us")
    print(f"{'a View':34} {min(milliseconds(lambda: view.between(1, 2), 20000) for _ in range(ROUNDS)) * 1000:.2f} us")


def arrays():
    vertices, faces = globe(500, 1000)
    for of_vertices in (numpy.float32, numpy.float64):
        for of_faces in (numpy.uint32, numpy.int64):
            v, f = vertices.astype(of_vertices), faces.astype(of_faces)
            milliseconds(lambda: fm.Scene.from_arrays(v, f), 20)  # memory that the process already has is quicker
            best = statistics.median(milliseconds(lambda: fm.Scene.from_arrays(v, f), 3) for _ in range(ROUNDS))
            print(f"from_arrays, 1,000,000 triangles   {v.dtype}, {f.dtype}: {best:.1f} ms")


def accounts():
    random = numpy.random.default_rng(1)
    scene = fm.Scene()
    for i in range(10):
        pose = numpy.eye(4)
        pose[:3, 3] = random.uniform(-3, 3, 3)
        scene.add(*globe(32, 32), name=f"object {i}", pose=pose)
    surfaces = fm.Surfaces(scene)
    middle = surfaces.bounds.mean(0)
    views = [fm.View.look_at(middle + 14 * d / numpy.linalg.norm(d), middle, near=1, far=40, width=640, height=480)
             for d in random.normal(size=(200, 3))]
    times = []
    for _ in range(3):
        begin = time.process_time()
        for view in views:
            seen = surfaces.zbuffer(view, threads=1)
            seen.depth, seen.object, seen.account(threads=1).visible_share
        times.append(time.process_time() - begin)
    print(f"{'200 views of ten objects, accounts':34} {200 / statistics.median(times):.0f} views a second")


def imports():
    def run(code):
        def used():
            usage = resource.getrusage(resource.RUSAGE_CHILDREN)
            return usage.ru_utime + usage.ru_stime
        begin = used()
        subprocess.run([sys.executable, "-c", code], check=True)
        return used() - begin
    rounds = [(run("pass"), run("import numpy"), run("import frontmost")) for _ in range(ROUNDS)]
    bare, of_numpy, of_both = (statistics.median(column) * 1000 for column in zip(*rounds))
    print(f"{'import':34} numpy {of_numpy - bare:.0f} ms, frontmost beside it {of_both - of_numpy:.0f} ms")


def main():
    with tempfile.TemporaryDirectory() as folder:
        against_the_library(sys.argv[1], folder)
    overhead()
    arrays()
    accounts()
    imports()


if __name__ == "__main__":
    main()
