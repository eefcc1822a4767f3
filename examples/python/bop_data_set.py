# SPDX-License-Identifier: Apache-2.0
"""A data set in BOP's format, of 50 views: pictures, depths, masks, poses and shares. bop_data_set.py FOLDER"""
import json
import pathlib
import sys

import numpy as np

import frontmost as fm

folder = pathlib.Path(sys.argv[1])
for name in ("rgb", "depth", "mask", "mask_visib"):
    (folder / name).mkdir(parents=True, exist_ok=True)
scene = fm.load("builtin:gallery")  # one unit counts as a millimetre
surfaces = fm.Surfaces(scene)
cameras, truths, infos, shown = {}, {}, {}, []
for n in range(50):  # from above downwards, a golden angle apart
    forward = [np.cos(2.4 * n), -1.2 + n / 50, np.sin(2.4 * n)]
    view = fm.frame(surfaces, 320, 240, forward=forward)
    seen = surfaces.zbuffer(view)
    accounts, camera = seen.account(), view.pose("opencv")
    fm.save(seen.shade(), folder / f"rgb/{n:06}.png")
    fm.save({"Z": seen.depth}, folder / f"depth/{n:06}.png", depth_scale=10)
    cameras[n] = {"cam_K": view.K.ravel().tolist(), "depth_scale": 0.1,
                  "cam_R_w2c": camera[:3, :3].ravel().tolist(), "cam_t_w2c": camera[:3, 3].tolist()}
    truths[n], infos[n] = [], []
    for i, k in enumerate(np.flatnonzero(accounts.in_frame)):
        pose = camera @ scene.objects[k].pose
        turn = pose[:3, :3] / np.cbrt(np.linalg.det(pose[:3, :3]))
        truths[n].append({"obj_id": scene.objects[k].mesh + 1, "cam_R_m2c": turn.ravel().tolist(),
                          "cam_t_m2c": pose[:3, 3].tolist()})
        infos[n].append({"px_count_all": int(accounts.alone[k]), "px_count_valid": int(accounts.in_frame[k]),
                         "px_count_visib": int(accounts.visible[k]), "visib_fract": float(accounts.visible_share[k])})
        fm.save({"Y": seen.mask(k, part="whole")}, folder / f"mask/{n:06}_{i:06}.png")
        fm.save({"Y": seen.mask(k)}, folder / f"mask_visib/{n:06}_{i:06}.png")
    shown += [np.vstack([seen.shade(), seen.shade(shading="ids")])] if n % 30 == 5 else []
for name, what in (("camera", cameras), ("gt", truths), ("gt_info", infos)):
    (folder / f"scene_{name}.json").write_text(json.dumps(what))
fm.save(np.hstack(shown), folder / "bop_data_set.png")  # two of the pictures, and below each its object ids
