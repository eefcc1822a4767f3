#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Depths and triangle ids as NumPy arrays, beside what people use for them in Python today: ./dev bench python.

    PYTHONPATH=BUILD/python peers.py

Each peer draws the same triangles from the same cameras at 640x480 pixels on one thread, and gives two arrays; times
are processor times. A peer that is not installed, or does not work here, is named. VTK needs a display, which xvfb-run
provides. trimesh, which has no package in Debian 12, is left out.
"""
import os
import statistics
import time

os.environ.update(LP_NUM_THREADS="0", OMP_NUM_THREADS="1")  # one thread, of llvmpipe and of Open3D

import numpy  # noqa: E402
from module import globe  # noqa: E402

import frontmost as fm  # noqa: E402

WIDTH, HEIGHT, VIEWS, ROUNDS = 640, 480, 8, 5


class Absent(Exception):
    """The reason why a peer is missing."""


class ZBuffer:
    name = "Frontmost, z-buffer"

    def __init__(self, vertices, faces):
        self.surfaces = fm.Surfaces(fm.Scene.from_arrays(vertices, faces))

    def look(self, view):
        seen = self.surfaces.zbuffer(view, threads=1)
        return seen.depth, seen.primitive


class Rays(ZBuffer):
    name = "Frontmost, rays"

    def __init__(self, vertices, faces):
        super().__init__(vertices, faces)
        self.index = fm.RayIndex(self.surfaces)

    def look(self, view):
        seen = self.index.raycast(view, threads=1)
        return seen.depth, seen.primitive


class Vtk:
    name = "VTK off screen, llvmpipe"

    def __init__(self, vertices, faces):
        try:
            import vtk
            from vtk.util import numpy_support
        except ImportError:
            raise Absent("python3-vtk9 is not installed") from None
        if "DISPLAY" not in os.environ:
            raise Absent("needs a display: xvfb-run")
        self.to_numpy = numpy_support.vtk_to_numpy
        # Flat colours tell triangles apart, as no faster way gives their numbers.
        number = numpy.arange(1, len(faces) + 1, dtype=numpy.uint32)
        color = numpy.stack([number & 255, number >> 8 & 255, number >> 16], -1).astype(numpy.uint8)
        cells = vtk.vtkCellArray()
        cells.SetData(3, numpy_support.numpy_to_vtkIdTypeArray(faces.astype(numpy.int64).ravel(), deep=True))
        points = vtk.vtkPoints()
        points.SetData(numpy_support.numpy_to_vtk(vertices.astype(numpy.float32), deep=True))
        data = vtk.vtkPolyData()
        data.SetPoints(points)
        data.SetPolys(cells)
        data.GetCellData().SetScalars(numpy_support.numpy_to_vtk(color, deep=True))
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputData(data)
        mapper.SetScalarModeToUseCellData()
        mapper.SetColorModeToDirectScalars()
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().LightingOff()
        self.renderer = vtk.vtkRenderer()
        self.renderer.AddActor(actor)
        self.window = vtk.vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(WIDTH, HEIGHT)
        self.window.AddRenderer(self.renderer)
        self.pixels, self.depths = vtk.vtkUnsignedCharArray(), vtk.vtkFloatArray()

    def look(self, view):
        camera = self.renderer.GetActiveCamera()
        camera.SetPosition(view.eye)
        camera.SetFocalPoint(view.eye + view.forward)
        camera.SetViewUp(view.up)
        camera.SetViewAngle(2 * numpy.degrees(numpy.arctan(HEIGHT / 2 / view.K[1, 1])))
        camera.SetClippingRange(view.near, view.far)
        self.window.Render()
        whole = (0, 0, WIDTH - 1, HEIGHT - 1)
        self.window.GetPixelData(*whole, 0, self.pixels, 0)
        self.window.GetZbufferData(*whole, self.depths)
        color = self.to_numpy(self.pixels).reshape(HEIGHT, WIDTH, 3)[::-1].astype(numpy.uint32)
        stored = self.to_numpy(self.depths).reshape(HEIGHT, WIDTH)[::-1]
        depth = numpy.float32(view.near * view.far) / (view.far - stored * (view.far - view.near))
        depth[stored == 1] = numpy.inf
        return depth, (color[..., 0] | color[..., 1] << 8 | color[..., 2] << 16) - 1


def rays_of(view):
    """(h * w, 3) directions of depth 1, so that distances along them are depths."""
    x, y = numpy.meshgrid(numpy.arange(WIDTH), numpy.arange(HEIGHT))
    rays = numpy.stack([x, y, numpy.ones_like(x)], -1).reshape(-1, 3) @ numpy.linalg.inv(view.K).T
    return (rays @ view.pose("opencv_camera_to_world")[:3, :3].T).astype(numpy.float32)


class Open3d:
    name = "Open3D, RaycastingScene"

    def __init__(self, vertices, faces):
        try:
            import open3d
        except ImportError:
            raise Absent("python3-open3d is not installed") from None
        self.core = open3d.core
        self.scene = open3d.t.geometry.RaycastingScene()
        self.scene.add_triangles(self.core.Tensor(vertices.astype(numpy.float32)),
                                 self.core.Tensor(faces.astype(numpy.uint32)))
        if numpy.isinf(self.cast(numpy.array([[0, 0, 9, 0, 0, -1]], dtype=numpy.float32))[0]).all():
            raise Absent(f"version {open3d.__version__} hits nothing on this machine, not even a sphere ahead")

    def cast(self, rays):
        answer = self.scene.cast_rays(self.core.Tensor(rays))
        return answer["t_hit"].numpy(), answer["primitive_ids"].numpy()

    def look(self, view):
        directions = rays_of(view)
        eyes = numpy.broadcast_to(view.eye.astype(numpy.float32), directions.shape)
        return [plane.reshape(HEIGHT, WIDTH) for plane in self.cast(numpy.hstack([eyes, directions]))]


def compare(rows, columns):
    vertices, faces = globe(rows, columns)
    vertices *= 1 + 0.2 * numpy.sin(9 * vertices).prod(1, keepdims=True)  # hills, so that some parts hide others
    turns = 2 * numpy.pi * numpy.arange(VIEWS) / VIEWS
    views = [fm.View.look_at((3 * numpy.cos(t), 1, 3 * numpy.sin(t)), (0, 0, 0), near=1, far=6, fov=40) for t in turns]
    print(f"{len(faces):,} triangles, {WIDTH}x{HEIGHT}")
    ready = []
    for peer in (ZBuffer, Rays, Vtk, Open3d):
        try:
            begin = time.process_time()
            made = peer(vertices, faces)
            answers = [[plane.copy() for plane in made.look(view)] for view in views]
            ready.append((made, time.process_time() - begin, answers, []))
        except Absent as reason:
            print(f"  {peer.name:26} {reason}")
    for _ in range(ROUNDS):
        for made, _, _, times in ready:
            begin = time.process_time()
            for view in views:
                made.look(view)
            times.append((time.process_time() - begin) / VIEWS * 1000)
    ours = statistics.median(ready[0][3])
    for made, first, answers, times in ready:
        same, close, every = 0, 0, 0
        for (depth, ids), (our_depth, our_ids) in zip(answers, ready[0][2]):
            equal = ids == our_ids
            same, every = same + equal.sum(), every + equal.size
            both = equal & numpy.isfinite(our_depth)
            close = max(close, abs(depth[both] - our_depth[both]).max())
        mine = statistics.median(times)
        print(f"  {made.name:26} {mine:8.2f} ms a view  {mine / ours:6.1f} times  same ids in {same / every:8.3%} of the pixels,"
              f" there depths within {close:.1e}; ready, with {VIEWS} views, in {first:.2f} s")


if __name__ == "__main__":
    compare(100, 100)
    compare(500, 1000)
