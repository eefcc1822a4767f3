#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that every source file compiles alone: without the other files of its folder, and without a precompiled header.

The usual build joins the files of a folder, so a file may rely on an include of its neighbour without anybody noticing.
"""
import concurrent.futures
import json
import os
import pathlib
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build/alone"


def error_of(entry):
    words = shlex.split(entry["command"])
    words = words[words.index(next(word for word in words if word.endswith("++"))):]  # without a compiler cache
    place = words.index("-o")
    del words[place:place + 2]
    done = subprocess.run([*words, "-fsyntax-only", "-w"], cwd=entry["directory"], capture_output=True, text=True)
    return done.stderr if done.returncode else ""


def main():
    options = ["-DFRONTMOST_TOGETHER=OFF", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON",
               "-DFRONTMOST_TESTS=ON", "-DFRONTMOST_BENCH=ON", "-DFRONTMOST_PYTHON=AUTO"]
    subprocess.run(["cmake", "--preset", "release", "-B", BUILD, *options], cwd=ROOT, check=True, capture_output=True)
    entries = json.loads((BUILD / "compile_commands.json").read_text())
    # The build makes a few files. Programs in C are whole files in any case.
    entries = [entry for entry in entries if entry["file"].endswith(".cpp") and pathlib.Path(entry["file"]).exists()]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        errors = [error for error in pool.map(error_of, entries) if error]
    print(f"{len(entries)} files, {len(errors)} do not compile alone", *errors, sep="\n")
    sys.exit(bool(errors) or len(entries) < 500)


main()
