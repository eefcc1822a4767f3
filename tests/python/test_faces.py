# SPDX-License-Identifier: Apache-2.0
"""Visible faces: areas computed by hand, and the bytes of the command line's tables."""
import json

import numpy
import pytest

import frontmost as fm


def test_areas_are_known_on_paper(box):
    # From the middle of a cube of side 2, each of the 6 sides fills a view of 90 degrees, and a sixth of the sphere.
    surfaces = fm.Surfaces(fm.Scene.from_arrays(*box))
    view = fm.View.look_at((0, 0, 0), (0, 0, -1), width=80, height=80, fov=90)
    faces = surfaces.visible_faces(view)
    assert faces["primitive"].tolist() == faces["triangle"].tolist() == [8, 9]
    assert numpy.allclose(faces["pixels"], 3200) and numpy.allclose(faces["area"], 2)
    assert numpy.allclose(faces["solid_angle"], numpy.pi / 3) and not faces["object"].any()


def test_faces_of_many_views_are_known_on_paper(box):
    surfaces = fm.Surfaces(fm.Scene.from_arrays(*box))
    ahead = [fm.View.look_at((0, 0, 5), (0, 0, 0)), fm.View.look_at((0, 0, 3), (0, 0, 0))]
    faces = surfaces.faces_ever_seen([*ahead, fm.View.look_at((5, 0, 5), (0, 0, 0))])
    front, right = faces["primitive"] >= 10, (faces["primitive"] >= 2) & (faces["primitive"] < 4)
    assert len(faces) == 4 and (front | right).all()
    assert (faces["views"][front] == 3).all() and (faces["views"][right] == 1).all()
    assert (faces["best_view"][front] == 0).all() and (faces["best_view"][right] == 2).all()
    assert numpy.allclose(faces["largest_share"], 1) and (faces["largest_pixels"] > 0).all()
    assert len(surfaces.faces_ever_seen([])) == 0


def test_tables_are_the_command_lines(cli):
    surfaces = fm.Surfaces(fm.builtin("city"))
    folder = cli("visible", "builtin:city", "--resolution", "160,120", "-o", "faces.npy", "-q")
    there, ours = numpy.load(folder / "faces.npy"), surfaces.visible_faces(fm.frame(surfaces, 160, 120))
    assert there.dtype == ours.dtype and there.tobytes() == ours.tobytes()
    directions = ["front", "left", "top"]
    (folder / "views.json").write_text(json.dumps(
        {"views": [{"view": one, "resolution": "160,120"} for one in directions]}))
    folder = cli("visible", "builtin:city", "--views", "views.json", "-o", "ever.npy", "--keep-visible", "kept.glb", "-q")
    views = [fm.frame(surfaces, 160, 120, direction=one) for one in directions]
    there, ours = numpy.load(folder / "ever.npy"), surfaces.faces_ever_seen(views, threads=1)
    assert there.dtype == ours.dtype and there.tobytes() == ours.tobytes()
    kept = surfaces.scene.keep_faces(ours["primitive"])
    assert kept.triangle_count == len(ours) < surfaces.triangle_count
    kept.save(folder / "ours.glb")
    assert (folder / "ours.glb").read_bytes() == (folder / "kept.glb").read_bytes()


def test_models_carry_what_is_known_of_their_faces(cli):
    surfaces = fm.Surfaces(fm.builtin("cubes"))
    folder = cli("visible", "builtin:cubes", "--resolution", "160,120", "-o", "seen.ply", "--keep-visible", "kept.ply", "-q")
    faces = surfaces.visible_faces(fm.frame(surfaces, 160, 120))
    kept = surfaces.scene.keep_faces(faces["primitive"])
    kept.save(folder / "ours.ply", of_triangles={"object": faces["object"], "triangle": faces["triangle"]})
    assert (folder / "ours.ply").read_bytes() == (folder / "kept.ply").read_bytes()
    kept.save(folder / "bits.ply", of_triangles={"red": faces["pixels"] > 1, "share": faces["area"]})
    header = (folder / "bits.ply").read_bytes().split(b"end_header")[0].decode()
    assert "property uchar red\nproperty double share" in header


@pytest.mark.parametrize("call, error, message", [
    (lambda s: s.scene.keep_faces([1, 0]), ValueError, "^primitives: must ascend"),
    (lambda s: s.scene.keep_faces([0, 0]), ValueError, "^primitives: must ascend"),
    (lambda s: s.scene.keep_faces([12]), ValueError, "^primitives: row 0 holds 12"),
    (lambda s: s.scene.keep_faces([0.5]), TypeError, "^primitives: "),
    (lambda s: s.scene.save("x.ply", of_triangles={"red": [1, 2]}), ValueError, "^of_triangles: red: must have the shape"),
    (lambda s: s.scene.save("x.ply", of_triangles={"red": "red"}), TypeError, "^of_triangles: red: "),
    (lambda s: s.scene.save("x.stl", of_triangles={"red": numpy.zeros(12, dtype=numpy.uint8)}), fm.Error, "x.stl"),
    (lambda s: s.faces_ever_seen([fm.frame(s), 3]), TypeError, "views"),
])
def test_wrong_uses_end_in_errors(box, tmp_path, monkeypatch, call, error, message):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(error, match=message):
        call(fm.Surfaces(fm.Scene.from_arrays(*box)))
    assert not list(tmp_path.iterdir())


def test_numbers_of_faces_may_be_of_any_integers(box):
    scene = fm.Scene.from_arrays(*box)
    for kind in ("u1", ">i8", "u8"):
        kept = scene.keep_faces(numpy.arange(12, dtype=kind)[::5])
        assert (kept.meshes[0].face_ids == [0, 5, 10]).all() and kept.objects[0].name == scene.objects[0].name


def test_no_face_is_no_error(box):
    assert fm.Surfaces(fm.Scene.from_arrays(*box)).scene.keep_faces(numpy.zeros(0, dtype=int)).triangle_count == 0
