# SPDX-License-Identifier: Apache-2.0
"""Shows where a 16-bit depth buffer shows the wrong surface, which objects fight, and the remedy. z_fighting.py"""
import numpy as np

import frontmost as fm

scene = fm.load("builtin:gallery")
surfaces = fm.Surfaces(scene)
view = fm.frame(surfaces, 400, 300)
view = view.between(0.02, view.far)  # a near plane far too near
buffer = fm.DepthBuffer(view.width, view.height, format="d16")
buffer.draw(surfaces, view)
exact = surfaces.find_exact_visible(view)
fights = exact.find_depth_fights(buffer.visible())
print(f"{fights.wrong} of {fights.covered} pixels show the wrong surface")

names = [thing.name for thing in scene.objects]
areas = surfaces.find_fighting_faces(view, "d16")
for pair in areas.objects[:5]:
    if fm.fight_kinds[pair["kind"]] == "close":
        print(f"{names[pair['first']]} and {names[pair['second']]}: {pair['visible_area']:.0f} pixels at risk; "
              f"there the buffer tells {pair['gap']:.2g} apart")
for setup, wrong in exact.try_remedies(areas.setup):
    print(f"with {setup} {wrong} pixels are wrong")
shown = buffer.visible().shade(see_through="never")  # as drawn, glass included
fm.save(np.hstack([shown, fights.image()]), "z_fighting.png")
