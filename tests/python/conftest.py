# SPDX-License-Identifier: Apache-2.0
"""Shared by the module's tests: the command line to compare with, and small scenes."""
import os
import pathlib
import subprocess

import numpy
import pytest

import frontmost as fm


@pytest.fixture
def cli(tmp_path):
    """Runs the program in an empty folder; returns that folder."""
    def run(*arguments):
        program = os.environ.get("FRONTMOST_CLI")
        if not program:
            pytest.skip("FRONTMOST_CLI does not say where the program is")
        subprocess.run([program, *map(str, arguments)], cwd=tmp_path, check=True, capture_output=True, text=True)
        return tmp_path
    return run


@pytest.fixture
def box():
    """Vertices and faces of a cube of side 2 about zero, counter-clockwise from outside."""
    vertices = numpy.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=numpy.float32)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = numpy.array([f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))], dtype=numpy.int64)
    return vertices, faces


@pytest.fixture(scope="session")
def stubs():
    """The text of the stubs."""
    return pathlib.Path(fm.__file__).with_name("__init__.pyi").read_text()
