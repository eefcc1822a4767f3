// SPDX-License-Identifier: Apache-2.0
// What is in a scene and what is odd in it; how much of each object is seen, and what hides the rest.
//
// Files in the wild have holes, faces that stand twice, and faces that are inside out; printers, solvers and drawings
// care. Everything here is counted by the positions of corners as they are stored, bit for bit, so that two programs
// that look at the same file find the same numbers:
//
//    +---+---+     an edge of two triangles joins them to a shell
//    | / | / |     an edge of one is a boundary: the rim of a hole
//    +---+---+     an edge of three and more is not manifold
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

/// What is odd in a mesh. Corners are the same when their positions are (bit for bit, but +0 = -0), whatever their
/// numbers. Nothing is rounded and nothing has a tolerance.
struct Oddities {
  std::uint64_t non_finite_triangles = 0;  ///< a corner is NaN or infinite; left out of everything below
  std::uint64_t degenerate_triangles = 0;  ///< area exactly zero: corners repeated, or on one line
  std::uint64_t duplicate_triangles = 0;   ///< the three corners of an earlier triangle, in any order
  // Edges of all triangles whose corners are three different points.
  std::uint64_t boundary_edges = 0;      ///< of one triangle
  std::uint64_t non_manifold_edges = 0;  ///< of more than two triangles
  std::uint64_t inconsistent_edges = 0;  ///< of two triangles that run along it the same way: one is inside out

  [[nodiscard]] bool any() const {
    return (non_finite_triangles | degenerate_triangles | duplicate_triangles | boundary_edges | non_manifold_edges |
            inconsistent_edges) != 0;
  }
  friend bool operator==(const Oddities&, const Oddities&) = default;
};

/// Triangles of one material.
struct MaterialUse {
  std::uint32_t material = no_index;
  std::uint64_t triangles = 0;
};

struct MeshReport {
  std::string name;
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;   ///< as stored
  std::uint64_t positions = 0;  ///< different finite ones that triangles use
  std::uint64_t faces = 0;      ///< polygons of the file
  bool has_normals = false, has_texcoords = false, has_colors = false;
  std::vector<MaterialUse> materials;  ///< by number; no_index, the default material, last
  Oddities odd;
  std::uint64_t pieces = 0;  ///< parts that hang together, be it in one corner
  std::uint64_t shells = 0;  ///< parts that hang together over edges: as many or more
  bool closed = false;       ///< has triangles, and no boundary edge
  /// Handles of all shells together; none unless closed, without non-manifold and inconsistent edges.
  std::optional<std::uint64_t> genus;
};

/// One instance.
struct ObjectReport {
  std::string name;
  std::uint32_t mesh = no_index;
  std::uint64_t triangles = 0;
  Box bounds;       ///< of its finite triangles, in world space
  double area = 0;  ///< of its finite triangles, in world space
  /// Enclosed in world space; of meshes with a genus alone. Shells that wind the other way are taken off, as hollows.
  std::optional<double> volume;
};

struct MaterialReport {
  std::string name;
  std::uint64_t triangles = 0;  ///< over all instances
  std::uint32_t textures = 0;   ///< how many maps it has
  Material::Alpha alpha = Material::Alpha::opaque;
  bool double_sided = false;
};

struct CameraReport {
  std::string name;
  glm::dvec3 position{0}, direction{0, 0, -1}, up{0, 1, 0};  ///< world space; both directions of unit length
  bool orthographic = false;
  double vertical = 0;  ///< as in Camera: radians, or height
};

/// One of the scene's, placed in the world.
struct LightReport {
  std::string name;
  Light::Kind kind = Light::Kind::point;
  glm::dvec3 position{0}, direction{0, 0, -1};  ///< world space; the way it shines, of unit length
  glm::vec3 color{1};
  double intensity = 0;                   ///< as in Light: lux, or candela
  std::optional<double> range;            ///< of points and spots
  double inner_cone = 0, outer_cone = 0;  ///< of spots: radians
};

struct SceneReport {
  std::string name;
  Axis up = Axis::y;
  std::uint64_t triangles = 0;         ///< over all instances
  std::uint64_t stored_triangles = 0;  ///< over all meshes
  std::uint64_t vertices = 0;          ///< stored, over all meshes
  std::uint64_t texture_count = 0;
  glm::dvec3 origin{0};          ///< of the scene: world space is about it
  Box bounds;                    ///< world space
  double area = 0;               ///< of all objects
  std::optional<double> volume;  ///< of the objects that have one; none without any
  /// How far from where the file has it a vertex may lie, because floats are kept: half a step of the farthest.
  double rounding = 0;
  std::vector<MeshReport> meshes;
  std::vector<ObjectReport> objects;
  std::vector<MaterialReport> materials;
  std::vector<CameraReport> cameras;
  std::vector<LightReport> lights;
  Oddities odd;  ///< summed over meshes, each counted once
  std::vector<std::string> warnings;
};

/// O(stored triangles * log + triangles over all instances), in parallel; about 100 bytes a triangle of the largest
/// mesh while it runs. The same result for any number of threads.
/// \throws Error as validate(scene) does, and limit_exceeded for a mesh of more than 2^29 triangles.
[[nodiscard]] SceneReport inspect(const Scene& scene, const Execution& execution = {});

/// The units that the coordinates of a model may be in, by its greatest extent alone, as metres to a unit: millimetres
/// where that is then 5 mm to 2 m, as of parts and prints; metres where millimetres would be a grain of sand, below 1;
/// in between metres, centimetres and inches, since anything may be meant. None where nothing tells: below 0.001, above
/// 2000, or without anything. Files that say their unit need no guess: SceneSource::metres_per_unit.
[[nodiscard]] std::vector<double> likely_units(const Box& bounds);

// Accounting of objects: how much of each object is seen, how much of it lies beyond the frame, and who hides the rest.
//
//    canvas  +- - - - - - - - - - - +
//              +-------------+              alone      every sample that the object covers when nothing else is there
//            | |frame   #####|%%%%  |       in frame   those of them within the picture: # and =
//              |   wall=#####|%%%           visible    those that see it: #
//            | |       ======|%%%%  |       hidden     in frame, and not visible: =, by the wall
//              +-------------+              cut        beyond the frame: %
//            + - - - - - - - - - - - +
//
// An object is an instance of the scene. Samples are counted, exactly and without any tolerance: what an object covers
// alone is what zbuffer() would show of it.

/// Pixels [x, x + width) x [y, y + height) from the picture's top left; beyond the picture x and y may be negative.
struct PixelBox {
  int x = 0, y = 0, width = 0, height = 0;

  [[nodiscard]] bool is_empty() const { return width == 0; }
  friend bool operator==(const PixelBox&, const PixelBox&) = default;
};

/// Samples, and the least box around their pixels; empty where there are none.
struct SampleSet {
  std::uint64_t count = 0;
  PixelBox box;

  friend bool operator==(const SampleSet&, const SampleSet&) = default;
};

/// One instance in one view. The three shares add up to 1 where the object covers any sample; else all are 0.
struct ObjectAccount {
  SampleSet alone;     ///< on the canvas
  SampleSet in_frame;  ///< of those, within the picture
  SampleSet visible;   ///< of those, where nothing hides it
  /// Planar distance of the nearest visible sample, as depths_of() gives it; +inf where none is visible.
  float distance = std::numeric_limits<float>::infinity();
  /// The mean place of the visible samples on the screen, in pixels from the top left corner; 0 where none is visible.
  glm::dvec2 centroid{0};
  /// It reaches nearer than the near plane, and what is there counts nowhere.
  bool is_cut_by_near = false;

  [[nodiscard]] double visible_share() const { return share(visible.count); }
  [[nodiscard]] double hidden_share() const { return share(in_frame.count - visible.count); }
  [[nodiscard]] double cut_share() const { return share(alone.count - in_frame.count); }

 private:
  [[nodiscard]] double share(std::uint64_t count) const {
    return alone.count == 0 ? 0 : double(count) / double(alone.count);
  }
};

/// Samples of one object that another one hides.
struct HiddenSamples {
  std::uint32_t object = no_index;  ///< the hidden one, an instance
  std::uint32_t hider = no_index;
  std::uint64_t count = 0;  ///< at least 1

  friend bool operator==(const HiddenSamples&, const HiddenSamples&) = default;
};

struct AccountingOptions {
  /// The canvas on which objects are counted alone, as a multiple of the picture's width and height, 1 to 16; the
  /// picture lies in its middle. 1 is the picture itself, so that no object counts as cut. Three, as BOP has it, is
  /// wide enough for whatever is half in the picture and no larger than it. Rounded down to whole pixels on each side,
  /// and never more than 16384 pixels wide or high.
  double canvas = 3;
  /// Also all other pairs: hidden_by_any and hidden_only_by. Some ten times the time, and 20 MiB and more.
  bool all_hiders = false;
};

struct Accounting {
  PixelBox canvas;                     ///< on which objects were counted alone
  std::vector<ObjectAccount> objects;  ///< by instance
  std::uint64_t background = 0;        ///< samples that see nothing; with all that are visible, those of the picture
  /// Samples in frame by the object that is seen there in its place, ordered by object, then by hider. Those of one
  /// object add up to what of it is hidden.
  std::vector<HiddenSamples> hidden_by_front;
  /// In the same order, samples in frame at which the hider covers the object from before, whatever else does. Empty
  /// unless AccountingOptions::all_hiders is set, as is the next one.
  std::vector<HiddenSamples> hidden_by_any;
  /// Samples at which nothing but the hider covers the object: what appears of it when the hider is taken away.
  std::vector<HiddenSamples> hidden_only_by;
};

/// Accounts for every object in a view. `visible` is what zbuffer() or a ZBuffer gave for these surfaces: with answers
/// of other methods, which do not snap, sums hold only nearly. The same for all numbers of threads and instruction
/// sets. O(triangles + rows of pixels that each object touches + samples); beside the result about 8 bytes a run of
/// samples that see the same object, and a bit for each sample of the canvas and thread.
/// \throws Error bad_argument as validate(view) does, for a canvas out of range, and for a `visible` of other surfaces.
[[nodiscard]] Accounting account(const Surfaces& surfaces, const Visible& visible,
                                 const AccountingOptions& options = {}, const Execution& execution = {});

/// Which objects hide which, put in order: what hides something comes before it, wherever that can be.
struct HidingOrder {
  /// By object: 0 where nothing hides it, else one more than the greatest of those that hide it; those of a cycle have
  /// one rank.
  std::vector<std::uint32_t> ranks;
  /// Objects of which each hides the next and the last the first, all that hang together so in one list, ascending;
  /// lists by their first object. Objects without a list have an order among them.
  std::vector<std::vector<std::uint32_t>> cycles;
};

/// The order of `object_count` objects by their pairs, such as Accounting::hidden_by_front. O(objects + pairs * log).
/// Source: R. Tarjan. Depth-First Search and Linear Graph Algorithms. 1972.
/// \throws Error bad_argument where a pair is not of two different objects below `object_count`.
[[nodiscard]] HidingOrder find_hiding_order(std::size_t object_count, std::span<const HiddenSamples> pairs);

// Masks of objects, as pixels, run lengths and polygons.

enum class MaskPixel : std::uint8_t { outside, hidden, visible };

/// What one object covers of a picture, by the first sample of each pixel.
struct PixelMask {
  PixelBox box;              ///< the least one around what is not outside
  Buffer<MaskPixel> pixels;  ///< of the box, rows from the top

  /// Of a pixel of the picture.
  [[nodiscard]] MaskPixel at(int x, int y) const {
    x -= box.x, y -= box.y;
    if (x < 0 || y < 0 || x >= box.width || y >= box.height) return MaskPixel::outside;
    return pixels[std::size_t(y) * std::size_t(box.width) + std::size_t(x)];
  }
};

/// Which pixels of a mask are meant: those that are visible, or these and those that are hidden.
enum class MaskPart : std::uint8_t { visible, whole };

/// COCO's compressed run lengths of a mask in a picture of `size`: columns from the left, each from the top, runs of 0
/// and 1 in turn, as its mask API writes them. O(pixels of the box).
/// Source: T.-Y. Lin et al. Microsoft COCO: Common Objects in Context. 2014.
[[nodiscard]] std::string coco_runs(const PixelMask& mask, MaskPart part, const glm::ivec2& size);
/// Polygons along the sides of pixels, x and y in turn, in pixels from the picture's top left. They do not overlap,
/// have no holes, and fill the mask exactly, also by the rule of COCO's mask API. O(pixels of the box).
[[nodiscard]] std::vector<std::vector<int>> coco_polygons(const PixelMask& mask, MaskPart part);

/// The masks of one object after another. Borrows what it is made of; not for several threads at once.
class PixelMasks {
 public:
  /// `visible` is what zbuffer() or a ZBuffer gave for these surfaces. O(samples); a bit for each sample of the
  /// picture. \throws Error bad_argument as account() does.
  PixelMasks(const Surfaces& surfaces, const Visible& visible, const Execution& execution = {});
  ~PixelMasks();
  PixelMasks(const PixelMasks&) = delete;
  PixelMasks& operator=(const PixelMasks&) = delete;

  /// With one sample a pixel it has as many pixels visible and hidden as account() counts. O(triangles of the object +
  /// pixels of its box). Precondition: an instance of the scene.
  [[nodiscard]] PixelMask of(std::uint32_t object);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// Why an object is seen, or is not: one reason, its numbers, what to change, and all of it as a sentence.
//
//                       far -+---------------------+-         Every triangle is somewhere, and is counted once:
//             left            \   beyond far      /           at the first reason of the list that holds for all of
//       .-.                    \                 /            it. An object has the last reason that any of its
//       '-' outside             \    in view    /             triangles has: it was kept from being seen there.
//                                \    .-.      /              What is in view may still be turned away, transparent,
//                        near -   +---'-'-----+   -           between the samples, or hidden.
//                                  \ nearer  /
//                                   \       /
//             - - - - - - - - - - - - eye  - - - - - - - -
//                      behind the eye
//
// Samples have the last word: an object that one of them sees is seen, whatever doubles make of its triangles.

/// In the order in which reasons are asked for.
enum class SightReason : std::uint8_t {
  empty,             ///< no triangle with finite corners has an area
  behind_eye,        ///< in perspective: everything else lies behind the eye, or beside it
  nearer_than_near,  ///< before the near plane
  beyond_far,        ///< behind the far plane
  outside,           ///< between near and far, but beside the picture
  faces_away,        ///< in the picture, but View::culling leaves those sides out
  transparent,       ///< its opacity is 0, or every sample of it is a hole
  no_sample,         ///< in the picture, but it covers no sample
  hidden,            ///< other objects are before it at every sample that it covers
  seen,
};
/// \returns "empty", "behind_eye", ...
[[nodiscard]] std::string_view name(SightReason reason);

/// How many triangles of an object are where; each is counted once, at the first that holds for all of it.
struct TrianglePlaces {
  std::uint64_t empty = 0;  ///< a corner is not finite, or its area is 0
  std::uint64_t behind_eye = 0, nearer_than_near = 0, beyond_far = 0;
  // What of it lies between near and far is outside on one side of the picture, or past one of its corners.
  std::uint64_t left = 0, right = 0, above = 0, below = 0, past_corner = 0;
  std::uint64_t faces_away = 0;
  std::uint64_t in_view = 0;  ///< in part, at least

  [[nodiscard]] std::uint64_t outside() const { return left + right + above + below + past_corner; }
  [[nodiscard]] std::uint64_t total() const {
    return empty + behind_eye + nearer_than_near + beyond_far + outside() + faces_away + in_view;
  }
  friend bool operator==(const TrianglePlaces&, const TrianglePlaces&) = default;
};

/// What to change.
enum class RemedyKind : std::uint8_t {
  none,
  set_near,         ///< to Remedy::value
  set_far,          ///< likewise
  turn,             ///< the camera: about its up axis, then up about what is then its right axis
  move,             ///< the camera, in parallel projection: along its right and up axes
  show_both_sides,  ///< View::culling
  make_opaque,      ///< the object's materials: alpha mode and transmission
  enlarge,          ///< the picture, to Remedy::value times the pixels each way
  take_away,        ///< the objects of Remedy::objects, all of them
};
/// \returns "none", "set_near", ...
[[nodiscard]] std::string_view name(RemedyKind kind);

/// Numbers are round ones, those of the sentence. What was in the way of the object is so no longer when it is done;
/// what comes later in the list of reasons may be then, and has its own remedy.
struct Remedy {
  RemedyKind kind = RemedyKind::none;
  double value = 0;
  /// Of `turn` in radians, of `move` in scene units: to the right and upwards where positive.
  double right = 0, up = 0;
  /// By number. Of all that are before the object in one place, so that it is seen there without them: the place where
  /// they are fewest, among four that are spread over the object.
  std::vector<std::uint32_t> objects;
};

/// Who hides a part of an object.
struct HiderShare {
  std::uint32_t object = no_index;
  double share = 0;  ///< of what of the hidden object is in frame; more than 0
};

/// Of one object in one view.
struct Explanation {
  std::uint32_t object = no_index;  ///< an instance
  SightReason reason = SightReason::empty;
  TrianglePlaces triangles;
  /// Where no sample is covered: the area in the picture of what would be seen of it alone, in square pixels, exact as
  /// visible_faces() is; 0 of what is seen edge on.
  double pixels = 0;
  bool is_all_holes = false;  ///< where it is transparent: by the holes of its materials, not by its opacity
  double visible_share = 0, hidden_share = 0, cut_share = 0;  ///< as ObjectAccount has them
  std::vector<HiderShare> hiders;                             ///< front-most, the greatest share first
  Remedy remedy;
};

/// Explains every object, by number. `visible` is what zbuffer() gave for these surfaces, `accounts` what account()
/// gave for it. The same for all numbers of threads and instruction sets. O(triangles), one to seven times the time of
/// account(), and that of visible_faces() for each object that covers no sample. \throws Error as account() does, and
/// bad_argument for accounts of other objects.
[[nodiscard]] std::vector<Explanation> explain_all(const Surfaces& surfaces, const Visible& visible,
                                                   const Accounting& accounts, const Execution& execution = {});
/// Explains one object. The time of zbuffer() and account(). \throws Error as validate(view) does, and bad_argument for
/// an object that does not exist.
[[nodiscard]] Explanation explain(const Surfaces& surfaces, const View& view, std::uint32_t object,
                                  const Execution& execution = {});

/// The view, changed as a remedy says; as it is for remedies that change the scene. \throws Error as validate(view)
/// does for a picture that becomes too large.
[[nodiscard]] View remedied(const View& view, const Remedy& remedy);

/// How texts call the objects of a scene: "bolt"; "bolt #13" where several have that name; "object 13" where it has
/// none. What does not print is written as printable_text() does.
class ObjectNames {
 public:
  /// Keeps a reference. Texts make these names by themselves from a scene; whoever writes many keeps them. O(objects).
  ObjectNames(const Scene& scene);
  [[nodiscard]] std::string operator[](std::uint32_t object) const;

 private:
  const Scene* scene_;
  std::vector<bool> is_shared_;  ///< by object: another has its name
};

/// What the object is: "hidden by wall 63 % and lamp 37 %". Shares are rounded to whole percents.
[[nodiscard]] std::string reason_text(const Explanation& explanation, const ObjectNames& names);
/// What to do: "take wall and lamp away"; nothing where there is no remedy.
[[nodiscard]] std::string remedy_text(const Explanation& explanation, const ObjectNames& names);
/// Both: "crate is hidden by wall 63 % and lamp 37 %: take wall and lamp away."
[[nodiscard]] std::string sentence(const Explanation& explanation, const ObjectNames& names);

// Visible faces: every triangle of which any part is seen, however small, and how much of it.
//
//      .___________.
//      |      /   /|       0  2 of its 8 square pixels are seen, the rest lies behind 2
//      |  0 / 1 / :|       1  hidden: it is not in the list
//      |__/___/_2_:|       2  all of its 6 square pixels are seen
//
// Nothing is sampled: what is seen of a triangle is a polygon, and its area is that of the polygon. So the areas of all
// triangles together are the area inside the outlines of what is seen.

/// What is seen of one triangle.
struct VisibleFace {
  PrimitiveId id = no_primitive;
  double pixels = 0;       ///< its area in the picture, in square pixels; more than 0
  double area = 0;         ///< its area on the triangle, in scene units squared
  double solid_angle = 0;  ///< in steradians, from the eye; 0 in parallel projection, whose eye is infinitely far away
};

struct VisibleFaces {
  View view;
  std::vector<VisibleFace> faces;  ///< by id, ascending; what is not seen is not there
};

/// Every triangle of which a part is seen within the picture between near and far, with the area of that part.
///
/// Corners are where doubles put them, not on the grid of 1/256 pixel on which samples are covered: a triangle far
/// smaller than a pixel is found. No place counts twice: of triangles that lie in one plane, exactly, the lower id is
/// seen where they overlap; those that pass through each other are parted along their intersection. Cuts that would
/// leave less than 2^-30 pixel beside them are not made, so that what is narrower than that is not told apart from its
/// neighbour. Triangles with holes (alpha mode MASK) and translucent ones count as whole and hide what is behind them.
/// What View::culling leaves out is not there. View::samples does not count.
///
/// The picture is divided into cells, where something ends in them into smaller ones. (J. Warnock. A Hidden Surface
/// Algorithm for Computer Generated Halftone Pictures. 1969.) In a cell in which no surface ends and the nearest one
/// lies before all others, what is seen is known without cutting anything; in the smallest the triangles are cut by
/// each other. Near-linear in meshes and in stacks of parallel sheets; where n triangles pass through each other in one
/// place and none of them hides the others whole, time goes with n squared there. About 150 bytes a triangle, 350 where
/// they share no vertices. The same for any number of threads and every instruction set. \throws Error as
/// validate(view) does, and limit_exceeded for a mesh of more than 2^29 triangles, or more than about 2^31 steps,
/// fifteen times as many as the most crowded of 237 models takes.
[[nodiscard]] VisibleFaces visible_faces(const Surfaces& surfaces, const View& view, const Execution& execution = {});

/// A triangle that is seen in one of several views.
struct SeenFace {
  PrimitiveId id = no_primitive;
  std::uint32_t view_count = 0;  ///< in how many views a part of it is seen
  std::uint32_t best_view = 0;   ///< the number of the view that shows the largest share; the first of several such
  double largest_share = 0;      ///< of its own area, in scene units, that one view shows: more than 0, at most 1
  double largest_pixels = 0;     ///< the most square pixels of it that any view shows
};

/// Which triangles are seen in any of `views`, by id, ascending. The cost of visible_faces() for each view; what does
/// not depend on the view is found once. \throws as above.
[[nodiscard]] std::vector<SeenFace> faces_ever_seen(const Surfaces& surfaces, std::span<const View> views,
                                                    const Execution& execution = {});

/// A scene of some of another's triangles alone, such as those that are ever seen: objects of which none is kept are
/// gone, every other one has a mesh of its own. Vertices that no triangle needs are left out; order, names, places,
/// materials and textures stay, and Mesh::face_ids tells which polygon of the first scene's mesh each triangle came
/// from. Curved primitives are not kept. O(size of the scene). \throws Error bad_argument for ids that do not ascend,
/// or are none of the scene's.
[[nodiscard]] Scene keep_faces(const Scene& scene, std::span<const PrimitiveId> ids);

// Reports as files of data sets: COCO's annotations, scenes of BOP, and masks.
//
//   DatasetWriter writer({.bop = "scene"});
//   for (const View& view : views) {
//     const Visible visible = zbuffer(surfaces, view);
//     writer.add({surfaces, visible, account(surfaces, visible)}, "");
//   }
//   writer.finish();

/// Which samples of an object BOP's files call visible: those that see it, or what is at most 15 mm behind.
enum class BopVisible : std::uint8_t { exact, bop19 };

struct DatasetOptions {
  std::optional<std::string> coco;        ///< the file of the annotations: JSON; "-" is standard output
  std::optional<std::string> bop, masks;  ///< folders, which are made where they are missing
  bool coco_polygons = false;             ///< masks of COCO as polygons, not as run lengths
  BopVisible bop_visible = BopVisible::exact;
  bool are_masks_numbered = false;  ///< names of masks begin with the number of the view, as for several views
  /// Names of objects, or of categories, that get no annotation, mask or pose. They still hide others.
  std::vector<std::string> leave_out;
};

/// One view with what was found out about its objects. Borrows all of it.
struct DatasetView {
  const Surfaces& surfaces;
  const Visible& visible;      ///< as zbuffer() gave it, with one sample a pixel
  const Accounting& accounts;  ///< of both
};

/// Writes the objects of one view after another. docs/command-line.md says what the files hold. BOP's and the masks'
/// files are written into a hidden folder and moved when all views are there; COCO's text is kept until then.
class DatasetWriter {
 public:
  /// Makes the folders. \throws Error file_unwritable where one cannot be made.
  explicit DatasetWriter(const DatasetOptions& options);
  ~DatasetWriter();
  DatasetWriter(const DatasetWriter&) = delete;
  DatasetWriter& operator=(const DatasetWriter&) = delete;

  /// Views count from 0, in this order; `picture` is COCO's file_name. Views may be of several scenes.
  /// \throws Error file_unwritable; unsupported for BOP of a parallel view, or of an object that is stretched or
  /// mirrored; bad_argument for a name in leave_out that nothing has, for more samples than one, and for two categories
  /// of one number. After an error only the destructor may be called.
  void add(const DatasetView& view, const std::string& picture, const Execution& execution = {});

  /// Moves the files to their places, and removes masks and depths that an earlier writer left in the same folders:
  /// files of the same kinds of names.
  /// \returns the paths of all files. \throws Error file_unwritable. Call once.
  std::vector<std::string> finish();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace frontmost
