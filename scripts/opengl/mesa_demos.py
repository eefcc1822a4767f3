#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds `frontmost gl` against Mesa: draws the first frame of Mesa's demos with both, and compares the pictures.

    mesa_demos.py DEMOS BUILD FRONTMOST [--hashes]

DEMOS is a checkout of freedesktop/mesa-demos as of 2017, BUILD a folder outside the repository for programs and
pictures, FRONTMOST the program `frontmost`. mesa_demos.txt beside this file lists the demos by tiers.

A pixel has an equal in another picture if one of the 3 x 3 pixels around it is within 2 of 255 in every channel. Two
pictures are alike if at most 0.1 % of the pixels lack an equal in either direction. Demos count if Mesa's two drivers,
llvmpipe and softpipe, draw alike. The status is 1 if too few of the counted demos are drawn as llvmpipe does.

Mesa draws by Frontmost's GLUT, which calls OSMesa and OpenGL, with Mesa's libOSMesa loaded before Frontmost's.
"""
import argparse
import collections
import concurrent.futures
import itertools
import os
import pathlib
import subprocess
import sys

import numpy as np  # Debian package python3-numpy
from PIL import Image  # Debian package python3-pil

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
PACKAGES = "Debian packages: gcc freeglut3-dev libglew-dev libglu1-mesa-dev libosmesa6-dev"
LARGEST_SHARE = 0.001  # of pixels without an equal
MOST_UNLIKE = 5  # demos of tiers 1 and 2 together
LEAST_ALIKE = 52  # demos of tier 3
LIBRARIES = ["-lGLEW", "-lglut", "-lGLU", "-lGL", "-lm"]
THREADS = ("1", "2", "5")
FLAG_OF_ISA = {"sse4": "sse4_2", "avx2": "avx2", "avx512": "avx512bw", "neon": "asimd"}  # flags of /proc/cpuinfo

# GLEW asks GLX for functions. Frontmost's libGL answers itself; for Mesa, OSMesa answers. Frontmost's GL_VERSION is 1.1.
# GLEW looks for functions of later versions, which some demos call without asking, only if it is told to.
GLUE = """void (*OSMesaGetProcAddress(const char*))(void);
void (*glXGetProcAddressARB(const char* name))(void) { return OSMesaGetProcAddress(name); }
unsigned char glewExperimental = 1;
"""
PROBE = """#include <GL/glew.h>
#include <GL/glut.h>
#include <stdio.h>
void (*glXGetProcAddressARB(const char*))(void);
int main(int count, char** words) {
  glutInit(&count, words);
  glutCreateWindow("");
  puts((const char*)glGetString(GL_RENDERER));
  puts((const char*)((const GLubyte* (*)(GLenum))glXGetProcAddressARB("glGetString"))(GL_RENDERER));
  return 0;
}
"""


def run(command, **environment):
    """Returns the status of a program and what it prints, errors first."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=120,
                              stdin=subprocess.DEVNULL, env=dict(os.environ, **environment))
        return done.returncode, done.stderr + done.stdout
    except subprocess.TimeoutExpired:
        return 1, "did not end within 120 s"


def compile_c(*arguments):
    """Returns what the compiler says if it fails."""
    status, words = run(["cc", "-O1", "-w", *arguments])
    return words if status else None


class Demos:
    def __init__(self, given):
        self.source, self.build, self.frontmost = given.demos / "src", given.build, given.frontmost
        for folder in ("programs", "llvmpipe", "softpipe", "frontmost", "hashes"):
            (self.build / folder).mkdir(parents=True, exist_ok=True)
        self.glue, probe = self.build / "glue.so", self.build / "probe"
        for program, text, options in ((self.glue, GLUE, ["-shared", "-fPIC"]), (probe, PROBE, LIBRARIES)):
            program.with_suffix(".c").write_text(text)
            if words := compile_c(program.with_suffix(".c"), "-o", program, *options):
                sys.exit(f"{words}{PACKAGES}")
        self.helpers = [self.build / f"{name}.o" for name in ("readtex", "showbuffer", "trackball", "shaderutil")]
        for helper in self.helpers:
            if words := compile_c("-ffunction-sections", "-c", self.source / f"util/{helper.stem}.c", "-o", helper):
                sys.exit(words)
        osmesa = run(["cc", "-print-file-name=libOSMesa.so"])[1].strip()
        if not os.path.isabs(osmesa):
            sys.exit(f"libOSMesa.so is missing; {PACKAGES}")
        status, folders = run([self.frontmost, "gl", "printenv", "LD_LIBRARY_PATH"])
        if status:
            sys.exit(folders)
        self.mesa = {"LD_LIBRARY_PATH": folders.strip(), "LD_PRELOAD": f"{self.glue} {osmesa}"}
        for driver in ("llvmpipe", "softpipe"):
            told = run([probe], GALLIUM_DRIVER=driver, **self.mesa)[1]
            if told.count(driver) != 2:
                sys.exit(f"{driver} should draw, but {probe} says: {told}")

    def program(self, demo):
        return self.build / "programs" / "-".join(demo)

    def draw(self, demo, by, **environment):
        """Draws the first frame. Returns the picture's path, and why there is none."""
        program = self.program(demo)
        path = self.build / by / f"{program.name}.png"
        path.unlink(missing_ok=True)
        if by in ("llvmpipe", "softpipe"):
            status, words = run([program], GALLIUM_DRIVER=by, FRONTMOST_GL_OUTPUT=str(path), **self.mesa)
        else:
            status, words = run([self.frontmost, "gl", program, "-o", path], LD_PRELOAD=str(self.glue), **environment)
        why = f"no picture by {by}: status {status}, {(words.splitlines() or ['no words'])[0]}"
        return path, why if status != 0 or not path.exists() else None

    def judge(self, demo):
        """Returns whether a demo counts, whether it is drawn alike, and why not."""
        program, source = self.program(demo), self.source / f"{'/'.join(demo)}.c"
        if not program.exists() and compile_c(source, *self.helpers, "-Wl,--gc-sections", f"-I{self.source / 'util'}",
                                              f'-DDEMOS_DATA_DIR="{self.source}/data/"', "-o", program, *LIBRARIES):
            return False, False, "cannot be built"
        pictures = []
        for by in ("llvmpipe", "softpipe", "frontmost"):
            path, why = self.draw(demo, by)
            if why:
                return by == "frontmost", False, why
            pictures.append(path)
            if by == "softpipe" and (share := share_without_equal(*pictures)) > LARGEST_SHARE:
                return False, False, f"{share:.2%} unlike between llvmpipe and softpipe"
        share = share_without_equal(pictures[0], pictures[2])
        return True, share <= LARGEST_SHARE, f"{share:.2%} unlike"

    def settings_by_bytes(self, demo, isas):
        """Returns lists of settings: those of a list give the same picture. There is no list if no picture is drawn."""
        found = collections.defaultdict(list)
        for isa, threads in itertools.product(isas, THREADS):
            path, why = self.draw(demo, "hashes", FRONTMOST_GL_ISA=isa, FRONTMOST_GL_THREADS=threads)
            found[why or path.read_bytes()].append(f"{isa}-{threads}")
        return [] if why and len(found) == 1 else list(found.values())


def share_without_equal(path, other):
    a, b = (np.asarray(Image.open(p).convert("RGB")).astype(np.int16) for p in (path, other))
    return float((lacks_equal(a, b) | lacks_equal(b, a)).mean()) if a.shape == b.shape else 1


def lacks_equal(a, b):
    height, width = a.shape[:2]
    around = np.pad(b, ((1, 1), (1, 1), (0, 0)), mode="edge")
    differences = [np.abs(a - around[y:y + height, x:x + width]).max(axis=2) for y in range(3) for x in range(3)]
    return np.min(differences, axis=0) > 2


def listed():
    """Returns the tier of each (folder, name)."""
    lines = map(str.split, pathlib.Path(__file__).with_suffix(".txt").read_text().splitlines())
    return {(folder, name): tier for tier, folder, *names in lines if tier != "#" for name in names}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("demos", "build", "frontmost"):
        parser.add_argument(name, type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("--hashes", action="store_true", help="compare bytes by instruction sets and numbers of threads")
    given = parser.parse_args()
    if given.build.is_relative_to(REPOSITORY) or given.build.is_relative_to(given.demos):
        parser.error("BUILD lies in the repository or in DEMOS")
    demos, tier_of, count = Demos(given), listed(), collections.Counter()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as workers:
        for (demo, tier), (counts, is_alike, why) in zip(tier_of.items(), workers.map(demos.judge, tier_of)):
            count.update({("demos", tier): 1, ("counted", tier): counts, ("alike", tier): is_alike})
            if not is_alike:
                print(f"tier {tier} {'/'.join(demo)}: {'' if counts else 'not counted, '}{why}", flush=True)
        print("\ntier  demos  counted  alike")
        for tier in "123":
            print(f"{tier:>4}  {count['demos', tier]:5}  {count['counted', tier]:7}  {count['alike', tier]:5}", flush=True)
        unlike = sum(count["counted", tier] - count["alike", tier] for tier in "12")
        fails = unlike > MOST_UNLIKE or count["alike", "3"] < LEAST_ALIKE
        if given.hashes:
            flags = pathlib.Path("/proc/cpuinfo").read_text().split()
            isas = ["scalar", *(isa for isa, flag in FLAG_OF_ISA.items() if flag in flags)]
            found = list(workers.map(demos.settings_by_bytes, tier_of, itertools.repeat(isas)))
            for demo, settings in zip(tier_of, found):
                if len(settings) > 1:
                    print(f"{'/'.join(demo)}: different pictures by {', '.join(map(str, settings))}")
            different = sum(len(settings) > 1 for settings in found)
            print(f"bytes by {', '.join(isas)}, with {', '.join(THREADS)} threads: "
                  f"{sum(len(settings) == 1 for settings in found)} pictures equal, {different} not")
            fails |= different > 0
    sys.exit(fails)


if __name__ == "__main__":
    main()
