#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that check_house.py refuses includes against the arrows and names them; exit status 0 if all is well."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import check_house as house

REFUSED = {
    "src/methods/zbuffer/x.cpp": ["frontmost/raycast.h", "frontmost/methods.h", "raycast/x.h", "shade/x.h"],
    "src/core/base/x.cpp": ["frontmost/scene.h", "view/x.h"],
    "src/core/view/x.cpp": ["frontmost/frontmost.h", "frontmost/zbuffer.h"],
    "src/files/io/x.cpp": ["frontmost/zbuffer.h", "pages/x.h"],
    "src/drawings/rounds/x.cpp": ["sheets/x.h", "frontmost/files.h"],
    "include/frontmost/base.h": ["frontmost/view.h", "base/parallel.h"],
    "cli/x.cpp": ["view/x.h"],
}
ALLOWED = {
    "src/methods/zbuffer/x.cpp": ["frontmost/zbuffer.h", "frontmost/view.h", "view/x.h", "zbuffer/x.h"],
    "src/drawings/sheets/x.cpp": ["rounds/x.h", "frontmost/sheets.h", "shade/x.h", "painter/x.h"],
    "include/frontmost/frontmost.h": ["frontmost/core.h"],
    "include/frontmost/view.h": ["frontmost/scene.h"],
    "cli/x.cpp": ["frontmost/frontmost.h", "cli/view/x.h"],
}


def errors(path, name):
    return list(house.arrow_errors(pathlib.PurePosixPath(path), f'#include "{name}"\n', rooms))


rooms = house.House(house.read("docs/design.md"))
wrong = [f"{path} may include {name}" for path, names in REFUSED.items() for name in names if not errors(path, name)]
wrong += [error for path, names in ALLOWED.items() for name in names for error in errors(path, name)]
if not errors("src/core/x.cpp", "base/isa.h"):
    wrong.append("src/core/x.cpp lies in no room, and passes")
lost = {pathlib.PurePosixPath("src/drawings/lines/x.cpp"): '#include "hatching/nowhere.h"\n',
        pathlib.PurePosixPath("src/drawings/hatching/y.h"): ""}
if not list(house.lost_includes(lost)):
    wrong.append("hatching/nowhere.h is not missed")
sys.exit("\n".join(wrong) or 0)
