#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Hashes of every kind of output over a folder of models, to tell what a change of the code changes.

    models.py store PROGRAM MODELS LIST     writes the hashes of what PROGRAM makes of the models below MODELS into LIST
    models.py check PROGRAM MODELS LIST     makes all of it again, and prints each output that is not as LIST says

LIST is a text file, a line for each output: hash, kind and model. An output's hash is that of its bytes (of a PDF's
before they are compressed), of an error message's where the program refuses, in front of which stands its exit status.
LIST belongs to one machine, because colours go through functions of the C library; it is not stored with the code.
"""
import concurrent.futures
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from golden import inflated

MODEL_SUFFIXES = {".stl", ".ply", ".obj", ".off", ".glb", ".gltf", ".3mf"}
SMALL = ["--resolution", "160,120"]
TINY = ["--resolution", "96,72"]
# Kinds of outputs: the words of a command with its file names. The files and standard output are hashed.
KINDS = {
    "info": ["info", "MODEL"],
    "camera": ["camera", "MODEL", "--view", "iso"],
    "picture": ["render", "MODEL", *SMALL, "-o", "picture.png"],
    "inside": ["render", "MODEL", *SMALL, "--camera-position", "0.1,0.2,0.3",
               "--camera-view-angle", "90", "-o", "picture.png", "--depth", "depth.exr"],
    "maps": ["render", "MODEL", *SMALL, "--samples", "1", "--view", "iso", "-o", "picture.exr", "--depth", "depth.exr",
             "--ray-distance", "distance.pfm", "--window-depth", "window.npy", "--depth-format", "D24", "--ids", "primitive=primitive.npy",
             "--ids", "object=object.png", "--normals", "normals.exr", "--hash"],
    "flat": ["render", "MODEL", *TINY, "--shading", "flat", "--cull", "back", "-o", "picture.png"],
    "rays": ["render", "MODEL", *TINY, "--method", "raycast", "--shadows", "rays", "-o", "picture.png", "--hash"],
    "panorama": ["render", "MODEL", *TINY, "--camera-model", "panorama", "-o", "picture.png"],
    "layers": ["render", "MODEL", *TINY, "--opacity", "0.5", "-o", "picture_{layer}.png", "--layers", "2", "--ids", "primitive=ids_{layer}.npy",
               "--deep", "deep.exr"],
    "figure": ["render", "MODEL", *TINY, "-o", "figure.svg", "-o", "figure.pdf"],
    "merged": ["render", "MODEL", *TINY, "--shading", "flat", "--merge-neighbours", "-o", "figure.svg"],
    "all_polygons": ["render", "MODEL", *TINY, "--visible-only", "no", "-o", "figure.svg"],
    "glass": ["render", "MODEL", *TINY, "--opacity", "0.6", "-o", "figure.svg"],
    "drawing": ["lines", "MODEL", "--hidden", "dashed", "-o", "drawing.svg", "-o", "drawing.pdf", "-o", "drawing.dxf", "-o", "drawing.json"],
    "sheet": ["lines", "MODEL", "--views", "front,top,left,iso", "--frame", "--dimensions", "diameters", "--page", "a3-landscape", "-o", "sheet.svg"],
    "plot": ["lines", "MODEL", "--view", "iso", "--plot", "--hatch", "3", "--page", "a6", "-o", "plot.svg"],
    "stippled": ["lines", "MODEL", "--style", "figure", "--stipple", "3", "--page", "100,80", "-o", "drawing.svg"],
    "sight": ["sight", "MODEL", "--from", "0,2,0", "--to", "3,1,-5"],
    "lidar": ["lidar", "MODEL", "--from", "0.1,0.2,0.3", "--steps", "256", "-o", "points.ply", "-o", "range.exr"],
}
# Models above this size only get LARGE_KINDS: other kinds would take minutes and test nothing new.
MOST_BYTES = 3_000_000
LARGE_KINDS = ["info", "picture", "maps", "rays"]


def hash_of(name, data):
    return hashlib.sha256(inflated(data) if name.endswith(".pdf") else data).hexdigest()[:16]


def text_of(data, model):
    """Printed text without the times in it."""
    return re.sub(rb"[0-9.]+ m?s\b", b"", data.replace(os.fsencode(model), b"MODEL"))


def outputs(program, model, kind):
    """{"WORDS": hash} of one command: its printed text and its files."""
    words = [program, *(str(model) if word == "MODEL" else word for word in KINDS[kind]), "--quiet", "--threads", "1", "--timeout", "900"]
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(words, cwd=folder, capture_output=True)
        if done.returncode != 0:
            return {f"{kind}/error": f"{done.returncode}:{hash_of('', text_of(done.stderr, model))}"}
        files = sorted(pathlib.Path(folder).iterdir())
        found = {f"{kind}/{file.name}": hash_of(file.name, file.read_bytes()) for file in files}
        if done.stdout:
            found[f"{kind}/printed"] = hash_of("", text_of(done.stdout, model))
        return found


def kinds_of(model, models):
    is_for_readers = model.relative_to(models).parts[0] == "loader"
    return ["info", "picture"] if is_for_readers else LARGE_KINDS if model.stat().st_size > MOST_BYTES else list(KINDS)


def hashes(program, models):
    files = sorted(file for file in models.rglob("*") if file.suffix.lower() in MODEL_SUFFIXES)
    work = [(file, kind) for file in files for kind in kinds_of(file, models)]
    found = {}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for (file, _), part in zip(work, pool.map(lambda item: outputs(program, *item), work)):
            for what, value in part.items():
                found[f"{what} {file.relative_to(models).as_posix()}"] = value
    return found


def main():
    if len(sys.argv) != 5 or sys.argv[1] not in ("store", "check"):
        sys.exit(__doc__)
    program, models = (str(pathlib.Path(sys.argv[2]).resolve()), pathlib.Path(sys.argv[3]).resolve())
    path = pathlib.Path(sys.argv[4])
    found = hashes(program, models)
    if sys.argv[1] == "store":
        path.write_text("".join(f"{value} {what}\n" for what, value in sorted(found.items())))
        print(f"{len(found)} outputs")
        return
    stored = dict(reversed(line.split(" ", 1)) for line in path.read_text().splitlines())
    differing = [what for what in sorted(stored | found) if stored.get(what) != found.get(what)]
    for what in differing:
        print(f"{what}: is {found.get(what)}, was {stored.get(what)}")
    print(f"{len(found)} outputs, {len(differing)} of them not as stored")
    sys.exit(bool(differing))


if __name__ == "__main__":
    main()
