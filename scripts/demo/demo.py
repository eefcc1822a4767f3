#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders the built-in scenes with every output kind and makes one page of them.

    demo.py PROGRAM FOLDER

The page FOLDER/index.html holds its pictures, so that it can be copied anywhere alone; the files that a browser cannot
show (EXR, NPY, PFM) lie beside it.
"""
import dataclasses
import json
import pathlib
import shlex
import subprocess
import sys
import time

import page
from shows import SECTIONS


@dataclasses.dataclass
class Result:
    """What one command did."""

    show: object
    files: list
    wall_ms: float
    report: dict


def run_show(program, folder, show):
    command = [program, "render", *shlex.split(show.arguments), "--json"]
    start = time.perf_counter()
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    wall_ms = 1e3 * (time.perf_counter() - start)
    if done.returncode != 0:
        sys.exit(f"frontmost render {show.arguments}\nfailed with {done.returncode}\n{done.stderr}")
    return Result(show, [folder / name for name in show.files], wall_ms, json.loads(done.stdout))


def content_hash(program, arguments):
    """The hash of what is visible, as --hash prints it: a promise of equal bytes, so it is shown for several runs."""
    done = subprocess.run([program, "render", *shlex.split(arguments), "--hash"], capture_output=True, text=True)
    return done.stdout.split() if done.returncode == 0 else []


def same_bytes(program):
    """(how it ran, the hash of visible surfaces) for instruction sets and thread counts that this machine has."""
    rows = []
    for how in ["--isa scalar --threads 1", "--isa sse4", "--isa avx2", "--isa avx512", "--threads 7"]:
        words = content_hash(program, f"builtin:city --resolution 640,360 {how}")
        if words:
            rows.append((how, words[words.index("visible") + 1] if "visible" in words else words[0]))
    return rows


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program, folder = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    sections = []
    for section in SECTIONS:
        results = []
        for show in section.shows:
            results.append(run_show(program, folder, show))
            print(f"  {results[-1].wall_ms:6.0f} ms  frontmost render {show.arguments}")
        sections.append((section, results))
    version = subprocess.run([program, "--version"], capture_output=True, text=True).stdout.strip()
    index = folder / "index.html"
    index.write_text(page.html(sections, same_bytes(program), version))
    print(f"\nLook at {index.resolve()}")


main()
