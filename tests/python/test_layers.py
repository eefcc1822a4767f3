# SPDX-License-Identifier: Apache-2.0
"""Layers and fragments."""
import gc

import numpy
import pytest

import frontmost as fm


def look(surfaces):
    return surfaces.zbuffer(fm.frame(surfaces, 80, 60))


def test_layers_are_in_order(cli):
    surfaces = fm.Surfaces(fm.builtin("gallery"))
    seen = look(surfaces)
    layers = seen.layers(3, opacity=0.5)
    assert [type(layer) for layer in layers] == [fm.Visible] * 3
    assert layers[0].content_hash() == seen.content_hash()
    assert (layers[0].depth <= layers[1].depth).all() and (layers[1].depth <= layers[2].depth).all()
    assert ((layers[0].primitive != layers[1].primitive) | (layers[0].primitive == fm.no_primitive)).all()
    folder = cli("render", "builtin:gallery", "--resolution", "80,60", "--samples", "1", "--opacity", "0.5", "--layers", "3",
                 "--depth", "depth{layer}.npy", "-q")
    for i, layer in enumerate(layers):
        assert layer.depth.tobytes() == numpy.load(folder / f"depth{i}.npy").tobytes()


def test_layers_know_their_objects(box):
    vertices, faces = box
    scene = fm.Scene.from_arrays(vertices, faces)
    pose = numpy.eye(4)
    pose[2, 3] = -5
    scene.place(0, pose)
    surfaces = fm.Surfaces(scene)
    view = fm.View.look_at((0, 0, 9), (0, 0, 0), width=33, height=33, fov=10, near=1, far=100)
    layers = surfaces.zbuffer(view).layers(5, opacity=0.5)
    assert [layer.object[16, 16] for layer in layers] == [0, 0, 1, 1, fm.no_index]
    assert numpy.allclose([layer.depth[16, 16] for layer in layers], [8, 10, 13, 15, numpy.inf], rtol=1e-6)
    assert [layer.object[16, 16] for layer in surfaces.zbuffer(view).layers(2)] == [0, fm.no_index]


def test_fragments_say_what_layers_say():
    surfaces = fm.Surfaces(fm.builtin("cubes"))
    seen = look(surfaces)
    fragments = surfaces.abuffer(seen.view, opacity=0.5)
    assert fragments.samples.tolist() == [[128, 128]]
    rows, first = fragments.rows, fragments.first
    assert len(rows) == len(fragments) == first[-1] and len(first) == 80 * 60 + 1
    for k, layer in enumerate(seen.layers(4, opacity=0.5)):
        flat = layer.primitive.reshape(-1)
        counts = numpy.diff(first.astype(int))
        assert ((flat != fm.no_primitive) == (counts > k)).all()
        there = counts > k
        assert (rows["primitive"][first[:-1][there].astype(int) + k] == flat[there]).all()
    y, x = numpy.argwhere(seen.primitive != fm.no_primitive)[0]
    at = fragments.at(x, y)
    assert at["primitive"][0] == seen.primitive[y, x] and at["opacity"][0] == 0.5
    assert surfaces.abuffer(seen.view, grid=4).samples.shape == (16, 2)
    kept = rows.copy()
    del fragments, surfaces, seen, at
    gc.collect()
    assert (rows == kept).all()
    with pytest.raises(ValueError):
        rows["mask"][0] = 0


@pytest.mark.parametrize("call, error, message", [
    (lambda s: s.layers(0), fm.Error, "count|layers"),
    (lambda s: s.layers(2000), fm.Error, "count|layers"),
    (lambda s: s.layers(2, opacity=3), fm.Error, "opacity"),
    (lambda s: s.surfaces.abuffer(s.view, grid=3), fm.Error, "grid"),
    (lambda s: s.surfaces.abuffer(s.view).at(80, 0), ValueError, "^x, y: "),
])
def test_options_out_of_range_end_in_errors(call, error, message):
    with pytest.raises(error, match=message):
        call(look(fm.Surfaces(fm.builtin("cubes"))))
