# SPDX-License-Identifier: Apache-2.0
"""Depths of many views, drawn by Dask workers: python3 render_views.py engine.glb 64 FOLDER [SCHEDULER]"""
import math
import os
import pathlib
import sys

from dask.distributed import Client, get_worker, progress

import frontmost as fm


def render(model, number, count, path):
    if path.exists():
        return path  # an earlier run made it: files appear only when they are whole
    worker = get_worker()
    if not hasattr(worker, "surfaces"):
        worker.surfaces = fm.Surfaces(fm.load(model))  # once for all views of this worker
    angle = math.tau * number / count
    view = fm.frame(worker.surfaces, 320, 240, forward=(math.sin(angle), -0.4, -math.cos(angle)))
    fm.save({"Z": worker.surfaces.zbuffer(view, threads=1).depth}, path)
    return path


def main(model, count, folder, scheduler=None):
    client = Client(scheduler) if scheduler else Client(n_workers=os.cpu_count(), threads_per_worker=1)
    folder = pathlib.Path(folder).resolve()
    views = [client.submit(render, model, number, int(count), folder / f"{number}.exr", retries=3)
             for number in range(int(count))]
    progress(views)
    print(f"{len(client.gather(views))} views")  # raises the error of a view's last try


if __name__ == "__main__":
    main(*sys.argv[1:])
