# SPDX-License-Identifier: Apache-2.0
"""Resolution of depth buffers: gaps, fights, and remedies."""
import json
import os
import subprocess

import numpy
import pytest

import frontmost as fm


@pytest.fixture
def plates(box):
    """Two plates of 8 x 8 units, 0.0007 apart, seen from above in parallel projection, one pixel to a unit."""
    vertices = numpy.array([[-4, -4, -1], [4, -4, -1], [4, 4, -1], [-4, 4, -1]])
    faces = [[0, 1, 2], [0, 2, 3]]
    pose = numpy.eye(4)
    pose[2, 3] = 0.0007
    scene = fm.Scene.from_arrays(vertices, faces, name="lower")
    scene.place(0, pose, name="upper")
    view = fm.View.orthographic((0, 0, 0), (0, 0, -1), width=10, height=10, tall=10, near=0, far=100)
    return fm.Surfaces(scene), view


def test_gaps_are_known_on_paper():
    parallel = fm.DepthSetup(0, 100, format="d16", orthographic=True)
    assert numpy.allclose(parallel.resolvable_gap([1, 50, 99]), 100 / 65535, rtol=1e-6)
    assert parallel.share_of_values(25) == 0.25
    setup = fm.DepthSetup(0.1, 100)
    gaps = setup.resolvable_gap(numpy.array([[1, 10], [20, 50]]))
    assert gaps.shape == (2, 2)
    wanted = numpy.array([[1, 10], [20, 50]]) ** 2 * 99.9 / (100 * 0.1 * (2**24 - 1))
    assert numpy.allclose(gaps, wanted, rtol=2e-3)
    assert (setup.certain_gap([1, 10]) > setup.resolvable_gap([1, 10])).all()
    assert (setup.rounding_gap([1, 10]) < setup.rounding_gap([1, 10], reach=1000)).all()
    near = setup.near_for_gap(50, 0.01)
    assert 0 < near < 0.1 and numpy.isclose(fm.DepthSetup(near, 100).resolvable_gap(50), 0.01, rtol=1e-2)
    assert setup.round_distances().tolist() == [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100]
    assert (setup.near, setup.far, setup.format, setup.reversed, setup.orthographic) == (0.1, 100, "d24", False, False)
    assert "d24" in repr(setup) and "reversed" in repr(fm.DepthSetup(0.1, numpy.inf, format="f32", reversed=True))


def test_fights_are_known_on_paper(plates):
    surfaces, view = plates
    exact = surfaces.find_exact_visible(view)
    assert set(numpy.unique(exact.primitives)) == {2, 3, fm.no_primitive} and not exact.tied.any()
    assert exact.view == view and exact.tied.dtype == bool and "10x10" in repr(exact)
    buffer = fm.DepthBuffer(10, 10, format="d16")
    buffer.draw(surfaces, view)
    fights = exact.find_depth_fights(buffer.visible())
    assert (fights.covered, fights.wrong, fights.tied) == (64, 64, 0)
    assert fights.pairs.tolist() == [(0, 1, 64, pytest.approx(0.0007, rel=1e-3))]
    assert fights.errors.shape == (1, 10, 10) and (fights.errors > 0).sum() == 64 and fights.view == view
    assert "64 of 64" in repr(fights)
    none = exact.find_depth_fights(surfaces.zbuffer(view))
    assert none.wrong == 0 and len(none.pairs) == 0
    (remedy, wrong), *_ = exact.try_remedies(fm.DepthSetup(0, 100, format="d16", orthographic=True))
    assert isinstance(remedy, fm.DepthSetup) and wrong == 0


def test_areas_are_known_on_paper(plates):
    surfaces, view = plates
    areas = surfaces.find_fighting_faces(view, "d16")
    row, = areas.objects
    assert (row["first"], row["second"], row["area"]) == (0, 1, 64)
    assert fm.fight_kinds[row["kind"]] == "close" and numpy.isclose(row["gap"], 100 / 65535, rtol=1e-6)
    assert numpy.isclose(areas.faces["area"].sum(), 64) and len(areas) == len(areas.faces) == len(areas.polygons)
    polygon = areas.polygons[0]
    assert polygon.shape[1] == 2 and not polygon.flags.writeable and areas.view == view and areas.setup.format == "d16"
    kept, exact = polygon.copy(), surfaces.find_exact_visible(view)
    assert "1 pairs" in repr(areas)
    number, factor, units = areas.find_offset(exact, 0)
    buffer = fm.DepthBuffer(10, 10, format="d16")
    buffer.draw(surfaces, view, end=2)
    buffer.draw(surfaces, view, begin=2, polygon_offset=(factor, units))
    assert number == 1 and exact.find_depth_fights(buffer.visible()).wrong == 0
    with pytest.raises(ValueError, match="^pair: there is no row 1"):
        areas.find_offset(exact, 1)
    assert len(surfaces.find_fighting_faces(view, "d24").objects) == 0
    del areas
    assert (polygon == kept).all()


def test_maps_are_the_command_lines(cli):
    flags = ("--near", "0.001", "--resolution", "160,120", "--format", "D16", "--heat-map", "map.png", "--json")
    folder = cli("precision", "builtin:gallery", *flags)
    surfaces = fm.Surfaces(fm.builtin("gallery"))
    view = fm.frame(surfaces, 160, 120)
    view = view.between(0.001, view.far)
    buffer = fm.DepthBuffer(160, 120, format="d16")
    buffer.draw(surfaces, view)
    fights = surfaces.find_exact_visible(view).find_depth_fights(buffer.visible())
    assert fights.wrong > 0
    fm.save(fights.image(), folder / "ours.png")
    assert (folder / "ours.png").read_bytes() == (folder / "map.png").read_bytes()
    told = subprocess.run([os.environ["FRONTMOST_CLI"], "precision", "builtin:gallery", *flags[:-3], "--json"],
                          check=True, capture_output=True, text=True)
    assert json.loads(told.stdout)["buffers"][0]["fights"]["wrong_pixels"] == fights.wrong


@pytest.mark.parametrize("call, error, message", [
    (lambda s, v: fm.DepthSetup(0, 10), fm.Error, "near"),
    (lambda s, v: fm.DepthSetup(1, 10, format="d32"), ValueError, "^format: "),
    (lambda s, v: fm.DepthSetup(1, 10).resolvable_gap(11), fm.Error, "distance"),
    (lambda s, v: fm.DepthSetup(1, 10).resolvable_gap([2, numpy.nan]), fm.Error, "distance"),
    (lambda s, v: fm.DepthSetup(1, 10).near_for_gap(2, 0), fm.Error, "gap"),
    (lambda s, v: s.find_exact_visible(v).find_depth_fights(s.zbuffer(v.sampled(2))), fm.Error, "view"),
    (lambda s, v: s.find_exact_visible(v).find_depth_fights(fm.Surfaces(s.scene.copy()).zbuffer(v)), fm.Error,
     "^answer: is of other surfaces"),
    (lambda s, v: s.find_fighting_faces(v, "d16").find_offset(s.find_exact_visible(v.sampled(2)), 0), fm.Error,
     "^exact: was made for another view"),
])
def test_wrong_uses_end_in_errors(plates, call, error, message):
    with pytest.raises(error, match=message):
        call(*plates)


def test_what_was_found_before_a_move_is_refused(plates):
    surfaces, view = plates
    exact, seen = surfaces.find_exact_visible(view), surfaces.zbuffer(view)
    areas = surfaces.find_fighting_faces(view, "d16")
    fights = exact.find_depth_fights(seen)
    surfaces.move(0, numpy.eye(4))
    for call in (lambda: exact.find_depth_fights(surfaces.zbuffer(view)), fights.image,
                 lambda: exact.try_remedies(areas.setup), lambda: areas.find_offset(exact, 0)):
        with pytest.raises(fm.Error, match="moved"):
            call()
