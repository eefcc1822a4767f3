# SPDX-License-Identifier: Apache-2.0
"""Pictures as arrays that show themselves."""
import os
import tempfile

import numpy

from . import _core


class Bitmap(numpy.ndarray):
    """A picture: (height, width, 4) uint8, sRGB with straight alpha, rows from the top. It is NumPy's array, which shows
    itself in notebooks."""

    def _repr_png_(self):
        if self.ndim != 3 or self.shape[2] not in (3, 4) or self.dtype != numpy.uint8 or 0 in self.shape:
            return None
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "picture.png")
            _core.save(self, path)
            with open(path, "rb") as file:
                return file.read()


Bitmap.__module__ = "frontmost"
