#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Packs the Python module of a build, and the libraries that it is linked with, into a wheel.

    make_wheel.py BUILD FOLDER

The wheel is for one version of Python. Of the system it needs the C and C++ libraries alone; its name says from which
glibc on. Every other library lies beside the module, with its licence. Needs Debian's patchelf and python3-wheel.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile

# What every desktop and server has.
OF_THE_SYSTEM = re.compile(r"(libc|libm|libdl|librt|libpthread|libstdc\+\+|libgcc_s|ld-linux.*)\.so\b")


def run(*command, **options):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}failed with {done.returncode}")
    return done.stdout


def linked_libraries(module):
    """All that are loaded with it, however indirectly, but those of the system."""
    found = re.findall(r"^\s*(\S+) => (\S+) \(", run("ldd", module), re.MULTILINE)
    return [pathlib.Path(path) for name, path in found if not OF_THE_SYSTEM.match(name)]


def bundle(package, module):
    """Copies libraries to package/libs, and has all of them found from there."""
    libraries = linked_libraries(module)
    folder = package / "libs"
    folder.mkdir()
    for library in libraries:
        copy = folder / library.name
        shutil.copy(library.resolve(), copy)
        run("patchelf", "--set-rpath", "$ORIGIN", copy)
    run("patchelf", "--set-rpath", "$ORIGIN/libs", module)
    return libraries


def copy_licences(libraries, folder):
    folder.mkdir(parents=True)
    for library in libraries:
        # Debian's list of files may have the library's folder with or without /usr.
        owner = run("dpkg-query", "--search", f"*/{library.resolve().name}").split(":")[0]
        shutil.copy(pathlib.Path("/usr/share/doc") / owner / "copyright", folder / f"{owner}.txt")


def oldest_glibc(files):
    wanted = {(int(major), int(minor)) for file in files
              for major, minor in re.findall(r"\bGLIBC_(\d+)\.(\d+)", run("readelf", "--version-info", "--wide", file))}
    return max(wanted)


def describe(info, version, tag, licence):
    (info / "METADATA").write_text(
        f"Metadata-Version: 2.1\nName: frontmost\nVersion: {version}\n"
        "Summary: What can be seen of 3D models: depths, ids, pictures, drawings, and who hides whom\n"
        f"License: Apache-2.0\nRequires-Python: =={sys.version_info[0]}.{sys.version_info[1]}.*\nRequires-Dist: numpy\n")
    (info / "WHEEL").write_text(
        f"Wheel-Version: 1.0\nGenerator: make_wheel.py\nRoot-Is-Purelib: false\nTag: {tag}\n")
    shutil.copy(licence, info / "LICENSE")


def make_wheel(build, folder):
    """The wheel's path."""
    cache = (build / "CMakeCache.txt").read_text()
    place = re.search(r"^FRONTMOST_PYTHON_DIR:STRING=(.*)$", cache, re.MULTILINE)
    version = re.search(r"^CMAKE_PROJECT_VERSION:STATIC=(.*)$", cache, re.MULTILINE)[1]
    if not place:
        sys.exit(f"{build} has no Python module; configure it with -DFRONTMOST_PYTHON=ON")
    with tempfile.TemporaryDirectory() as staged:
        staged = pathlib.Path(staged)
        run("cmake", "--install", build, "--component", "python", "--strip", "--prefix", staged / "prefix")
        root = staged / "wheel"
        shutil.copytree(staged / "prefix" / place[1], root)
        module = next((root / "frontmost").glob("_core.*.so"))
        libraries = bundle(root / "frontmost", module)
        major, minor = oldest_glibc(root.rglob("*.so*"))
        python = f"cp{sys.version_info[0]}{sys.version_info[1]}"
        machine = sysconfig.get_platform().replace("linux-", "").replace("-", "_")
        info = root / f"frontmost-{version}.dist-info"
        copy_licences(libraries, info / "licenses")
        source = pathlib.Path(__file__).resolve().parent.parent
        describe(info, version, f"{python}-{python}-manylinux_{major}_{minor}_{machine}", source / "LICENSE")
        folder.mkdir(parents=True, exist_ok=True)
        said = run(sys.executable, "-m", "wheel", "pack", root, "--dest-dir", folder)
    return pathlib.Path(re.search(r"as (\S+\.whl)", said)[1])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    arguments = parser.parse_args()
    wheel = make_wheel(arguments.build.resolve(), arguments.folder)
    print(f"{wheel}: {wheel.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
