# SPDX-License-Identifier: Apache-2.0
"""Surfaces and Visible: planes equal the command line's files, and stay valid while in use."""
import gc
import os
import pathlib
import resource
import signal
import threading

import numpy
import pytest

import frontmost as fm


def test_planes_are_the_command_lines_files(cli):
    folder = cli("render", "builtin:city", "--resolution", "320,240", "--depth", "depth.npy", "--ids",
                 "object=object.npy", "--ids", "primitive=primitive.npy", "--ids", "material=material.npy", "-q")
    surfaces = fm.Surfaces(fm.builtin("city"))
    view = fm.frame(surfaces, 320, 240)
    for seen in (surfaces.zbuffer(view), surfaces.zbuffer(view.sampled(1), threads=1)):
        for name in ("depth", "object", "primitive", "material"):
            there, ours = numpy.load(folder / f"{name}.npy"), getattr(seen, name)
            assert there.dtype == ours.dtype and there.tobytes() == ours.tobytes(), name


def test_depth_is_known_on_paper(box):
    # The eye is 5 from the middle of a cube of side 2: its front is 4 away, along the axis and beside it.
    scene = fm.Scene.from_arrays(*box)
    view = fm.View.look_at((0, 0, 5), (0, 0, 0), width=65, height=65, fov=60, near=0.5, far=100)
    seen = fm.Surfaces(scene).zbuffer(view)
    half = int(0.25 / numpy.tan(numpy.radians(30)) * 32.5)
    middle = slice(32 - half + 1, 32 + half)
    assert (seen.depth[middle, middle] == 4).all()
    assert numpy.isinf(seen.depth[0, 0]) and seen.primitive[0, 0] == fm.no_primitive and seen.key[0, 0] == 0
    assert (seen.key[middle, middle] == 0.125).all()
    assert set(numpy.unique(seen.face[middle, middle])) <= {10, 11}  # the two triangles of z = 1
    assert (seen.triangle == seen.face).all()


def test_faces_count_in_their_object(box):
    scene = fm.Scene.from_arrays(*box)
    shift = numpy.eye(4)
    shift[0, 3] = 3
    scene.place(0, shift)
    seen = fm.Surfaces(scene).zbuffer(fm.frame(scene, 200, 100))
    there = seen.primitive != fm.no_primitive
    assert (seen.primitive[there] == seen.object[there] * 12 + seen.face[there]).all()
    assert (seen.object[~there] == fm.no_index).all() and (seen.face[~there] == fm.no_index).all()
    assert set(numpy.unique(seen.object)) == {0, 1, fm.no_index}


def test_rays_and_triangles_agree(box):
    surfaces = fm.Surfaces(fm.Scene.from_arrays(*box))
    view = fm.frame(surfaces, 160, 120)
    drawn, cast = surfaces.zbuffer(view), surfaces.raycast(view)
    assert (drawn.primitive != cast.primitive).mean() < 0.02
    same = drawn.primitive == cast.primitive
    assert numpy.allclose(drawn.depth[same], cast.depth[same], rtol=1e-4)


def test_planes_of_all_samples():
    surfaces = fm.Surfaces(fm.builtin("cubes"))
    seen = surfaces.zbuffer(fm.frame(surfaces, 40, 30, samples=4))
    assert seen.primitives.shape == seen.keys.shape == (4, 30, 40)
    assert seen.primitive.shape == seen.depth.shape == (30, 40)
    assert (seen.primitives[0] == seen.primitive).all() and (seen.keys[0] == seen.key).all()


def test_planes_outlive_everything():
    surfaces = fm.Surfaces(fm.builtin("teapot"))
    view = fm.frame(surfaces)
    seen = surfaces.zbuffer(view)
    planes = [seen.primitive, seen.key, seen.primitives[0][10:20], seen.depth, seen.object]
    kept = [plane.copy() for plane in planes]
    hash_before = seen.content_hash()
    others = [surfaces.zbuffer(view) for _ in range(3)]
    del seen, others
    gc.collect()
    again = [surfaces.zbuffer(view.looking((0, 30, 30), (0, 0, 0))) for _ in range(8)]  # into planes that are free
                                                                                        # again
    del surfaces, again
    gc.collect()
    noise = [numpy.full(480 * 640, i, dtype=numpy.uint32) for i in range(20)]
    assert len(noise) == 20 and all((a == b).all() for a, b in zip(planes, kept))
    assert hash_before == fm.Surfaces(fm.builtin("teapot")).zbuffer(view).content_hash()


def test_what_pictures_are_made_of_cannot_be_written():
    seen = fm.Surfaces(fm.builtin("cubes")).zbuffer(fm.frame(fm.builtin("cubes"), 20, 20))
    for plane in (seen.primitive, seen.key, seen.primitives, seen.keys):
        with pytest.raises(ValueError):
            plane[...] = 0
        with pytest.raises(ValueError):
            plane.flags.writeable = True
    seen.depth[0, 0] = -1  # the caller owns its planes
    assert seen.depth[0, 0] == -1


def test_everything_keeps_what_it_is_of():
    seen = fm.Surfaces(fm.builtin("teapot")).zbuffer(fm.frame(fm.builtin("teapot")))
    gc.collect()
    assert seen.object.min() == 0 and seen.surfaces.scene.objects[0].name == "teapot"
    assert "pixels" in repr(seen) and "6320" in repr(seen.surfaces)


def test_answers_do_not_depend_on_threads():
    surfaces = fm.Surfaces(fm.builtin("city"), threads=3)
    view = fm.frame(surfaces, 320, 240, samples=2)
    hashes = {surfaces.zbuffer(view, threads=threads).content_hash() for threads in (0, 1, 2, 5)}
    assert len(hashes) == 1
    for threads in (-1, 1025):
        with pytest.raises(ValueError, match="^threads: "):
            surfaces.zbuffer(view, threads=threads)


def test_python_threads_draw_at_once():
    surfaces = fm.Surfaces(fm.builtin("city"))
    view = fm.frame(surfaces, 320, 240)
    wanted = surfaces.zbuffer(view).content_hash()
    hashes = []

    def draw():
        for _ in range(10):
            hashes.append(surfaces.zbuffer(view, threads=1).content_hash())

    workers = [threading.Thread(target=draw) for _ in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert hashes == [wanted] * 40


def test_signed_ids():
    ids = numpy.array([[0, 7], [fm.no_index, 2**31]], numpy.uint32)
    signed = fm.signed_ids(ids)
    assert signed.dtype == numpy.int64 and signed.tolist() == [[0, 7], [-1, 2**31]] and signed.flags.writeable
    assert fm.signed_ids(ids[0], dtype="int32").dtype == numpy.int32
    assert fm.signed_ids(ids[:, :1].T, dtype="int32").tolist() == [[0, -1]]
    with pytest.raises(ValueError, match="^ids: int32 does not hold 2147483648"):
        fm.signed_ids(ids, dtype="int32")
    with pytest.raises(ValueError, match="^dtype: 'uint8' is not one of"):
        fm.signed_ids(ids, dtype="uint8")
    with pytest.raises(TypeError, match="^ids: "):
        fm.signed_ids(ids.astype("int64"))


def test_moved_objects():
    scene = fm.builtin("cubes")
    surfaces = fm.Surfaces(scene)
    view = fm.frame(surfaces, 160, 120)
    before = surfaces.zbuffer(view)
    pose = scene.objects[0].pose
    pose[1, 3] += 1.5
    surfaces.move(0, pose)
    assert (scene.objects[0].pose == pose).all()
    after = surfaces.zbuffer(view)
    assert after.content_hash() != before.content_hash()
    assert after.content_hash() == fm.Surfaces(scene.copy()).zbuffer(view).content_hash()
    with pytest.raises(ValueError, match="^pose: "):
        surfaces.move(0, numpy.full((4, 4), numpy.nan))
    other = fm.Surfaces(scene)
    with pytest.raises(fm.Error, match="other surfaces"):
        surfaces.move(0, pose)
    del other
    gc.collect()
    surfaces.move(scene.objects[0].name, pose)
    poses = numpy.stack([item.pose for item in scene.objects])
    poses[:, 0, 3] += numpy.arange(len(poses))
    surfaces.move(numpy.arange(len(poses)), poses)
    assert (numpy.stack([item.pose for item in scene.objects]) == poses).all()
    with pytest.raises(ValueError, match="^pose: must be one for each object"):
        surfaces.move([0, 1], poses[:1])
    with pytest.raises(ValueError, match="^object: there is no object 99"):
        surfaces.move([0, 99], poses[[1, 0]])
    assert (scene.objects[0].pose == poses[0]).all()


@pytest.mark.skipif("FRONTMOST_SANITIZED" in os.environ, reason="a sanitizer keeps what was freed for a while")
def test_views_do_not_grow_memory():
    surfaces = fm.Surfaces(fm.builtin("cubes"))
    view = fm.frame(surfaces, 320, 240)

    def look(times):
        for _ in range(times):
            seen = surfaces.zbuffer(view, threads=1)
            seen.depth, seen.object, seen.primitive[::2]

    def resident():
        return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()

    look(100)
    before = resident()
    look(1000)
    assert resident() - before < 2**22  # a view takes a quarter of this


@pytest.mark.skipif("FRONTMOST_SANITIZED" in os.environ, reason="a sanitizer keeps what was freed for a while")
def test_answers_of_every_kind_do_not_grow_memory():
    surfaces = fm.Surfaces(fm.builtin("cubes"))
    view = fm.frame(surfaces, 160, 120)
    occlusion, index = fm.Occlusion(surfaces), fm.RayIndex(surfaces)

    def look(times):
        for _ in range(times):
            seen, exact = surfaces.zbuffer(view, threads=1), surfaces.find_exact_visible(view, threads=1)
            occlusion.cull(view), occlusion.is_hidden(numpy.zeros((9, 2, 3)))
            surfaces.visible_faces(view, threads=1), surfaces.find_fighting_faces(view, "d16", threads=1).polygons
            exact.find_depth_fights(seen, threads=1).errors, exact.tied
            seen.check_agreement(index.raycast(view, threads=1)).differences
            order = surfaces.painter(view, threads=1)
            order.polygons, order.corners, order.paint().depth, order.visible_parts(threads=1).corners
            surfaces.cut("z").outlines, surfaces.draw_lines(view, threads=1).segments, seen.account(threads=1).visible

    def resident():
        return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()

    look(20)
    before = resident()
    look(100)
    assert resident() - before < 2**22  # the planes of one round take a quarter of this


def test_planes_of_every_kind_outlive_everything():
    surfaces = fm.Surfaces(fm.builtin("cubes"))
    view = fm.frame(surfaces, 80, 60)
    exact, seen = surfaces.find_exact_visible(view), surfaces.zbuffer(view)
    planes = [exact.primitives, exact.tied, exact.find_depth_fights(seen).errors, surfaces.abuffer(view).rows,
              seen.check_agreement(surfaces.raycast(view)).differences, *surfaces.find_fighting_faces(view).polygons,
              *surfaces.cut("z").outlines[0], *surfaces.draw_figure(view).polygons[0], surfaces.scene.meshes[0].faces]
    kept = [plane.copy() for plane in planes]
    for plane in planes:
        with pytest.raises(ValueError):
            plane[...] = plane
        with pytest.raises(ValueError):
            plane.flags.writeable = True
    del exact, seen, surfaces
    gc.collect()
    noise = [numpy.full(4800, i, dtype=numpy.uint32) for i in range(500)]
    assert len(noise) == 500 and all((a == b).all() for a, b in zip(planes, kept))


def big_work(**options):
    random = numpy.random.default_rng(1)
    vertices = random.random((300000, 3))
    surfaces = fm.Surfaces(fm.Scene.from_arrays(vertices, numpy.arange(300000).reshape(-1, 3)))
    return surfaces.zbuffer(fm.frame(surfaces, 2000, 2000, samples=4), **options)


def test_control_c_stops_a_call_in_the_middle():
    # Hidden lines of ten thousand intersecting triangles take minutes. C code puts the progress into a dict, so that no
    # Python code runs meanwhile that could notice the signal.
    random = numpy.random.default_rng(1)
    surfaces = fm.Surfaces(fm.Scene.from_arrays(random.random((30000, 3)), numpy.arange(30000).reshape(-1, 3)))
    view, told = fm.frame(surfaces), {}
    timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        surfaces.draw_lines(view, counts_hidden=True, progress=told.__setitem__)
    assert told.get("lines", 0) < 1
    timer.join()


def test_progress_is_told_and_what_it_raises_ends_the_work():
    told = []
    big_work(progress=lambda stage, fraction: told.append((stage, fraction)))
    assert told and all(isinstance(stage, str) and 0 <= fraction <= 1 for stage, fraction in told)

    def stop(stage, fraction):
        raise ZeroDivisionError(stage)

    with pytest.raises(ZeroDivisionError):
        big_work(progress=stop)
    with pytest.raises(TypeError, match="^progress: "):
        big_work(progress=3)
    big_work(progress=True)
