# SPDX-License-Identifier: Apache-2.0
"""Hidden lines, sheets and figures: arithmetic, and the bytes of the command line's files."""
import xml.etree.ElementTree as xml

import numpy
import pytest

import frontmost as fm


@pytest.fixture
def crate_behind_wall(box):
    """A cube of side 2 seen from the front, its right half behind a plate."""
    vertices, faces = box
    scene = fm.Scene.from_arrays(vertices, faces, name="crate")
    pose = numpy.eye(4)
    pose[:3, 3] = (2, 0, 4)
    scene.add(vertices * [2, 3, 0.1], faces, name="wall", pose=pose)
    return fm.Surfaces(scene)


def test_segments_are_known_on_paper(crate_behind_wall):
    view = fm.View.orthographic((0, 0, 10), (0, 0, 0), width=64, height=64, tall=4, near=1, far=20)
    drawing = crate_behind_wall.draw_lines(view, counts_hidden=True)
    seen = drawing.segments[drawing.is_seen]
    # The crate's left edge and the left halves of top and bottom, from x = 16 to 32; and the wall's left edge.
    for ends in ([[16, 16], [16, 48]], [[16, 16], [32, 16]], [[16, 48], [32, 48]]):
        assert any(numpy.allclose(sorted(s.tolist()), ends, atol=1e-6) for s in seen), ends
    assert not any(numpy.allclose(s[:, 0], 48) for s in seen)  # the crate's right edge is behind the wall
    assert (drawing.is_seen == (drawing.hidden_by == 0)).all() and drawing.is_seen.dtype == bool
    assert drawing.hidden_by.max() >= 2
    assert {fm.edge_kinds[k] for k in drawing.kind} <= {"silhouette", "crease"}
    assert len(drawing) == len(drawing.segments) and "edges" in repr(drawing)
    ends = drawing.edges[drawing.edge]
    world = ends[:, 0] + drawing.span[:, :1] * (ends[:, 1] - ends[:, 0])
    assert numpy.allclose(world[:, 0] * 16 + 32, drawing.segments[:, 0, 0])
    assert drawing.edge_primitives.max() < 24 and drawing.view == view
    assert not drawing.is_outline.any()
    assert crate_behind_wall.draw_lines(view, outlines=True).is_outline.any()
    assert {fm.edge_kinds[k] for k in crate_behind_wall.draw_lines(view, kinds=["crease"]).kind} == {"crease"}
    assert len(crate_behind_wall.draw_lines(view, kinds=[])) == 0


def test_drawings_show_themselves(crate_behind_wall, tmp_path):
    view = fm.View.orthographic((0, 0, 10), (0, 0, 0), width=96, height=48, tall=4, near=1, far=20)
    drawing = crate_behind_wall.draw_lines(view)
    sheet = drawing.sheet()
    assert numpy.allclose(sheet.size, (25.4, 12.7)) and sheet.scale is None
    assert drawing._repr_svg_() == sheet.svg and xml.fromstring(sheet.svg).tag.endswith("svg")
    hidden = {word: drawing.sheet(hidden=word, style="technical").svg for word in ("none", "dashed", "thin")}
    assert len(set(hidden.values())) == 3 and len(hidden["none"]) < len(hidden["thin"])
    for suffix in ("svg", "pdf", "dxf", "json"):
        sheet.save(tmp_path / f"lines.{suffix}")
    assert (tmp_path / "lines.pdf").read_bytes().startswith(b"%PDF")
    with pytest.raises(ValueError, match="^hidden: "):
        drawing.sheet(hidden="dotted")


def test_edges_over_a_picture_are_the_command_lines(cli, tmp_path):
    # A rough plate that is seen nearly edge-on, so that its ripples have silhouettes.
    rows, random = 30, numpy.random.RandomState(1)
    points = [(x / 10, z / 60 + 0.05 * random.rand(), -z / 10) for z in range(rows) for x in range(rows)]
    corners = [row * rows + x + 1 for row in range(rows - 1) for x in range(rows - 1)]
    (tmp_path / "rough.obj").write_text(
        "".join("v %.4f %.4f %.4f\n" % point for point in points) +
        "".join(f"f {i} {i + 1} {i + rows + 1}\nf {i} {i + rows + 1} {i + rows}\n" for i in corners))
    folder = cli("render", "rough.obj", "--view", "front", "--resolution", "160,90", "--edges", "--edge-width", "1.5",
                 "-o", "edges.png", "-q")
    surfaces = fm.Surfaces(fm.load(tmp_path / "rough.obj"))
    view = fm.frame(surfaces, 160, 90, direction="front", samples=4)
    edges = surfaces.draw_lines(view, ripples=False)
    assert len(edges) < len(surfaces.draw_lines(view))
    picture = surfaces.zbuffer(view).shade_linear()
    drawn = edges.draw_over(picture, width=1.5)
    planes = fm.load_image(folder / "edges.png")
    fm.save(drawn, folder / "drawn.png")
    own = fm.load_image(folder / "drawn.png")
    assert all(numpy.array_equal(planes[name], own[name]) for name in "RGB")
    assert not numpy.array_equal(drawn, surfaces.zbuffer(view).shade())
    with pytest.raises(fm.Error, match="width"):
        edges.draw_over(picture, width=0)
    for bad in (picture[:, :, :3], picture[:, 1:], picture[:80]):
        with pytest.raises(ValueError, match=r"^picture: must have the shape \(90, 160, 4\), not "):
            edges.draw_over(bad)
    for bad in ((0, 0, 1.5), (-1, 0, 0)):
        with pytest.raises(fm.Error, match="colour"):
            edges.draw_over(picture, color=bad)


def test_plots_count_the_strokes_in_the_ink_of_others(box):
    vertices, faces = box
    scene = fm.Scene.from_arrays(vertices * [20, 20, 0.1], faces)
    for height in (0.2, 0.4):  # plates in a pile
        pose = numpy.eye(4)
        pose[2, 3] = height
        scene.add(vertices * [20, 20, 0.1], faces, pose=pose)
    surfaces = fm.Surfaces(scene)
    assert surfaces.draw_sheet(["top"], scale=1, plot=True).covered > 0
    assert surfaces.draw_sheet(["top"], scale=1, plot=True, pen=0.2).covered == 0
    assert surfaces.draw_sheet(["top"], scale=1).covered == 0


def test_dimensions_in_fractions_of_inches(box):
    vertices, faces = box
    surfaces = fm.Surfaces(fm.Scene.from_arrays(vertices, faces))  # of side 2
    sheets = [surfaces.draw_sheet(["front"], scale=1, dimensions="overall", in_inches=True, inch_fractions=is_wanted,
                                  millimetres_per_unit=unit * 25.4).svg for unit in (0.9375, 0.95) for is_wanted in (False, True)]
    assert sheets[0] != sheets[1]  # 1.875, 1 7/8
    assert sheets[2] == sheets[3]  # 1.9


def test_sheets_are_the_command_lines_files(cli):
    folder = cli("lines", "builtin:cubes", "--views", "front,top,left,iso", "--hidden", "dashed", "-o", "sheet.svg", "-q")
    surfaces = fm.Surfaces(fm.builtin("cubes"))
    sheet = surfaces.draw_sheet(["front", "top", "left", "iso"], hidden="dashed")
    sheet.save(folder / "ours.svg")
    assert (folder / "ours.svg").read_bytes() == (folder / "sheet.svg").read_bytes()
    assert sheet.svg.encode() == sheet._repr_svg_().encode() == (folder / "sheet.svg").read_bytes()
    assert sheet.size in ((210, 297), (297, 210)) and sheet.scale > 0 and "A4" in repr(sheet)
    for suffix in ("pdf", "dxf", "json"):
        sheet.save(folder / f"ours.{suffix}")
    with pytest.raises(fm.Error):
        sheet.save(folder / "ours.png")


def test_views_on_paper():
    surfaces = fm.Surfaces(fm.builtin("cubes"))
    sheet = surfaces.draw_sheet(fm.frame(surfaces), style="figure", page=(100, 80), hatch=1.0)
    assert sheet.scale is None and sheet.size == (100, 80)
    xml.fromstring(sheet.svg)
    sheet = surfaces.draw_sheet(["front"], sections=["front"], dimensions="diameters", page="a3-landscape",
                                title_block={"title": "Cubes", "author": "A. Appel"})
    assert sheet.size == (420, 297) and "Cubes" in sheet.svg and "<text" not in sheet.svg and (sheet.left_out, sheet.undrawn, sheet.prisms) == (0, 0, 0)


def test_texts_of_sheets():
    surfaces = fm.Surfaces(fm.builtin("cubes"))
    sheet = surfaces.draw_sheet(["front"], page="a4", title_block={"title": "Two cubes"}, lettering="text")
    assert ">Two cubes</text>" in sheet.svg
    with pytest.raises(ValueError, match="^lettering: "):
        surfaces.draw_sheet(["front"], lettering="font")
    with pytest.raises(fm.Error, match="plotters"):
        surfaces.draw_sheet(["front"], lettering="text", plot=True)


def test_figures_are_the_command_lines_files(cli):
    folder = cli("render", "builtin:cubes", "--resolution", "160,120", "-o", "figure.svg", "-q")
    surfaces = fm.Surfaces(fm.builtin("cubes"))
    figure = surfaces.draw_figure(fm.frame(surfaces, 160, 120), title="three-quarter")
    figure.save(folder / "ours.svg")
    assert (folder / "ours.svg").read_bytes() == (folder / "figure.svg").read_bytes()
    assert figure._repr_svg_() == figure.svg and len(figure) == len(figure.polygons) == len(figure.colors) > 2
    assert figure.colors.shape[1] == 4 and "shapes" in repr(figure)
    for shape in figure.polygons:
        for ring in shape:
            assert ring.shape[1] == 2 and not ring.flags.writeable
    ring = figure.polygons[0][0]
    kept = ring.copy()
    del figure, surfaces
    assert (ring == kept).all()


@pytest.mark.parametrize("call, error, message", [
    (lambda s: s.draw_lines(fm.frame(s), kinds=["edge"]), ValueError, "^kinds: 'edge' is not one of"),
    (lambda s: s.draw_lines(fm.frame(s), crease_angle=200), fm.Error, "angle"),
    (lambda s: s.draw_sheet(["above"]), ValueError, "^direction: "),
    (lambda s: s.draw_sheet([]), fm.Error, "view"),
    (lambda s: s.draw_sheet(page="a9"), fm.Error, "a9"),
    (lambda s: s.draw_sheet(page=(1, 2, 3)), ValueError, "^page: "),
    (lambda s: s.draw_sheet(title_block={"name": "x"}), ValueError, "^title_block: 'name'"),
    (lambda s: s.draw_sheet(hidden="dotted"), ValueError, "^hidden: "),
    (lambda s: s.draw_sheet(pen=99.0), fm.Error, "pen"),
    (lambda s: s.draw_figure(fm.frame(s), tolerance=-1), fm.Error, "tolerance"),
    (lambda s: s.draw_figure(fm.frame(s), most_polygons=1), fm.Error, "polygons"),
])
def test_options_out_of_range_end_in_errors(crate_behind_wall, call, error, message):
    with pytest.raises(error, match=message):
        call(crate_behind_wall)
