# SPDX-License-Identifier: Apache-2.0
"""Pictures and maps: the bytes of the command line's files, and reading them back."""
import numpy
import pytest

import frontmost as fm


def look(name="gallery", width=160, height=120, samples=1):
    surfaces = fm.Surfaces(fm.builtin(name))
    return surfaces.zbuffer(fm.frame(surfaces, width, height, samples=samples))


@pytest.mark.parametrize("flags, options", [
    ([], {}),
    (["--background", "transparent", "--shadows", "off"], {"background": None, "shadows": "off"}),
    (["--environment", "sky", "--show-environment", "--exposure", "0.5", "--tone-mapping", "khronos"],
     {"environment": "sky", "shows_environment": True, "exposure": 0.5, "tone_mapping": "khronos"}),
    (["--opacity", "0.4", "--blend", "srgb"], {"opacity": 0.4, "blend": "srgb"}),
    (["--ambient-occlusion", "1", "--shadows", "rays"], {"ambient_occlusion": 1.0, "shadows": "rays"}),
])
def test_pictures_are_the_command_lines_files(cli, flags, options):
    folder = cli("render", "builtin:gallery", "--resolution", "160,120", "-o", "picture.png", "-q", *flags)
    seen = look(samples=4)
    ours = folder / "ours.png"
    for _ in range(2):  # the second time with what the first one kept
        fm.save(seen.shade(**options), ours)
        assert ours.read_bytes() == (folder / "picture.png").read_bytes()


def test_linear_pictures_and_maps_are_the_command_lines_files(cli):
    folder = cli("render", "builtin:gallery", "--resolution", "160,120", "--samples", "1", "-o", "picture.exr", "--depth",
                 "depth.exr", "--normals", "normals.npy", "--ids", "object=object.npy", "--ray-distance", "range.pfm", "-q")
    seen = look()
    linear = seen.shade_linear()
    assert linear.dtype == numpy.float32 and linear.shape == (120, 160, 4)
    fm.save(linear, folder / "ours.exr")
    there = fm.load_image(folder / "picture.exr")
    assert all((there[name] == linear[..., i]).all() for i, name in enumerate("RGBA"))
    assert seen.normals.tobytes() == numpy.load(folder / "normals.npy").tobytes()
    for name, plane in (("depth.exr", {"Z": seen.depth}), ("object.npy", {"object": seen.object}),
                        ("range.pfm", {"distance": seen.ray_distance})):
        fm.save(plane, folder / f"ours_{name}")
        assert (folder / f"ours_{name}").read_bytes() == (folder / name).read_bytes(), name


def test_shadings_differ():
    seen = look()
    pictures = {shading: seen.shade(shading=shading).tobytes() for shading in ("lit", "flat", "normals", "depth", "ids", "uv")}
    assert len(set(pictures.values())) == 6
    kinds = {word: seen.shade(see_through=word).tobytes() for word in ("where_needed", "never")}
    assert kinds["where_needed"] == pictures["lit"] != kinds["never"]  # there is a pane of glass


def test_bitmaps_are_arrays_that_show_themselves():
    picture = look().shade()
    assert isinstance(picture, fm.Bitmap) and isinstance(picture, numpy.ndarray)
    assert picture.shape == (120, 160, 4) and picture.dtype == numpy.uint8 and picture.flags.writeable
    png = picture._repr_png_()
    assert png.startswith(b"\x89PNG") and picture[:, ::2]._repr_png_().startswith(b"\x89PNG")
    assert picture[0]._repr_png_() is None and (picture / 2)._repr_png_() is None
    assert type(picture[..., :3].astype(float).mean()) is not None


def test_files_come_back(tmp_path):
    picture = look().shade()
    fm.save(picture, tmp_path / "a.png")
    again = fm.load_image(tmp_path / "a.png")
    assert list(again)[:3] == ["R", "G", "B"]
    linear = numpy.stack([again["R"], again["G"], again["B"]], axis=-1)
    fm.save(linear, tmp_path / "b.png")
    assert (tmp_path / "b.png").read_bytes() == (tmp_path / "a.png").read_bytes()
    fm.save(picture[..., :3], tmp_path / "c.png")
    assert (tmp_path / "c.png").read_bytes() == (tmp_path / "a.png").read_bytes()
    fm.save(picture, tmp_path / "a.jpeg", quality=50)
    assert (tmp_path / "a.jpeg").stat().st_size < (tmp_path / "a.png").stat().st_size
    ids = numpy.arange(12, dtype=numpy.int16).reshape(3, 4)
    fm.save({"object": ids}, tmp_path / "ids.exr")
    assert (fm.load_image(tmp_path / "ids.exr")["object"] == ids).all()
    for mask in ({"Y": ids > 5}, ids > 5):
        fm.save(mask, tmp_path / "mask.npy")
        assert (numpy.load(tmp_path / "mask.npy") == (ids > 5)).all()
    fm.save(ids > 5, tmp_path / "mask.png")
    assert (fm.load_image(tmp_path / "mask.png")["R"] == (ids > 5)).all()


@pytest.mark.parametrize("image, error, message", [
    (numpy.zeros((4, 4)), TypeError, "^image: "),
    (numpy.zeros((4, 4, 2)), TypeError, "^image: "),
    ("picture", TypeError, "^image: "),
    (None, TypeError, "^image: "),
    (numpy.zeros((4, 4, 3), dtype=complex), TypeError, "^image: "),
    (numpy.zeros((0, 4, 3), dtype=numpy.uint8), fm.Error, ""),
    ({}, fm.Error, ""),
    ({"Z": numpy.zeros((4, 4)), "A": numpy.zeros((4, 5))}, ValueError, "^A: "),
    ({"Z": numpy.zeros(4)}, ValueError, "^Z: "),
    ({"object": numpy.full((2, 2), -1)}, ValueError, "^object: "),
    ({3: numpy.zeros((2, 2))}, TypeError, "^image: "),
])
def test_hostile_images_end_in_errors(tmp_path, image, error, message):
    with pytest.raises(error, match=message):
        fm.save(image, tmp_path / "x.png")
    assert not list(tmp_path.iterdir())


def test_environments(tmp_path):
    seen = look("teapot", 60, 40)
    light = numpy.ones((16, 32, 3), dtype=numpy.float32)
    fm.save(light, tmp_path / "even.exr")
    made = fm.Environment(light)
    assert not made.turns_with_camera and fm.Environment("studio").turns_with_camera
    pictures = [seen.shade(environment=given).tobytes() for given in (made, str(tmp_path / "even.exr"), "studio", None)]
    assert pictures[0] == pictures[1] != pictures[2] == pictures[3]
    for given in (numpy.ones((16, 16, 3)), numpy.full((16, 32, 3), -1.0)):
        with pytest.raises(fm.Error):
            fm.Environment(given)
    with pytest.raises(ValueError, match="^source: "):
        fm.Environment(numpy.ones((16, 32)))
    with pytest.raises(fm.Error):
        seen.shade(environment=tmp_path / "none.hdr")


@pytest.mark.parametrize("option, value, error", [
    ("shading", "toon", ValueError), ("shadows", "soft", ValueError), ("background", (1, 2), ValueError),
    ("opacity", 2.0, fm.Error), ("grid", 3, fm.Error), ("light_direction", (0, 0, 0), fm.Error),
    ("exposure", 99.0, fm.Error), ("ambient_occlusion", 2.0, fm.Error),
])
def test_options_out_of_range_end_in_errors(option, value, error):
    with pytest.raises(error, match=option.split("_")[0]):
        look("gallery", 20, 20).shade(**{option: value})


def test_what_was_moved_is_not_shaded():
    surfaces = fm.Surfaces(fm.builtin("cubes"))
    seen = surfaces.zbuffer(fm.frame(surfaces, 20, 20))
    surfaces.move(0, numpy.eye(4))
    for call in (seen.shade, seen.shade_linear, lambda: seen.normals):
        with pytest.raises(fm.Error, match="moved"):
            call()
