# SPDX-License-Identifier: Apache-2.0
"""Methods beside each other: the painter's order, and whether answers agree."""
import json
import os
import subprocess

import numpy
import pytest

import frontmost as fm


def look(name, width=160, height=120):
    surfaces = fm.Surfaces(fm.builtin(name))
    return surfaces, fm.frame(surfaces, width, height)


def test_methods_agree():
    surfaces, view = look("gallery")
    seen = surfaces.zbuffer(view)
    same = seen.check_agreement(seen)
    assert same.counts == {"none": 160 * 120, "edge": 0, "depth": 0, "translucent": 0, "unexplained": 0}
    layers = seen.layers(2)
    for other, behind in ((surfaces.raycast(view), None), (layers[0], layers[1]), (surfaces.painter(view).paint(), None)):
        found = seen.check_agreement(other, behind=behind)
        assert found.counts["unexplained"] == 0 and sum(found.counts.values()) == 160 * 120
        assert found.differing == 160 * 120 - found.counts["none"]
        kinds = numpy.bincount(found.differences.reshape(-1), minlength=5)
        assert dict(zip(fm.difference_kinds, kinds)) == found.counts
        assert found.differences.shape == (1, 120, 160) and not found.differences.flags.writeable
        assert "0 of them unexplained" in repr(found)
    assert seen.check_agreement(layers[0], behind=layers[1]).counts["translucent"] > 0
    wrong = surfaces.painter(view, method="centroid").paint()
    assert seen.check_agreement(wrong).counts["unexplained"] > 0


def test_agreement_is_the_command_lines():
    if "FRONTMOST_CLI" not in os.environ:
        pytest.skip("FRONTMOST_CLI does not say where the program is")
    told = subprocess.run([os.environ["FRONTMOST_CLI"], "compare", "builtin:cubes", "--resolution", "160,120", "--runs", "1",
                           "--json"], check=True, capture_output=True, text=True)
    surfaces, view = look("cubes")
    seen = surfaces.zbuffer(view)
    others = {"raycast": surfaces.raycast(view), "painter": surfaces.painter(view).paint()}
    methods = {method["method"]: method for method in json.loads(told.stdout)["methods"]}
    for name, other in others.items():
        found = seen.check_agreement(other)
        assert methods[name]["differing"] == found.differing
        assert {"none": methods[name]["samples"] - found.differing, **methods[name]["explained"],
                "unexplained": methods[name]["unexplained"]} == found.counts
    culling = json.loads(told.stdout)["occlusion_culling"]
    sights = numpy.bincount(fm.Occlusion(surfaces).cull(view), minlength=3)
    assert dict(zip(fm.object_sights, sights)) == {word: culling[word] for word in fm.object_sights}


def test_orders_are_known_on_paper(box):
    # A triangle 2 units in front of another. The far one is painted first; an L of it shows around the near one's
    # corner.
    far = numpy.array([[-4, -4, 0], [4, -4, 0], [-4, 4, 0]])
    scene = fm.Scene.from_arrays(far / 4 + [0, 0, 2], [[0, 1, 2]], name="near")
    scene.add(far, [[0, 1, 2]], name="far")
    surfaces = fm.Surfaces(scene)
    view = fm.View.orthographic((0, 0, 10), (0, 0, 0), width=80, height=80, tall=10, near=1, far=20)
    order = surfaces.painter(view)
    assert order.polygons["primitive"].tolist() == [1, 0] and len(order) == 2
    first, count = order.polygons["first_corner"][0], order.polygons["corner_count"][0]
    corners = order.corners[first:first + count]
    assert sorted(corners[:, :2].round(6).tolist()) == [[8, 8], [8, 72], [72, 72]] and (corners[:, 2] == 10).all()
    assert order.steps["cuts"] == 0 and not order.is_cut.any() and "2 polygons" in repr(order)
    assert order.paint().content_hash() == surfaces.zbuffer(view).content_hash()
    parts = order.visible_parts()
    areas = {0: 0.0, 1: 0.0}
    for primitive, count, first in parts.polygons.tolist():
        x, y, _ = parts.corners[first:first + count].T
        areas[primitive] += abs(numpy.dot(x, numpy.roll(y, 1)) - numpy.dot(y, numpy.roll(x, 1))) / 2
    assert numpy.isclose(areas[0], 16 * 16 / 2) and numpy.isclose(areas[1], 64 * 64 / 2 - 16 * 16 / 2)
    assert len(parts) == len(parts.polygons) and len(parts.is_cut) == len(parts.corners)
    assert parts.is_cut.any() and "VisibleParts" in repr(parts)


def test_cycles_are_cut():
    surfaces, view = look("cubes")
    order = surfaces.painter(view, threads=1)
    assert (order.steps["cuts"] > 0) == (len(order) > len(numpy.unique(order.polygons["primitive"])))
    assert len(surfaces.painter(view, method="bsp")) >= len(order)
    with pytest.raises(fm.Error) as raised:
        surfaces.painter(view, most_polygons=1)
    assert raised.value.code == "limit_exceeded"
    with pytest.raises(ValueError, match="^method: 'newell' is not one of depth_sort, bsp, farthest, centroid"):
        surfaces.painter(view, method="newell")


def test_answers_of_others_are_refused():
    surfaces, view = look("cubes")
    seen, order = surfaces.zbuffer(view), surfaces.painter(view)
    with pytest.raises(fm.Error, match="^other: is of other surfaces"):
        seen.check_agreement(look("cubes")[0].zbuffer(view))
    with pytest.raises(fm.Error, match="^behind: is of other surfaces"):
        seen.check_agreement(seen, behind=look("cubes")[0].zbuffer(view))
    with pytest.raises(fm.Error, match="view"):
        seen.check_agreement(surfaces.zbuffer(view.sampled(2)))
    surfaces.move(0, numpy.eye(4))
    with pytest.raises(fm.Error, match="moved"):
        seen.check_agreement(surfaces.zbuffer(view))
    with pytest.raises(fm.Error, match="moved"):
        order.paint()
