#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""frontmost gl: pictures of a program with a window, events, arguments, exit statuses, and what is wrong.

    command.py FRONTMOST WINDOW
"""
import os
import pathlib
import struct
import subprocess
import sys
import tempfile

frontmost, window = (pathlib.Path(path).resolve() for path in sys.argv[1:])
failures = 0


def run(*arguments, folder, **environment):
    return subprocess.run([frontmost, "gl", *arguments], cwd=folder, capture_output=True, text=True, timeout=300,
                          env=dict(os.environ, **environment))


def expect(holds, what):
    global failures
    if not holds:
        failures += 1
        print("expected:", what)


def size(path):
    return struct.unpack(">II", path.read_bytes()[16:24]) if path.exists() else None


def refused(done, *words):
    expect(done.returncode != 0 and all(word in done.stderr for word in words),
           f"an error with {words}, not {done.returncode}: {done.stderr}")


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    done = run(window, "-o", "a.png", folder=folder)
    expect(done.returncode == 0 and size(folder / "a.png") == (320, 240), f"a picture of 320 x 240: {done.stderr}")
    for threads, isa in (("1", "scalar"), ("5", "best")):
        run(window, "-o", "same.png", folder=folder, FRONTMOST_GL_THREADS=threads, FRONTMOST_GL_ISA=isa)
        expect((folder / "same.png").read_bytes() == (folder / "a.png").read_bytes(), f"the same bytes with {threads}, {isa}")
    run(window, "--frames", "30", "--size", "160x120", "-o", "b.png", folder=folder)
    expect(size(folder / "b.png") == (160, 120), "a picture of 160 x 120")
    (folder / "tour.txt").write_text("frames 10\nkey a\nwrite axis.png\nreshape 100 80\nwrite small.png\n")
    done = run(window, "--script", "tour.txt", "--", "-model", "x", folder=folder)
    expect(done.returncode == 0 and "argument -model\nargument x\n" in done.stdout, f"the program's arguments: {done.stdout}")
    expect(done.returncode == 0, f"a script: {done.stderr}")
    expect(size(folder / "axis.png") == (320, 240) and size(folder / "small.png") == (100, 80), "the script's pictures")
    expect((folder / "axis.png").read_bytes() != (folder / "a.png").read_bytes(), "events change the picture")

    done = run(window, "--explain", "160,120", "-o", "a.png", folder=folder)
    expect(done.stdout.startswith("pixel 160,120:\ndraw ") and ": drawn: depth LESS: 0." in done.stdout,
           f"what happened at a pixel: {done.stdout}")
    expect("nothing came to it" in run(window, "--explain", "0,0", folder=folder).stdout, "nothing at a corner")
    expect("outside of the picture" in run(window, "--explain", "320,0", folder=folder).stdout, "a pixel outside")

    (folder / "bad.txt").write_text("frames 10\nkey\n")
    refused(run(window, "--script", "bad.txt", folder=folder), "bad.txt:2")
    refused(run("./nothing", folder=folder), "./nothing")
    refused(run("/bin/true", "-o", "c.png", folder=folder), "/bin/true")
    expect(not (folder / "c.png").exists(), "no picture of a program that draws none")
    expect(run("/bin/sh", "--", "-c", "exit 7", folder=folder).returncode == 7, "the program's exit status")
    refused(run(window, folder=folder, FRONTMOST_GL_LIBRARIES="/nowhere"), "frontmost-gl")
    refused(run(window, "--size", "0x5", folder=folder), "size")
    refused(run(window, "--explain", "5", folder=folder), "--explain", "X,Y")
sys.exit(failures != 0)
