# SPDX-License-Identifier: Apache-2.0
"""Views: every convention in, and back out."""
import json
import os
import pickle
import subprocess

import numpy
import pytest

import frontmost as fm

CONVENTIONS = ["opencv_world_to_camera", "opencv_camera_to_world", "opengl_camera_to_world", "opengl_world_to_camera"]
K = numpy.array([[615.0, 0, 319.5], [0, 610.0, 239.25], [0, 0, 1]])


def some_pose(seed=7):
    random = numpy.random.default_rng(seed)
    rotation, _ = numpy.linalg.qr(random.normal(size=(3, 3)))
    pose = numpy.eye(4)
    pose[:3, :3] = rotation * numpy.sign(numpy.linalg.det(rotation))
    pose[:3, 3] = random.normal(size=3)
    return pose


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_poses_come_back(convention):
    pose = some_pose()
    view = fm.View.from_intrinsics(K, 640, 480, pose=pose, convention=convention, near=0.1, far=10)
    assert numpy.allclose(view.pose(convention), pose, atol=1e-6)
    assert numpy.allclose(view.K, K)
    assert numpy.allclose(view.intrinsics("centre_at_half")[:2, 2], K[:2, 2] + 0.5)
    assert (view.near, view.far, view.width, view.height) == (0.1, 10, 640, 480)


def test_short_conventions_are_what_the_documentation_says():
    pose = some_pose()
    for short, whole in (("opencv", CONVENTIONS[0]), ("opengl", CONVENTIONS[2])):
        view = fm.View.from_intrinsics(K, 640, 480, pose=pose, convention=short)
        assert (view.pose(whole) == fm.View.from_intrinsics(K, 640, 480, pose=pose, convention=whole).pose(whole)).all()


def test_a_point_lands_where_opencv_puts_it():
    pose = some_pose()
    view = fm.View.from_intrinsics(K, 640, 480, pose=pose, near=0.1, far=100)
    eye_point = numpy.array([0.3, -0.2, 4.0])
    world_point = numpy.linalg.inv(pose) @ [*eye_point, 1]
    x, y, _ = K @ eye_point / eye_point[2]
    clip = view.clip_from_world() @ world_point
    ndc = clip[:3] / clip[3]
    assert numpy.allclose([(ndc[0] + 1) / 2 * 640 - 0.5, (1 - ndc[1]) / 2 * 480 - 0.5], [x, y])
    reversed_depth = (view.clip_from_world("reversed") @ world_point)[2] / clip[3]
    assert numpy.isclose(reversed_depth, (0.1 / 4 - 0.1 / 100) / (1 - 0.1 / 100))


def test_intrinsics_as_four_numbers():
    view = fm.View.from_intrinsics([615, 610, 320, 239.75], 640, 480, pixel_rule="centre_at_half")
    assert numpy.allclose(view.K, K)
    assert view.far == numpy.inf
    assert numpy.allclose(view.forward, [0, 0, 1]) and numpy.allclose(view.up, [0, -1, 0])  # OpenCV's own axes


def test_look_at_and_orthographic():
    view = fm.View.look_at((0, 0, 5), (0, 0, 0), width=200, height=100, fov=90)
    assert numpy.allclose(view.eye, [0, 0, 5]) and numpy.allclose(view.forward, [0, 0, -1])
    assert numpy.allclose(view.right, [1, 0, 0]) and numpy.isclose(view.K[1, 1], 50)
    flat = fm.View.orthographic((0, 0, 5), (0, 0, 0), width=200, height=100, tall=4)
    assert flat.is_orthographic and not view.is_orthographic
    assert numpy.isclose(flat.clip_from_eye()[1, 1], 0.5) and numpy.isclose(flat.clip_from_eye()[0, 0], 0.25)
    with pytest.raises(fm.Error, match="orthographic"):
        flat.K


def test_copies_with_one_thing_changed(box):
    view = fm.View.look_at((0, 0, 5), (0, 0, 0))
    assert view.between(1, 2).far == 2 and view.sampled(4).samples == 4 and view.culled("back").culling == "back"
    assert numpy.allclose(view.about((0, 0, 1)).eye, [0, 0, 4])
    assert numpy.allclose(view.looking((1, 2, 3), (0, 0, 0)).eye, [1, 2, 3])
    assert numpy.allclose(view.placed(some_pose()).pose(), some_pose(), atol=1e-6)
    surfaces = fm.Surfaces(fm.Scene.from_arrays(*box))
    for bounds in (surfaces, surfaces.bounds):
        fitted = view.enclosing(bounds)
        assert 3.9 < fitted.near <= 4 and 6 <= fitted.far < 6.1
    assert view.near == 0.1 and view.samples == 1  # unchanged


@pytest.mark.parametrize("change, error, message", [
    ({"K": numpy.eye(4)}, ValueError, "^K: "),
    ({"K": [1, 2, 3]}, ValueError, "^K: "),
    ({"K": [[600, 1, 320], [0, 600, 240], [0, 0, 1]]}, ValueError, "^K: .*skew"),
    ({"K": [[600, 0, 320], [0, 600, 240], [0, 0, 2]]}, ValueError, "^K: element 2, 2 is not 1, as in every K"),
    ({"K": K * numpy.nan}, (ValueError, fm.Error), ""),
    ({"width": 0}, fm.Error, "width"),
    ({"width": 100000}, fm.Error, ""),
    ({"pose": numpy.diag([2, 2, 2, 1.0])}, fm.Error, "pose"),
    ({"pose": numpy.eye(3)}, ValueError, "^pose: "),
    ({"pose": [[1, 0, 0, numpy.inf], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}, ValueError, "^pose: "),
    ({"convention": "blender"}, ValueError, "^convention: 'blender' is not one of"),
    ({"near": 0}, fm.Error, "near"),
    ({"near": 2, "far": 1}, fm.Error, "far"),
    ({"near": numpy.nan}, fm.Error, ""),
    ({"samples": 3}, fm.Error, "samples"),
    ({"culling": "sides"}, ValueError, "^culling: 'sides' is not one of none, back, front, both"),
    ({"pixel_rule": "corner"}, ValueError, "^pixel_rule: "),
])
def test_what_no_camera_is_ends_in_an_error(change, error, message):
    arguments = {"K": K, "width": 640, "height": 480, **change}
    with pytest.raises(error, match=message):
        fm.View.from_intrinsics(**arguments)


def test_views_are_pickled_and_compared():
    views = [fm.View.from_intrinsics(K, 640, 480, pose=some_pose(), samples=4, culling="back"),
             fm.View.orthographic((1, 2, 3), (0, 0, 0)), fm.View.orthographic((1, 2, 3), (0, 0, 0), tall=3)]
    again = pickle.loads(pickle.dumps(views))
    assert again == views and views[1] != views[2] and views[0] != "view"
    assert len({*views, *again}) == 3
    assert [repr(view) for view in again] == [repr(view) for view in views]


def test_the_eye_at_its_target_is_an_error():
    with pytest.raises(fm.Error) as raised:
        fm.View.look_at((1, 2, 3), (1, 2, 3))
    assert raised.value.code == "singular_camera"
    with pytest.raises(ValueError, match="^eye: "):
        fm.View.look_at((1, 2), (1, 2, 3))


def test_frame_is_the_command_lines():
    if "FRONTMOST_CLI" not in os.environ:
        pytest.skip("FRONTMOST_CLI does not say where the program is")
    scene = fm.builtin("city")
    for direction in ("front", "iso", "three_quarter"):
        named = [] if direction == "three_quarter" else ["--view", direction]
        told = subprocess.run([os.environ["FRONTMOST_CLI"], "camera", "builtin:city", *named, "--resolution", "320,200",
                               "--json"], check=True, capture_output=True, text=True)
        camera = json.loads(told.stdout)
        for view in (fm.frame(scene, 320, 200, direction=direction),
                     fm.frame(fm.Surfaces(scene), 320, 200, direction=direction)):
            assert view.pose("opencv").tolist() == camera["poses"]["opencv"]["camera_from_world"]
            assert view.pose("opengl").tolist() == camera["poses"]["opengl"]["world_from_camera"]
            assert view.K.tolist() == camera["intrinsics"]["pixel_center_integer"]["K"]
            assert (view.near, view.far) == (camera["near"], camera["far"])
    with pytest.raises(TypeError, match="^scene: "):
        fm.frame("city")
