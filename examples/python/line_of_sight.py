# SPDX-License-Identifier: Apache-2.0
"""The part of a city that a tower sees, and the part that sees the tower: both are the same. line_of_sight.py"""
import numpy as np

import frontmost as fm

scene = fm.load("builtin:city")
surfaces = fm.Surfaces(scene)
index = fm.RayIndex(surfaces)
watcher = np.array([45, 140, 15])
view = fm.View.look_at((-260, 420, 520), (0, 0, 30), width=480, height=300, fov=36).enclosing(surfaces)
seen = surfaces.zbuffer(view)

# World position of each pixel's surface: along the ray through the pixel's centre, as far as its depth.
x, y = np.meshgrid(np.arange(view.width), np.arange(view.height))
rays = np.stack([x, y, np.ones_like(x)], -1) @ np.linalg.inv(view.K).T
camera_to_world = view.pose("opencv_camera_to_world")
there = np.isfinite(seen.depth)
points = (rays[there] * seen.depth[there][:, None]) @ camera_to_world[:3, :3].T + camera_to_world[:3, 3]

clear = np.zeros(there.shape, dtype=bool)
clear[there] = index.is_clear(points + 0.5 * seen.normals[there], watcher)  # half a metre in front of the surface
print(f"from ({', '.join(map(str, watcher))}) {clear.sum() / there.sum():.0%} of what this picture shows is seen")
picture = seen.shade(ambient_occlusion=0.7).astype(float)
picture[there & ~clear] *= [0.35, 0.38, 0.5, 1]
picture[clear, :3] = 0.65 * picture[clear, :3] + 0.35 * np.array([255, 190, 40])
fm.save(picture.astype(np.uint8), "line_of_sight.jpg", quality=80)
