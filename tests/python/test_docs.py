# SPDX-License-Identifier: Apache-2.0
"""Runs every ```python block of README.md and docs/*.md, in the order of its page."""
import pathlib
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "docs"))

import sample_models  # noqa: E402
import snippets  # noqa: E402

BLOCKS = list(snippets.blocks("python"))


@pytest.mark.parametrize("page", sorted({str(page) for page, _, _ in BLOCKS}))
def test_blocks_run(page, tmp_path, monkeypatch):
    sample_models.write(tmp_path)
    monkeypatch.chdir(tmp_path)
    names = {}
    for _, first, text in (block for block in BLOCKS if str(block[0]) == page):
        exec(compile("\n" * (first - 1) + text, str(ROOT / page), "exec"), names)
