#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Installs a build into a fresh folder, compares the installed files with the stored list, and builds and runs the
consumer against them, found once by CMake and once by pkg-config. Also builds a program that needs only the methods.

    consumer.py BUILD            the test; exit status 0 if all is well
    consumer.py BUILD --update   stores the lists again
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
STORED = HERE / "installed.txt"
MOST_BYTES = 800_000  # of the program that needs only the methods


def run(*command, **options):
    print("+", *command, flush=True)
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"{done.stdout}{done.stderr}failed with {done.returncode}")
    return done.stdout


def listing(folder):
    """All files below a folder. Public headers become one line, once they are known to be the repository's own."""
    found = {p.relative_to(folder).as_posix() for p in folder.rglob("*") if not p.is_dir()}
    headers = {name for name in found if name.endswith(".h") and "frontmost-gl" not in name}
    if headers:
        expected = {p.name for p in (HERE.parent.parent / "include" / "frontmost").glob("*.h")} | {"version.h"}
        if {pathlib.PurePath(name).name for name in headers} != expected:
            sys.exit(f"installed headers {sorted(headers)} are not those of include/frontmost")
        found = found - headers | {f"{pathlib.PurePath(min(headers)).parent}/*.h"}
    return sorted(found)


def compare(found, stored, update):
    if update:
        stored.write_text("\n".join(found) + "\n")
        return
    expected = stored.read_text().split("\n")[:-1]
    errors = [f"missing: {name}" for name in expected if name not in found]
    errors += [f"unexpected: {name}" for name in found if name not in expected]
    if errors:
        sys.exit("\n".join(errors) + f"\nthe list is {stored}; --update stores it anew")


def check_output(text):
    print(text, end="")
    if not re.match(r"frontmost [0-9.]+ sees [0-9a-f]{16}$", text):
        sys.exit("the consumer ran, and said something else")


def check_small(folder):
    """A program with a z-buffer of its own meshes finds no library of images, models or pages, and is small."""
    run("cmake", "--build", folder)
    picture = run(folder / "small")
    print(picture, end="")
    if not {"0", "1", "."} <= set(picture):
        sys.exit("the small program does not see both of its triangles")
    asked_for = (folder / "CMakeCache.txt").read_text()
    linked = run("readelf", "--dynamic", folder / "small")
    for name in ["png", "jpeg", "exr", "webp", "zip", "expat", "draco", "meshopt", "isal", "zlib", "libz.so"]:
        if re.search(name, asked_for + linked, re.IGNORECASE):
            sys.exit(f"the small program has to do with {name}")
    size = (folder / "small").stat().st_size
    print(f"{size} bytes: the small program, with the library in it")
    if size > MOST_BYTES and "libfrontmost" not in linked:
        sys.exit(f"more than {MOST_BYTES} bytes")


ASKS = """cmake_minimum_required(VERSION 3.22)
project(asks LANGUAGES CXX)
find_package(frontmost QUIET COMPONENTS methods OPTIONAL_COMPONENTS files nothing)
if(NOT frontmost_FOUND OR NOT frontmost_methods_FOUND OR frontmost_files_FOUND OR frontmost_nothing_FOUND)
  message(FATAL_ERROR "${frontmost_FOUND} ${frontmost_methods_FOUND} ${frontmost_files_FOUND} ${frontmost_nothing_FOUND}")
endif()
find_package(frontmost COMPONENTS nothing)
if(frontmost_FOUND OR NOT frontmost_NOT_FOUND_MESSAGE MATCHES "there is no part nothing")
  message(FATAL_ERROR "${frontmost_FOUND} ${frontmost_NOT_FOUND_MESSAGE}")
endif()
"""


def check_components(folder, prefix):
    """Methods are found without libpng, which static files need; a component that does not exist is named in the error."""
    if not list(prefix.rglob("libfrontmost_files.a")):
        return
    folder.mkdir()
    (folder / "CMakeLists.txt").write_text(ASKS)
    run("cmake", "-S", folder, "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_DISABLE_FIND_PACKAGE_PNG=ON")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--update", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        prefix = folder / "prefix"
        run("cmake", "--install", arguments.build.resolve(), "--prefix", prefix)
        # The modules for Python and MPI lie where the build puts them; deb.py has their lists.
        program = [name for name in listing(prefix) if "-packages/" not in name and "frontmost_mpi" not in name]
        compare(program, STORED, arguments.update)

        run("cmake", "-S", HERE / "consumer", "-B", folder / "by_cmake", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}")
        run("cmake", "--build", folder / "by_cmake")
        check_output(run(folder / "by_cmake" / "consumer", cwd=folder))

        run("cmake", "-S", HERE / "small", "-B", folder / "small", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
            f"-DCMAKE_PREFIX_PATH={prefix}")
        check_small(folder / "small")
        check_components(folder / "asks", prefix)

        modules = next(prefix.rglob("frontmost.pc")).parent
        environment = dict(os.environ, PKG_CONFIG_PATH=str(modules))
        flags = run("pkg-config", "--cflags", "--libs", "frontmost", env=environment).split()
        run("c++", "-std=c++20", HERE / "consumer" / "main.cpp", "-o", folder / "by_pkg_config", *flags)
        check_output(run(folder / "by_pkg_config", cwd=folder))


if __name__ == "__main__":
    main()
