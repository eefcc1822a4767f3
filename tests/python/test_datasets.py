# SPDX-License-Identifier: Apache-2.0
"""Data sets: COCO, BOP and mask files equal the command line's, to the byte."""
import json

import pytest

import frontmost as fm

K = (120, 120, 47.5, 31.5)
POSES = [[[1, 0, 0, x], [0, -c, -d, y], [0, d, -c, 12]] for x, y, c, d in ((0, 1, 0.8, 0.6), (2, 2, 0.6, 0.8), (-3, 0, 1, 0))]
KINDS = {"teapot": "vessel", "vase": "vessel", "knot": (17, "toy"), "stage": (3, "ground")}


@pytest.fixture
def views(tmp_path):
    """The gallery; for the program, a batch file of three views and a file of categories."""
    scene = fm.load("builtin:gallery")
    (tmp_path / "views.json").write_text(json.dumps({"views": [
        {"pose": pose + [[0, 0, 0, 1]], "pose-convention": "opencv-world-to-camera"} for pose in POSES]}))
    (tmp_path / "kinds.json").write_text(json.dumps({
        "categories": ["vessel", {"name": "toy", "number": 17}, {"name": "ground", "number": 3}],
        "objects": {"teapot": "vessel", "vase": "vessel", "knot": "toy", "stage": "ground"}}))
    return scene


def seen_of(scene):
    surfaces = fm.Surfaces(scene)
    for pose in POSES:
        yield surfaces.zbuffer(fm.View.from_intrinsics(K, 96, 64, pose=pose + [[0, 0, 0, 1]], near=1, far=60))


OPTIONS = ("report", "builtin:gallery", "--views", "views.json", "--resolution", "96,64", "--intrinsics",
           ",".join(map(str, K)), "--near", "1", "--far", "60")


def files_of(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_files_are_the_command_lines(views, cli):
    folder = cli(*OPTIONS, "--coco", "cli.json", "--bop", "cli_bop", "--masks", "cli_masks")
    written = fm.write_coco(folder / "own.json", seen_of(views))
    assert written == [str(folder / "own.json")]
    assert (folder / "own.json").read_bytes() == (folder / "cli.json").read_bytes()
    written = fm.write_bop(folder / "own_bop", seen_of(views))
    assert files_of(folder / "own_bop") == files_of(folder / "cli_bop")
    assert sorted(written) == sorted(str(folder / "own_bop" / name) for name in files_of(folder / "own_bop"))
    fm.write_masks(folder / "own_masks", seen_of(views))
    assert files_of(folder / "own_masks") == files_of(folder / "cli_masks") != {}


def test_categories_polygons_and_what_is_left_out(views, cli):
    views.set_categories(KINDS)
    assert views.objects[views.find("knot")].category == "toy"
    left = ("--categories", "kinds.json", "--leave-out", "ground", "--leave-out", "pane")
    folder = cli(*OPTIONS, *left, "--coco", "cli.json", "--coco-polygons", "--bop", "cli_bop", "--bop-visible", "bop19")
    fm.write_coco(folder / "own.json", seen_of(views), polygons=True, leave_out=["ground", "pane"])
    assert (folder / "own.json").read_bytes() == (folder / "cli.json").read_bytes()
    fm.write_bop(folder / "own_bop", seen_of(views), visible="bop19", leave_out=["ground", "pane"])
    assert files_of(folder / "own_bop") == files_of(folder / "cli_bop")
    found = json.loads((folder / "own.json").read_text())
    assert {c["name"]: c["id"] for c in found["categories"]}["toy"] == 17
    assert not {a["name"] for a in found["annotations"]} & {"stage", "pane"}


def test_one_view_is_the_command_lines_single_report(views, cli):
    seen = next(seen_of(views))
    one = [o for o in OPTIONS if o not in ("--views", "views.json")]
    pose = " ".join(str(number) for row in POSES[0] for number in row)
    folder = cli(*one, "--pose", pose, "--pose-convention", "opencv-world-to-camera", "--coco", "cli.json", "--masks", "cli_masks")
    fm.write_coco(folder / "own.json", seen)
    assert (folder / "own.json").read_bytes() == (folder / "cli.json").read_bytes()
    fm.write_masks(folder / "own_masks", seen)
    assert files_of(folder / "own_masks") == files_of(folder / "cli_masks")


def test_views_of_several_scenes(box, tmp_path):
    def seen(kinds):
        scene = fm.Scene.from_arrays(*box, name="crate")
        scene.set_categories(kinds)
        return fm.Surfaces(scene).zbuffer(fm.frame(scene, 32, 32))
    fm.write_coco(tmp_path / "c.json", [seen({"crate": (2, "box")}), seen({"crate": (5, "bin")}), seen({})],
                  names=["a.png", "b.png", "c.png"])
    found = json.loads((tmp_path / "c.json").read_text())
    assert [(c["id"], c["name"]) for c in found["categories"]] == [(2, "box"), (5, "bin"), (6, "crate")]
    assert [a["category_id"] for a in found["annotations"]] == [2, 5, 6]
    assert [i["file_name"] for i in found["images"]] == ["a.png", "b.png", "c.png"]
    with pytest.raises(fm.Error, match="category 2 is box in one view and bin in another"):
        fm.write_coco(tmp_path / "d.json", [seen({"crate": (2, "box")}), seen({"crate": (2, "bin")})])
    assert not (tmp_path / "d.json").exists()


def test_wrong_arguments(views, tmp_path):
    seen = next(seen_of(views))
    with pytest.raises(fm.Error, match="leave_out: no object and no category has the name teepot"):
        fm.write_masks(tmp_path / "m", seen, leave_out=["teepot"])
    assert not (tmp_path / "m").exists()
    with pytest.raises(ValueError, match="names: fewer than there are views"):
        fm.write_coco(tmp_path / "c.json", [seen, seen], names=["a.png"])
    with pytest.raises(fm.Error, match="bop: the view is a parallel projection"):
        view = fm.View.orthographic((0, 3, 12), (0, 1, 0), width=32, height=32, tall=8)
        fm.write_bop(tmp_path / "b", fm.Surfaces(views).zbuffer(view))
    with pytest.raises(ValueError, match="categories: none is called 'teepot'"):
        views.set_categories({"teepot": "vessel"})
    with pytest.raises(TypeError, match="values must be names, numbers"):
        views.set_categories({"teapot": 1.5})
    views.set_categories({"teapot": 4, "vase": 4})
    assert views.objects[views.find("vase")].category == "4"
    with pytest.raises(fm.Error, match="the number is there twice"):
        views.set_categories({"teapot": (4, "pot"), "vase": (4, "vase")})
    assert views.objects[views.find("vase")].category == "4", "stays as it was"
