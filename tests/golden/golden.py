#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Golden pictures: few, small, and each inspected by a person.

    golden.py check PROGRAM FOLDER     renders every case into FOLDER and compares
    golden.py update PROGRAM FOLDER    renders, and stores the result as the new truth

Visible surfaces (ids and depths) and maps are promised to the byte, so their content hashes must be equal. Figures are
promised to the byte if no C library function affects their colours; drawings are in all formats, PDF before
compression. Colours depend on C library functions and may differ by a rounding: each channel within COLOUR_TOLERANCE.
On failure the picture and its difference are in FOLDER, and the reference is beside this script.
"""
import hashlib
import json
import pathlib
import re
import shutil
import subprocess
import sys
import zlib

HERE = pathlib.Path(__file__).resolve().parent
HASHES = HERE / "hashes.json"
COLOUR_TOLERANCE = 2 / 255

SMALL = ["--resolution", "96,72"]
MAPS = ["--depth", "{}_depth.exr", "--ids", "primitive={}_primitives.npy", "--normals", "{}_normals.exr"]
CASES = {
    "teapot": ["builtin:teapot", *SMALL],
    "teapot_back_culled": ["builtin:teapot", *SMALL, "--cull", "back", "--view", "top", "--camera-orthographic"],
    "cubes": ["builtin:cubes", *SMALL, "--samples", "1"],
    "cycle": ["builtin:cycle", *SMALL, "--shading", "flat"],
    "city_ids": ["builtin:city", *SMALL, "--shading", "ids"],
    "spheres": ["builtin:spheres", *SMALL, "--background", "transparent"],
    "spheres_normals": ["builtin:spheres", *SMALL, "--shading", "normals"],
}
FIGURES = {
    "cubes_figure": ["builtin:cubes", *SMALL, "--shading", "flat"],
    "cubes_merged_figure": ["builtin:cubes", *SMALL, "--shading", "flat", "--merge-neighbours"],
    "cycle_figure": ["builtin:cycle", *SMALL, "--shading", "ids"],
}
DRAWINGS = {
    "drawing_sheet": ["builtin:cubes", "--views", "front,top,left,iso", "--hidden", "dashed", "--page", "a4-landscape"],
    "drawing_plot": ["builtin:cubes", "--view", "iso", "--camera-orthographic", "--plot", "--hidden", "dashed", "--hatch", "3", "--page", "a6"],
    "drawing_figure": ["builtin:teapot", "--style", "figure", "--tessellation-error", "20", "--stipple", "3", "--page", "100,80"],
}


def hashes_of(text):
    """{"visible": ..., "depth": ...} from the lines "WHAT HASH [FILE]" of --hash, without colours, which are compared
    otherwise."""
    words = [line.split() for line in text.splitlines()]
    return {line[0]: line[1] for line in words if line and line[0] != "picture"}


def render(program, folder, name, compare):
    command = [program, "render", *CASES[name], "-o", f"{name}.png", *(word.format(name) for word in MAPS), "--hash"]
    if compare:
        command += ["--reference", HERE / f"{name}.png", "--reference-threshold", str(COLOUR_TOLERANCE)]
    done = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True)
    return done, hashes_of(done.stdout)


def inflated(data):
    """A PDF with its streams decompressed, without their lengths and offsets."""
    data = re.sub(rb"stream\n(.*?)\nendstream", lambda found: zlib.decompress(found.group(1)), data, flags=re.S)
    return re.sub(rb"/Length \d+|^\d{10} .*$|startxref\n\d+", b"", data, flags=re.M)


def draw(program, folder, name):
    """Hashes of the bytes of a figure or a drawing, by format."""
    words, formats = (["render", *FIGURES[name]], ["svg"]) if name in FIGURES else (["lines", *DRAWINGS[name]], ["svg", "pdf", "dxf", "json"])
    outputs = [word for suffix in formats for word in ("-o", f"{name}.{suffix}")]
    subprocess.run([str(word) for word in [program, *words, *outputs, "--quiet"]], cwd=folder, check=True)
    hashes = {}
    for suffix in formats:
        data = (folder / f"{name}.{suffix}").read_bytes()
        hashes[suffix] = hashlib.sha256(inflated(data) if suffix == "pdf" else data).hexdigest()[:16]
    return hashes


def check(program, folder):
    stored = json.loads(HASHES.read_text())
    failures = []
    for name in [*FIGURES, *DRAWINGS]:
        if draw(program, folder, name) != stored[name]:
            failures.append(f"{name}: its bytes differ from those stored")
    for name in CASES:
        done, found = render(program, folder, name, True)
        if done.returncode != 0:
            failures.append(f"{name}: exit status {done.returncode}: {done.stderr.strip()}")
        for key in sorted(set(stored[name]) | set(found)):
            if stored[name].get(key) != found.get(key):
                failures.append(f"{name}: {key} has hash {found.get(key)}, stored is {stored[name].get(key)}")
    if failures:
        sys.exit("\n".join(failures) + f"\npictures and differences: {folder}; references: {HERE}")
    print(f"{len(CASES)} pictures, {len(FIGURES)} figures, {len(DRAWINGS)} drawings, {sum(map(len, stored.values()))} hashes")


def update(program, folder):
    stored = {}
    for name in CASES:
        done, stored[name] = render(program, folder, name, False)
        if done.returncode != 0:
            sys.exit(f"{name}: {done.stderr}")
        shutil.copy(folder / f"{name}.png", HERE / f"{name}.png")
    stored |= {name: draw(program, folder, name) for name in [*FIGURES, *DRAWINGS]}
    HASHES.write_text(json.dumps(stored, indent=1, sort_keys=True) + "\n")


def main():
    if len(sys.argv) != 4 or sys.argv[1] not in ("check", "update"):
        sys.exit(__doc__)
    program, folder = pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    (check if sys.argv[1] == "check" else update)(program, folder)


if __name__ == "__main__":
    main()
