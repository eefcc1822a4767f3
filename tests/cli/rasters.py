# SPDX-License-Identifier: Apache-2.0
"""Images of other programs as integer arrays: rows, columns and, unless grey, channels.

Without NumPy and Pillow the importing test is skipped. If python3 is not the system's, Debian's packages belong to
another interpreter, and the test restarts in that one.
"""
import os
import sys

SYSTEM_PYTHON = "/usr/bin/python3"

try:
    import numpy
    from PIL import Image
except ImportError as missing:
    if sys.executable != SYSTEM_PYTHON and os.path.exists(SYSTEM_PYTHON):
        os.execv(SYSTEM_PYTHON, [SYSTEM_PYTHON, *sys.argv])
    print(f"skipped: {missing}")
    sys.exit(77)


def read_picture(path):
    """Reads a PNG, PGM or PPM."""
    with Image.open(path) as picture:
        return numpy.asarray(picture).astype(int)


def read_ids(path):
    """Reads an id map that frontmost wrote as .npy."""
    return numpy.load(path)


def near(fine, step, before, size):
    """Squares of `size` pixels, beginning `before` pixels before each pixel of a picture `step` times as coarse."""
    after = size - before - step
    padded = numpy.pad(fine, ((before, after), (before, after)) + ((0, 0),) * (fine.ndim - 2), "edge")
    return numpy.lib.stride_tricks.sliding_window_view(padded, (size, size), (0, 1))[::step, ::step]
