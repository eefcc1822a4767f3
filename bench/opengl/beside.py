#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Frames of OpenGL by Frontmost, and beside them by Mesa's llvmpipe if Debian's libosmesa6 is installed.

    beside.py FRAMES [REPETITIONS]

Prints the least processor time of each frame by one thread, in turn by each library, and the time on the clock by one
thread over that by two.
"""
import ctypes.util
import os
import subprocess
import sys

frames, repetitions = sys.argv[1], (sys.argv[2:] or ["10"])[0]


def measured(**environment):
    """Least milliseconds by name: processor time, and time on the clock."""
    done = subprocess.run([frames, repetitions], env=dict(os.environ, **environment), capture_output=True, text=True,
                          check=True)
    rows = (line.split("\t") for line in done.stdout.splitlines())
    return done.stderr.strip(), {name: (float(cpu), float(wall)) for name, cpu, wall in rows}


def least(*tables):
    return {name: tuple(map(min, zip(*(table[name] for table in tables)))) for name in tables[0]}


mesa = ctypes.util.find_library("OSMesa")
ours, theirs, by_two = [], [], []
for _ in range(3):
    ours.append(measured(FRONTMOST_GL_THREADS="1")[1])
    by_two.append(measured(FRONTMOST_GL_THREADS="2")[1])
    if mesa:
        name, table = measured(LD_PRELOAD=mesa, LP_NUM_THREADS="0", GALLIUM_DRIVER="llvmpipe")
        theirs.append(table)
one, two = least(*ours), least(*by_two)
print(f"beside {name}" if mesa else "libosmesa6 is not installed")
print(f"{'frame':50}  {'ms':>7}  {'llvmpipe':>8}  {'times':>6}  {'by two threads':>14}")
other = least(*theirs) if mesa else {}
for frame, (cpu, wall) in one.items():
    ratio = f"{other[frame][0]:8.1f}  {other[frame][0] / cpu:6.2f}" if mesa else f"{'':8}  {'':6}"
    print(f"{frame:50}  {cpu:7.1f}  {ratio}  {wall / two[frame][1]:14.2f}")
