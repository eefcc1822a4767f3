# SPDX-License-Identifier: Apache-2.0
"""Panorama, fisheye, laser scanners: the command line's files, and arithmetic."""
import gc

import numpy
import pytest

import frontmost as fm

EYE, TARGET = (8, 3, 25), (9, 3, 25)


@pytest.fixture(scope="module")
def city():
    return fm.RayIndex(fm.Surfaces(fm.builtin("city")))


@pytest.mark.parametrize("model, camera", [
    ("panorama", fm.RayCamera.panorama(128, 64)), ("fisheye", fm.RayCamera.fisheye(64, 64))])
def test_all_around_is_the_command_lines_files(cli, city, model, camera):
    folder = cli("render", "builtin:city", "--camera-model", model, "--resolution", f"{camera.shape[1]},{camera.shape[0]}",
                 "--camera-position", "8,3,25", "--camera-direction", "+x", "--samples", "1", "-o", "picture.png",
                 "--ray-distance", "range.npy", "--ids", "object=object.npy", "--ids",
                 "material=material.npy", "--ids", "primitive=primitive.npy", "-q")
    scan = city.scan(camera.looking(EYE, TARGET))
    for name in ("range", "object", "material", "primitive"):
        assert getattr(scan, name).tobytes() == numpy.load(folder / f"{name}.npy").tobytes(), name
    fm.save(scan.shade(), folder / "ours.png")
    assert (folder / "ours.png").read_bytes() == (folder / "picture.png").read_bytes()
    fm.save(scan.shade_linear(), folder / "linear.png")
    assert (folder / "linear.png").read_bytes() == (folder / "picture.png").read_bytes()


def test_points_lie_on_their_rays(city):
    camera = fm.RayCamera.lidar(fm.ring_elevations(8, -20, 10), 90).looking(EYE, TARGET)
    scan = city.scan(camera)
    assert camera.shape == scan.range.shape == (8, 90) and "90x8" in repr(scan)
    met = numpy.isfinite(scan.range)
    assert 0 < met.sum() < 720 and (met == (scan.primitive != fm.no_primitive)).all()
    assert numpy.isnan(scan.points[~met]).all()
    pose = camera.pose()
    for row, elevation in enumerate(numpy.radians(fm.ring_elevations(8, -20, 10))):
        for column in range(0, 90, 7):
            azimuth = 2 * numpy.pi * column / 90
            ray = pose[:3, :3] @ [numpy.sin(azimuth) * numpy.cos(elevation), numpy.sin(elevation),
                                  -numpy.cos(azimuth) * numpy.cos(elevation)]
            if met[row, column]:
                along = scan.range[row, column] * (ray @ -pose[:3, 2])
                assert numpy.isclose(scan.depth[row, column], along if along > 1e-3 else numpy.inf, rtol=1e-4)
                wanted = numpy.array(EYE) + scan.range[row, column] * ray
                assert numpy.allclose(scan.points[row, column], wanted, atol=1e-3 * scan.range[row, column])


def test_patterns_are_rays(box):
    index = fm.RayIndex(fm.Surfaces(fm.Scene.from_arrays(*box)))
    scan = index.scan(fm.RayCamera.pattern([[0, 0, -1], [0, 0, -3], [0, 0, 1], [0, 0, 0]]).looking((0, 0, 5), (0, 0, 0)))
    assert scan.range.tolist() == [[4, 4, numpy.inf, numpy.inf]]
    eye = numpy.eye(4)
    eye[2, 3] = -5
    opencv = index.scan(fm.RayCamera.pattern([[0, 0, -1]], pose=numpy.linalg.inv(eye), convention="opencv"))
    assert opencv.range.shape == (1, 1)
    assert opencv.camera.pose("opencv").tolist() == numpy.linalg.inv(eye).tolist()


def test_scanners_have_parts_of_a_turn_ranges_and_incidence(box):
    # The scanner is two units from the middle of a cube of side 2, so its wall is one away.
    index = fm.RayIndex(fm.Surfaces(fm.Scene.from_arrays(*box)))
    camera = fm.RayCamera.lidar([0, -30], 3, azimuths=(30, -30)).looking((0, 0, 2), (0, 0, 0))
    scan, slant = index.scan(camera), 2 / numpy.sqrt(3)
    assert numpy.allclose(scan.range, [[slant, 1, slant], [4 / 3, slant, 4 / 3]])
    acute = numpy.degrees(numpy.arccos(0.75))
    assert numpy.allclose(scan.incidence, [[30, 0, 30], [acute, 30, acute]], atol=1e-4)
    side = numpy.tan(numpy.radians(30))
    assert numpy.allclose(scan.robot_points[0], [[1, -side, 0], [1, 0, 0], [1, side, 0]])
    assert numpy.allclose(scan.robot_points[1, 1], [1, 0, -side])
    near = index.scan(fm.RayCamera.lidar([0], 3, azimuths=(-30, 30), ranges=(0, 1)).looking((0, 0, 2), (0, 0, 0)))
    assert near.range.tolist() == [[numpy.inf, 1, numpy.inf]] and numpy.isnan(near.incidence[0, 0])
    assert near.primitive[0, 0] == fm.no_primitive
    far = index.scan(fm.RayCamera.pattern([[0, 0, -1]], ranges=(1.5, numpy.inf)).looking((0, 0, 2), (0, 0, 0)))
    assert far.range.tolist() == [[numpy.inf]], "what is too near hides what is behind"


def test_robots_axes_are_a_convention():
    pose = fm.RayCamera.lidar([0], pose=numpy.eye(4), convention="robot").pose("opengl")
    assert (-pose[:3, 2]).tolist() == [1, 0, 0] and pose[:3, 1].tolist() == [0, 0, 1]


def test_planes_outlive_their_scan():
    scan = fm.RayIndex(fm.Surfaces(fm.builtin("city"))).scan(fm.RayCamera.panorama(64, 32).looking(EYE, TARGET))
    planes, kept = [scan.range, scan.primitive], [scan.range.copy(), scan.primitive.copy()]
    picture = scan.shade()
    del scan
    gc.collect()
    assert all((a == b).all() for a, b in zip(planes, kept)) and picture.shape == (32, 64, 4)
    with pytest.raises(ValueError):
        planes[0][0] = 1


@pytest.mark.parametrize("make, error, message", [
    (lambda: fm.RayCamera.panorama(0, 5), fm.Error, ""),
    (lambda: fm.RayCamera.panorama(5, 5, samples=3), fm.Error, "samples"),
    (lambda: fm.RayCamera.fisheye(5, 5, fov=400), fm.Error, ""),
    (lambda: fm.RayCamera.lidar([[0]]), ValueError, "^elevations: "),
    (lambda: fm.RayCamera.lidar([100]), fm.Error, ""),
    (lambda: fm.RayCamera.lidar([0], steps=0), fm.Error, ""),
    (lambda: fm.RayCamera.lidar([0], azimuths=(-200, 200)), fm.Error, "azimuths"),
    (lambda: fm.RayCamera.lidar([0], ranges=(2, 1)), fm.Error, "ranges"),
    (lambda: fm.RayCamera.lidar([0], ranges=5), ValueError, "^ranges: "),
    (lambda: fm.RayCamera.pattern([[0, 1]]), ValueError, "^directions: "),
    (lambda: fm.RayCamera.panorama(pose=numpy.eye(3)), ValueError, "^pose: "),
    (lambda: fm.RayCamera.panorama(convention="x"), ValueError, "^convention: "),
    (lambda: fm.ring_elevations(-1, 0, 1), fm.Error, ""),
    (lambda: fm.RayCamera.panorama().looking((0, 0), (1, 1, 1)), ValueError, "^eye: "),
])
def test_hostile_cameras_end_in_errors(make, error, message):
    with pytest.raises(error, match=message):
        make()
