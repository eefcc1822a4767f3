# SPDX-License-Identifier: Apache-2.0
"""The demo's contents: sections of pictures, each with the arguments of the command that makes it."""
import dataclasses
import shlex


@dataclasses.dataclass
class Show:
    title: str
    caption: str
    arguments: str
    wide: bool = False
    command: str = "render"

    @property
    def files(self):
        """The file names among the arguments, in their order."""
        words = shlex.split(self.arguments)
        names = [word.split("=")[-1] for word in words]
        return [name for name in names if name.endswith((".png", ".exr", ".npy", ".pfm", ".svg", ".pdf", ".dxf"))]


@dataclasses.dataclass
class Section:
    title: str
    words: str
    shows: list


CARD = "--resolution 640,480 --background transparent"

SECTIONS = [
    Section("Pictures", "A model in, a picture out. Near, far and the camera are fitted unless you say otherwise.", [
        Show("The gallery", "Everything at once: metal, glaze and stone, smooth and rough, in one light.",
             "builtin:gallery --resolution 1600,900 --samples 8 --background transparent -o gallery.png", wide=True),
        Show("Teapot", "The classic patches.", f"builtin:teapot {CARD} -o teapot.png"),
        Show("Spheres", "Smooth shapes, and the shadows they cast.", f"builtin:spheres {CARD} -o spheres.png"),
        Show("City", "Many objects that hide each other.", f"builtin:city {CARD} -o city.png"),
    ]),
    Section("Maps", "Every map answers one question about the same visible surfaces.", [
        Show("Depth", "How far? Near is bright.", f"builtin:city {CARD} --shading depth -o map_depth.png"),
        Show("Objects", "Which object? A colour for each.", f"builtin:city {CARD} --shading ids -o map_ids.png"),
        Show("Normals", "Which way does it face?", f"builtin:teapot {CARD} --shading normals -o map_normals.png"),
        Show("Texture coordinates", "Where on the texture? u is red, v green.",
             f"builtin:teapot {CARD} --shading uv -o map_uv.png"),
        Show("Base colour", "Without light.", f"builtin:spheres {CARD} --shading flat -o map_flat.png"),
    ]),
    Section("Views", "Named views, parallel projection, angles as other viewers name them.", [
        Show("Front", "Parallel projection.", f"builtin:teapot {CARD} --view front --camera-orthographic -o front.png"),
        Show("Top", "Parallel projection.", f"builtin:teapot {CARD} --view top --camera-orthographic -o top.png"),
        Show("Iso", "Along the diagonal.", f"builtin:teapot {CARD} --view iso --camera-orthographic -o iso.png"),
        Show("From below", "Turned by azimuth and elevation.",
             f"builtin:teapot {CARD} --camera-azimuth-angle 40 --camera-elevation-angle -50 -o below.png"),
    ]),
    Section("Drawings", "Edges cut exactly where they go out of sight, in millimetres, for paper and for pens.", [
        Show("For a paper", "Outlines heavier than contours; hatched by the direction of light, with the shadows that it casts.",
             "builtin:gallery --style figure --hatch 1.2 --page 240,150 --margin 3 -o figure.svg", wide=True, command="lines"),
        Show("For a pen plotter", "Dashes are lines of their own, from corner to corner; layers are pens.",
             "bracket.obj --up +z --view iso --camera-orthographic --plot --hidden dashed --hatch 1.5 --page 160,130 "
             "--margin 5 -o plot.svg", command="lines"),
        Show("A drawing sheet", "Three views in line and one at an angle, to scale. The same as PDF and DXF.",
             "bracket.obj --up +z --views front,top,left,iso --hidden dashed --page 200,180 --scale 1:1 -o sheet.svg "
             "-o sheet.pdf -o sheet.dxf", command="lines"),
        Show("Polygons", "The painter's algorithm: shaded polygons as vectors, what is hidden left out or cut.",
             "builtin:teapot --resolution 640,480 -o painted.svg -o painted.pdf"),
    ]),
    Section("Hard cases", "What paints wrongly when triangles are sorted whole, decided here sample by sample.", [
        Show("Ring of three", "Each triangle lies over the next one: no order of painting is right.",
             f"builtin:cycle {CARD} --shading flat -o cycle.png"),
        Show("Through each other", "Two cubes that intersect.", f"builtin:cubes {CARD} -o cubes.png"),
    ]),
    Section("Files", "The same view as numbers. Distances are in scene units, ids count from 0 in the file's order.", [
        Show("Picture, depth and normals in one EXR", "Named channels of 32-bit floats; outputs that share a name share the file.",
             "builtin:city --resolution 640,480 -o city.exr --depth city.exr --normals city.exr"),
        Show("Depth as NPY and PFM, ids as NPY", "float32 and uint32 arrays, ready for numpy.load.",
             "builtin:city --resolution 640,480 --depth depth.npy --ray-distance distance.pfm --ids object=objects.npy "
             "--ids primitive=primitives.npy --ids material=materials.npy"),
        Show("Depth as 16-bit PNG", "Ten steps to the unit; 0 where nothing is seen.",
             "builtin:city --resolution 640,480 --depth depth16.png --depth-scale 10"),
    ]),
]
