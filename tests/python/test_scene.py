# SPDX-License-Identifier: Apache-2.0
"""Scenes: made from arrays, read from files, inspected, changed, and written."""
import base64
import gc
import json
import os
import pathlib
import subprocess

import numpy
import pytest

import frontmost as fm


def seen_from(scene, **options):
    surfaces = fm.Surfaces(scene)
    return surfaces.zbuffer(fm.frame(surfaces, 64, 48, **options))


def test_arrays_of_all_kinds_make_the_same_scene(box):
    vertices, faces = box
    wanted = seen_from(fm.Scene.from_arrays(vertices, faces)).content_hash()
    kinds = [numpy.float32, numpy.float64, numpy.int8, numpy.int64]
    for kind in kinds:
        assert seen_from(fm.Scene.from_arrays(vertices.astype(kind), faces)).content_hash() == wanted, kind
    for kind in [numpy.uint8, numpy.int16, numpy.int32, numpy.uint32, numpy.uint64, ">i4", ">u8"]:
        assert seen_from(fm.Scene.from_arrays(vertices, faces.astype(kind))).content_hash() == wanted, kind
    fortran = fm.Scene.from_arrays(numpy.asfortranarray(vertices), numpy.asfortranarray(faces))
    assert seen_from(fortran).content_hash() == wanted
    strided = fm.Scene.from_arrays(numpy.repeat(vertices, 2, axis=0)[::2], numpy.repeat(faces, 3, axis=1)[:, ::3])
    assert seen_from(strided).content_hash() == wanted
    reversed_twice = fm.Scene.from_arrays(vertices[::-1][::-1], faces[::-1][::-1])
    assert seen_from(reversed_twice).content_hash() == wanted
    assert seen_from(fm.Scene.from_arrays(vertices.tolist(), faces.tolist())).content_hash() == wanted
    vertices.flags.writeable = faces.flags.writeable = False
    assert seen_from(fm.Scene.from_arrays(vertices, faces)).content_hash() == wanted


def test_arrays_are_copied(box):
    vertices, faces = box
    scene = fm.Scene.from_arrays(vertices, faces)
    vertices[:] = 7
    faces[:] = 0
    assert numpy.unique(scene.meshes[0].vertices).tolist() == [-1, 1]
    assert scene.meshes[0].faces.max() == 7


@pytest.mark.parametrize("argument, value, error", [
    ("vertices", numpy.zeros((4, 2)), ValueError),
    ("vertices", numpy.zeros(12), ValueError),
    ("vertices", numpy.zeros((2, 3), dtype=complex), TypeError),
    ("vertices", [["a", "b", "c"]], TypeError),
    ("vertices", None, TypeError),
    ("vertices", object(), TypeError),
    ("vertices", [[0, 0, 0], [1, 1]], TypeError),
    ("faces", [[0, 1, 8]], ValueError),
    ("faces", [[0, 1, -1]], ValueError),
    ("faces", numpy.array([[0, 1, 2**63]], dtype=numpy.uint64), ValueError),
    ("faces", numpy.array([[0, 1, -2**63]], dtype=numpy.int64), ValueError),
    ("faces", [[0, 1, 2**32]], ValueError),
    ("faces", [[0, 1, 2.0]], TypeError),
    ("faces", [[0, 1, 2, 3]], ValueError),
    ("faces", [[True, False, True]], TypeError),
    ("pose", numpy.eye(3), ValueError),
    ("pose", numpy.full((4, 4), numpy.nan), ValueError),
    ("pose", numpy.ones((4, 4)), ValueError),
    ("color", [1, 2, 3.0], ValueError),
    ("color", [1.0, 1.0], ValueError),
    ("color", "red", TypeError),
    ("vertex_colors", numpy.zeros((7, 3)), ValueError),
    ("vertex_colors", numpy.full((8, 3), numpy.nan), ValueError),
    ("face_colors", numpy.zeros((8, 3)), ValueError),
    ("normals", numpy.zeros((8, 2)), ValueError),
    ("texcoords", numpy.zeros((7, 2)), ValueError),
    ("texture", numpy.zeros((4, 4, 3)), ValueError),
    ("texture", numpy.zeros((4, 4, 3), dtype=numpy.uint8), ValueError),
])
def test_hostile_arrays_end_in_errors_that_name_the_argument(box, argument, value, error):
    arguments = {"vertices": box[0], "faces": box[1], argument: value}
    with pytest.raises(error, match=f"^{argument}: "):
        fm.Scene.from_arrays(**arguments)
    scene = fm.Scene.from_arrays(*box)
    with pytest.raises(error, match=f"^{argument}: "):
        scene.add(**arguments)
    assert len(scene.objects) == len(scene.meshes) == 1  # no partial addition


def test_empty_arrays_show_nothing():
    for vertices in (numpy.zeros((0, 3)), numpy.zeros((3, 3))):
        scene = fm.Scene.from_arrays(vertices, numpy.zeros((0, 3), dtype=int))
        assert (seen_from(scene).primitive == fm.no_primitive).all()
    assert (seen_from(fm.Scene()).primitive == fm.no_primitive).all()


def test_vertices_that_are_not_finite_are_never_seen(box):
    vertices, faces = box
    more = numpy.vstack([vertices, [[numpy.nan, 0, 0], [numpy.inf, 0, 0]]])
    scene = fm.Scene.from_arrays(more, numpy.vstack([faces, [[0, 1, 8], [0, 1, 9]]]))
    seen = seen_from(scene)
    assert scene.triangle_count == 14
    assert set(numpy.unique(seen.primitive)) <= {*range(12), fm.no_primitive}


def test_objects_have_names_places_and_colours(box):
    scene = fm.Scene.from_arrays(*box, name="left", color=[255, 0, 0], pose=numpy.eye(4))
    pose = numpy.eye(4)
    pose[0, 3] = 3
    assert scene.add(*box, name="right", pose=pose[:3], vertex_colors=numpy.full((8, 3), 0.25)) == 1
    pose[0, 3] = 6
    assert scene.place(1, pose, name="far right") == 2
    assert [o.name for o in scene.objects] == ["left", "right", "far right"]
    assert [o.mesh for o in scene.objects] == [0, 1, 1]
    assert scene.objects[2].pose[0, 3] == 6
    assert scene.find("right") == 1 and scene.find(2) == 2
    assert scene.meshes[1].colors[0].tolist() == [0.25, 0.25, 0.25, 1]
    with pytest.raises(ValueError, match="^object: none is called 'middle'"):
        scene.find("middle")
    with pytest.raises(ValueError, match="^object: there is no object 3"):
        scene.find(3)
    with pytest.raises(ValueError, match="^mesh: there is no mesh 2"):
        scene.place(2)
    objects = seen_from(scene, direction="front").object
    columns = [numpy.nonzero((objects == i).any(axis=0))[0].mean() for i in range(3)]
    assert columns == sorted(columns)


def test_bytes_of_colours_are_those_of_files(box, tmp_path):
    vertices = numpy.zeros((256, 3))
    path = tmp_path / "grey.ply"
    rows = "\n".join(f"0 0 {i} {i} {i} {i}" for i in range(256))
    path.write_text("ply\nformat ascii 1.0\nelement vertex 256\nproperty float x\nproperty float y\nproperty float z\n"
                    "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
                    f"property list uchar int vertex_indices\nend_header\n{rows}\n3 0 1 2\n")
    levels = numpy.arange(256, dtype=numpy.uint8)[:, None].repeat(3, axis=1)
    ours = fm.Scene.from_arrays(vertices, [[0, 1, 2]], vertex_colors=levels)
    assert (ours.meshes[0].colors == fm.load(path).meshes[0].colors).all()


def test_doubles_far_from_zero_lose_nothing(box):
    vertices, faces = box
    near = seen_from(fm.Scene.from_arrays(vertices / 8, faces)).content_hash()
    far_away = numpy.array([4.5e6, 5.0e6, 2.0e6])
    scene = fm.Scene.from_arrays(vertices.astype(float) / 8 + far_away, faces)
    assert (scene.origin == far_away).all()
    assert seen_from(scene).content_hash() == near
    pose = numpy.eye(4)
    pose[:3, 3] = far_away
    scene.add(vertices / 8, faces, pose=pose)
    assert (scene.objects[1].pose[:3, 3] == far_away).all()
    assert fm.Surfaces(scene).bounds.max() == 0.125


def test_poses_are_those_of_points_as_they_were_given(box):
    vertices, faces = box
    for middle in ((0, 0, 0), (4.5e6, 5.0e6, 2.0e6), (0, 0, 3000)):
        scene = fm.Scene.from_arrays(vertices.astype(float) + middle, faces)
        pose = numpy.diag([-1.0, -1.0, 1.0, 1.0])  # half a turn about z
        scene.place(0, pose)
        assert (scene.objects[0].pose == numpy.eye(4)).all() and (scene.objects[1].pose == pose).all()
        assert (scene.meshes[0].vertices + scene.meshes[0].origin == vertices + middle).all()
        turned = numpy.array(middle) * [-1, -1, 1]
        wanted = [numpy.minimum(middle, turned) - 1, numpy.maximum(middle, turned) + 1]
        surfaces = fm.Surfaces(scene.copy())
        assert (surfaces.bounds + scene.origin == wanted).all(), middle
        surfaces.move(1, numpy.eye(4))
        assert (surfaces.bounds + scene.origin == [numpy.array(middle) - 1, numpy.array(middle) + 1]).all(), middle
    flat = fm.Scene.from_arrays([[0.0, 0, -1], [8, 0, -1], [0, 8, -1]], [[0, 1, 2]])  # thin, and not far away
    assert not flat.meshes[0].origin.any() and (flat.meshes[0].vertices[:, 2] == -1).all()


def test_what_was_made_of_a_scene_keeps_it(box):
    scene = fm.Scene.from_arrays(*box)
    surfaces = fm.Surfaces(scene)
    before = surfaces.zbuffer(fm.frame(surfaces)).content_hash()
    faces = scene.meshes[0].faces
    for _ in range(100):
        scene.add(*box)
    assert surfaces.scene.triangle_count == 12 and scene.triangle_count == 1212
    assert surfaces.zbuffer(fm.frame(surfaces)).content_hash() == before
    kept = faces.copy()
    del scene, surfaces
    gc.collect()
    noise = [numpy.full(1000, i) for i in range(1000)]
    assert len(noise) == 1000 and (faces == kept).all()


def test_arrays_of_meshes_cannot_be_written(box):
    mesh = fm.Scene.from_arrays(*box).meshes[0]
    for plane in (mesh.vertices, mesh.faces):
        with pytest.raises(ValueError):
            plane[0] = 9
        with pytest.raises(ValueError):
            plane.flags.writeable = True


def test_files_come_back(box, tmp_path):
    scene = fm.Scene.from_arrays(*box, name="crate")
    for suffix in ("ply", "stl", "glb"):
        path = tmp_path / f"crate.{suffix}"
        scene.save(path)
        again = fm.load(path)
        assert again.triangle_count == 12 and again.name == "crate"
        assert fm.load(path.read_bytes(), format=None if suffix != "glb" else "gltf").triangle_count == 12
    with pytest.raises(fm.Error, match="cannot open") as raised:
        fm.load(tmp_path / "none.stl")
    assert raised.value.code == "file_unreadable"
    assert raised.value.file == str(tmp_path / "none.stl") and raised.value.place == ""
    assert str(raised.value) == f"{raised.value.file}: {raised.value.reason}"
    with pytest.raises(fm.Error) as raised:
        scene.save(tmp_path / "crate.xyz")
    assert raised.value.code == "unsupported"
    with pytest.raises(ValueError, match="^format: 'usd' is not one of stl, ply"):
        fm.load(path, format="usd")
    with pytest.raises(TypeError):
        fm.load(3)


def test_builtin_scenes():
    assert "teapot" in fm.builtin_names()
    for name in fm.builtin_names():
        scene = fm.builtin(name)
        assert scene.name == name and scene.triangle_count > 0 and name in repr(scene)
    with pytest.raises(fm.Error, match="teapot"):
        fm.builtin("teakettle")
    copy = scene.copy()
    copy.name, copy.up = "other", "-z"
    assert (copy.name, copy.up, scene.up) == ("other", "-z", "y")
    scene.add_scene(copy)
    assert scene.triangle_count == 2 * copy.triangle_count


def test_polygons_of_files_keep_their_numbers(tmp_path):
    # Two squares side by side, of two triangles each, and a missing material library.
    path = tmp_path / "squares.obj"
    path.write_text("mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nf 1 2 5 4\nf 2 3 6 5\n")
    scene = fm.load(path)
    assert scene.meshes[0].face_ids.tolist() == [0, 0, 1, 1]
    assert len(scene.warnings) == 1 and "none.mtl" in scene.warnings[0]
    seen = seen_from(scene, direction="front")
    assert set(numpy.unique(seen.face)) == {0, 1, fm.no_index}
    assert set(numpy.unique(seen.triangle)) == {0, 1, 2, 3, fm.no_index}
    assert ((seen.face == seen.triangle // 2) | (seen.face == fm.no_index)).all()


def test_what_is_odd_is_told(box):
    vertices, faces = box
    told = fm.Scene.from_arrays(vertices, faces, name="cube").inspect()
    mesh, = told["meshes"]
    assert mesh["closed"] and mesh["genus"] == 0 and mesh["shells"] == mesh["pieces"] == 1 and not any(told["odd"].values())
    assert told["bounds"].tolist() == [[-1] * 3, [1] * 3] and told["triangles"] == 12 and told["up"] == "y"
    odd = fm.Scene.from_arrays(vertices, [*faces[1:], faces[1], [0, 0, 1]]).inspect(threads=1)["odd"]
    assert (odd["duplicate_triangles"], odd["degenerate_triangles"], odd["boundary_edges"]) == (1, 1, 3 - 1)
    far = fm.Scene.from_arrays(vertices.astype(float) + 4.5e6, faces).inspect()
    assert far["bounds"].tolist() == [[4.5e6 - 1] * 3, [4.5e6 + 1] * 3]


def test_cameras_of_files_are_told(tmp_path):
    path = tmp_path / "camera.gltf"
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"camera": 0, "translation": [1, 2, 3], "name": "door"}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}]}))
    camera, = fm.load(path).inspect()["cameras"]
    assert camera["position"].tolist() == [1, 2, 3] and camera["direction"].tolist() == [0, 0, -1]
    assert numpy.isclose(camera["vertical"], numpy.degrees(1.0)) and not camera["orthographic"]


def test_inspection_is_the_command_lines():
    if "FRONTMOST_CLI" not in os.environ:
        pytest.skip("FRONTMOST_CLI does not say where the program is")
    told = json.loads(subprocess.run([os.environ["FRONTMOST_CLI"], "info", "builtin:gallery", "--json"], check=True,
                                     capture_output=True, text=True).stdout)
    ours = fm.builtin("gallery").inspect()
    for key in ("name", "triangles", "stored_triangles", "vertices", "rounding"):
        assert ours[key] == told[key], key
    assert ours["materials"] == told["materials"] and len(ours["meshes"]) == len(told["meshes"])
    for one, other in zip(ours["meshes"], told["meshes"]):
        for key in ("name", "triangles", "vertices", "positions", "faces", "pieces", "closed"):
            assert one[key] == other[key], key


def test_objects_of_scene_files_have_categories(box, tmp_path):
    fm.Scene.from_arrays(*box).save(tmp_path / "crate.ply")
    (tmp_path / "two.json").write_text('{"objects": [{"model": "crate.ply", "category": "crate"}, {"model": "crate.ply"}]}')
    scene = fm.load(tmp_path / "two.json")
    assert [(o.number, o.category) for o in scene.objects] == [(0, "crate"), (1, None)]


def test_scene_files_name_models_where_they_are_allowed_to(box, tmp_path):
    (tmp_path / "models").mkdir()
    (tmp_path / "scenes").mkdir()
    fm.Scene.from_arrays(*box, name="crate").save(tmp_path / "models" / "crate.ply")
    (tmp_path / "scenes" / "room.json").write_text('{"objects": [{"model": "../models/crate.ply"}]}')
    with pytest.raises(fm.Error, match=r"objects\[0\].model: ../models/crate.ply: lies outside .*--allow-outside"):
        fm.load(tmp_path / "scenes" / "room.json")
    scene = fm.load(tmp_path / "scenes" / "room.json", allow_outside=[tmp_path / "models"])
    assert [o.name for o in scene.objects] == ["crate"]


def test_what_a_file_hides_is_told():
    corners = base64.b64encode(numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], numpy.float32).tobytes()).decode()
    scene = fm.load(json.dumps({
        "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_node_visibility"],
        "nodes": [{"name": "cup", "mesh": 0},
                  {"name": "lid", "mesh": 0, "extensions": {"KHR_node_visibility": {"visible": False}}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + corners}]}).encode())
    assert [o.name for o in scene.objects] == ["cup"] and scene.hidden_by_file == ["lid"]


def test_cad_files_are_read_where_the_importer_is(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv("LD_PRELOAD", raising=False)  # a sanitizer takes more memory than the importer allows itself
    cad = pathlib.Path(__file__).resolve().parent.parent.parent / "examples" / "cad" / "fixture.step"
    monkeypatch.setenv("FRONTMOST_IMPORT", "/missing")
    with pytest.raises(fm.Error, match="is read where frontmost-import is installed"):
        fm.load(cad)
    importer = pathlib.Path(os.environ["FRONTMOST_CLI"]).parent / "frontmost-import"
    if not importer.exists():
        pytest.skip("frontmost-import is not built")
    monkeypatch.setenv("FRONTMOST_IMPORT", str(importer))
    coarse, fine = fm.load(cad), fm.load(cad, mesh_tolerance=0.01, mesh_angle=5, import_seconds=100, cache=False)
    assert fine.triangle_count > 2 * coarse.triangle_count
    kept = list((tmp_path / "frontmost" / "import").iterdir())
    assert len(kept) == 1
    assert fm.load(cad.read_bytes()).triangle_count == coarse.triangle_count
    assert list((tmp_path / "frontmost" / "import").iterdir()) == kept
