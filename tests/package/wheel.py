#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes a wheel of a build, unpacks it into an empty folder and uses it from there. Libraries that its module and its
other libraries link must lie in that folder or belong to the system. It must give the answers of the build's own
module. Libraries of the interpreter and NumPy are not checked.

    wheel.py BUILD
"""
import argparse
import os
import pathlib
import sys
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "python"))
from make_wheel import linked_libraries, make_wheel, run  # noqa: E402

USED = """
import frontmost as fm
seen = fm.Surfaces(fm.builtin("teapot")).zbuffer(fm.frame(fm.builtin("teapot"), 320, 240))
print(fm.__version__, seen.content_hash())
"""


def used(folder):
    environment = dict(os.environ, PYTHONPATH=str(folder))
    return run(sys.executable, "-c", USED, env=environment, cwd=folder)


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
        libraries = list((folder / "unpacked").rglob("*.so*"))
        assert len(libraries) > 1, "no library lies beside the module"
        for library in libraries:
            for path in linked_libraries(library):
                assert folder in path.parents, f"{library.name} loads {path}, which is not in the wheel"
        seen, expected = used(folder / "unpacked"), used(build / "python")
        assert seen == expected, f"the wheel sees {seen}, the build {expected}"
        print(wheel.name, wheel.stat().st_size, seen)


if __name__ == "__main__":
    main()
