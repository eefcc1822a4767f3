#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders and draws the built-in scenes with every output kind and makes one page of them.

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
    """The outcome of one command."""

    show: object
    files: list
    wall_ms: float
    report: dict


def run_show(program, folder, show):
    command = [program, show.command, *shlex.split(show.arguments), "--json"]
    start = time.perf_counter()
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    wall_ms = 1e3 * (time.perf_counter() - start)
    if done.returncode != 0:
        sys.exit(f"frontmost {show.command} {show.arguments}\nfailed with {done.returncode}\n{done.stderr}")
    return Result(show, [folder / name for name in show.files], wall_ms, json.loads(done.stdout))


def same_bytes(program):
    """Pairs (options of the run, hash of the visible surfaces) for this machine's instruction sets, and for odd
    threads."""
    rows = []
    for how in ["--isa scalar --threads 1", "--isa sse4", "--isa avx2", "--isa avx512", "--threads 7"]:
        command = [program, "render", "builtin:city", "--resolution", "640,360", "--hash", *how.split()]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode == 0:  # the program refuses a set that the machine lacks
            rows.append((how, done.stdout.split()[1]))
    return rows


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program, folder = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    bracket = pathlib.Path(__file__).parents[2] / "examples/bracket.py"
    (folder / "bracket.obj").write_bytes(subprocess.run([sys.executable, bracket], capture_output=True, check=True).stdout)
    sections = []
    for section in SECTIONS:
        results = []
        for show in section.shows:
            results.append(run_show(program, folder, show))
            print(f"  {results[-1].wall_ms:6.0f} ms  frontmost {show.command} {show.arguments}")
        sections.append((section, results))
    version = subprocess.run([program, "--version"], capture_output=True, text=True).stdout.strip()
    index = folder / "index.html"
    browser_page = folder.parent / "page/index.html"
    link = "../page/index.html" if browser_page.is_file() else None
    index.write_text(page.html(sections, same_bytes(program), version, link))
    print(f"\nLook at {index.resolve()}")


main()
