# SPDX-License-Identifier: Apache-2.0
# The types of the package. The docstrings are those of the compiled part as well: make_docstrings.py takes them from
# here, so help(), docs/python.md and type checkers say the same.
import os
from typing import Any, Callable, Iterable, Literal, Mapping, Sequence, Union

import numpy
from numpy.typing import ArrayLike, NDArray

__version__: str

Progress = Union[None, bool, Callable[[str, float], Any]]
Path = Union[str, os.PathLike[str]]
Up = Literal["x", "y", "z", "-x", "-y", "-z"]
Format = Literal["stl", "ply", "obj", "off", "gltf", "3mf", "scene", "step", "iges", "brep", "foreign"]
Convention = Literal["opencv", "opengl", "opencv_world_to_camera", "opencv_camera_to_world", "opengl_camera_to_world",
                     "opengl_world_to_camera", "robot", "robot_camera_to_world", "robot_world_to_camera"]
PixelRule = Literal["centre_at_integer", "centre_at_half"]
Culling = Literal["none", "back", "front", "both", "material"]
Direction = Literal["front", "back", "left", "right", "top", "bottom", "iso", "three_quarter"]
Shading = Literal["lit", "flat", "normals", "depth", "ids", "uv"]
Reason = Literal["empty", "behind_eye", "nearer_than_near", "beyond_far", "outside", "faces_away", "transparent",
                 "no_sample", "hidden", "seen"]
MaskPart = Literal["visible", "whole"]
EdgeKind = Literal["boundary", "silhouette", "border", "crease", "intersection"]
DepthFormat = Literal["d8", "d16", "d24", "f32"]
DepthFunc = Literal["never", "less", "equal", "less_equal", "greater", "not_equal", "greater_equal", "always"]
ImageFormat = Literal["png", "exr", "pfm", "npy", "jpeg", "webp"]
Hidden = Literal["none", "dashed", "thin"]
Style = Literal["technical", "figure"]
PaintMethod = Literal["depth_sort", "bsp", "farthest", "centroid"]
ObjectUnit = Literal["instances", "parts", "clusters"]
ObjectSight = Literal["outside", "hidden", "may_be_seen"]
DifferenceKind = Literal["none", "edge", "depth", "translucent", "unexplained"]
FightKind = Literal["one_plane", "fold", "close", "clear"]
DepthConvention = Literal["opengl", "gortler", "zero_to_one", "reversed"]

no_primitive: int
no_index: int
edge_kinds: tuple[EdgeKind, ...]
object_sights: tuple[ObjectSight, ...]
difference_kinds: tuple[DifferenceKind, ...]
fight_kinds: tuple[FightKind, ...]

class Error(RuntimeError):
    """Why the library could not do what it was asked.

    The message names the culprit first: "engine.stl: triangle 41: ...". Arguments of a wrong type are TypeErrors, arrays
    of a wrong shape and words that are none of the known ones ValueErrors, each with the argument's name.
    """
    code: Literal["bad_argument", "file_unreadable", "file_malformed", "file_unwritable", "unsupported", "limit_exceeded",
                  "singular_camera", "cancelled"]
    """What kind of failure it is: "file_unreadable", ..."""
    file: str
    """Whose contents or name is wrong: a path, "standard input", "builtin:..."; empty where no file is."""
    place: str
    """Where in the file, or which argument or function: "line 7", "near"; may be empty."""
    reason: str
    """What is wrong. The message is file, place and reason with ": " between them."""

class Object:
    """One of a scene's objects: a mesh at a place."""
    @property
    def number(self) -> int:
        """Its number in the scene, as Visible.object has it."""
    @property
    def name(self) -> str:
        """As the file has it; not always the only one so called."""
    @property
    def mesh(self) -> int:
        """The number of its mesh in Scene.meshes."""
    @property
    def pose(self) -> NDArray[numpy.float64]:
        """4x4 transform of the mesh's points, vertices + origin, to the world in the file's coordinates."""
    @property
    def category(self) -> str | None:
        """What kind of thing it is, where the scene says so."""

class Mesh:
    """Triangles in a space of their own. Arrays are views of the scene's memory, which they keep; not writable."""
    @property
    def name(self) -> str:
        """As the file has it."""
    @property
    def vertices(self) -> NDArray[numpy.float32]:
        """(n, 3) positions, told from origin."""
    @property
    def origin(self) -> NDArray[numpy.float64]:
        """(3,) what was taken off the positions as they were given: (0, 0, 0), but for those far from zero."""
    @property
    def faces(self) -> NDArray[numpy.uint32]:
        """(m, 3) corners of triangles, counter-clockwise from outside: numbers of vertices."""
    @property
    def normals(self) -> NDArray[numpy.float32] | None:
        """(k, 3), of vertices or of corners; None where there are none."""
    @property
    def texcoords(self) -> NDArray[numpy.float32] | None:
        """(k, 2), u to the right and v down from the picture's first row; None where there are none."""
    @property
    def colors(self) -> NDArray[numpy.float32] | None:
        """(k, 4) linear RGBA; None where there are none."""
    @property
    def face_ids(self) -> NDArray[numpy.uint32] | None:
        """(m,) the polygon of the file that each triangle came from; None where each was one."""

class Scene:
    """Meshes, materials and placed objects.

    What is made of a scene (Surfaces, arrays of meshes) keeps it as it was: a scene that changes afterwards is a copy.
    """
    def __init__(self) -> None: ...
    @staticmethod
    def from_arrays(vertices: ArrayLike, faces: ArrayLike, *, name: str | None = None, pose: ArrayLike | None = None,
                    color: ArrayLike | None = None, vertex_colors: ArrayLike | None = None,
                    face_colors: ArrayLike | None = None, normals: ArrayLike | None = None,
                    texcoords: ArrayLike | None = None, texture: ArrayLike | None = None) -> Scene:
        """A scene of one object; add() adds others.

        vertices: (n, 3) of any numbers, kept as float32. float64 that lie far from zero for their size are told from an
        origin of their own (see Scene.origin), so that nothing is lost. NaN is allowed: triangles that have one are
        never seen. faces: (m, 3) integers, 0 to n - 1, counter-clockwise from outside. pose: 4x4, or 3x4, that takes
        vertices to the world. color: 3 or 4 numbers; vertex_colors: (n, 3 or 4); face_colors: (m, 3 or 4); integers are
        sRGB, 0 to 255, floats linear, 0 to 1. normals: (n, 3). texcoords: (n, 2), v down from the first row of texture:
        (height, width, 3 or 4) of uint8. All are copied. O(n + m).
        """
    def add(self, vertices: ArrayLike, faces: ArrayLike, *, name: str | None = None, pose: ArrayLike | None = None,
            color: ArrayLike | None = None, vertex_colors: ArrayLike | None = None, face_colors: ArrayLike | None = None,
            normals: ArrayLike | None = None, texcoords: ArrayLike | None = None,
            texture: ArrayLike | None = None) -> int:
        """Adds an object, as from_arrays() makes one. Returns its number."""
    def place(self, mesh: int, pose: ArrayLike | None = None, *, name: str | None = None) -> int:
        """Adds an object of a mesh that is there. pose: 4x4, in the coordinates of the file. Returns its number."""
    def add_scene(self, part: Scene) -> None:
        """Adds all that another scene holds."""
    def copy(self) -> Scene:
        """A scene of its own."""
    def save(self, path: Path, *, of_triangles: dict[str, Any] = {}) -> None:
        """Writes a model: .ply, .stl or .glb, whole or not at all. Raises Error: unsupported, file_unwritable.

        of_triangles: properties of the faces of a PLY, (triangle_count,) arrays by their names. uint8 and bool become
        bytes, other integers 32 bits, floats doubles; bytes that are named red, green and blue are what viewers show.
        """
    def keep_faces(self, primitives: ArrayLike) -> Scene:
        """A scene of some triangles alone, such as those that are ever seen; names, places and materials stay.

        primitives: (n,) numbers of triangles, ascending. Objects without kept triangles are removed. Mesh.face_ids tells which
        polygon of this scene's mesh each triangle came from.
        """
    def tessellate(self, view: View, pixels: float) -> Scene:
        """A scene with new triangles for its curved meshes (spheres, patches), none of which is farther than so many
        pixels of the view from its surface. Mesh.face_ids tells which sphere or patch each is of. Raises Error:
        bad_argument, limit_exceeded."""
    name: str
    """What files made of it are called."""
    up: Up
    """Which way is up in the world."""
    @property
    def origin(self) -> NDArray[numpy.float64]:
        """Where the world's zero lies in the coordinates of the file: (0, 0, 0), but for models far from zero.

        Eyes and rays in those coordinates have it taken off first: View.about(scene.origin), points - scene.origin.
        """
    @property
    def objects(self) -> list[Object]:
        """In the order of their numbers."""
    @property
    def meshes(self) -> list[Mesh]:
        """In the order of their numbers."""
    @property
    def triangle_count(self) -> int:
        """Number of triangles over all objects."""
    @property
    def warnings(self) -> list[str]:
        """What the reader passed over: "file: place: what"."""
    def inspect(self, *, threads: int = 0, progress: Progress = None) -> dict[str, Any]:
        """What is in it, and what is odd: names and numbers as `frontmost info --json` has them.

        triangles, stored_triangles (of meshes), vertices, bounds (2, 3) in the coordinates of the file, area of all triangles,
        volume of the objects whose meshes have a genus (None without any), rounding; odd: counts of triangles that are not finite, degenerate or there twice, and of edges on a boundary, of more than two triangles, or
        wound both ways; meshes: these and pieces, shells, closed, genus; materials; cameras: position, direction, up,
        orthographic, and vertical, the field of view in degrees or the height.
        """
    @property
    def hidden_by_file(self) -> list[str]:
        """Names of nodes that the file hides (glTF's KHR_node_visibility); they are not drawn, and are not among objects."""
    def find(self, name: str | int) -> int:
        """The number of an object. Raises ValueError where none, or several, are so called."""
    def set_categories(self, categories: Mapping[str, str | int | tuple[int, str]]) -> None:
        """Gives the objects of these names the category of that name, number, or (number, name), in place of all that they
        had; for write_coco() and write_bop().

        Names alone are numbered from 1, in the order of the objects' names. Where other categories have numbers, a name
        has that of its place among all categories, as they come in the dict. Raises ValueError for a name that no object
        has.
        """

def load(source: Path | bytes, *, name: str = "memory", up: Up | None = None, format: Format | None = None,
         allow_outside: Sequence[Path] = [], mesh_tolerance: float = 0, mesh_angle: float = 12,
         import_seconds: float = 600, cache: bool = True, threads: int = 0, progress: Progress = None) -> Scene:
    """Reads a model: STL, PLY, OBJ, OFF, glTF, GLB, 3MF or a scene file; where frontmost-import is installed, STEP, IGES,
    BREP and other formats; "builtin:NAME"; or the bytes of a file.

    name: what messages call bytes. up, format: None takes the file's. allow_outside: folders in which, or below which,
    a scene file may name models, besides its own. mesh_tolerance: greatest distance of triangles from the surfaces of
    STEP, IGES and BREP, in millimetres; 0: 0.05 % of the diagonal. mesh_angle: greatest angle between the normals of
    neighbours, in degrees. import_seconds: greatest time of frontmost-import. cache: whether a copy of a STEP, IGES
    or BREP file and its triangles are kept in $XDG_CACHE_HOME/frontmost/import (else ~/.cache/frontmost/import), and
    taken from there the next time. Raises Error with the file, the place and the reason: file_unreadable,
    file_malformed, unsupported, limit_exceeded.
    """

def builtin(name: str) -> Scene:
    """A scene made by code. Raises Error naming the known ones."""

def builtin_names() -> list[str]:
    """The names that builtin() knows."""

class View:
    """A camera and a grid of pixels. Never changes; the methods that seem to change one give another. Can be pickled.

    Distances are in scene units. samples: 1, 2, 4, 8 or 16 a pixel. culling: which sides of triangles are left out;
    "material": backs of materials that are not double-sided.
    Raises Error: bad_argument, singular_camera.
    """
    @staticmethod
    def from_intrinsics(K: ArrayLike, width: int, height: int, *, pose: ArrayLike | None = None,
                        convention: Convention = "opencv", near: float = 0.1, far: float = ...,
                        pixel_rule: PixelRule = "centre_at_integer", samples: int = 1,
                        culling: Culling = "none") -> View:
        """A calibrated camera.

        K: 3x3 without skew, or (fx, fy, cx, cy), in pixels. pose: 4x4 rotation and translation; None: the identity.
        convention: direction and axes of the pose. "opencv" is opencv_world_to_camera (x right, y down, z ahead; [R | t] of
        calibrations, BOP), "opengl" is opengl_camera_to_world (x right, y up, looks down -z), "robot" is
        robot_camera_to_world (x ahead, y left, z up; the transforms of ROS). near, far: distances of the clipping planes;
        far is infinite by default. pixel_rule: the middle of the first pixel in K, (0, 0) as in OpenCV or (0.5, 0.5).
        """
    @staticmethod
    def look_at(eye: ArrayLike, target: ArrayLike, up: ArrayLike = (0, 1, 0), *, width: int = 640, height: int = 480,
                fov: float = 30.0, near: float = 0.1, far: float = ..., samples: int = 1,
                culling: Culling = "none") -> View:
        """A view from an eye towards a target. fov: degrees, of the smaller side of the picture."""
    @staticmethod
    def orthographic(eye: ArrayLike, target: ArrayLike, up: ArrayLike = (0, 1, 0), *, width: int = 640, height: int = 480,
                     tall: float = 2.0, near: float = 0.1, far: float = 1000.0, samples: int = 1,
                     culling: Culling = "none") -> View:
        """A view in parallel projection. tall: height of the picture in scene units."""
    def placed(self, pose: ArrayLike, convention: Convention = "opencv") -> View:
        """A copy of the view with this pose."""
    def looking(self, eye: ArrayLike, target: ArrayLike, up: ArrayLike = (0, 1, 0)) -> View:
        """A copy of the view from another eye towards a target."""
    def about(self, origin: ArrayLike) -> View:
        """A copy of a view in the coordinates of a file, relative to this Scene.origin."""
    def between(self, near: float, far: float) -> View:
        """A copy of the view with these near and far planes."""
    def enclosing(self, bounds: ArrayLike | Surfaces) -> View:
        """A copy whose near and far planes enclose surfaces or a box, (2, 3) of low and high corners."""
    def sampled(self, samples: int) -> View:
        """A copy of the view with so many samples a pixel."""
    def culled(self, culling: Culling) -> View:
        """A copy of the view that leaves out other sides of triangles."""
    @property
    def width(self) -> int:
        """Width of the picture in pixels."""
    @property
    def height(self) -> int:
        """Height of the picture in pixels."""
    @property
    def samples(self) -> int:
        """Samples of a pixel."""
    @property
    def culling(self) -> Culling:
        """Sides of triangles that are left out."""
    @property
    def is_orthographic(self) -> bool:
        """Whether the projection is parallel."""
    @property
    def near(self) -> float:
        """The distance of the near plane."""
    @property
    def far(self) -> float:
        """The distance of the far plane; may be infinite."""
    @property
    def eye(self) -> NDArray[numpy.float64]:
        """(3,) position of the eye in the world."""
    @property
    def forward(self) -> NDArray[numpy.float64]:
        """(3,) of unit length: viewing direction."""
    @property
    def up(self) -> NDArray[numpy.float64]:
        """(3,) of unit length: up in the picture."""
    @property
    def right(self) -> NDArray[numpy.float64]:
        """(3,) of unit length: right in the picture."""
    @property
    def K(self) -> NDArray[numpy.float64]:
        """3x3 with the middle of the first pixel at (0, 0), as from_intrinsics() takes it. Raises Error for parallel projection."""
    def intrinsics(self, pixel_rule: PixelRule = "centre_at_integer") -> NDArray[numpy.float64]:
        """3x3 camera matrix by either pixel rule."""
    def pose(self, convention: Convention = "opencv") -> NDArray[numpy.float64]:
        """4x4 pose, as from_intrinsics() takes it."""
    def clip_from_eye(self, depth: DepthConvention = "opengl") -> NDArray[numpy.float64]:
        """4x4 projection. depth: -1 near to 1 far ("opengl"), 1 to -1 ("gortler"), 0 to 1 or 1 to 0 ("reversed")."""
    def clip_from_world(self, depth: DepthConvention = "opengl") -> NDArray[numpy.float64]:
        """4x4: clip_from_eye() times the pose."""

def frame(scene: Scene | Surfaces | ArrayLike, width: int = 640, height: int = 480, *, direction: Direction = "three_quarter",
          orthographic: bool = False, fov: float = 30.0, margin: float = 0.05, forward: ArrayLike | None = None,
          up: ArrayLike | None = None, target: ArrayLike | None = None, objects: Literal["subject", "all"] = "subject",
          samples: int = 1, culling: Culling = "none") -> View:
    """A view that shows a scene from as near as the margin allows. Quicker for Surfaces than for a Scene.

    direction, or forward and up: viewing direction. fov: degrees, of the smaller side. margin: share of the picture at
    each side. target: middle of the picture, by default that of the model. objects: "subject" does not fit objects that lie
    or reach far away. scene may be bounds, (2, 3) of low and high corners: the view then shows the whole box, and y is up.
    """

class Surfaces:
    """All triangles of a scene in world space, with stable numbers. Visibility methods work on surfaces.

    The number of a triangle is its running number over all objects in the order of the scene. Long calls release the
    interpreter's lock and stop at Ctrl-C. threads: 0 for one per core; results do not depend on threads. progress: True
    shows a bar; a function is called with a stage and a fraction from 0 to 1.
    """
    def __init__(self, scene: Scene, *, threads: int = 0, progress: Progress = None) -> None: ...
    def zbuffer(self, view: View, *, threads: int = 0, progress: Progress = None) -> Visible:
        """The front-most triangle at every sample, by rasterisation. O(triangles + covered samples)."""
    def raycast(self, view: View, *, threads: int = 0, progress: Progress = None) -> Visible:
        """The front-most triangle at every sample, by rays, with an index made for this view. Vertices are not snapped."""
    def abuffer(self, view: View, *, grid: int = 0, opacity: float = 1.0, threads: int = 0,
                progress: Progress = None) -> Fragments:
        """All fragments of a view: the coverage of each triangle in each pixel, in the order of depth.

        grid: sub-samples, 0 for those of the view, or 2, 4 or 8 squared. opacity: below 1, fragments behind opaque surfaces
        are kept. Raises Error limit_exceeded beyond 2^28 fragments and 1,024 for each triangle, 2^30 in all.
        """
    def draw_lines(self, view: View, *, crease_angle: float | None = None, counts_hidden: bool = False,
                   kinds: Sequence[EdgeKind] = ..., ripples: bool = True, outlines: bool = False, threads: int = 0,
                   progress: Progress = None) -> Drawing:
        """The feature edges, each cut exactly into seen and hidden parts.

        crease_angle: degrees between normals from which an edge is a crease; None decides by the surfaces on both sides.
        counts_hidden: Drawing.hidden_by counts surfaces, else it is 0 or 1. kinds: wanted edge_kinds. ripples:
        silhouettes of single triangles are kept where a smooth surface is seen nearly edge-on. outlines: finds
        Drawing.is_outline.
        """
    def draw_sheet(self, views: Sequence[Direction] | View = ("front", "top", "left"), *,
                   sections: list[Direction | tuple[Direction, float]] = [], uncut: Sequence[str] | None = None,
                   projection: Literal["none", "first_angle", "third_angle"] = "first_angle", dimensions: Literal["none", "overall", "diameters", "holes", "all"] = "none",
                   hidden: Hidden = "none", hidden_views: list[Direction] | None = None,
                   style: Style = "technical", pen: float | None = None,
                   crease_angle: float | None = None, shortest_stroke: float | None = None,
                   centre_lines: bool | None = None, plot: bool = False,
                   lettering: Literal["strokes", "text"] = "strokes",
                   page: str | tuple[float, float] | None = None, margin: float = 10.0, scale: float | None = None,
                   standard_scale: bool | None = None, millimetres_per_unit: float | None = None,
                   in_inches: bool | None = None, inch_fractions: bool = False,
                   title_block: dict[str, str] | None = None, hatch: float | None = None,
                   stipple: float | None = None, hatch_angle: float = 45.0, light: ArrayLike | None = None,
                   casts_shadows: bool = True, keeps_picture: bool = False, threads: int = 0,
                   progress: Progress = None) -> Sheet:
        """A drawing on paper: named views to scale, or one View, with hidden lines removed.

        sections: directions, or (direction, place of the plane in the coordinates of the file). uncut: words in names of
        objects that sections leave whole; None: fasteners, shafts and balls. page: "a4", "a3-landscape", ..., or (width,
        height). pen, margin, hatch, stipple, shortest_stroke: millimetres. scale: paper to model.
        millimetres_per_unit: unit of the model's coordinates, in place of the file's. in_inches: unit of dimensions, by
        default True for models in inches; inch_fractions: as fractions down to 1/64 where exact to 0.0005. title_block:
        title, number, author, date, owner. hatch_angle, crease_angle: degrees. plot: strokes for plotters, joined, in an
        order, and none in the ink of others. lettering: texts as strokes of a pen, or as text that programs can search and
        edit.
        Raises Error: bad_argument, limit_exceeded.
        """
    def draw_figure(self, view: View, *, tolerance: float = 6.0, visible_only: bool = True,
                    merges_neighbours: bool = False, most_polygons: int = 2000000, shading: Shading = "lit",
                    background: ArrayLike | None = (1.0, 1.0, 1.0), shadows: Literal["off", "map", "rays"] = "map",
                    opacity: float = 1.0, lights: Literal["key", "file", "both", "none"] = "key",
                    title: str | None = None, threads: int = 0, progress: Progress = None) -> Figure:
        """A picture of polygons, by the painter's algorithm.

        tolerance: steps of 8-bit sRGB by which a polygon's colour may differ. visible_only: leaves out hidden polygons, else
        all polygons are in the order of painting. merges_neighbours: joins neighbours of one colour. title: by default the
        scene's name. Raises Error limit_exceeded beyond most_polygons.
        """
    def painter(self, view: View, *, method: PaintMethod = "depth_sort", most_polygons: int = 134217728,
                most_cuts: int = 1048576, threads: int = 0, progress: Progress = None) -> PaintOrder:
        """Triangles, and pieces of them, in an order in which painting one over the other is right everywhere.

        method: "depth_sort" (Newell, Newell and Sancha) cuts only triangles that have no order, "bsp" cuts many more;
        "farthest" and "centroid" sort by one depth, and are wrong where it does not decide. Raises Error limit_exceeded.
        """
    def visible_faces(self, view: View, *, threads: int = 0, progress: Progress = None) -> NDArray[Any]:
        """Every triangle that is at least partly seen, in the order of numbers: exact, not sampled.

        (n,) records: primitive, object, triangle; pixels, visible area in square pixels; area, visible area on the triangle
        in scene units squared; solid_angle, in steradians from the eye, 0 in parallel projection.
        """
    def faces_ever_seen(self, views: Sequence[View], *, threads: int = 0, progress: Progress = None) -> NDArray[Any]:
        """Every triangle that is at least partly seen in any of these views, in the order of numbers.

        (n,) records: primitive, object, triangle; views, number of views that show it; best_view, the view that shows most of
        it; largest_share, largest share of its area that one view shows; largest_pixels, largest visible area in a view.
        """
    def find_exact_visible(self, view: View, *, threads: int = 0, progress: Progress = None) -> ExactVisible:
        """The nearest triangle at every sample, decided without rounding: the reference for depth buffers."""
    def find_fighting_faces(self, view: View, format: DepthFormat = "d24", *, reversed: bool = False, threads: int = 0,
                            progress: Progress = None) -> FightAreas:
        """The faces that a depth buffer of this format may show wrongly, and where.

        reversed: depth 1 at the near plane, 0 at the far one. Raises Error limit_exceeded if more than 2^22 areas are found,
        or thousands of faces lie in one place.
        """
    def cut(self, towards: Up, at: float = 0.0, *, threads: int = 0, progress: Progress = None) -> Section:
        """The part of the scene behind a plane across an axis of the world, with the faces of the cut.

        towards: the part on this side is removed. at: the plane's coordinate along that axis, also of a minus axis.
        """
    def move(self, object: int | str | Any, pose: ArrayLike, *, threads: int = 0) -> None:
        """Gives an object another pose, 4x4, in the scene and here; or each object of a list the pose of its place in
        (n, 4, 4). Earlier results become invalid: their pictures and reports raise Error. Raises Error if other surfaces
        show the same scene."""
    @property
    def scene(self) -> Scene:
        """The scene of the surfaces."""
    @property
    def triangle_count(self) -> int:
        """Number of triangles over all objects."""
    @property
    def bounds(self) -> NDArray[numpy.float32]:
        """(2, 3): low and high corner of the box around all, in the world; infinite the wrong way round without any."""

class Visible:
    """The front-most triangle at every sample of a view, and its depth. Planes are (height, width), rows from the top, of
    the first sample; primitives and keys have all samples. Arrays stay valid when their Visible is gone."""
    @property
    def view(self) -> View:
        """The view of the answer."""
    @property
    def surfaces(self) -> Surfaces:
        """The surfaces of the answer."""
    @property
    def depth(self) -> NDArray[numpy.float32]:
        """Planar distance along the viewing axis, in scene units; inf where nothing is seen. Found once, and kept."""
    @property
    def primitive(self) -> NDArray[numpy.uint32]:
        """Numbers of triangles; no_primitive where nothing is seen. No copy; not writable."""
    @property
    def key(self) -> NDArray[numpy.float32]:
        """The compared depth key: near / distance, or in parallel projection (far - distance) / (far - near). No copy."""
    @property
    def primitives(self) -> NDArray[numpy.uint32]:
        """(samples, height, width). No copy; not writable."""
    @property
    def keys(self) -> NDArray[numpy.float32]:
        """(samples, height, width). No copy; not writable."""
    @property
    def object(self) -> NDArray[numpy.uint32]:
        """Numbers of objects; no_index where nothing is seen."""
    @property
    def material(self) -> NDArray[numpy.uint32]:
        """Numbers of materials; no_index where nothing is seen, or none is set."""
    @property
    def face(self) -> NDArray[numpy.uint32]:
        """Numbers of a mesh's original faces, such as polygons of a file; no_index where nothing is seen."""
    @property
    def triangle(self) -> NDArray[numpy.uint32]:
        """Rows of Mesh.faces; no_index where nothing is seen."""
    def shade(self, *, shading: Shading = "lit", background: ArrayLike | None = (1.0, 1.0, 1.0),
              shadows: Literal["off", "map", "rays"] = "map", opacity: float = 1.0,
              see_through: Literal["where_needed", "always", "never"] = "where_needed", grid: int = 0,
              lights: Literal["key", "file", "both", "none"] = "key", ambient_occlusion: float | None = None,
              ambient_occlusion_radius: float | None = None, blend: Literal["linear", "srgb"] = "linear",
              environment: Environment | Path | None = None, environment_angle: float = 0.0,
              shows_environment: bool = False, exposure: float = 0.0,
              tone_mapping: Literal["none", "aces", "khronos"] = "none", light_direction: ArrayLike | None = None,
              light_intensity: float | None = None, threads: int = 0, progress: Progress = None) -> Bitmap:
        """A picture, with the same bytes as that of the command line.

        shading: "lit", "flat" base colours, "normals", "depth", "ids" or "uv". background: sRGB, 0 to 1; None:
        transparent. opacity: 0 to 1, multiplies every opacity. grid: the A-buffer's sub-samples, 0 those of the view, or 2, 4 or 8
        squared. ambient_occlusion: strength, 0 to 1; its radius in scene units. environment: "studio", "sky", "none",
        the path of a picture, or an Environment, which is made once for many pictures; environment_angle: degrees.
        exposure: stops. light_direction: towards the key light. Raises Error if objects were moved since.
        """
    def shade_linear(self, *, shading: Shading = "lit", background: ArrayLike | None = (1.0, 1.0, 1.0),
                     shadows: Literal["off", "map", "rays"] = "map", opacity: float = 1.0,
                     see_through: Literal["where_needed", "always", "never"] = "where_needed", grid: int = 0,
                     lights: Literal["key", "file", "both", "none"] = "key", ambient_occlusion: float | None = None,
                     ambient_occlusion_radius: float | None = None, blend: Literal["linear", "srgb"] = "linear",
                     environment: Environment | Path | None = None, environment_angle: float = 0.0,
                     shows_environment: bool = False, exposure: float = 0.0,
                     tone_mapping: Literal["none", "aces", "khronos"] = "none", light_direction: ArrayLike | None = None,
                     light_intensity: float | None = None, threads: int = 0, progress: Progress = None) -> NDArray[numpy.float32]:
        """The picture of shade() as (height, width, 4) of linear light, multiplied by alpha."""
    @property
    def normals(self) -> NDArray[numpy.float32]:
        """(height, width, 3) unit normals in the world; 0 where nothing is seen."""
    @property
    def ray_distance(self) -> NDArray[numpy.float32]:
        """Distance from the eye along the ray; inf where nothing is seen. In parallel projection as depth."""
    def layers(self, count: int, *, opacity: float = 1.0, threads: int = 0, progress: Progress = None) -> list[Visible]:
        """The nearest layers of the same view, 1 to 1024: the k-th holds the k-th nearest triangle at every sample. Nothing
        is seen behind opaque surfaces unless opacity is below 1. The first layer is the z-buffer's answer. shade() shows
        one with see_through="never"."""
    def account(self, *, canvas: float = 3.0, all_hiders: bool = False, threads: int = 0,
                progress: Progress = None) -> Accounting:
        """Shares of every object that are seen, hidden and beyond the frame, and its hiders. Needs a result of zbuffer().

        canvas: size of the area in which objects are counted alone, as a multiple of the picture's, 1 to 16. all_hiders: also
        finds hidden_by_any and hidden_only_by, in some ten times the time.
        """
    def report(self, *, threads: int = 0, progress: Progress = None) -> list[Explanation]:
        """Why each object is seen or not, by number; print(*seen.report(), sep="\\n") prints sentences."""
    def explain(self, object: int | str, *, threads: int = 0, progress: Progress = None) -> Explanation:
        """Why one object, a number or a name, is seen, or is not, and what to change."""
    def mask(self, object: int | str, *, part: MaskPart = "visible") -> NDArray[numpy.bool_]:
        """(height, width): True where an object is visible, or with "whole" would be visible alone."""
    def coco_runs(self, object: int | str, *, part: MaskPart = "visible") -> str:
        """A mask as COCO's compressed run lengths."""
    def coco_polygons(self, object: int | str, *, part: MaskPart = "visible") -> list[list[int]]:
        """A mask as polygons along the sides of pixels: x and y in turn, from the picture's top left."""
    def check_agreement(self, other: Visible, *, behind: Visible | None = None, threads: int = 0,
                        progress: Progress = None) -> Agreement:
        """Compares with the answer of another method for the same surfaces and view. Where they differ, exact arithmetic
        finds why both may be right, or that one is wrong. behind: other's second layer, for translucent surfaces."""
    def content_hash(self) -> int:
        """Equal for equal answers, on every machine; the number that `frontmost render --hash` prints."""

class Bitmap(numpy.ndarray[Any, numpy.dtype[numpy.uint8]]):
    """A picture: (height, width, 4) uint8, sRGB with straight alpha, rows from the top. It is NumPy's array, which shows
    itself in notebooks."""

class Environment:
    """Light from all directions, prepared once for many pictures.

    source: "studio", "sky", "none", the path of an equirectangular picture (.hdr, .exr, ...), or (height, 2 * height, 3)
    floats of linear light. Raises Error: bad_argument, file_unreadable, file_malformed.
    """
    def __init__(self, source: Path | ArrayLike, *, threads: int = 0, progress: Progress = None) -> None: ...
    @property
    def turns_with_camera(self) -> bool:
        """True for the studio, which keeps its direction relative to the camera."""

def save(image: ArrayLike | dict[str, Any], path: Path, *, format: ImageFormat | None = None, bits: int = 8,
         depth_scale: float | None = None, quality: int = 90) -> None:
    """Writes an image whole or not at all. The suffix decides the format: PNG, OpenEXR, PFM, NPY, JPEG, WebP.

    image: (height, width, 3 or 4) of uint8 (sRGB, straight alpha) or floats (linear light, multiplied by alpha); a bool mask
    (height, width), which becomes a black and white picture; or planes (height, width) by name, as files hold them:
    {"Z": seen.depth}, {"object": seen.object}, {"N.X": ..., ...}; bool masks become 0 and 1. bits: 8 or 16, of colours in
    PNG. depth_scale: PNG holds depth times this, rounded; None fits the range. quality: 1 to 100, of JPEG and WebP.
    Raises Error: file_unwritable, unsupported, limit_exceeded, bad_argument.
    """

def signed_ids(ids: NDArray[numpy.uint32], *, dtype: Literal["int32", "int64"] = "int64") -> NDArray[Any]:
    """Ids as signed numbers, for libraries without uint32: -1 where nothing is seen.

    torch.from_numpy(fm.signed_ids(seen.object)) shares the new array. Raises ValueError if an id does not fit into int32.
    """

def load_image(path: Path) -> dict[str, NDArray[Any]]:
    """Reads PNG, OpenEXR, PFM, NPY or HDR: a plane (height, width) of float32 or uint32 for each channel, by name.

    Colours are R, G, B, A: linear light, multiplied by alpha. Raises Error: file_unreadable, file_malformed, unsupported,
    limit_exceeded.
    """

class Hits:
    """The hits of rays: an element for each ray."""
    @property
    def primitive(self) -> NDArray[numpy.uint32]:
        """(n,) numbers of triangles; no_primitive where nothing is met."""
    @property
    def t(self) -> NDArray[numpy.float64]:
        """(n,): the hit is at origin + t * direction, or start + t * (end - start); inf where nothing is met."""
    @property
    def is_front(self) -> NDArray[numpy.bool_]:
        """(n,) True if the ray hit the side on which vertices are counter-clockwise."""
    @property
    def object(self) -> NDArray[numpy.uint32]:
        """(n,) numbers of objects; no_index where nothing is met."""
    @property
    def face(self) -> NDArray[numpy.uint32]:
        """(n,) as Visible.face; no_index where nothing is met."""
    def __len__(self) -> int: ...

class RayIndex:
    """A hierarchy of boxes over the triangles of surfaces, for any number of views and queries.

    Points and directions are (n, 3), or (3,) for all rays; they are relative to Scene.origin and rounded to float32. Queries
    see both sides of all triangles and are exact, without a tolerance; a ray through an edge hits its triangles. Rays that
    are not finite hit nothing. After Surfaces.move() queries raise Error until refit().
    """
    def __init__(self, surfaces: Surfaces, *, threads: int = 0, progress: Progress = None) -> None: ...
    def closest_hit(self, origins: ArrayLike, directions: ArrayLike | None = None, *, end: ArrayLike | None = None,
                    threads: int = 0, progress: Progress = None) -> Hits:
        """The nearest surface along each ray; with end in place of directions, between two points."""
    def all_hits(self, origins: ArrayLike, directions: ArrayLike, *,
                 progress: Progress = None) -> tuple[Hits, NDArray[numpy.uint64]]:
        """Every surface along each ray, nearest first: the hits of ray i are those from first[i] to first[i + 1]."""
    def is_clear(self, start: ArrayLike, end: ArrayLike, *, threads: int = 0,
                 progress: Progress = None) -> NDArray[numpy.bool_]:
        """(n,) True if no surface lies between two points: the line of sight."""
    def are_lit(self, primitives: ArrayLike, weights: ArrayLike, to_light: ArrayLike, *, threads: int = 0,
                progress: Progress = None) -> NDArray[numpy.bool_]:
        """(n,) True if a light at infinity reaches points of triangles.

        primitives: (n,) numbers of triangles. weights: (n, 3) of their vertices, of any sum. to_light: (3,). A triangle
        casts no shadow on itself.
        """
    def raycast(self, view: View, *, threads: int = 0, progress: Progress = None) -> Visible:
        """The answer of Surfaces.raycast(), with this index."""
    def scan(self, camera: RayCamera, *, threads: int = 0, progress: Progress = None) -> RangeScan:
        """Finds the nearest surface along the rays of a camera."""
    def refit(self, *, threads: int = 0) -> None:
        """Updates the index after Surfaces.move()."""
    @property
    def surfaces(self) -> Surfaces:
        """The surfaces of the index."""

class RayCamera:
    """A camera without an image plane, for rays only. pose: 4x4; None: the identity. Azimuths go from ahead to the right, elevations
    from the horizon upwards; ahead is -z of the "opengl" convention, which is the default here, +z of "opencv",
    +x of "robot". ranges: least and greatest, inclusive; a hit outside counts as none, and still hides
    surfaces behind it.
    Raises Error: bad_argument, limit_exceeded, singular_camera.
    """
    @staticmethod
    def panorama(width: int = 2048, height: int = 1024, *, pose: ArrayLike | None = None,
                 convention: Convention = "opengl", samples: int = 1) -> RayCamera:
        """All around, equirectangular: straight ahead is in the middle, straight up is the top."""
    @staticmethod
    def fisheye(width: int = 1024, height: int = 1024, *, fov: float = 180.0, pose: ArrayLike | None = None,
                convention: Convention = "opengl", samples: int = 1) -> RayCamera:
        """Equidistant. fov: degrees, where the circle touches the nearer sides."""
    @staticmethod
    def lidar(elevations: ArrayLike, steps: int = 1024, *, azimuths: ArrayLike = (0.0, 360.0),
              ranges: ArrayLike = ..., pose: ArrayLike | None = None,
              convention: Convention = "opengl") -> RayCamera:
        """A scanner that turns to the right: a row for each elevation (degrees), a column for each step of a turn.

        azimuths: degrees of the first step and of the last, to the right of ahead; a whole turn does not repeat its first
        ray; to the left where the last is less.
        """
    @staticmethod
    def pattern(directions: ArrayLike, *, ranges: ArrayLike = ..., pose: ArrayLike | None = None,
                convention: Convention = "opengl") -> RayCamera:
        """Any rays from one point: (n, 3) directions in the camera's space, x right, y up, -z ahead. One row."""
    def looking(self, eye: ArrayLike, target: ArrayLike, up: ArrayLike = (0, 1, 0)) -> RayCamera:
        """A copy of the camera at another eye, turned towards a target."""
    def pose(self, convention: Convention = "opengl") -> NDArray[numpy.float64]:
        """4x4, as panorama() takes it."""
    @property
    def samples(self) -> int:
        """Rays of a pixel."""
    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of its rays."""

class RangeScan:
    """The hits of a camera's rays, as planes of its shape, of the first sample."""
    @property
    def camera(self) -> RayCamera:
        """The camera of the rays."""
    @property
    def range(self) -> NDArray[numpy.float32]:
        """Distance along the ray; inf where nothing is met. No copy; not writable."""
    @property
    def primitive(self) -> NDArray[numpy.uint32]:
        """Numbers of triangles; no_primitive where nothing is met. No copy; not writable."""
    @property
    def object(self) -> NDArray[numpy.uint32]:
        """Numbers of objects; no_index where nothing is met."""
    @property
    def material(self) -> NDArray[numpy.uint32]:
        """Numbers of materials; no_index where nothing is met, or none is set."""
    @property
    def depth(self) -> NDArray[numpy.float32]:
        """Distance along the viewing axis; inf where nothing is met, and for rays that do not lead ahead."""
    @property
    def points(self) -> NDArray[numpy.float64]:
        """(rows, columns, 3): points where rays hit surfaces, in the world; NaN where a ray hits nothing."""
    @property
    def robot_points(self) -> NDArray[numpy.float64]:
        """Hit points in the scanner's own axes: x ahead, y left, z up."""
    @property
    def incidence(self) -> NDArray[numpy.float32]:
        """Degrees between the ray and the surface's normal: 0 head-on; NaN where nothing is met."""
    def shade(self, *, shading: Shading = "lit", background: ArrayLike | None = (1.0, 1.0, 1.0),
              shadows: Literal["off", "map", "rays"] = "map", opacity: float = 1.0,
              see_through: Literal["where_needed", "always", "never"] = "where_needed", grid: int = 0,
              lights: Literal["key", "file", "both", "none"] = "key", ambient_occlusion: float | None = None,
              ambient_occlusion_radius: float | None = None, blend: Literal["linear", "srgb"] = "linear",
              environment: Environment | Path | None = None, environment_angle: float = 0.0,
              shows_environment: bool = False, exposure: float = 0.0,
              tone_mapping: Literal["none", "aces", "khronos"] = "none", light_direction: ArrayLike | None = None,
              light_intensity: float | None = None, threads: int = 0, progress: Progress = None) -> Bitmap:
        """A picture of panoramas and fisheyes; options are those of Visible.shade()."""
    def shade_linear(self, *, shading: Shading = "lit", background: ArrayLike | None = (1.0, 1.0, 1.0),
                     shadows: Literal["off", "map", "rays"] = "map", opacity: float = 1.0,
                     see_through: Literal["where_needed", "always", "never"] = "where_needed", grid: int = 0,
                     lights: Literal["key", "file", "both", "none"] = "key", ambient_occlusion: float | None = None,
                     ambient_occlusion_radius: float | None = None, blend: Literal["linear", "srgb"] = "linear",
                     environment: Environment | Path | None = None, environment_angle: float = 0.0,
                     shows_environment: bool = False, exposure: float = 0.0,
                     tone_mapping: Literal["none", "aces", "khronos"] = "none", light_direction: ArrayLike | None = None,
                     light_intensity: float | None = None, threads: int = 0, progress: Progress = None) -> NDArray[numpy.float32]:
        """The picture of shade() as (height, width, 4) of linear light, multiplied by alpha."""

def ring_elevations(rings: int, lowest: float, highest: float) -> NDArray[numpy.float64]:
    """Elevations of so many rings, evenly from highest down to lowest; degrees."""

class Fragments:
    """The coverage of each triangle in each pixel, nearer first. Arrays are views without a copy; not writable."""
    @property
    def rows(self) -> NDArray[Any]:
        """(n,) records: mask (a bit for each sub-sample), primitive, key, key_dx, key_dy, opacity."""
    @property
    def first(self) -> NDArray[numpy.uint64]:
        """(height * width + 1,): the fragments of pixel i, counted row by row, are rows[first[i]:first[i + 1]]."""
    @property
    def samples(self) -> NDArray[numpy.int32]:
        """(sub-samples, 2): positions in 1/256 pixel from the pixel's top left corner."""
    def at(self, x: int, y: int) -> NDArray[Any]:
        """The fragments of a pixel: its part of rows."""
    def __len__(self) -> int: ...

class PaintOrder:
    """Polygons in the order of painting: where two overlap, the later one is in front. Every access makes a new array."""
    @property
    def polygons(self) -> NDArray[Any]:
        """(n,) records: primitive, of which the polygon is all or a convex piece; first_corner and corner_count, in corners."""
    @property
    def corners(self) -> NDArray[numpy.float64]:
        """(m, 3): x and y in pixels of the view, and the planar depth; counter-clockwise on the screen."""
    @property
    def is_cut(self) -> NDArray[numpy.bool_]:
        """(m,) whether the side from this corner on is a cut, and no edge of the triangle."""
    @property
    def steps(self) -> dict[str, int]:
        """The number of pairs that each test decided, and the numbers of exchanges, cycles and cuts."""
    def paint(self) -> Visible:
        """The visible polygons at the samples of the z-buffer, painted one over the other. Raises Error if objects were moved
        since the order was made."""
    def visible_parts(self, *, threads: int = 0, progress: Progress = None) -> VisibleParts:
        """The visible parts of the polygons, as convex polygons in the same order. All polygons count as opaque."""
    def __len__(self) -> int: ...

class VisibleParts:
    """The visible parts of a PaintOrder: convex polygons within the picture, in the same order, without overlaps."""
    @property
    def polygons(self) -> NDArray[Any]:
        """Records like those of PaintOrder.polygons."""
    @property
    def corners(self) -> NDArray[numpy.float64]:
        """Corners like those of PaintOrder.corners."""
    @property
    def is_cut(self) -> NDArray[numpy.bool_]:
        """Cut sides like those of PaintOrder.is_cut."""
    def __len__(self) -> int: ...

class Section:
    """The half of a scene behind a cutting plane."""
    @property
    def scene(self) -> Scene:
        """Objects with their numbers and names, in world space. Closed objects stay closed: the cut is filled."""
    @property
    def faces(self) -> NDArray[Any]:
        """(n,) records of cut objects: object; material, which only the filling has; area, without holes; open_count, the number
        of outlines that do not close."""
    @property
    def outlines(self) -> list[list[NDArray[numpy.float32]]]:
        """For each row of faces its closed outlines, (k, 3) in world space, clockwise around holes. No copy; not writable."""

class Occlusion:
    """Finds for many views the objects that are certainly hidden, also between the samples of every picture.

    unit: the objects: "instances", their connected "parts", or "clusters" of up to 128 triangles. The next cull() follows
    Surfaces.move().
    """
    def __init__(self, surfaces: Surfaces, *, unit: ObjectUnit = "instances", threads: int = 0,
                 progress: Progress = None) -> None: ...
    def cull(self, view: View, *, cell: int = 2, threads: int = 0, progress: Progress = None) -> NDArray[numpy.uint8]:
        """(n,) by object: object_sights[...], 0 outside the view, 1 hidden, 2 may be seen.

        cell: side of the screen cells that objects cover, 1 to 64 pixels; smaller cells find more hidden objects.
        """
    def is_hidden(self, boxes: ArrayLike) -> NDArray[numpy.bool_]:
        """(n,) whether everything within a box is certainly hidden in the view of the last cull(), for things that are not in
        the scene. boxes: (n, 2, 3) low and high corners in world space. True before the first cull()."""
    @property
    def object(self) -> NDArray[numpy.uint32]:
        """(n,) by object: number of its object in the scene."""
    @property
    def part(self) -> NDArray[numpy.uint32]:
        """(n,) by object: number of the part or cluster within the object of the scene."""
    def triangles(self, number: int) -> NDArray[numpy.uint32]:
        """Rows of Mesh.faces that an object consists of."""
    @property
    def surfaces(self) -> Surfaces:
        """The surfaces that were given."""
    def __len__(self) -> int: ...

class Agreement:
    """How far two answers agree."""
    @property
    def counts(self) -> dict[DifferenceKind, int]:
        """Numbers of samples by reason: "none", both answers are equal; "edge", a triangle's edge passes within 1/128 pixel;
        "depth", two depths are closer than floats resolve; "translucent", one answer looks through a surface that the other
        shows; "unexplained", one answer is wrong."""
    @property
    def differing(self) -> int:
        """Samples at which the answers differ, for any reason."""
    @property
    def differences(self) -> NDArray[numpy.uint8]:
        """(samples, height, width): difference_kinds[...]. No copy; not writable."""

class DepthSetup:
    """A depth buffer's planes and format, which decide its precision. Distances are planar arrays; answers have their shape.

    reversed: depth 1 at the near plane, 0 at the far plane. Raises Error bad_argument, also for distances outside near to
    far.
    """
    def __init__(self, near: float, far: float, *, format: DepthFormat = "d24", reversed: bool = False,
                 orthographic: bool = False) -> None: ...
    @property
    def near(self) -> float:
        """The distance of the near plane."""
    @property
    def far(self) -> float:
        """The distance of the far plane; may be infinite."""
    @property
    def format(self) -> DepthFormat:
        """The format of stored depths."""
    @property
    def reversed(self) -> bool:
        """Whether the near plane has depth 1."""
    @property
    def orthographic(self) -> bool:
        """Whether the projection is parallel."""
    def resolvable_gap(self, distance: ArrayLike) -> Any:
        """The smallest gap behind a distance that the format resolves; inf if it resolves none."""
    def rounding_gap(self, distance: ArrayLike, reach: float | None = None) -> Any:
        """The gap that floats of positions and transforms add. reach: greatest distance of vertices from the eye and the
        origin; None: twice the distance."""
    def certain_gap(self, distance: ArrayLike, reach: float | None = None) -> Any:
        """The sum of resolvable_gap() and rounding_gap(): every picture resolves this gap at every pixel, between surfaces that
        face the eye."""
    def share_of_values(self, distance: ArrayLike) -> Any:
        """The share of the format's values between the near plane and a distance, 0 to 1."""
    def near_for_gap(self, distance: float, gap: float) -> float | None:
        """The smallest near distance that resolves a gap at a distance; 0: any near distance does; None: none does."""
    def round_distances(self) -> NDArray[numpy.float64]:
        """The distances of both planes, and 1, 2, 5, 10, 20, ... between them, for tables."""

class ExactVisible:
    """The nearest triangle of every sample, decided without rounding."""
    @property
    def view(self) -> View:
        """The view that was given."""
    @property
    def primitives(self) -> NDArray[numpy.uint32]:
        """(samples, height, width): the nearest triangle, the lowest number of several. No copy; not writable."""
    @property
    def tied(self) -> NDArray[numpy.bool_]:
        """(samples, height, width): whether another triangle is exactly as near. No copy; not writable."""
    def find_depth_fights(self, answer: Visible, *, threads: int = 0, progress: Progress = None) -> DepthFights:
        """The samples at which an answer, such as DepthBuffer.visible(), does not show the nearest triangle."""
    def try_remedies(self, setup: DepthSetup, *, threads: int = 0,
                     progress: Progress = None) -> list[tuple[DepthSetup, int]]:
        """Other depth buffers with fewer wrong samples in this view, and the number of these samples, found by drawing: fitted
        planes, 24 bits, reversed floats; the list ends at the first without wrong samples."""

class DepthFights:
    """Samples at which an answer shows a surface that is not the nearest."""
    @property
    def view(self) -> View:
        """The view that was given."""
    @property
    def covered(self) -> int:
        """Samples that see a surface."""
    @property
    def wrong(self) -> int:
        """Samples at which the answer shows a farther surface, or none."""
    @property
    def tied(self) -> int:
        """Samples at which several surfaces are exactly nearest, so that no answer is wrong."""
    @property
    def pairs(self) -> NDArray[Any]:
        """(n,) records, most samples first: seen, nearer (numbers of objects; no_index: nothing), samples; farthest, the
        greatest distance of the seen object behind the nearer one."""
    @property
    def errors(self) -> NDArray[numpy.float32]:
        """(samples, height, width): distance of the shown surface behind the nearest, as a share of the nearest's distance; 0
        where the answer is right, inf where it shows nothing. No copy; not writable."""
    def image(self, *, threads: int = 0, progress: Progress = None) -> Bitmap:
        """A map over the model in grey: violet (an error of a millionth of the distance) through red to yellow (a tenth), light
        blue where the answer shows nothing."""

class FightAreas:
    """Areas of the picture in which a depth buffer may show the wrong face of two."""
    @property
    def view(self) -> View:
        """The view that was given."""
    @property
    def setup(self) -> DepthSetup:
        """The depth buffer that was given."""
    @property
    def faces(self) -> NDArray[Any]:
        """(n,) records: first and second, numbers of triangles; kind, fight_kinds[...]; area and visible_area in square
        pixels; distance, the planar depth of the nearest point."""
    @property
    def polygons(self) -> list[NDArray[numpy.float64]]:
        """For each row of faces its area: (k, 2) corners in pixels, convex. No copy; not writable."""
    @property
    def objects(self) -> NDArray[Any]:
        """(m,) records, the greatest visible area first: first and second, numbers of objects; kind; areas, their number; area and
        visible_area of their union; distance; gap, the smallest that the format resolves there."""
    def find_offset(self, exact: ExactVisible, pair: int, *, threads: int = 0,
                    progress: Progress = None) -> tuple[int, float, float] | None:
        """The least polygon offset that ends the fights of a row of objects: (object, factor, units), found by drawing; None if no
        offset does. exact: an ExactVisible of the same view."""
    def __len__(self) -> int: ...

def write_coco(path: Path, seen: Visible | Iterable[Visible], *, names: Iterable[str] | None = None,
               polygons: bool = False, leave_out: Sequence[str] = [], canvas: float = 3.0, threads: int = 0,
               progress: Progress = None) -> list[str]:
    """Writes COCO annotations of one view, or of all views of an iterable, like `frontmost report --coco`.

    A generator keeps one Visible in memory at a time. names: "file_name" of each picture; None: the scene's name and the
    view's number from 0. polygons: masks as polygons, not as run lengths. leave_out: names of objects or categories without
    annotations; they still hide other objects. canvas: see account(). Returns the paths of the files.
    Raises Error: file_unwritable, unsupported, bad_argument.
    """

def write_bop(folder: Path, seen: Visible | Iterable[Visible], *, visible: Literal["exact", "bop19"] = "exact",
              leave_out: Sequence[str] = [], canvas: float = 3.0, threads: int = 0,
              progress: Progress = None) -> list[str]:
    """Writes a BOP scene, like `frontmost report --bop`: poses, shares, masks and depths, an image for each view.

    All files appear when all views are done; after an error none does. visible: the samples that count as visible; the other
    arguments are those of write_coco().
    """

def write_masks(folder: Path, seen: Visible | Iterable[Visible], *, leave_out: Sequence[str] = [], threads: int = 0,
                progress: Progress = None) -> list[str]:
    """Writes two masks (PNG) of every object in the picture, like `frontmost report --masks`.

    Object 3 has "000003_visible.png" and "000003_amodal.png"; for an iterable the view's number precedes these names.
    """

class Accounting:
    """Exact counts of the samples of every object: arrays with an element for each object."""
    @property
    def alone(self) -> NDArray[numpy.uint64]:
        """Samples that the object alone covers on the canvas."""
    @property
    def in_frame(self) -> NDArray[numpy.uint64]:
        """Samples of alone within the picture."""
    @property
    def visible(self) -> NDArray[numpy.uint64]:
        """Samples of in_frame at which the object is seen."""
    @property
    def alone_boxes(self) -> NDArray[numpy.int32]:
        """(n, 4): x, y, width, height in pixels around the samples of alone; x and y are negative left of the picture and above."""
    @property
    def in_frame_boxes(self) -> NDArray[numpy.int32]:
        """(n, 4): the box around the samples of in_frame."""
    @property
    def visible_boxes(self) -> NDArray[numpy.int32]:
        """(n, 4): the box around the samples of visible."""
    @property
    def visible_share(self) -> NDArray[numpy.float64]:
        """Share of alone that is visible. The three shares add up to 1, or are 0 if the object covers no sample."""
    @property
    def hidden_share(self) -> NDArray[numpy.float64]:
        """Share of alone that is in frame, and hidden by other objects."""
    @property
    def cut_share(self) -> NDArray[numpy.float64]:
        """Share of alone outside the frame."""
    @property
    def distance(self) -> NDArray[numpy.float32]:
        """Planar distance of the nearest visible sample; inf if none is visible."""
    @property
    def is_cut_by_near(self) -> NDArray[numpy.bool_]:
        """Whether the object reaches across the near plane."""
    @property
    def background(self) -> int:
        """Samples that see nothing."""
    @property
    def hidden_by_front(self) -> NDArray[numpy.uint64]:
        """(m, 3): object, hider, number of in-frame samples of the object at which the hider is seen."""
    @property
    def hidden_by_any(self) -> NDArray[numpy.uint64]:
        """(m, 3): object, hider, number of samples at which the hider is nearer, seen or not. Needs all_hiders."""
    @property
    def hidden_only_by(self) -> NDArray[numpy.uint64]:
        """(m, 3): object, hider, number of samples at which only this hider is nearer. Needs all_hiders."""
    def __len__(self) -> int: ...

class Explanation:
    """The reason why an object is seen or not. str() gives a sentence."""
    @property
    def object(self) -> int:
        """The number of the object."""
    @property
    def reason(self) -> Reason:
        """The reason as one word."""
    @property
    def visible_share(self) -> float:
        """Accounting.visible_share of the object."""
    @property
    def hidden_share(self) -> float:
        """Accounting.hidden_share of the object."""
    @property
    def cut_share(self) -> float:
        """Accounting.cut_share of the object."""
    @property
    def hiders(self) -> list[tuple[int, float]]:
        """Pairs of a hider and its share of the object's samples in frame; the greatest share first."""
    @property
    def remedy(self) -> str:
        """The change that would show the object; empty if there is none."""
    def remedied(self, view: View) -> View:
        """The view with the remedy applied; unchanged if the remedy changes the scene."""

class DepthBuffer:
    """A depth buffer with OpenGL's state: triangles are drawn in the order of their numbers, depths are rounded to format.

    Takes 12 bytes a sample, cleared to 1. Surfaces.zbuffer() finds the nearest surfaces faster; use DepthBuffer for effects of
    order, format or state. Raises Error: bad_argument, limit_exceeded.
    """
    def __init__(self, width: int, height: int, *, samples: int = 1, format: DepthFormat = "d24") -> None: ...
    def clear(self, depth: float = 1.0) -> None:
        """Removes all drawn triangles, and stores a depth in every sample."""
    def draw(self, surfaces: Surfaces, view: View, *, func: DepthFunc = "less", mask: bool = True,
             range: tuple[float, float] = (0.0, 1.0), nearer_is_greater: bool = False,
             polygon_offset: tuple[float, float] = (0.0, 0.0), offset_clamp: float = 0.0, begin: int = 0,
             end: int = 4294967295, threads: int = 0, progress: Progress = None) -> None:
        """One draw call for the triangles from begin up to end, on top of earlier calls.

        func: glDepthFunc. mask: glDepthMask. range: glDepthRange. nearer_is_greater: the near plane maps to the end of
        the range (reversed z): compare with "greater" and clear to 0. polygon_offset: factor and units of
        glPolygonOffset; offset_clamp: glPolygonOffsetClamp. Raises Error if other surfaces were drawn since clear().
        """
    @property
    def stored(self) -> NDArray[numpy.uint32]:
        """(samples, height, width): the stored bits; a copy."""
    @property
    def depths(self) -> NDArray[numpy.float32]:
        """(samples, height, width): stored depths from 0 to 1, as glReadPixels returns them."""
    def visible(self) -> Visible:
        """The triangle of the last fragment that passed at every sample; a copy. Raises Error before anything is drawn. If the
        scene has glass, shade(see_through="never") shows the triangles as they were drawn."""

class Drawing:
    """Feature edges, divided into parts that are wholly seen or wholly hidden. Notebooks display the drawing. Arrays have an
    element for each part, in the order of edges; every access makes a new array."""
    def sheet(self, *, hidden: Hidden = "none", style: Style = "figure") -> Sheet:
        """The lines on a page as large as the view, at 96 pixels to an inch, for files and notebooks."""
    def draw_over(self, picture: ArrayLike, *, width: float = 1.2, color: ArrayLike = (0.1, 0.1, 0.1),
                  blend: Literal["linear", "srgb"] = "linear", threads: int = 0, progress: Progress = None) -> Bitmap:
        """A picture of the same view with the seen edges over it.

        picture: what Visible.shade_linear() returns, with the size of the view. width: pixels, 0.1 to 1000. color: sRGB,
        0 to 1. frontmost render --edges draws the edges of draw_lines(view, ripples=False). Raises Error bad_argument
        for values out of range, ValueError for a picture of another size.
        """
    @property
    def view(self) -> View:
        """The view that was given."""
    @property
    def segments(self) -> NDArray[numpy.float64]:
        """(n, 2, 2) ends in pixels of the view: x right, y down, the first pixel's centre at (0.5, 0.5)."""
    @property
    def edge(self) -> NDArray[numpy.uint32]:
        """(n,) by part: its row of edges."""
    @property
    def kind(self) -> NDArray[numpy.uint8]:
        """(n,) by part: the reason why it is drawn, edge_kinds[kind]."""
    @property
    def hidden_by(self) -> NDArray[numpy.uint32]:
        """(n,) by part: the number of surfaces in front of it; without counts_hidden 0 or 1."""
    @property
    def is_seen(self) -> NDArray[numpy.bool_]:
        """(n,) by part: whether it is visible."""
    @property
    def is_outline(self) -> NDArray[numpy.bool_]:
        """(n,) by part: whether one of its sides shows the background. Needs outlines."""
    @property
    def span(self) -> NDArray[numpy.float64]:
        """(n, 2) by part: its begin and end on its edge, 0 to 1."""
    @property
    def edges(self) -> NDArray[numpy.float64]:
        """(m, 2, 3) ends of edges in world space."""
    @property
    def edge_primitives(self) -> NDArray[numpy.uint32]:
        """(m, 2) by edge: two of its triangles; no_primitive for the second if there is only one."""
    def __len__(self) -> int: ...

class Sheet:
    """A page of lines. Notebooks display it."""
    def save(self, path: Path) -> None:
        """Writes .svg, .pdf, .dxf or .json, whole or not at all."""
    @property
    def svg(self) -> str:
        """The page as SVG."""
    @property
    def scale(self) -> float | None:
        """Length on paper divided by length of the model; None in perspective."""
    @property
    def size(self) -> tuple[float, float]:
        """Width and height in millimetres."""
    @property
    def left_out(self) -> int:
        """Number of diameters, radii, widths across flats, positions and steps without room."""
    @property
    def undrawn(self) -> int:
        """Number of cylinders without a diameter: no view along the cylinder's axis shows the cylinder, and no view from the
        side states its diameter."""
    @property
    def prisms(self) -> int:
        """Number of cylinders of 7 to 17 sides, which count as prisms and have no diameter."""
    @property
    def covered(self) -> int:
        """Number of strokes left out by plot because they lie in the ink of longer strokes."""

class Figure:
    """A picture of polygons, filled one after the other. Notebooks display it."""
    def save(self, path: Path) -> None:
        """Writes .svg or .pdf, whole or not at all."""
    @property
    def svg(self) -> str:
        """The figure as SVG."""
    @property
    def polygons(self) -> list[list[NDArray[numpy.float64]]]:
        """By shape: its outlines, (k, 2) in pixels, filled by the nonzero rule. No copy; not writable."""
    @property
    def colors(self) -> NDArray[numpy.uint8]:
        """(n, 4) by shape: RGBA of 8 bits."""
    def __len__(self) -> int: ...
