# SPDX-License-Identifier: Apache-2.0
"""What can be seen from here? Visible surfaces of 3D models, exactly and fast, on any CPU.

    import frontmost as fm

    scene = fm.load("engine.glb")
    seen = fm.Surfaces(scene).zbuffer(fm.frame(scene))
    seen.depth, seen.object, seen.face

Arrays are NumPy's. World space is right-handed; eyes look down -z, y up; rows of pixels are counted from the top; angles
are in degrees. docs/python.md has every call, docs/conventions.md what every number means.
"""
from . import _core
from ._bitmap import Bitmap
from ._core import *  # noqa: F403

__version__ = _core.version
__all__ = ["Bitmap"] + [name for name in dir(_core) if not name.startswith("_") and name != "version"]

