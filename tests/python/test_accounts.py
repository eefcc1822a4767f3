# SPDX-License-Identifier: Apache-2.0
"""How much of every object is visible, and what hides the rest."""
import json
import os
import subprocess

import numpy
import pytest

import frontmost as fm


@pytest.fixture
def wall_and_crate(box):
    """A crate half behind a wall that is nearer."""
    vertices, faces = box
    scene = fm.Scene.from_arrays(vertices, faces, name="crate")
    pose = numpy.eye(4)
    pose[:3, 3] = (2, 0, 4)
    scene.add(vertices * [2, 3, 0.1], faces, name="wall", pose=pose)
    pose[:3, 3] = (0, 0, 40)
    scene.place(0, pose, name="behind the camera")
    view = fm.View.orthographic((0, 0, 10), (0, 0, 0), width=64, height=64, tall=4, near=1, far=20)
    return fm.Surfaces(scene).zbuffer(view)


def test_counts_are_known_on_paper(wall_and_crate):
    # 16 pixels a unit: the crate covers 32 x 32 of them, the wall all right of the middle, 3 units up and down.
    accounts = wall_and_crate.account()
    assert accounts.alone.tolist() == [32 * 32, 64 * 96, 0]
    assert accounts.in_frame.tolist() == [32 * 32, 32 * 64, 0]
    assert accounts.visible.tolist() == [16 * 32, 32 * 64, 0]
    assert accounts.visible_share.tolist() == [0.5, 1 / 3, 0]
    assert accounts.hidden_share.tolist() == [0.5, 0, 0]
    assert accounts.cut_share.tolist() == [0, 2 / 3, 0]
    assert accounts.background == 64 * 64 - 32 * 64 - 16 * 32
    assert accounts.visible_boxes.tolist() == [[16, 16, 16, 32], [32, 0, 32, 64], [0, 0, 0, 0]]
    assert accounts.in_frame_boxes[0].tolist() == [16, 16, 32, 32]
    assert accounts.alone_boxes[1].tolist() == [32, -16, 64, 96]
    assert accounts.hidden_by_front.tolist() == [[0, 1, 16 * 32]]
    assert accounts.distance[0] == 9 and numpy.isinf(accounts.distance[2])
    assert not accounts.is_cut_by_near.any() and accounts.is_cut_by_near.dtype == bool
    assert len(accounts.hidden_by_any) == len(accounts.hidden_only_by) == 0
    every = wall_and_crate.account(all_hiders=True, canvas=1)
    assert every.hidden_by_any.tolist() == every.hidden_only_by.tolist() == [[0, 1, 16 * 32]]
    assert every.cut_share.tolist() == [0, 0, 0]
    assert len(accounts) == 3 and "2 of 3" in repr(accounts)


def test_masks(wall_and_crate):
    visible, whole = wall_and_crate.mask("crate"), wall_and_crate.mask("crate", part="whole")
    assert visible.dtype == bool and visible.shape == (64, 64)
    assert (visible == (wall_and_crate.object == 0)).all() and (visible <= whole).all()
    assert (visible.sum(), whole.sum()) == (16 * 32, 32 * 32)
    assert not wall_and_crate.mask(2).any()
    for part, right in (("visible", 32), ("whole", 48)):
        polygon, = wall_and_crate.coco_polygons("crate", part=part)
        assert sorted(zip(polygon[::2], polygon[1::2])) == [(16, 16), (16, 48), (right, 16), (right, 48)]
    assert wall_and_crate.coco_runs("crate") != wall_and_crate.coco_runs("crate", part="whole")
    with pytest.raises(ValueError, match="^part: "):
        wall_and_crate.mask(0, part="half")


def test_explanations_are_sentences(wall_and_crate):
    crate = wall_and_crate.explain("crate")
    assert (crate.object, crate.reason, crate.hiders) == (0, "seen", [(1, 0.5)])
    assert (crate.visible_share, crate.hidden_share, crate.cut_share) == (0.5, 0.5, 0)
    lost = wall_and_crate.explain(2)
    assert lost.reason == "nearer_than_near" and str(lost).startswith("behind the camera is") and lost.remedy in str(lost)
    assert lost.remedied(wall_and_crate.view).near < 1
    report = wall_and_crate.report()
    assert [str(one) for one in report] == [str(wall_and_crate.explain(i)) for i in range(3)]
    assert repr(report[1]) == str(report[1])
    with pytest.raises(ValueError, match="^object: none is called 'lamp'"):
        wall_and_crate.explain("lamp")


def test_reports_are_the_command_lines():
    if "FRONTMOST_CLI" not in os.environ:
        pytest.skip("FRONTMOST_CLI does not say where the program is")
    told = subprocess.run([os.environ["FRONTMOST_CLI"], "report", "builtin:gallery", "--resolution", "160,120", "--json"],
                          check=True, capture_output=True, text=True)
    objects = json.loads(told.stdout)["objects"]
    surfaces = fm.Surfaces(fm.builtin("gallery"))
    accounts = surfaces.zbuffer(fm.frame(surfaces, 160, 120)).account()
    assert [o["visible"]["samples"] for o in objects] == accounts.visible.tolist()


def test_options_out_of_range_end_in_errors(wall_and_crate):
    with pytest.raises(fm.Error, match="canvas"):
        wall_and_crate.account(canvas=99)
    pose = numpy.eye(4)
    wall_and_crate.surfaces.move(0, pose)
    for call in (wall_and_crate.account, wall_and_crate.report, lambda: wall_and_crate.explain(0),
                 lambda: wall_and_crate.mask(0), lambda: wall_and_crate.layers(2)):
        with pytest.raises(fm.Error, match="moved"):
            call()
