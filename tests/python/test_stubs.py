# SPDX-License-Identifier: Apache-2.0
"""The stubs, the docstrings and docs/python.md name all of the module, and nothing else."""
import ast
import inspect
import os
import pathlib
import re
import subprocess
import sys

import pytest

import frontmost as fm

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "python.md"


def stub_members(tree, prefix=""):
    """Qualified name -> list of argument names (functions), or None."""
    found = {}
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            found[prefix + node.name] = None
            found.update(stub_members(node, f"{prefix}{node.name}."))
        elif isinstance(node, ast.FunctionDef):
            is_property = any(isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list)
            arguments = [a.arg for a in node.args.args if a.arg != "self"] + ["*"] * bool(node.args.kwonlyargs)
            arguments += [a.arg for a in node.args.kwonlyargs]
            found[prefix + node.name] = None if is_property else arguments
        elif isinstance(node, ast.AnnAssign):
            found[prefix + node.target.id] = None
    return found


def module_members():
    found = {}
    for name in fm.__all__:
        thing = getattr(fm, name)
        found[name] = thing
        if isinstance(thing, type):
            for inner, member in vars(thing).items():
                if not inner.startswith("_"):
                    found[f"{name}.{inner}"] = member
    return found


def arguments_of(docstring):
    """Argument names in the signature that pybind11 writes."""
    match = re.match(r"\w+\((.*?)\)(?: -> .*)?$", docstring.splitlines()[0])
    depth, parts = 0, [""]
    for letter in match[1]:
        depth += (letter in "[(") - (letter in ")]")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    names = [part.split(":")[0].split("=")[0].strip() for part in parts if part.strip()]
    return [name for name in names if name != "self"]


def test_stubs_name_what_is_there(stubs):
    stubbed = {n for n in stub_members(ast.parse(stubs)) if not n.split(".")[-1].startswith("_")}
    assert stubbed - {"Error.code", "Error.file", "Error.place", "Error.reason"} == set(module_members())


def test_arguments_are_those_of_the_stubs(stubs):
    stubbed, compared = stub_members(ast.parse(stubs)), 0
    for name, thing in module_members().items():
        thing = getattr(thing, "__func__", thing)  # static methods
        if callable(thing) and not isinstance(thing, type) and not inspect.isfunction(thing):
            assert arguments_of(thing.__doc__) == stubbed[name], name
            compared += 1
    assert compared > 15


def test_everything_says_what_it_is():
    for name, thing in module_members().items():
        if isinstance(thing, (int, str)):
            continue
        text = inspect.getdoc(thing)
        assert text and len(text.splitlines()[-1]) > 3, name
        assert "frontmost::" not in text and "_core" not in text, (name, text)


def test_the_page_has_every_name_in_the_words_of_the_stubs():
    page = PAGE.read_text()
    missing = [name for name in module_members() if not re.search(rf"(?<![\w.]){re.escape(name)}(?!\w)", page)]
    assert not missing
    subprocess.run([sys.executable, ROOT / "scripts" / "python_page.py", "check"], check=True)


def test_everything_prints_what_it_is():
    for name, thing in module_members().items():
        if isinstance(thing, type) and not issubclass(thing, Exception):
            assert thing.__repr__ is not object.__repr__, name


def test_every_name_is_tested():
    tests = "".join(path.read_text() for path in pathlib.Path(__file__).parent.glob("test_*.py"))
    names = [name for name, thing in module_members().items() if not isinstance(thing, type)]
    assert not [name for name in names if not re.search(rf"\b{re.escape(name.split('.')[-1])}\b", tests)]


@pytest.mark.skipif("FRONTMOST_SANITIZED" in os.environ, reason="mypy is not what a sanitizer is for")
def test_types_check(tmp_path):
    pytest.importorskip("mypy")
    program = tmp_path / "program.py"
    program.write_text("import frontmost as fm\n"
                       "scene: fm.Scene = fm.load('a.stl', up='z')\n"
                       "seen: fm.Visible = fm.Surfaces(scene).zbuffer(fm.frame(scene, culling='back'), threads=2)\n"
                       "near: float = float(seen.depth.min()) + scene.meshes[0].vertices.ndim\n")
    wrong = tmp_path / "wrong.py"
    wrong.write_text("import frontmost as fm\nfm.frame(fm.builtin('city'), culling='sides')\nfm.load('x').zbuffer()\n")
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache")]
    done = subprocess.run([*command, str(program)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    done = subprocess.run([*command, str(wrong)], capture_output=True, text=True)
    assert done.stdout.count("error:") == 2, done.stdout
