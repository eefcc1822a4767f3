# SPDX-License-Identifier: Apache-2.0
"""Which faces do these 100 cameras see? On the lamp posts of a city, coloured by how many see each. faces_of_cameras.py"""
import numpy as np

import frontmost as fm

scene = fm.load("builtin:city")
surfaces = fm.Surfaces(scene)
random = np.random.default_rng(4)
views = []
for x, z in random.integers(-3, 4, (100, 2)) * 60 - 30:  # the middles of crossings
    ahead = random.normal(size=3) * [1, 0.1, 1]
    eye = np.array([x, 6, z])
    views.append(fm.View.look_at(eye, eye + ahead, width=320, height=240, fov=60, near=0.1, far=250))
faces = surfaces.faces_ever_seen(views)
print(f"{len(faces)} of {surfaces.triangle_count} faces are seen; {(faces['views'] > 5).sum()} by more than five cameras")

color = np.full((surfaces.triangle_count, 3), 235, dtype=np.uint8)
often = np.log(faces["views"]) / np.log(50)
for channel, stops in enumerate([(255, 225, 50), (210, 80, 35), (70, 65, 105)]):  # amber: one camera; dark: fifty and
                                                                                  # more
    color[faces["primitive"], channel] = np.interp(often, [0, 0.5, 1], stops)
scene.save("seen.ply", of_triangles=dict(zip(("red", "green", "blue"), color.T)))
seen = fm.load("seen.ply")
view = fm.View.look_at((0, 420, 330), (0, 10, 20), width=480, height=300, fov=34).enclosing(fm.Surfaces(seen)).sampled(4)
fm.save(fm.Surfaces(seen).zbuffer(view).shade(ambient_occlusion=0.8), "faces_of_cameras.jpg", quality=80)
