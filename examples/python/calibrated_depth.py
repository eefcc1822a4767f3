# SPDX-License-Identifier: Apache-2.0
"""The depth of a model laid over a photograph of a calibrated camera. calibrated_depth.py PHOTOGRAPH MODEL CALIBRATION

CALIBRATION is a JSON file of K and of the pose [R | t] of OpenCV, which solvePnP gives.
"""
import json
import sys

import numpy as np

import frontmost as fm

photograph, model, calibration = sys.argv[1:]
planes = fm.load_image(photograph)
photo = np.stack([planes[c] for c in "RGB"], -1)  # linear light
height, width, _ = photo.shape
told = json.load(open(calibration))
surfaces = fm.Surfaces(fm.load(model))
view = fm.View.from_intrinsics(told["K"], width, height, pose=told["pose"], convention="opencv").enclosing(surfaces)
seen = surfaces.zbuffer(view)

there = np.isfinite(seen.depth)
near, far = seen.depth[there].min(), seen.depth[there].max()
print(f"{there.mean():.0%} of the photograph shows the model, {near:.2f} to {far:.2f} away")
share = np.where(there, (seen.depth - near) / (far - near), 0)[..., None]
color = np.clip(np.concatenate([1.5 - 2.2 * share, 1.1 - abs(2 * share - 0.9), 2.2 * share - 0.6], -1), 0, 1)
steps = (share * 16).astype(int)
lines = (steps != np.roll(steps, 1, 0)) | (steps != np.roll(steps, 1, 1))  # contours of equal depth
mixed = np.where(there[..., None], 0.45 * photo + 0.55 * color, photo)
fm.save(np.where(lines, 1, mixed).astype(np.float32), "calibrated_depth.png")
