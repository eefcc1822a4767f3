#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes a wheel of a build, unpacks it into an empty folder and uses it from there: what it loads must lie in that
folder, or be of the system or of NumPy, and it must see what the build's own module sees.

    wheel.py BUILD
"""
import argparse
import os
import pathlib
import subprocess
import sys
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "python"))
from make_wheel import OF_THE_SYSTEM, make_wheel, run  # noqa: E402

IMAGES = """
import re
def mapped():
    return {line.split(None, 5)[5].strip() for line in open("/proc/self/maps") if re.search(r"/.*[.]so", line)}
"""
USED = IMAGES + """
import numpy
before = mapped()
import frontmost as fm
seen = fm.Surfaces(fm.builtin("teapot")).zbuffer(fm.frame(fm.builtin("teapot"), 320, 240))
print(fm.__version__, seen.content_hash())
for path in sorted(mapped() - before):
    print(path)
"""


def used(folder):
    environment = dict(os.environ, PYTHONPATH=str(folder))
    return run(sys.executable, "-c", USED, env=environment, cwd=folder).splitlines()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    build = parser.parse_args().build.resolve()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder).resolve()
        wheel = make_wheel(build, folder / "made")
        with zipfile.ZipFile(wheel) as packed:
            packed.extractall(folder / "unpacked")
        assert wheel.stat().st_size < 12e6, f"{wheel.name} has grown to {wheel.stat().st_size} bytes"
        seen, *loaded = used(folder / "unpacked")
        assert loaded, "nothing was loaded"
        for path in map(pathlib.Path, loaded):
            own = folder in path.parents or "lib-dynload" in path.parts or OF_THE_SYSTEM.match(path.name)
            assert own, f"{path} is neither in the wheel nor of the system"
        expected = used(build / "python")[0]
        assert seen == expected, f"the wheel sees {seen}, the build {expected}"
        print(wheel.name, wheel.stat().st_size, seen)


if __name__ == "__main__":
    main()
