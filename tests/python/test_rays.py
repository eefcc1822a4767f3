# SPDX-License-Identifier: Apache-2.0
"""Rays one by one, against arithmetic and against pictures."""
import json
import os
import subprocess

import numpy
import pytest

import frontmost as fm


def met_by_hand(corners, origin, direction):
    """The t of a ray and every triangle, by a determinant in doubles; inf if the ray misses."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = numpy.cross(b - a, c - a)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        t = ((a - origin) * normal).sum(1) / (normal @ direction)
        point = origin + t[:, None] * direction
        inside = numpy.ones(len(t), dtype=bool)
        for p, q in ((a, b), (b, c), (c, a)):
            inside &= (numpy.cross(q - p, point - p) * normal).sum(1) >= 0
    return numpy.where(inside & (t > 0), t, numpy.inf)


def test_hits_are_those_worked_out_by_hand():
    scene = fm.builtin("cubes")
    surfaces = fm.Surfaces(scene)
    index = fm.RayIndex(surfaces)
    corners = []
    for thing in scene.objects:
        mesh = scene.meshes[thing.mesh]
        points = mesh.vertices.astype(float) @ thing.pose[:3, :3].T + thing.pose[:3, 3]
        corners.append(points[mesh.faces])
    corners = numpy.concatenate(corners)
    random = numpy.random.default_rng(3)
    low, high = surfaces.bounds
    origins = random.uniform(low - 1, high + 1, (200, 3)).astype(numpy.float32)
    directions = random.normal(size=(200, 3)).astype(numpy.float32)
    hits = index.closest_hit(origins, directions)
    every, first = index.all_hits(origins, directions)
    assert len(hits) == 200 and first[0] == 0 and first[-1] == len(every) and "200" in repr(hits)
    for i in range(200):
        t = met_by_hand(corners, origins[i].astype(float), directions[i].astype(float))
        wanted = numpy.sort(t[numpy.isfinite(t)])
        assert numpy.allclose(every.t[first[i]:first[i + 1]], wanted, rtol=1e-5, atol=1e-6)
        assert numpy.isclose(hits.t[i], t.min(), rtol=1e-5, atol=1e-6) or (numpy.isinf(hits.t[i]) and not len(wanted))
        assert (hits.primitive[i] == fm.no_primitive) == (not len(wanted))
    met = hits.primitive != fm.no_primitive
    assert 10 < met.sum() < 200
    assert (hits.object[~met] == fm.no_index).all() and set(hits.object[met]) <= {0, 1}
    ends = origins + directions
    between = index.closest_hit(origins, end=ends)
    clear = index.is_clear(origins, ends)
    assert clear.dtype == bool and (clear == (between.primitive == fm.no_primitive)).all()
    assert (clear == index.is_clear(ends, origins)).all()
    assert ((hits.t < 1) == ~clear).all()


def test_one_point_stands_for_all(box):
    index = fm.RayIndex(fm.Surfaces(fm.Scene.from_arrays(*box)))
    hits = index.closest_hit((0, 0, 5), [[0, 0, -1], [0, 0, -2], [0, 0, 1]])
    assert hits.t.tolist() == [4, 2, numpy.inf] and hits.is_front.tolist() == [True, True, False]
    assert index.closest_hit((0, 0, 0), (0, 0, 1)).is_front.tolist() == [False]
    assert index.is_clear([[0, 0, 5], [0, 5, 5]], (0, 0, -5)).tolist() == [False, True]
    assert index.is_clear((5, 5, 5), (5, 5, -5)).tolist() == [True]
    assert len(index.closest_hit(numpy.zeros((0, 3)), numpy.zeros((0, 3)))) == 0
    strange = index.closest_hit([[numpy.nan, 0, 0], [0, 0, 5]], [[0, 0, 1], [0, 0, 0]])
    assert (strange.primitive == fm.no_primitive).all()


def test_line_of_sight_is_the_command_lines():
    if "FRONTMOST_CLI" not in os.environ:
        pytest.skip("FRONTMOST_CLI does not say where the program is")
    surfaces = fm.Surfaces(fm.builtin("city"))
    index = fm.RayIndex(surfaces)
    low, high = surfaces.bounds
    random = numpy.random.default_rng(5)
    for start, end in random.uniform(low, high, (4, 2, 3)).astype(numpy.float32).tolist():
        told = subprocess.run([os.environ["FRONTMOST_CLI"], "sight", "builtin:city", "--from", ",".join(map(repr, start)),
                               "--to", ",".join(map(repr, end)), "--json"], capture_output=True, text=True)
        assert json.loads(told.stdout)["clear"] == index.is_clear(start, end)[0], told.stdout


def test_views_by_an_index():
    surfaces = fm.Surfaces(fm.builtin("teapot"))
    view = fm.frame(surfaces, 80, 60)
    index = fm.RayIndex(surfaces)
    del surfaces
    seen = index.raycast(view)
    assert seen.content_hash() == index.surfaces.raycast(view).content_hash()
    assert "6320" in repr(index)


def test_light_reaches_one_side(box):
    surfaces = fm.Surfaces(fm.Scene.from_arrays(*box))
    index = fm.RayIndex(surfaces)
    lit = index.are_lit(numpy.arange(12), numpy.ones((12, 3)), (0.1, 0.2, 1))
    assert lit.dtype == bool
    assert set(numpy.nonzero(lit)[0]) == {2, 3, 6, 7, 10, 11}  # those of +x, +y and +z


def test_what_moves_is_followed(box):
    surfaces = fm.Surfaces(fm.Scene.from_arrays(*box))
    index = fm.RayIndex(surfaces)
    pose = numpy.eye(4)
    pose[2, 3] = 2
    surfaces.move(0, pose)
    for call in (lambda: index.closest_hit((0, 0, 9), (0, 0, -1)), lambda: index.is_clear((0, 0, 9), (0, 0, 0)),
                 lambda: index.all_hits((0, 0, 9), (0, 0, -1)), lambda: index.are_lit([0], [[1, 1, 1]], (0, 0, 1)),
                 lambda: index.raycast(fm.frame(surfaces))):
        with pytest.raises(fm.Error, match="moved"):
            call()
    index.refit()
    assert index.closest_hit((0, 0, 9), (0, 0, -1)).t.tolist() == [6]


@pytest.mark.parametrize("call, error, message", [
    (lambda i: i.closest_hit([[0, 0]], [[0, 0, 1]]), ValueError, "^origins: "),
    (lambda i: i.closest_hit([[0, 0, 0]] * 2, [[0, 0, 1]] * 3), ValueError, "^directions: are 3, for 2 origins"),
    (lambda i: i.closest_hit("here", [[0, 0, 1]]), TypeError, "^origins: "),
    (lambda i: i.closest_hit([[0, 0, 0]]), TypeError, "^directions: "),
    (lambda i: i.closest_hit([[0, 0, 0]], [[0, 0, 1]], end=[[0, 0, 1]]), TypeError, "^directions: "),
    (lambda i: i.is_clear([[0, 0, 0]], None), TypeError, "^end: "),
    (lambda i: i.is_clear([[0, 0, 0j]], [[0, 0, 1]]), TypeError, "^start: "),
    (lambda i: i.are_lit([12], [[1, 1, 1]], (0, 0, 1)), ValueError, "^primitives: "),
    (lambda i: i.are_lit([1], [[1, 1]], (0, 0, 1)), ValueError, "^weights: "),
    (lambda i: i.are_lit([1], [[0, 0, 0]], (0, 0, 1)), ValueError, "^weights: "),
    (lambda i: i.are_lit([1], [[1, 1, 1]], (0, 0, numpy.nan)), ValueError, "^to_light: "),
])
def test_hostile_queries_end_in_errors_that_name_the_argument(box, call, error, message):
    index = fm.RayIndex(fm.Surfaces(fm.Scene.from_arrays(*box)))
    with pytest.raises(error, match=message):
        call(index)
