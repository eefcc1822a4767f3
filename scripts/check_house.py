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
LIBRARY = {"include", "src", "cli", "python", "web"}  # a name has one meaning in all of these
FACES = {"cli", "examples", "python", "web"}  # see include/frontmost alone; tests and benchmarks look inside


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


def public_headers(rooms):
    """Public header without ".h" -> its room: the one of its name, or that in brackets behind it in docs/design.md."""
    block = re.search(r"^include/frontmost/ (.*?)^src/", read("docs/design.md"), re.M | re.S)[1]
    headers = {room: room for room in rooms}
    for names, room in re.findall(r"([^()]*)\(([a-z]+)\)", block):
        headers.update({name: room for name in re.findall(r"([a-z_]+)\.h", names)})
    del headers["frontmost"]  # all of them
    return headers


def header_errors(headers):
    """Every header of include/frontmost is of a room, but for the one that includes them all."""
    for path in sorted((ROOT / "include/frontmost").glob("*.h")):
        if path.stem not in {"frontmost", *headers}:
            yield f"include/frontmost/{path.name}: docs/design.md does not say which room it is of"


def included_rooms(text, headers):
    """Rooms named by the includes of a file: "room/file.h" or "frontmost/header.h"."""
    for number, line in enumerate(text.splitlines(), 1):
        match = re.match(r'\s*#\s*include\s+["<](?:(frontmost)/)?([a-z_]+)(?:/|\.h)', line)
        if match and (match[1] or headers.get(match[2]) == match[2]) and match[2] in headers:
            yield number, headers[match[2]], match[1] is not None


def arrow_errors(path, text, allowed, headers):
    top = path.parts[0]
    home = path.parts[1] if top == "src" and len(path.parts) > 2 else None
    if top == "src" and home and home not in allowed:
        yield f"{path}: room {home} is not in docs/design.md"
        return
    for number, room, public in included_rooms(text, headers):
        if home and room not in allowed[home]:
            yield f"{path}:{number}: {home} must not include {room}"
        if top in FACES and not public:
            yield f"{path}:{number}: {top} sees include/frontmost alone, not {room}'s own headers"


def lost_includes(texts):
    """Every include in quotes of a header of the house names one that is there: a header that was merged into another one
    may still be asked for by a file that was written meanwhile. `texts`: path -> text."""
    there = {str(path) for path in texts}
    homes = ("", "src/", "include/", "tests/", "bench/")
    ours = {path.parts[0] for path in texts} | {path.parts[1] for path in texts if len(path.parts) > 2}
    for path, text in texts.items():
        for number, line in enumerate(text.splitlines(), 1):
            match = re.match(r'\s*#\s*include\s+(?:"([^"]+)"|<(frontmost/[^>]+)>)', line)
            if not match or (name := match[1] or match[2]) == "frontmost/version.h":  # which the build makes
                continue
            if "/" in name and name.split("/")[0] not in ours:  # another library's
                continue
            if not any(f"{home}{name}" in there for home in (*homes, f"{path.parent}/")):
                yield f"{path}:{number}: there is no {name}"


def cli_folder_errors(texts):
    """Folders of cli include each other one way only. `texts`: path -> text. Files beside the folders are everybody's."""
    included = {}  # folder -> {folder: where}
    for path, text in texts.items():
        if path.parts[0] != "cli" or len(path.parts) < 3:
            continue
        for number, line in enumerate(text.splitlines(), 1):
            if (match := re.match(r'#include "cli/(\w+)/', line)) and match[1] != path.parts[1]:
                included.setdefault(path.parts[1], {}).setdefault(match[1], f"{path}:{number}")

    def reached(folder, seen):
        for other in included.get(folder, {}):
            if other not in seen:
                seen.add(other)
                reached(other, seen)
        return seen

    for folder, others in included.items():
        for other, place in others.items():
            if folder in reached(other, set()):
                yield f"{place}: cli/{other} includes cli/{folder}, so cli/{folder} must not include cli/{other}"


def types_of(text):
    """(line number, name, meaning) of the types that a file defines at namespace scope; of an alias the meaning is what
    it stands for, of all others it is their place."""
    for number, line in enumerate(text.splitlines(), 1):
        if match := re.match(r"using ([A-Z]\w\w+) = (.*);", line):
            yield number, match[1], match[2]
        elif match := re.match(r"(?:template <.*> )?(?:class|struct|enum class|union) (?:\w+\(.*?\) )?([A-Z]\w\w+)(?= [^;]*\{| :)", line):
            yield number, match[1], None


def name_errors(places):
    """A name at namespace scope means one thing in the whole library. `places`: (path, line number, name, meaning)."""
    by_name = {}
    for path, number, name, meaning in places:
        by_name.setdefault(name, {})[meaning or path] = f"{path}:{number}"
    for name, meanings in sorted(by_name.items()):
        if len(meanings) > 1:
            yield f"{name} means {len(meanings)} things: {', '.join(meanings.values())}"


def highway_errors(path, text):
    """Highway's operations are included by way of base/highway-inl.h: they may be precompiled."""
    if path.parts[:2] == ("src", "base") and path.name in {"highway-inl.h", "all_targets.h"}:
        return
    for number, line in enumerate(text.splitlines(), 1):
        if re.match(r"\s*#\s*include\s+[\"<]hwy/(highway|foreach_target|contrib/|ops/)", line):
            yield f"{path}:{number}: base/highway-inl.h includes Highway"


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
    headers = public_headers(allowed)
    errors, sources, types, texts = list(header_errors(headers)), 0, [], {}
    for path in tracked_files():
        if (size := (ROOT / path).stat().st_size) > LARGEST_FILE:
            errors.append(f"{path}: {size} bytes, more than {LARGEST_FILE}")
        if path.suffix not in MARKED:
            continue
        text = read(path)
        sources += path.suffix in CODE
        errors += file_errors(path, text)
        if path.suffix in CODE:
            errors += arrow_errors(path, text, allowed, headers)
            errors += highway_errors(path, text)
            texts[path] = text
            if path.parts[0] in LIBRARY:
                types += [(path, *found) for found in types_of(text)]
    errors += name_errors(types)
    errors += lost_includes(texts)
    errors += cli_folder_errors(texts)
    print("\n".join(errors) if errors else f"house: {sources} C++ files in order, {len(allowed)} rooms")
    sys.exit(bool(errors))


if __name__ == "__main__":
    main()
