# SPDX-License-Identifier: Apache-2.0
"""The depth buffer with OpenGL's state."""
import numpy
import pytest

import frontmost as fm


@pytest.mark.parametrize("flags, buffer, state, clear", [
    (["--depth-format", "D16"], {"format": "d16"}, {}, 1),
    (["--depth-format", "D8", "--depth-func", "LEQUAL"], {"format": "d8"}, {"func": "less_equal"}, 1),
    (["--depth-format", "F32", "--reversed"], {"format": "f32"}, {"func": "greater", "nearer_is_greater": True}, 0),
    (["--polygon-offset", "2,3", "--depth-range", "0.2,0.8"], {}, {"polygon_offset": (2, 3), "range": (0.2, 0.8)}, 1),
    (["--depth-func", "ALWAYS", "--depth-mask", "off"], {}, {"func": "always", "mask": False}, 1),
])
def test_depths_and_ids_are_the_command_lines(cli, flags, buffer, state, clear):
    folder = cli("render", "builtin:city", "--resolution", "160,120", "--window-depth", "depth.npy", "--ids",
                 "primitive=primitive.npy", "-q", *flags)
    surfaces = fm.Surfaces(fm.builtin("city"))
    drawn = fm.DepthBuffer(160, 120, **buffer)
    drawn.clear(clear)
    drawn.draw(surfaces, fm.frame(surfaces, 160, 120), **state)
    assert drawn.depths[0].tobytes() == numpy.load(folder / "depth.npy").tobytes()
    assert drawn.visible().primitive.tobytes() == numpy.load(folder / "primitive.npy").tobytes()


def test_bits_and_order_are_known_on_paper(box):
    scene = fm.Scene.from_arrays(*box)
    surfaces = fm.Surfaces(scene)
    view = fm.View.orthographic((0, 0, 4), (0, 0, 0), width=8, height=8, tall=1, near=1, far=9)
    buffer = fm.DepthBuffer(8, 8, format="d16")
    buffer.draw(surfaces, view)
    assert (buffer.stored == round(0.25 * 65535)).all() and buffer.stored.shape == (1, 8, 8)  # z = 1 is 3 away
    assert set(numpy.unique(buffer.visible().face)) <= {10, 11}
    buffer.draw(surfaces, view, func="always", begin=8, end=10)  # the back, over the front
    assert (buffer.stored == round(0.5 * 65535)).all() and set(numpy.unique(buffer.visible().face)) <= {8, 9}
    assert (buffer.visible().depth == 5).all()
    buffer.clear()
    assert (buffer.stored == 65535).all() and "d16" in repr(buffer)


def test_wrong_uses_end_in_errors(box):
    surfaces = fm.Surfaces(fm.Scene.from_arrays(*box))
    view = fm.frame(surfaces, 8, 8)
    buffer = fm.DepthBuffer(8, 8)
    with pytest.raises(fm.Error, match="nothing was drawn"):
        buffer.visible()
    with pytest.raises(fm.Error):
        buffer.draw(surfaces, fm.frame(surfaces, 9, 8))
    with pytest.raises(fm.Error):
        buffer.draw(surfaces, view, range=(0, 2))
    with pytest.raises(fm.Error):
        buffer.clear(float("nan"))
    with pytest.raises(ValueError, match="^func: 'lesser' is not one of never, less"):
        buffer.draw(surfaces, view, func="lesser")
    with pytest.raises(ValueError, match="^format: "):
        fm.DepthBuffer(8, 8, format="d32")
    with pytest.raises(fm.Error):
        fm.DepthBuffer(0, 8)
    buffer.draw(surfaces, view)
    other = fm.Surfaces(fm.Scene.from_arrays(*box))
    with pytest.raises(fm.Error, match="shows others"):
        buffer.draw(other, view)
    seen = buffer.visible()
    surfaces.move(0, numpy.eye(4))
    with pytest.raises(fm.Error, match="moved"):
        seen.shade()
    buffer.clear()
    buffer.draw(other, view)
