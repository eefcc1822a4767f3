#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Builds the Debian packages of a build, checks their fields and files, and runs the program out of its package.

    deb.py BUILD [--update]
"""
import argparse
import pathlib
import re
import subprocess
import tempfile

from consumer import compare, listing, run

HERE = pathlib.Path(__file__).resolve().parent
NEEDED = {"frontmost": ["libc6", "libstdc++6"], "libfrontmost-dev": ["libglm-dev", "libhwy-dev", "libpng-dev"],
          "python3-frontmost": ["libc6", "libpng16-16", "python3", "python3-numpy"],
          "frontmost-mpi": ["frontmost", "libopenmpi3", "openmpi-bin"], "frontmost-gl": ["libc6", "libstdc++6"],
          "frontmost-import": ["libassimp5", "libocct-data-exchange-7.6"]}
MODULES = {"python3-frontmost": "python/frontmost/_core*.so", "frontmost-mpi": "frontmost_mpi.so",
           "frontmost-gl": "src/gl/libfrontmost-gl.so", "frontmost-import": "frontmost-import"}  # where they are built


def fields(package):
    text = run("dpkg-deb", "--field", package)
    return dict(re.findall(r"^([A-Z][\w-]*): (.*)$", text, re.MULTILINE))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--update", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        run("cpack", "-G", "DEB", "--config", arguments.build.resolve() / "CPackConfig.cmake", "-B", folder)
        packages = {fields(p)["Package"]: p for p in folder.glob("*.deb")}
        expected = {name for name in NEEDED if name not in MODULES or list(arguments.build.glob(MODULES[name]))}
        assert set(packages) == expected, packages
        for name, package in packages.items():
            depends = fields(package)["Depends"]
            for needed in NEEDED[name]:
                assert re.search(rf"(^|, ){re.escape(needed)}\b", depends), f"{name} does not depend on {needed}: {depends}"
            run("dpkg-deb", "--extract", package, folder / name)
            compare(listing(folder / name), HERE / f"{name}.txt", arguments.update)
        program = folder / "frontmost" / "usr" / "bin" / "frontmost"
        said = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
        assert fields(packages["frontmost"])["Version"] in said, said


if __name__ == "__main__":
    main()
