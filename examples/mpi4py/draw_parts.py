# SPDX-License-Identifier: Apache-2.0
"""Ids and depths of a model whose parts are spread over MPI ranks: mpirun -n 8 python3 draw_parts.py part-{rank}.ply"""
import sys

import numpy as np
from mpi4py import MPI

import frontmost as fm

ranks = MPI.COMM_WORLD
part = fm.Surfaces(fm.load(sys.argv[1].replace("{rank}", str(ranks.rank))))
bounds = part.bounds * np.float32([[1], [-1]])  # negates the high corner, so that one minimum serves both corners
ranks.Allreduce(MPI.IN_PLACE, bounds, MPI.MIN)
view = fm.frame(bounds * np.float32([[1], [-1]]), 640, 480)

seen = part.zbuffer(view)
first = ranks.exscan(part.triangle_count) or 0  # the id of this part's first triangle in the whole
ids = np.where(seen.primitive == fm.no_primitive, seen.primitive, seen.primitive + np.uint32(first))
# The greater key is nearer; among equal keys the lower id wins.
packed = seen.key.view(np.uint32).astype(np.uint64) << np.uint64(32) | ~ids
whole = np.empty_like(packed) if ranks.rank == 0 else None
ranks.Reduce(packed, whole, MPI.MAX)

if ranks.rank == 0:
    np.save("ids.npy", ~whole.astype(np.uint32))
    keys = (whole >> np.uint64(32)).astype(np.uint32).view(np.float32)
    with np.errstate(divide="ignore"):
        np.save("depth.npy", (np.float64(np.float32(view.near)) / keys.astype(np.float64)).astype(np.float32))
