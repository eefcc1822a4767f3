# SPDX-License-Identifier: Apache-2.0
"""Occlusion culling: objects that are called hidden are hidden."""
import gc

import numpy
import pytest

import frontmost as fm


@pytest.fixture
def crates_and_wall(box):
    """A crate behind a wall, one beside it, one behind the eye; seen from z = 20."""
    vertices, faces = box
    scene = fm.Scene.from_arrays(vertices, faces, name="behind")
    pose = numpy.eye(4)
    for name, place in (("beside", (9, 0, 0)), ("behind the eye", (0, 0, 40))):
        pose[:3, 3] = place
        scene.place(0, pose, name=name)
    pose[:3, 3] = (0, 0, 5)
    scene.add(vertices * [4, 4, 0.1], faces, name="wall", pose=pose)
    return fm.Surfaces(scene), fm.View.look_at((0, 0, 20), (0, 0, 0), fov=60, near=1, far=100)


def words(sights):
    return [fm.object_sights[sight] for sight in sights]


def test_objects_are_told_on_paper(crates_and_wall):
    surfaces, view = crates_and_wall
    occlusion = fm.Occlusion(surfaces)
    sights = occlusion.cull(view)
    assert sights.dtype == numpy.uint8 and words(sights) == ["hidden", "may_be_seen", "outside", "may_be_seen"]
    assert occlusion.object.tolist() == [0, 1, 2, 3] and occlusion.part.tolist() == [0] * 4
    assert occlusion.triangles(3).tolist() == list(range(12))
    assert len(occlusion) == 4 and "4 objects" in repr(occlusion) and occlusion.surfaces is surfaces


def test_boxes_are_told_on_paper(crates_and_wall):
    surfaces, view = crates_and_wall
    occlusion = fm.Occlusion(surfaces)
    boxes = numpy.array([[[-1, -1, 0], [1, 1, 1]], [[-1, -1, 6], [1, 1, 7]], [[0, 0, 0], [9, 1, 1]], [[0, 0, 30], [1, 1, 31]]])
    assert occlusion.is_hidden(boxes).all()  # before the first view, nothing is known to be visible
    occlusion.cull(view)
    hidden = occlusion.is_hidden(boxes)
    assert hidden.dtype == bool and hidden.tolist() == [True, False, False, True]
    assert occlusion.is_hidden(numpy.zeros((0, 2, 3))).shape == (0,)
    read_only = numpy.asfortranarray(boxes.astype(numpy.int16))
    read_only.flags.writeable = False
    for same in (read_only, numpy.repeat(boxes, 2, axis=2)[:, :, ::2], boxes[::-1][::-1].astype(">f4"), boxes.tolist()):
        assert (occlusion.is_hidden(same) == hidden).all()


def test_moves_are_followed(crates_and_wall):
    surfaces, view = crates_and_wall
    occlusion = fm.Occlusion(surfaces)
    occlusion.cull(view)
    pose = numpy.eye(4)
    pose[:3, 3] = (0, 30, 5)
    surfaces.move("wall", pose)
    assert words(occlusion.cull(view))[:3] == ["may_be_seen", "may_be_seen", "outside"]


def test_nothing_that_is_seen_is_hidden():
    surfaces = fm.Surfaces(fm.builtin("city"))
    bounds = surfaces.bounds
    view = fm.View.look_at((*bounds.mean(0)[:2], bounds[1, 2]), bounds[0], width=320, height=240).enclosing(surfaces)
    for unit in ("instances", "parts", "clusters"):
        occlusion = fm.Occlusion(surfaces, unit=unit)
        sights = occlusion.cull(view, cell=1)
        assert (sights == occlusion.cull(view, cell=1, threads=1)).all()
        seen = numpy.unique(surfaces.zbuffer(view).object)[:-1]
        may_be_seen = occlusion.object[sights == fm.object_sights.index("may_be_seen")]
        assert len(seen) > 0 and set(seen) <= set(may_be_seen)
    assert (sights == fm.object_sights.index("hidden")).any()
    assert sum(len(occlusion.triangles(i)) for i in range(len(occlusion))) == surfaces.triangle_count


def test_it_keeps_what_it_is_of(crates_and_wall):
    surfaces, view = crates_and_wall
    occlusion = fm.Occlusion(surfaces)
    triangles = occlusion.triangles(0)
    del surfaces, crates_and_wall
    gc.collect()
    assert words(occlusion.cull(view))[0] == "hidden"
    del occlusion
    assert triangles.tolist() == list(range(12))


@pytest.mark.parametrize("call, error, message", [
    (lambda o, v: o.is_hidden([[0, 0, 0], [1, 1, 1]]), ValueError, "^boxes: "),
    (lambda o, v: o.is_hidden([[[0, 0, 0], [1, 1, numpy.nan]]]), ValueError, "^boxes: box 0 holds NaN"),
    (lambda o, v: o.is_hidden("x"), TypeError, "^boxes: "),
    (lambda o, v: o.cull(v, cell=0), fm.Error, "cell"),
    (lambda o, v: o.triangles(4), ValueError, "^number: there is no object 4"),
    (lambda o, v: fm.Occlusion(o.surfaces, unit="rooms"), ValueError, "^unit: 'rooms' is not one of instances"),
])
def test_wrong_uses_end_in_errors(crates_and_wall, call, error, message):
    surfaces, view = crates_and_wall
    with pytest.raises(error, match=message):
        call(fm.Occlusion(surfaces), view)
