#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the rules of the house that a compiler cannot: arrows, budgets of lines, licences, unfinished work.

The parts, their rooms, what each may include and how many lines a part may have are read from the house block of
docs/design.md, so the page cannot drift from the code:

  core/     base.h view.h        (nobody)                 12,000 lines     a part, its public headers, the parts below it
    view/     words                (surfaces)             a room of it, and the rooms of its part that it may include
"""
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
MADE = {"build", "out", ".git"}  # made by ./dev and git
CODE = {".h", ".cpp"}
MARKED = CODE | {".py", ".sh", ".cmake"}
LARGEST_FILE = 512 * 1024  # bytes; a larger file is soon committed by mistake, and stays in the history
LIBRARY = {"include", "src", "cli", "python", "web"}  # a name has one meaning in all of these
FACES = {"cli", "examples", "python", "web"}  # these include include/frontmost alone; tests and benchmarks look inside


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


class House:
    """The parts and rooms that docs/design.md describes."""

    def __init__(self, page):
        self.part_of_header, self.budgets, self.part_of_room = {}, {}, {}
        parts, rooms, part = {}, {}, None
        for line in page.splitlines():
            if match := re.match(r"^  ([a-z]+)/ +(.*?) +\(([^()]*)\) +([\d,]+) lines$", line):
                part, headers = match[1], match[2].split()
                parts[part] = self.named(match[3])
                self.budgets[part] = int(match[4].replace(",", ""))
                self.part_of_header.update({name.removesuffix(".h"): part for name in [f"{part}.h", *headers]})
            elif part and (match := re.match(r"^    ([a-z]+)/ .*\(([^()]*)\)$", line)):
                self.part_of_room[match[1]] = part
                rooms[match[1]] = self.named(match[2])
        self.parts, self.rooms = self.closed(parts), self.closed(rooms)
        of_part = {part: {room for room in rooms if self.part_of_room[room] == part} for part in parts}
        # If most rooms of a part have headers of their names, the arrows between rooms hold for these headers too.
        self.room_of_header = {room: room for within in of_part.values() for room in within & self.part_of_header.keys()
                               if 2 * len(within & self.part_of_header.keys()) > len(within)}
        # Headers that only include others are for users, not for the library.
        self.gathering = {"frontmost"} | {part for part in parts if len(of_part[part]) > 1 and part not in rooms}

    @staticmethod
    def named(words):
        return [] if words == "nobody" else words.split(", ")

    @staticmethod
    def closed(direct):
        """Maps each name to all names that it may include, itself among them."""
        found = {}

        def close(name):
            if name not in found:
                found[name] = {name}.union(*(close(below) for below in direct[name]))
            return found[name]

        for name in direct:
            close(name)
        return found

    def may_include(self, room, other):
        """Whether `room` may include `other`: a room of a part below, or a room of its own part that its line allows."""
        part, below = self.part_of_room[room], self.part_of_room[other]
        return other in self.rooms[room] if part == below else below in self.parts[part]


def header_errors(house):
    """Every header of include/frontmost belongs to a part, except the one that includes them all."""
    there = {path.stem for path in (ROOT / "include/frontmost").glob("*.h")} - {"frontmost"}
    for name in sorted(there - house.part_of_header.keys()):
        yield f"include/frontmost/{name}.h: docs/design.md does not say which part it is of"
    for name in sorted(house.part_of_header.keys() - there):
        yield f"docs/design.md: there is no include/frontmost/{name}.h"


def arrow_errors(path, text, house):
    top = path.parts[0]
    if top == "src":
        if len(path.parts) < 4:
            yield f"{path}: lies in no room"
            return
        part, room = path.parts[1:3]
        if house.part_of_room.get(room) != part:
            yield f"{path}: docs/design.md has no room {room} in {part}"
            return
    elif top == "include":
        part, room = house.part_of_header.get(path.stem), house.room_of_header.get(path.stem)
    else:
        part = room = None
    for number, line in enumerate(text.splitlines(), 1):
        match = re.match(r'\s*#\s*include\s+["<](?:(frontmost)/([a-z_]+)\.h|([a-z]+)/)', line)
        if not match:
            continue
        header = match[2]
        if header and part and path.stem not in house.gathering and header != "version":
            of_room = house.room_of_header.get(header)
            if (header in house.gathering or house.part_of_header.get(header) not in house.parts[part]
                    or room and of_room and not house.may_include(room, of_room)):
                yield f"{path}:{number}: {room or part} must not include frontmost/{header}.h"
        if match[3] in house.part_of_room:
            if room and not house.may_include(room, match[3]):
                yield f"{path}:{number}: {room} must not include {match[3]}"
            if top == "include":
                yield f"{path}:{number}: a public header must not include {match[3]}'s own headers"
            if top in FACES:
                yield f"{path}:{number}: {top} sees include/frontmost alone, not {match[3]}'s own headers"


def budget_errors(texts, house):
    """The lines of a part are the lines of its folder and of its public headers."""
    lines = dict.fromkeys(house.budgets, 0)
    for path, text in texts.items():
        part = path.parts[1] if path.parts[0] == "src" else house.part_of_header.get(path.stem) if path.parts[0] == "include" else None
        if part in lines:
            lines[part] += text.count("\n")
    for part, budget in house.budgets.items():
        if lines[part] > budget:
            yield f"src/{part}: {lines[part]} lines, more than the {budget} of docs/design.md"
        elif lines[part] < budget - 500:
            yield f"src/{part}: {lines[part]} lines; lower the budget of {budget} in docs/design.md"


def lost_includes(texts):
    """Every quoted include of a header of the house must name an existing file. An include of a header that was merged
    into another one is caught here. `texts`: path -> text."""
    there = {str(path) for path in texts}
    homes = ("", "include/", "tests/", "bench/", *{f"src/{path.parts[1]}/" for path in texts if path.parts[0] == "src"})
    ours = {folder for path in texts for folder in path.parts[:-1][:3]}
    for path, text in texts.items():
        for number, line in enumerate(text.splitlines(), 1):
            match = re.match(r'\s*#\s*include\s+(?:"([^"]+)"|<(frontmost/[^>]+)>)', line)
            if not match or (name := match[1] or match[2]) == "frontmost/version.h":  # the build generates it
                continue
            if "/" in name and name.split("/")[0] not in ours:  # a header of another library
                continue
            if not any(f"{home}{name}" in there for home in (*homes, f"{path.parent}/")):
                yield f"{path}:{number}: there is no {name}"


def cli_folder_errors(texts):
    """Folders of cli include each other in one direction only. `texts`: path -> text. Any folder may include the files
    beside the folders."""
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
    """(line number, name, meaning) of the types that a file defines at namespace scope. The meaning of an alias is its
    target; the meaning of any other type is its place."""
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
    """Highway's operations are included through base/highway-inl.h only, because they may be precompiled."""
    if path.parts[:3] == ("src", "core", "base") and path.name in {"highway-inl.h", "all_targets.h"}:
        return
    for number, line in enumerate(text.splitlines(), 1):
        if re.match(r"\s*#\s*include\s+[\"<]hwy/(highway|foreach_target|contrib/|ops/)", line):
            yield f"{path}:{number}: base/highway-inl.h includes Highway"


def file_errors(path, text):
    lines = text.splitlines()
    if path.suffix in MARKED:
        if not any("SPDX-License-Identifier: Apache-2.0" in line for line in lines[:3]):
            yield f"{path}: no SPDX line at its top"
    if path.suffix in MARKED and path.name != "check_house.py":
        for number, line in enumerate(lines, 1):
            if re.search(r"\b(TODO|FIXME|XXX|HACK)\b", line):
                yield f"{path}:{number}: unfinished: {line.strip()}"


def main():
    house = House(read("docs/design.md"))
    if len(house.parts) < 7 or len(house.rooms) < 15:
        sys.exit("docs/design.md: the house block was not understood")
    errors, sources, types, texts = list(header_errors(house)), 0, [], {}
    for path in tracked_files():
        if (size := (ROOT / path).stat().st_size) > LARGEST_FILE:
            errors.append(f"{path}: {size} bytes, more than {LARGEST_FILE}")
        if path.suffix not in MARKED:
            continue
        text = read(path)
        sources += path.suffix in CODE
        errors += file_errors(path, text)
        if path.suffix in CODE:
            errors += arrow_errors(path, text, house)
            errors += highway_errors(path, text)
            texts[path] = text
            if path.parts[0] in LIBRARY:
                types += [(path, *found) for found in types_of(text)]
    errors += budget_errors(texts, house)
    errors += name_errors(types)
    errors += lost_includes(texts)
    errors += cli_folder_errors(texts)
    print("\n".join(errors) if errors else f"house: {sources} C++ files in order, {len(house.rooms)} rooms in {len(house.parts)} parts")
    sys.exit(bool(errors))


if __name__ == "__main__":
    main()
