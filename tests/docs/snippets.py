#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Takes the documentation at its word: the fenced blocks of README.md and docs/*.md are compiled and run.

    snippets.py emit FILE        writes one C++ file that holds every ```cpp block as a function
    snippets.py run PROGRAM      runs the program made from that file, and every ```sh block with frontmost on PATH

A cpp block is a whole program (with its own main) or statements with all of Frontmost's names in sight. A statement
"EXPRESSION;  // -> 1.5, 2" is checked: the expression's numbers must be those, to the digits that are written.
Blocks in other languages (console, text, json) are for reading.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import sample_models

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
CHECKED = re.compile(r"^(?P<indent>\s*)(?P<expression>.+?);\s*// -> (?P<expected>.+)$")


def blocks(language):
    """Yields (page, first line number, text) of every fenced block in that language."""
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]:
        lines = page.read_text().splitlines()
        start = None
        for number, line in enumerate(lines, 1):
            if start is None and line.strip() == "```" + language:
                start = number + 1
            elif start is not None and line.strip() == "```":
                yield page.relative_to(ROOT), start, "\n".join(lines[start - 1 : number - 1])
                start = None


def checked(line):
    match = CHECKED.match(line)
    if not match:
        return line
    return f'{match["indent"]}expect({match["expression"]}, "{match["expected"]}", __FILE__, __LINE__);'


def emit(out):
    includes, functions, calls = set(), [], []
    for number, (page, first, text) in enumerate(blocks("cpp")):
        body = []
        for line in text.splitlines():
            if line.startswith("#include"):
                includes.add(line)
                line = ""  # keeps the line numbers
            body.append(checked(line))
        name = f"block_{number}"
        code = "\n".join(body)
        if re.search(r"^int main\(", code, re.MULTILINE):
            code = re.sub(r"^int main\(\)", f"int {name}()", code, flags=re.MULTILINE)
            functions.append(f'namespace page_{number} {{\n#line {first} "{page}"\n{code}\n}}')
            calls.append(f"page_{number}::{name}();")
        else:
            functions.append(f'void {name}() {{\nusing namespace frontmost;\n#line {first} "{page}"\n{code}\n}}')
            calls.append(f"{name}();")
    text = ["// Made from the documentation by tests/docs/snippets.py.", *sorted(includes), '#include "docs/expect.h"']
    text += functions + ["int main() {", *calls, "return frontmost::test::failure_count != 0;", "}"]
    out.write_text("\n".join(text) + "\n")


def run_shell(page, first, text, folder, environment):
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=folder, env=environment, capture_output=True,
                          text=True, timeout=900)
    if done.returncode == 0:
        return True
    print(f"{page}:{first}: exit status {done.returncode}\n{text}\n{done.stdout}{done.stderr}")
    return False


def run(program, frontmost, window):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        sample_models.write(folder)
        environment = dict(os.environ, PATH=f"{frontmost.resolve().parent}:{os.environ['PATH']}",
                           XDG_CACHE_HOME=str(folder / "cache"))
        good = subprocess.run([program.resolve()], cwd=folder, timeout=900).returncode == 0
        commands = list(blocks("sh"))
        if window:  # a program that uses OpenGL
            for name in ("gears", "viewer"):
                (folder / name).symlink_to(window.resolve())
        else:
            of_opengl = [block for block in commands if "frontmost gl " in block[2]]
            commands = [block for block in commands if block not in of_opengl]
            print(f"{len(of_opengl)} shell blocks are skipped, because libfrontmost-gl is not built")
        if not (frontmost.resolve().parent / "frontmost-import").exists():
            of_cad = [block for block in commands if ".step" in block[2]]
            commands = [block for block in commands if block not in of_cad]
            print(f"{len(of_cad)} shell blocks are skipped, because frontmost-import is not built")
        good = all([run_shell(*block, folder, environment) for block in commands]) and good
    print(f"{len(list(blocks('cpp')))} C++ blocks, {len(commands)} shell blocks")
    sys.exit(not good)


def main():
    parser = argparse.ArgumentParser()
    verbs = parser.add_subparsers(dest="verb", required=True)
    verbs.add_parser("emit").add_argument("file", type=pathlib.Path)
    verb = verbs.add_parser("run")
    verb.add_argument("program", type=pathlib.Path)
    verb.add_argument("frontmost", type=pathlib.Path)
    verb.add_argument("window", type=pathlib.Path, nargs="?")
    arguments = parser.parse_args()
    if arguments.verb == "emit":
        emit(arguments.file)
    else:
        run(arguments.program, arguments.frontmost, arguments.window)


if __name__ == "__main__":
    main()
