# SPDX-License-Identifier: Apache-2.0
"""Scenes derived from others: sections, and finer triangles of curved surfaces."""
import gc

import numpy
import pytest

import frontmost as fm


def test_cubes_are_cut_on_paper(box):
    section = fm.Surfaces(fm.Scene.from_arrays(*box, name="cube")).cut("z", 0.5)
    assert section.faces["area"].tolist() == [4] and section.faces["object"].tolist() == [0]
    assert section.faces["open_count"].tolist() == [0] and section.faces["material"][0] < 2**32 - 1
    outline, = section.outlines[0]
    assert (outline[:, 2] == 0.5).all() and not outline.flags.writeable
    assert {(-1, -1), (1, -1), (1, 1), (-1, 1)} <= {tuple(p) for p in outline[:, :2].tolist()}
    left = section.scene
    assert left.objects[0].name == "cube" and fm.Surfaces(left).bounds[:, 2].tolist() == [-1, 0.5]
    assert "1 objects" in repr(section)
    kept = outline.copy()
    del section, left
    gc.collect()
    assert (outline == kept).all()


def test_planes_beside_the_model_cut_nothing(box):
    surfaces = fm.Surfaces(fm.Scene.from_arrays(*box))
    assert len(surfaces.cut("x", 2).faces) == 0 and surfaces.cut("x", 2).scene.triangle_count == 12
    assert surfaces.cut("-x", 2).scene.triangle_count == 0
    with pytest.raises(fm.Error):
        surfaces.cut("x", numpy.nan)
    with pytest.raises(ValueError, match="^axis: 'w' is not one of x, y, z"):
        surfaces.cut("w")
    assert surfaces.cut("+x", 1).scene.triangle_count == surfaces.cut("x", 1).scene.triangle_count > 0


def test_curved_meshes_are_as_fine_as_asked():
    scene = fm.builtin("teapot")
    view = fm.frame(scene)
    coarse, fine = scene.tessellate(view, 2.0), scene.tessellate(view, 0.1)
    assert coarse.triangle_count < fine.triangle_count
    assert fine.meshes[0].face_ids.max() < 2 * 32
    for pixels in (0, -1, numpy.nan):
        with pytest.raises(fm.Error, match="pixels"):
            scene.tessellate(view, pixels)
