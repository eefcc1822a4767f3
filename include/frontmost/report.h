// SPDX-License-Identifier: Apache-2.0
// Reports: the contents of a scene and the defects of its meshes; how much of each object is seen, and what hides it.
//
// Model files often have holes, duplicate faces and faces that are inside out, which matters to printers, solvers and
// drawings. Counts compare positions of vertices as they are stored, without a tolerance, so all programs can agree:
//
//    +---+---+     an edge of two triangles joins them to a shell
//    | / | / |     an edge of one triangle is a boundary: the rim of a hole
//    +---+---+     an edge of three or more triangles is not manifold
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "frontmost/base.h"
#include "frontmost/scene.h"
#include "frontmost/view.h"

namespace frontmost {

/// Defects of a mesh. Vertices count as one if their positions are equal (bit for bit, except that +0 equals -0),
/// whatever their numbers. Nothing is rounded; no tolerance is used.
struct Oddities {
  std::uint64_t non_finite_triangles = 0;  ///< with a NaN or infinite coordinate; not counted in anything below
  std::uint64_t degenerate_triangles = 0;  ///< area exactly zero: vertices repeated, or on one line
  std::uint64_t duplicate_triangles = 0;   ///< with the three vertices of an earlier triangle, in any order
  // Edges of all triangles with three different vertices.
  std::uint64_t boundary_edges = 0;      ///< edges of one triangle
  std::uint64_t non_manifold_edges = 0;  ///< edges of more than two triangles
  std::uint64_t inconsistent_edges = 0;  ///< edges that two triangles run along the same way: one is inside out

  [[nodiscard]] bool any() const {
    return (non_finite_triangles | degenerate_triangles | duplicate_triangles | boundary_edges | non_manifold_edges |
            inconsistent_edges) != 0;
  }
  friend bool operator==(const Oddities&, const Oddities&) = default;
};

/// Number of triangles of one material.
struct MaterialUse {
  std::uint32_t material = no_index;
  std::uint64_t triangles = 0;
};

struct MeshReport {
  std::string name;
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;   ///< number of vertices as stored
  std::uint64_t positions = 0;  ///< number of different finite positions that triangles use
  std::uint64_t faces = 0;      ///< number of polygons in the file
  bool has_normals = false, has_texcoords = false, has_colors = false;
  std::vector<MaterialUse> materials;  ///< by number; the default material (no_index) last
  Oddities odd;
  std::uint64_t pieces = 0;  ///< number of parts connected at least by a vertex
  std::uint64_t shells = 0;  ///< number of parts connected by edges; at least `pieces`
  bool closed = false;       ///< has triangles and no boundary edge
  /// Number of handles of all shells together. None unless the mesh is closed and has neither non-manifold nor
  /// inconsistent edges.
  std::optional<std::uint64_t> genus;
};

/// One instance of the scene.
struct ObjectReport {
  std::string name;
  std::uint32_t mesh = no_index;
  std::uint64_t triangles = 0;
  Box bounds;       ///< world space, of the finite triangles
  double area = 0;  ///< world space, of the finite triangles
  /// Volume in world space. None if the mesh has no genus. Shells that are wound the other way count as hollows and are
  /// subtracted.
  std::optional<double> volume;
};

struct MaterialReport {
  std::string name;
  std::uint64_t triangles = 0;  ///< sum over all instances
  std::uint32_t textures = 0;   ///< number of texture maps
  Material::Alpha alpha = Material::Alpha::opaque;
  bool double_sided = false;
};

struct CameraReport {
  std::string name;
  glm::dvec3 position{0}, direction{0, 0, -1}, up{0, 1, 0};  ///< world space; unit directions
  bool orthographic = false;
  double vertical = 0;  ///< radians, or height, as in Camera
};

/// A light of the scene, placed in the world.
struct LightReport {
  std::string name;
  Light::Kind kind = Light::Kind::point;
  glm::dvec3 position{0}, direction{0, 0, -1};  ///< world space; unit direction of its light
  glm::vec3 color{1};
  double intensity = 0;                   ///< lux or candela, as in Light
  std::optional<double> range;            ///< point lights and spots
  double inner_cone = 0, outer_cone = 0;  ///< radians, spots
};

struct SceneReport {
  std::string name;
  Axis up = Axis::y;
  std::uint64_t triangles = 0;         ///< sum over all instances
  std::uint64_t stored_triangles = 0;  ///< sum over all meshes
  std::uint64_t vertices = 0;          ///< stored vertices, sum over all meshes
  std::uint64_t texture_count = 0;
  glm::dvec3 origin{0};          ///< Scene::origin, to which world space is relative
  Box bounds;                    ///< world space
  double area = 0;               ///< sum over all objects
  std::optional<double> volume;  ///< sum over the objects that have a volume; none if no object has one
  /// Greatest rounding error of a vertex, because positions are floats: half a float step at the farthest coordinate.
  double rounding = 0;
  std::vector<MeshReport> meshes;
  std::vector<ObjectReport> objects;
  std::vector<MaterialReport> materials;
  std::vector<CameraReport> cameras;
  std::vector<LightReport> lights;
  Oddities odd;  ///< sum over meshes, each counted once
  std::vector<std::string> warnings;
};

/// Examines a scene. O(stored triangles * log + triangles over all instances), in parallel; about 100 bytes a triangle
/// of the largest mesh while it runs. The result is the same for any number of threads.
/// \throws Error as validate(scene) does, and limit_exceeded for a mesh of more than 2^29 triangles.
[[nodiscard]] SceneReport inspect(const Scene& scene, const Execution& execution = {});

/// Likely units of a model's coordinates, in metres, guessed from the greatest extent e of its bounds. Millimetres if e
/// is from 5 to 2000: the size of parts and prints. Metres if e is below 1, because in millimetres the model would be a
/// grain of sand. Centimetres, inches and metres if e is from 1 to 5. None if e is below 0.001 or above 2000, or the
/// box is empty. Files that state their unit need no guess: SceneSource::metres_per_unit.
[[nodiscard]] std::vector<double> likely_units(const Box& bounds);

// Accounting: how much of each object is seen, how much lies beyond the frame, and which objects hide the rest.
//
//    canvas  +- - - - - - - - - - - +
//              +-------------+              alone      all samples that the object covers if nothing else is there
//            | |frame   #####|%%%%  |       in frame   the part of these within the picture: # and =
//              |   wall=#####|%%%           visible    the samples that see the object: #
//            | |       ======|%%%%  |       hidden     in frame but not visible: =, by the wall
//              +-------------+              cut        beyond the frame: %
//            + - - - - - - - - - - - +
//
// An object is an instance of the scene. Samples are counted exactly: an object covers alone what zbuffer() would show.

/// Pixels [x, x + width) x [y, y + height) from the picture's top left; x and y may be negative beyond the picture.
struct PixelBox {
  int x = 0, y = 0, width = 0, height = 0;

  [[nodiscard]] bool is_empty() const { return width == 0; }
  friend bool operator==(const PixelBox&, const PixelBox&) = default;
};

/// A number of samples, and the smallest box around their pixels; empty if there are none.
struct SampleSet {
  std::uint64_t count = 0;
  PixelBox box;

  friend bool operator==(const SampleSet&, const SampleSet&) = default;
};

/// Samples of one instance in one view. The three shares add up to 1; all are 0 if the object covers no sample.
struct ObjectAccount {
  SampleSet alone;     ///< samples that the object covers alone, on the canvas
  SampleSet in_frame;  ///< the part of `alone` within the picture
  SampleSet visible;   ///< the part of `in_frame` that nothing hides
  /// Planar distance of the nearest visible sample, as in depths_of(); +inf if none is visible.
  float distance = std::numeric_limits<float>::infinity();
  /// Mean position of the visible samples, in pixels from the picture's top left corner; 0 if none is visible.
  glm::dvec2 centroid{0};
  /// True: the object reaches across the near plane. Its part in front of the plane is counted nowhere.
  bool is_cut_by_near = false;

  [[nodiscard]] double visible_share() const { return share(visible.count); }
  [[nodiscard]] double hidden_share() const { return share(in_frame.count - visible.count); }
  [[nodiscard]] double cut_share() const { return share(alone.count - in_frame.count); }

 private:
  [[nodiscard]] double share(std::uint64_t count) const {
    return alone.count == 0 ? 0 : double(count) / double(alone.count);
  }
};

/// Number of samples at which one object hides another.
struct HiddenSamples {
  std::uint32_t object = no_index;  ///< the hidden instance
  std::uint32_t hider = no_index;
  std::uint64_t count = 0;  ///< at least 1

  friend bool operator==(const HiddenSamples&, const HiddenSamples&) = default;
};

struct AccountingOptions {
  /// Size of the canvas on which objects are counted alone, as a multiple of the picture, 1 to 16; the picture lies in
  /// its middle. 1: the picture itself, so that no object is cut. 3, as in BOP: room for any object that is no larger
  /// than the picture and half in it. Rounded down to whole pixels on each side, and at most 16384 pixels wide or high.
  double canvas = 3;
  /// True: hidden_by_any and hidden_only_by are found, too. This takes some ten times as long, and 20 MiB or more.
  bool all_hiders = false;
};

struct Accounting {
  PixelBox canvas;                     ///< pixels on which objects were counted alone
  std::vector<ObjectAccount> objects;  ///< by instance
  std::uint64_t background = 0;        ///< samples that see nothing; together with all visible samples, the picture's
  /// Samples in frame that see `hider` in place of `object`; by object, then by hider. They add up to the hidden ones.
  std::vector<HiddenSamples> hidden_by_front;
  /// Samples in frame at which `hider` is in front of `object`, even if others are as well; in the same order. Empty
  /// unless AccountingOptions::all_hiders.
  std::vector<HiddenSamples> hidden_by_any;
  /// Samples at which only `hider` is in front of `object`: they appear when `hider` is removed. Empty unless
  /// AccountingOptions::all_hiders.
  std::vector<HiddenSamples> hidden_only_by;
};

/// Accounts for every object in a view. `visible` is the answer of zbuffer() or a ZBuffer for these surfaces; with
/// other methods, which do not snap vertices, sums hold only approximately. The result is the same for any number of
/// threads and every instruction set. O(triangles + rows of pixels that each object touches + samples);
/// memory: 8 bytes a run of samples that see the same object, and a bit for each sample of the canvas and thread.
/// \throws Error bad_argument as validate(view) does, for a canvas out of range, and for a `visible` of other surfaces.
[[nodiscard]] Accounting account(const Surfaces& surfaces, const Visible& visible,
                                 const AccountingOptions& options = {}, const Execution& execution = {});

/// The order in which objects hide each other. An object comes before those that it hides, unless they form a cycle.
struct HidingOrder {
  /// By object: 0 if nothing hides it, else one more than the greatest rank of its hiders. A cycle has one rank.
  std::vector<std::uint32_t> ranks;
  /// Cycles: objects that hide each other in a ring. Each list holds all objects connected by rings, ascending; lists
  /// are ordered by their first object. All other objects have an order among each other.
  std::vector<std::vector<std::uint32_t>> cycles;
};

/// Finds the hiding order of `object_count` objects from pairs such as Accounting::hidden_by_front. O(objects + pairs *
/// log). Source: R. Tarjan. Depth-First Search and Linear Graph Algorithms. 1972.
/// \throws Error bad_argument for a pair of equal objects, or of numbers that are not below `object_count`.
[[nodiscard]] HidingOrder find_hiding_order(std::size_t object_count, std::span<const HiddenSamples> pairs);

// Masks of objects, as pixels, run lengths and polygons.

enum class MaskPixel : std::uint8_t { outside, hidden, visible };

/// The mask of one object in a picture, by the first sample of each pixel.
struct PixelMask {
  PixelBox box;              ///< the smallest box around the pixels that are not `outside`
  Buffer<MaskPixel> pixels;  ///< pixels of the box, rows from the top

  /// The value at a pixel of the picture.
  [[nodiscard]] MaskPixel at(int x, int y) const {
    x -= box.x, y -= box.y;
    if (x < 0 || y < 0 || x >= box.width || y >= box.height) return MaskPixel::outside;
    return pixels[std::size_t(y) * std::size_t(box.width) + std::size_t(x)];
  }
};

/// The pixels of a mask that count: visible ones, or visible and hidden ones.
enum class MaskPart : std::uint8_t { visible, whole };

/// A mask as COCO's compressed run lengths, in a picture of `size`, as COCO's mask API writes them. Runs of 0 and 1
/// alternate along the columns, from the leftmost column on, each column from the top. O(pixels of the box). Source:
/// T.-Y. Lin et al. Microsoft COCO: Common Objects in Context. 2014.
[[nodiscard]] std::string coco_runs(const PixelMask& mask, MaskPart part, const glm::ivec2& size);
/// A mask as polygons along the sides of pixels: alternating x and y, in pixels from the picture's top left. They do
/// not overlap, have no holes, and fill the mask exactly, also by the rule of COCO's mask API. O(pixels of the box).
[[nodiscard]] std::vector<std::vector<int>> coco_polygons(const PixelMask& mask, MaskPart part);

/// Makes the masks of one object after another. Borrows its arguments; not for several threads at once.
class PixelMasks {
 public:
  /// `visible` is the answer of zbuffer() or a ZBuffer for these surfaces. O(samples); a bit for each sample of the
  /// picture. \throws Error bad_argument as account() does.
  PixelMasks(const Surfaces& surfaces, const Visible& visible, const Execution& execution = {});
  ~PixelMasks();
  PixelMasks(const PixelMasks&) = delete;
  PixelMasks& operator=(const PixelMasks&) = delete;

  /// The mask of an instance. With one sample a pixel, its numbers of visible and hidden pixels are those of account().
  /// O(triangles of the object + pixels of its box). Precondition: `object` is an instance of the scene.
  [[nodiscard]] PixelMask of(std::uint32_t object);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// Explanations: why an object is seen, or is not. An explanation has one reason, its numbers, a remedy, and a sentence.
//
//                       far -+---------------------+-         Each triangle is counted once: at the first reason of
//             left            \   beyond far      /           the list that holds for all of the triangle. An object
//       .-.                    \                 /            has the last reason that any of its triangles has,
//       '-' outside             \    in view    /             since only that one kept it from being seen. Triangles
//                                \    .-.      /              in view may still be turned away, transparent, between
//                        near -   +---'-'-----+   -           the samples, or hidden.
//                                  \ nearer  /
//                                   \       /
//             - - - - - - - - - - - - eye  - - - - - - - -
//                      behind the eye
//
// Samples decide: an object with a visible sample is seen, whatever doubles say about its triangles.

/// Reasons, in the order in which they are checked.
enum class SightReason : std::uint8_t {
  empty,             ///< no triangle with finite vertices has an area
  behind_eye,        ///< in perspective: every other triangle lies behind the eye, or beside it
  nearer_than_near,  ///< in front of the near plane
  beyond_far,        ///< behind the far plane
  outside,           ///< between near and far, but outside the picture
  faces_away,        ///< in the picture, but View::culling leaves out the side that is seen
  transparent,       ///< its opacity is 0, or all of its samples are holes
  no_sample,         ///< in the picture, but it covers no sample
  hidden,            ///< other objects are in front of it at every sample that it covers
  seen,
};
/// \returns "empty", "behind_eye", ...
[[nodiscard]] std::string_view name(SightReason reason);

/// Number of an object's triangles by place. Each triangle counts once, at the first place that holds for all of it.
struct TrianglePlaces {
  std::uint64_t empty = 0;  ///< with a non-finite vertex, or without area
  std::uint64_t behind_eye = 0, nearer_than_near = 0, beyond_far = 0;
  // The part between near and far lies outside the picture on one side, or past one corner of the picture.
  std::uint64_t left = 0, right = 0, above = 0, below = 0, past_corner = 0;
  std::uint64_t faces_away = 0;
  std::uint64_t in_view = 0;  ///< at least in part

  [[nodiscard]] std::uint64_t outside() const { return left + right + above + below + past_corner; }
  [[nodiscard]] std::uint64_t total() const {
    return empty + behind_eye + nearer_than_near + beyond_far + outside() + faces_away + in_view;
  }
  friend bool operator==(const TrianglePlaces&, const TrianglePlaces&) = default;
};

/// The change that a remedy makes.
enum class RemedyKind : std::uint8_t {
  none,
  set_near,         ///< sets the near plane to Remedy::value
  set_far,          ///< sets the far plane to Remedy::value
  turn,             ///< turns the camera about its up axis, then up about its new right axis
  move,             ///< moves the camera along its right and up axes, in parallel projection
  show_both_sides,  ///< sets View::culling to none
  make_opaque,      ///< makes the object's materials opaque: alpha mode and transmission
  enlarge,          ///< multiplies the picture's width and height by Remedy::value
  take_away,        ///< removes all of Remedy::objects
};
/// \returns "none", "set_near", ...
[[nodiscard]] std::string_view name(RemedyKind kind);

/// The remedy of an explanation, with the rounded numbers of its sentence. Applying the remedy removes this obstacle.
/// Another one, later in the list of reasons, may remain; explain() then reports it with its own remedy.
struct Remedy {
  RemedyKind kind = RemedyKind::none;
  double value = 0;
  /// Amounts, positive to the right and upwards: radians for `turn`, scene units for `move`.
  double right = 0, up = 0;
  /// Numbers of all objects in front of the object at one place, where it is seen once they are removed. Of four places
  /// spread over the object, the one with the fewest objects is taken.
  std::vector<std::uint32_t> objects;
};

/// Share of an object that another one hides.
struct HiderShare {
  std::uint32_t object = no_index;
  double share = 0;  ///< share of the hidden object's samples in frame; more than 0
};

/// Why one object is seen, or is not, in one view.
struct Explanation {
  std::uint32_t object = no_index;  ///< an instance
  SightReason reason = SightReason::empty;
  TrianglePlaces triangles;
  /// If the object covers no sample: the area in the picture that would be seen of it if it were alone, in square
  /// pixels, exact as in visible_faces(). 0 if the object is seen edge-on.
  double pixels = 0;
  bool is_all_holes = false;  ///< if transparent: true: all samples are holes; false: its opacity is 0
  double visible_share = 0, hidden_share = 0, cut_share = 0;  ///< as in ObjectAccount
  std::vector<HiderShare> hiders;                             ///< front-most objects, the greatest share first
  Remedy remedy;
};

/// Explains every object, by number. `visible` is the answer of zbuffer() for these surfaces, and `accounts` is the
/// answer of account() for `visible`. The result is the same for any number of threads and every instruction set.
/// O(triangles): one to seven times the time of account(), and that of visible_faces() for each object without a
/// sample. \throws Error as account() does, and bad_argument for accounts of other objects.
[[nodiscard]] std::vector<Explanation> explain_all(const Surfaces& surfaces, const Visible& visible,
                                                   const Accounting& accounts, const Execution& execution = {});
/// Explains one object. Takes the time of zbuffer() and account(). \throws Error as validate(view) does, and
/// bad_argument for an object that does not exist.
[[nodiscard]] Explanation explain(const Surfaces& surfaces, const View& view, std::uint32_t object,
                                  const Execution& execution = {});

/// Applies a remedy to a view. Remedies that change the scene leave the view as it is. \throws Error as validate(view)
/// does if the picture becomes too large.
[[nodiscard]] View remedied(const View& view, const Remedy& remedy);

/// Names of objects in texts: "bolt"; "bolt #13" if several objects have that name; "object 13" without a name.
/// Unprintable characters are written as by printable_text().
class ObjectNames {
 public:
  /// Borrows the scene. Functions that take names accept a scene as well; keep names to write many texts. O(objects).
  ObjectNames(const Scene& scene);
  [[nodiscard]] std::string operator[](std::uint32_t object) const;

 private:
  const Scene* scene_;
  std::vector<bool> is_shared_;  ///< by object: another object has its name
};

/// The reason in words: "hidden by wall 63 % and lamp 37 %". Shares are rounded to whole percents.
[[nodiscard]] std::string reason_text(const Explanation& explanation, const ObjectNames& names);
/// The remedy in words: "take wall and lamp away"; empty without a remedy.
[[nodiscard]] std::string remedy_text(const Explanation& explanation, const ObjectNames& names);
/// Reason and remedy: "crate is hidden by wall 63 % and lamp 37 %: take wall and lamp away."
[[nodiscard]] std::string sentence(const Explanation& explanation, const ObjectNames& names);

// Visible faces: every triangle of which any part is seen, however small, and the area of that part.
//
//      .___________.
//      |      /   /|       0  2 of its 8 square pixels are seen, the rest lies behind 2
//      |  0 / 1 / :|       1  hidden: it is not in the list
//      |__/___/_2_:|       2  all of its 6 square pixels are seen
//
// Nothing is sampled: the seen part of a triangle is a polygon, and its area is that of the polygon. The areas of all
// triangles add up to the area within the outlines of all that is seen.

/// The seen part of one triangle.
struct VisibleFace {
  PrimitiveId id = no_primitive;
  double pixels = 0;       ///< area in the picture, in square pixels; more than 0
  double area = 0;         ///< area on the triangle, in scene units squared
  double solid_angle = 0;  ///< steradians, from the eye; 0 in parallel projection, whose eye is infinitely far away
};

struct VisibleFaces {
  View view;
  std::vector<VisibleFace> faces;  ///< by id, ascending; only triangles that are seen
};

/// Finds every triangle of which a part is seen within the picture, between near and far, with the area of that part.
/// Vertices are not snapped, so triangles far smaller than a pixel are found. No place counts twice: where triangles
/// lie exactly in one plane, the lower id is seen; triangles that pass through each other are cut along their
/// intersection. Parts narrower than 2^-30 pixel are not told apart from their neighbours. Triangles with holes (alpha
/// mode MASK) and translucent ones count as whole, and hide. Culled triangles are left out; View::samples is ignored.
/// The same for any number of threads and every instruction set. Near-linear in meshes and stacks of parallel sheets;
/// O(n^2) where n triangles pass through each other and none hides the others. About 150 bytes a triangle, 350 without
/// shared vertices. \throws Error as validate(view) does; limit_exceeded beyond 2^29 triangles a mesh or about 2^31
/// steps.
[[nodiscard]] VisibleFaces visible_faces(const Surfaces& surfaces, const View& view, const Execution& execution = {});

/// A triangle that is seen in at least one of several views.
struct SeenFace {
  PrimitiveId id = no_primitive;
  std::uint32_t view_count = 0;  ///< number of views in which a part of it is seen
  std::uint32_t best_view = 0;   ///< number of the view that shows the largest share; the first of several such views
  double largest_share = 0;   ///< largest share of its area, in scene units, that a view shows: more than 0, at most 1
  double largest_pixels = 0;  ///< largest area that a view shows, in square pixels
};

/// The triangles that are seen in any of `views`, by id, ascending. Takes the time of visible_faces() for each view,
/// but does work that does not depend on the view only once. \throws Error as visible_faces() does.
[[nodiscard]] std::vector<SeenFace> faces_ever_seen(const Surfaces& surfaces, std::span<const View> views,
                                                    const Execution& execution = {});

/// \returns a scene with only the triangles `ids` of `scene`, such as those of faces_ever_seen(). Objects without a
/// kept triangle are removed; every other object gets a mesh of its own. Unused vertices and curved primitives are
/// removed. Order, names, places, materials and textures stay. Mesh::face_ids holds the polygon of the original mesh
/// for each triangle. O(size of the scene). \throws Error bad_argument for ids that do not ascend, or are not in the
/// scene.
[[nodiscard]] Scene keep_faces(const Scene& scene, std::span<const PrimitiveId> ids);

// Reports as files of data sets: COCO's annotations, scenes of BOP, and masks.
//
//   DatasetWriter writer({.bop = "scene"});
//   for (const View& view : views) {
//     const Visible visible = zbuffer(surfaces, view);
//     writer.add({surfaces, visible, account(surfaces, visible)}, "");
//   }
//   writer.finish();

/// Samples of an object that BOP's files call visible. exact: those that see the object. bop19: those where the object
/// is at most 15 mm behind the visible surface, along the ray.
enum class BopVisible : std::uint8_t { exact, bop19 };

struct DatasetOptions {
  std::optional<std::string> coco;        ///< file of the annotations, JSON; "-" is standard output
  std::optional<std::string> bop, masks;  ///< folders, made if they are missing
  bool coco_polygons = false;             ///< true: COCO masks are polygons; false: run lengths
  BopVisible bop_visible = BopVisible::exact;
  bool are_masks_numbered = false;  ///< true: names of masks begin with the number of the view, for several views
  /// Names of objects, or of categories, that get no annotation, mask or pose. These objects still hide others.
  std::vector<std::string> leave_out;
};

/// One view and the accounts of its objects. Borrows everything.
struct DatasetView {
  const Surfaces& surfaces;
  const Visible& visible;      ///< the answer of zbuffer() with one sample a pixel
  const Accounting& accounts;  ///< account() of `surfaces` and `visible`
};

/// Writes the objects of one view after another. docs/command-line.md describes the files. Files of BOP and masks are
/// written into a hidden folder until all views are done; COCO's text stays in memory until then.
class DatasetWriter {
 public:
  /// Makes the folders. \throws Error file_unwritable if one cannot be made.
  explicit DatasetWriter(const DatasetOptions& options);
  ~DatasetWriter();
  DatasetWriter(const DatasetWriter&) = delete;
  DatasetWriter& operator=(const DatasetWriter&) = delete;

  /// Adds a view, also of another scene; views are numbered from 0. `picture` is COCO's file_name. Not after an error.
  /// \throws Error file_unwritable; unsupported for BOP of a parallel view, or of an object that is stretched or
  /// mirrored; bad_argument for a name in leave_out that nothing has, for several samples a pixel, and for two
  /// categories of one number.
  void add(const DatasetView& view, const std::string& picture, const Execution& execution = {});

  /// Moves the files to their places. Removes masks and depths of an earlier writer in the same folders, recognised by
  /// their names. \returns the paths of all files. \throws Error file_unwritable. Call once.
  std::vector<std::string> finish();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace frontmost
