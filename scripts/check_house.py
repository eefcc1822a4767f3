#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the rules of the house that a compiler cannot: arrows, sizes, licences, unfinished work.

The rooms and what each may include are read from the house block of docs/design.md, so the page cannot drift from the
code: a line "  shade/   words   (image, zbuffer)" allows image, zbuffer and everything that those allow.
"""
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
MADE = {"build", "out", ".git"}  # by ./dev and git
CODE = {".h", ".cpp"}
MARKED = CODE | {".py", ".sh", ".cmake"}
LONGEST_FILE = 800
LARGEST_FILE = 512 * 1024  # bytes; what a command wrote is soon there by mistake, and stays in the history
PUBLIC_HEADER_OF = {"visible": "view", "ray_camera": "raycast", "page": "io", "sheet_view": "sheets", "dimensions": "sheets",
                    "lettering": "sheets", "section_marks": "sheets", "title_block": "sheets"}  # the others carry their room's name
FACES = {"cli", "examples"}  # see include/frontmost alone; tests and benchmarks look inside


def tracked_files():
    listing = None
    if shutil.which("git"):
        command = ["git", "-C", ROOT, "ls-files", "-co", "--exclude-standard"]
        listing = subprocess.run(command, capture_output=True, text=True)
    if listing and listing.returncode == 0:
        names = listing.stdout.splitlines()
    else:  # an unpacked archive is no repository, and a bare system has no git
        names = [str(p.relative_to(ROOT)) for p in ROOT.rglob("*") if p.is_file() and not MADE.intersection(p.parts)]
    return sorted(pathlib.PurePosixPath(n) for n in names if (ROOT / n).is_file())


def read(path):
    return (ROOT / path).read_text(errors="replace")


def allowed_rooms():
    """Room -> all rooms that it may include, itself among them."""
    direct = {}
    for line in read("docs/design.md").splitlines():
        match = re.match(r"^  ([a-z]+)/ .*\(([^()]*)\)$", line)
        if match:
            direct[match[1]] = [] if match[2] == "nobody" else match[2].split(", ")
    closed = {}

    def close(room):
        if room not in closed:
            closed[room] = {room}.union(*(close(below) for below in direct[room]))
        return closed[room]

    for room in direct:
        close(room)
    return closed


def included_rooms(text, rooms):
    """Rooms named by the includes of a file: "room/file.h" or "frontmost/room.h"."""
    for number, line in enumerate(text.splitlines(), 1):
        match = re.match(r'\s*#\s*include\s+["<](?:(frontmost)/)?([a-z_]+)(?:/|\.h)', line)
        if not match:
            continue
        room = PUBLIC_HEADER_OF.get(match[2], match[2])
        if room in rooms:
            yield number, room, match[1] is not None


def arrow_errors(path, text, allowed):
    top = path.parts[0]
    home = path.parts[1] if top == "src" and len(path.parts) > 2 else None
    if top == "src" and home and home not in allowed:
        yield f"{path}: room {home} is not in docs/design.md"
        return
    for number, room, public in included_rooms(text, allowed):
        if home and room not in allowed[home]:
            yield f"{path}:{number}: {home} must not include {room}"
        if top in FACES and not public:
            yield f"{path}:{number}: {top} sees include/frontmost alone, not {room}'s own headers"


def file_errors(path, text):
    lines = text.splitlines()
    if path.suffix in CODE and len(lines) > LONGEST_FILE:
        yield f"{path}: {len(lines)} lines, more than {LONGEST_FILE}"
    if path.suffix in MARKED:
        if not any("SPDX-License-Identifier: Apache-2.0" in line for line in lines[:3]):
            yield f"{path}: no SPDX line at its top"
    if path.suffix in MARKED and path.name != "check_house.py":
        for number, line in enumerate(lines, 1):
            if re.search(r"\b(TODO|FIXME|XXX|HACK)\b", line):
                yield f"{path}:{number}: unfinished: {line.strip()}"


def main():
    allowed = allowed_rooms()
    if len(allowed) < 8:
        sys.exit("docs/design.md: the house block was not understood")
    errors, sources = [], 0
    for path in tracked_files():
        if (size := (ROOT / path).stat().st_size) > LARGEST_FILE:
            errors.append(f"{path}: {size} bytes, more than {LARGEST_FILE}")
        if path.suffix not in MARKED:
            continue
        text = read(path)
        sources += path.suffix in CODE
        errors += file_errors(path, text)
        if path.suffix in CODE:
            errors += arrow_errors(path, text, allowed)
    print("\n".join(errors) if errors else f"house: {sources} C++ files in order, {len(allowed)} rooms")
    sys.exit(bool(errors))


if __name__ == "__main__":
    main()
