#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Drawings as other programs see them: parsed as XML, rasterised by librsvg and poppler, and compared with the
z-buffer's pictures.

    drawings.py PROGRAM

Drawings have one or three pixels per millimetre. In the id map, every border between two objects, or between an object
and nothing, must have ink beside it. All ink must lie beside a border between two triangles. Where parts are narrower
than pixels and lie between their samples, the triangles are those of an id map of four times the resolution. ezdxf
reads DXF, which must hold the content of the JSON. Views from all sides of one model are a sheet's views, one by one.
A sheet is drawn in both kinds of lettering: its PDF must look the same, and its texts must be found in all formats.
Programs that are not installed are skipped, and counted.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

sys.dont_write_bytecode = True
from rasters import near, numpy, read_ids, read_picture  # noqa: E402

try:
    import ezdxf
except ImportError:
    ezdxf = None

WIDTH, HEIGHT = 480, 270
FINE = 4
NARROW = ["builtin:city"]  # parts that fall between samples: 15 pixels of ink without a border at plain resolution
VIEWS = [["builtin:cubes"], ["builtin:cycle"], ["builtin:gallery", "--tessellation-error", "1"], ["builtin:teapot", "--tessellation-error", "1", "--crease-angle", "0"],
         *(["builtin:cubes", "--view", side, "--camera-orthographic"] for side in ("iso", "front", "left", "top", "bottom")), NARROW]
SCALES = [1, 3]  # pixels per millimetre
REACH = 2  # pixels: half a pixel of rounding, half of a line, and smoothing
INK = 235
SVG = "{http://www.w3.org/2000/svg}"
LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"


def run(*words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, timeout=900)
    if done.returncode != 0 or done.stderr:  # no warnings either
        sys.exit(f"{' '.join(map(str, words))}: {done.stderr}")
    return done.stdout


def borders(ids, fine=1):
    """Pixels whose right or lower neighbour differs. For an id map `fine` times as fine, the pixels around such
    borders."""
    beside, below = (numpy.concatenate((ids, ids.take([-1], axis)), axis) for axis in (1, 0))
    differs = (ids != beside[:, 1:]) | (ids != below[1:])
    return near(differs, fine, 0, fine).any((-2, -1))


def grown(pixels):
    return near(numpy.pad(pixels, REACH), 1, REACH, 2 * REACH + 1).any((-2, -1))[REACH:-REACH, REACH:-REACH]


def ink_of(rows):
    assert rows.shape == (HEIGHT, WIDTH), rows.shape
    return rows < INK


def check_xml(path, names):
    root = xml.etree.ElementTree.parse(path).getroot()
    assert root.get("width") == f"{WIDTH}mm" and root.get("viewBox") == f"0 0 {WIDTH} {HEIGHT}", root.attrib
    layers = root.findall(SVG + "g")
    assert [layer.get(LABEL) for layer in layers] == names, [layer.get(LABEL) for layer in layers]
    allowed = {SVG + tag for tag in ("svg", "title", "g", "path")}
    assert {element.tag for element in root.iter()} <= allowed


def check_dxf(path, page):
    """Returns whether a DXF reader is installed."""
    if ezdxf is None:
        return 0
    document = ezdxf.readfile(str(path))
    audit = document.audit()
    assert not audit.errors and not audit.fixes, (audit.errors, audit.fixes)
    assert document.header["$INSUNITS"] == ezdxf.units.MM, document.header["$INSUNITS"]
    colors = {layer.dxf.name[0]: layer.dxf.color for layer in document.layers}
    assert colors["2"] == 7 and colors.get("1", 6) == 6 and colors.get("4", 8) == 8, colors
    expected = {}
    for layer in page["layers"]:
        for group in layer["groups"]:
            # A DXF layer's name, as the page reference defines it: the class, and the object if it has a name.
            parts = [re.sub("[^A-Z0-9-]+", "_", name.upper()) for name in (layer["name"], group["name"]) if name]
            name = "-".join(parts)[:26]
            expected[name] = expected.get(name, 0) + len(group["paths"])
    found = {name: 0 for name in expected}
    for entity in document.modelspace():
        found[re.sub("_[0-9]+$", "", entity.dxf.layer) if entity.dxf.layer not in found else entity.dxf.layer] += 1
        assert entity.dxf.layer in document.layers
        assert entity.dxf.color == ezdxf.const.BYLAYER and entity.dxf.linetype == "BYLAYER", entity
    # A path of several arcs becomes as many DXF arcs.
    assert all(found[name] >= expected[name] > 0 for name in expected), (found, expected)
    return 1


def check_formats(program, drawing, folder):
    """Returns whether a DXF reader is installed."""
    files = [folder / f"all.{suffix}" for suffix in ("svg", "dxf", "json")]
    outputs = [word for path in files for word in ("-o", path)]
    run(program, "lines", *drawing, "--hidden", "dashed", "--hatch", "6", *outputs)
    page = json.loads(files[2].read_text())
    names = [layer["name"] for layer in page["layers"]]
    assert set(names) <= {"4 hatching", "1 hidden", "2 visible"} and "2 visible" in names, names
    check_xml(files[0], names)
    return check_dxf(files[1], page)


def check_view(program, view, folder):
    """Returns how many of the programs are installed."""
    size = ["--resolution", f"{WIDTH},{HEIGHT}"]
    page = ["--page", f"{WIDTH},{HEIGHT}", "--margin", "0"]
    readers = 0
    if view != NARROW:  # a hundred thousand entities take half a minute to read
        readers = check_formats(program, [*view, *size, *page], folder)
    camera = [word for word in view if word not in ("--crease-angle", "0")]
    run(program, "render", *camera, *size, "--ids", f"object={folder}/objects.npy")
    outlines = borders(read_ids(folder / "objects.npy"))
    fine = FINE if view == NARROW else 1
    width, height = WIDTH * fine, HEIGHT * fine
    run(program, "render", *camera, "--resolution", f"{width},{height}", "--ids", f"primitive={folder}/primitives.npy")
    edges = grown(borders(read_ids(folder / "primitives.npy"), fine))
    for scale in SCALES if view != NARROW else SCALES[:1]:
        readers += check_ink(program, [*view, *size], folder, scale, outlines, edges)
    return readers


def check_ink(program, drawing, folder, scale, outlines, edges):
    """Returns how many of the programs are installed."""
    page = ["--page", f"{WIDTH / scale},{HEIGHT / scale}", "--margin", "0", "--pen", str(0.5 / scale)]
    run(program, "lines", *drawing, *page, "-o", folder / "a.svg", "-o", folder / "a.pdf")
    inks = {}
    if shutil.which("rsvg-convert"):
        run("rsvg-convert", "-w", WIDTH, "-h", HEIGHT, "-b", "white", folder / "a.svg", "-o", folder / "svg.png")
        inks["librsvg"] = ink_of(read_picture(folder / "svg.png")[:, :, 0])
    if shutil.which("pdftoppm"):
        run("pdftoppm", "-r", str(25.4 * scale), "-gray", "-singlefile", folder / "a.pdf", folder / "pdf")
        inks["poppler"] = ink_of(read_picture(folder / "pdf.pgm"))
    for name, ink in inks.items():
        missing, stray = (numpy.argwhere(a & ~b) for a, b in ((outlines, grown(ink)), (ink, edges)))
        assert ink.sum() > 500, f"{drawing}: {name}: hardly any ink"
        assert not len(missing), f"{drawing}: {name}: {len(missing)} border pixels without ink, such as {missing[0]}"
        assert not len(stray), f"{drawing}: {name}: {len(stray)} ink pixels beside no border, such as {stray[0]}"
    return len(inks)


def check_lettering(program, folder):
    """Returns how many of the programs are installed."""
    title = "Two cubes, \u00e4 \u2264 \u2300"
    sheet = ["builtin:cubes", "--views", "front,top", "--sections", "left", "--dimensions", "all", "--page", "a3",
             "--title", title, "--number", "FM-17", "--owner", "50 % of\\P & <us>"]
    for kind in ("strokes", "text"):
        outputs = [word for suffix in ("svg", "pdf", "dxf", "json") for word in ("-o", folder / f"{kind}.{suffix}")]
        run(program, "lines", *sheet, "--lettering", kind, *outputs)
    groups = [group for layer in json.loads((folder / "text.json").read_text())["layers"] for group in layer["groups"]]
    wanted = sorted(text["text"] for group in groups for text in group.get("texts", ()))
    dimensions = [one for group in groups for one in group.get("dimensions", ())]
    assert {title, "A-A", "FM-17", "Legal owner"} <= set(wanted) and len(dimensions) >= 3, wanted
    root = xml.etree.ElementTree.parse(folder / "text.svg").getroot()
    assert sorted(text.text for text in root.iter(SVG + "text")) == wanted
    readers = 0
    if shutil.which("pdftotext"):
        readers += 1
        words = sorted(run("pdftotext", "-raw", folder / "text.pdf", "-").split())
        assert words == sorted(word for text in wanted for word in text.split()), words
        assert not run("pdftotext", folder / "strokes.pdf", "-").split()
    if shutil.which("pdftoppm"):
        readers += 1
        pictures = []
        for kind in ("strokes", "text"):
            run("pdftoppm", "-r", "150", "-gray", "-singlefile", folder / f"{kind}.pdf", folder / kind)
            pictures.append(read_picture(folder / f"{kind}.pgm").astype(int))
        # Poppler moves thin lines of pages, not of glyphs, to whole pixels.
        differs, ink = (abs(pictures[0] - pictures[1]) > 130).sum(), (pictures[0] < INK).sum()
        assert ink > 50000 and differs < ink / 1000, (differs, ink)
    return readers + check_dxf_texts(folder, wanted, dimensions)


def check_dxf_texts(folder, wanted, dimensions):
    """Returns whether a DXF reader is installed."""
    if ezdxf is None:
        return 0
    for kind in ("strokes", "text"):
        document = ezdxf.readfile(str(folder / f"{kind}.dxf"))
        audit = document.audit()
        assert document.dxfversion == "AC1015" and not audit.errors and not audit.fixes, (audit.errors, audit.fixes)
        entities = list(document.modelspace())
        blocks = [part for one in entities if one.dxftype() == "DIMENSION" for part in document.blocks[one.dxf.geometry]]
        texts = [text for text in entities + blocks if text.dxftype() == "TEXT"]
        if kind == "strokes":
            assert not blocks and not texts
            continue
        signs = {"%%c": "\u2300", "%%d": "\u00b0", "%%p": "\u00b1"}
        plain = [ezdxf.lldxf.encoding.decode_dxf_unicode(re.sub("%%[cdp]", lambda sign: signs[sign[0]], text.dxf.text)) for text in texts]
        assert sorted(plain) == wanted, plain
        # Each dimension of the page, except running ones, is an entity with its number, which is the text.
        shown = [one for one in entities if one.dxftype() == "DIMENSION"]
        assert len(shown) == sum(one["kind"] != "position" for one in dimensions) > 0
        for one in shown:
            number = float(re.search("[0-9.]+$", one.dxf.text)[0])
            scale = document.dimstyles.get(one.dxf.dimstyle).dxf.dimlfac
            assert abs(one.dxf.actual_measurement - number) <= 0.0051 and scale > 0, (one.dxf.text, one.dxf.actual_measurement)
            assert abs(one.get_measurement() * scale - number) <= 0.0051 + 0.001 * scale, (one.dxf.text, one.get_measurement())
    return 1


def main():
    program, checked = pathlib.Path(sys.argv[1]).resolve(), 0
    with tempfile.TemporaryDirectory() as folder:
        for view in VIEWS:
            checked += check_view(program, view, pathlib.Path(folder))
        checked += check_lettering(program, pathlib.Path(folder))
    # Every view is checked by two programs at each scale and as DXF; the narrow view at one scale only, and not as DXF.
    # The sheet is checked by three programs.
    every = (2 * len(SCALES) + 1) * (len(VIEWS) - 1) + 2 + 3
    print(f"{len(VIEWS)} drawings, {checked} times read, {every - checked} skipped for want of a reader")


main()
