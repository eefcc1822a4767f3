// SPDX-License-Identifier: Apache-2.0
// The painter's algorithm: polygons in an order such that painting them one over the other is right everywhere.
//
//   Surfaces, View --painter()--> PaintOrder --paint()----------> Visible, for comparison with other methods
//                                     |
//                                     +-------visible_parts()---> VisibleParts, for drawings; see draw_figure()
//
// The depth sort starts with the order of farthest depths. For every two polygons that may cover each other, the tests
// of Newell, Newell and Sancha run in their order until one decides which is painted first. Only if these decisions
// form a cycle are polygons cut, along the plane of one of them. Planes are compared by signs of determinants of the
// vertices' floats, without tolerance. Pairs are found by a grid when needed and not stored, so memory does not grow
// with overlap.
//
// visible_parts() clips every polygon by the later ones that overlap it, in the cells of a grid. At most the 4,096
// foremost occluders of a cell clip a polygon. If a polygon has more than 48 parts left in a cell, a part is removed
// only if a single occluder hides it whole. Polygons of meshes that overlap nothing are not clipped.
//
// M. Newell, R. Newell, T. Sancha. A Solution to the Hidden Surface Problem. 1972. R. Tarjan. Depth-First Search and
// Linear Graph Algorithms. 1972. H. Fuchs, Z. Kedem, B. Naylor. On Visible Surface Generation by A Priori Tree
// Structures. 1980.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "frontmost/scene.h"
#include "frontmost/view.h"

namespace frontmost {

/// The method that puts polygons into order.
enum class PaintMethod : std::uint8_t {
  depth_sort,  ///< by depth, with exchanges; right everywhere; cuts only polygons that cannot be ordered whole
  bsp,         ///< by a binary tree of planes; right everywhere; cuts many more polygons
  farthest,    ///< by farthest points alone; wrong where these do not decide
  centroid,    ///< by centroids alone; wrong in other cases than `farthest`
};

/// The set of triangles that hide everything behind them.
class Occluders {
 public:
  [[nodiscard]] static Occluders none() { return Occluders({}, false); }
  [[nodiscard]] static Occluders all() { return Occluders({}, true); }
  /// Triangles for which `is_occluder` returns true. Several threads may call it at once.
  [[nodiscard]] static Occluders where(std::function<bool(PrimitiveId)> is_occluder) {
    return Occluders(std::move(is_occluder), false);
  }
  /// False if it is certain that no triangle is an occluder.
  [[nodiscard]] bool may_exist() const { return is_occluder_ || is_each_; }
  [[nodiscard]] bool contain(PrimitiveId id) const { return is_occluder_ ? is_occluder_(id) : is_each_; }

 private:
  Occluders(std::function<bool(PrimitiveId)> is_occluder, bool is_each)
      : is_occluder_(std::move(is_occluder)), is_each_(is_each) {}

  std::function<bool(PrimitiveId)> is_occluder_;
  bool is_each_;
};

struct PainterOptions {
  PaintMethod method = PaintMethod::depth_sort;
  /// The most polygons, whole ones and pieces together; more are an error.
  std::size_t most_polygons = std::size_t(1) << 27;
  /// The most cuts; more are an error. If n triangles all pass through each other, there may be n * n cuts and more.
  /// Each cut takes about 400 bytes.
  std::size_t most_cuts = std::size_t(1) << 20;
  /// Triangles that hide what lies behind them. The triangles that these occluders hide together are mostly left out
  /// before sorting. This saves most of the time inside of a machine, and takes some 300 bytes more for each triangle.
  /// Triangles that overlap no other triangle on the screen are painted first and are not sorted. Pass the same
  /// occluders to visible_parts(), which also leaves out what is hidden here.
  Occluders occluders = Occluders::none();
};

/// A corner of a polygon, and the side of the polygon that leads from this corner to the next.
struct PaintCorner {
  glm::dvec3 at{0};     ///< x and y: pixels of the view (x right, y down); z: planar distance
  bool is_cut = false;  ///< true: the side was made by a cut; false: it lies on an edge of the primitive
};

/// A primitive, or a convex piece of one, counter-clockwise as seen. Its corners are the `corner_count` elements of
/// PaintOrder::corners from `first_corner` on.
struct PaintPolygon {
  PrimitiveId id = no_primitive;
  std::uint32_t corner_count = 0;
  std::size_t first_corner = 0;
};

/// Counts of the sort's steps. A pair is counted each time it is tested, under the test that decided its order.
struct PaintSteps {
  std::uint64_t depths_apart = 0;       ///< the depths of one end before those of the other begin
  std::uint64_t boxes_apart = 0;        ///< their bounding boxes do not overlap on the screen
  std::uint64_t behind = 0;             ///< the first lies wholly behind the plane of the second
  std::uint64_t before = 0;             ///< the second lies wholly before the plane of the first
  std::uint64_t projections_apart = 0;  ///< they do not overlap on the screen
  std::uint64_t compared = 0;           ///< they overlap on the screen; their planes decide
  std::uint64_t exchanges = 0;          ///< pairs, of all above, whose second polygon had to be painted first
  std::uint64_t cycles = 0;             ///< groups of polygons that have no order
  std::uint64_t largest_cycle = 0;      ///< number of polygons in the largest of these groups
  std::uint64_t cuts = 0;               ///< polygons that were cut in two
};

/// Polygons in painting order: where two overlap, the later one is in front of the earlier one. paint() paints them.
struct PaintOrder {
  View view;
  std::vector<PaintPolygon> polygons;  ///< the first is painted first
  std::vector<PaintCorner> corners;
  PaintSteps steps;
};

/// The visible parts of an order: convex polygons within the picture, in the same order. Parts of occluders do not
/// overlap, except for hidden parts that visible_parts() keeps.
struct VisibleParts {
  View view;
  std::vector<PaintPolygon> polygons;
  std::vector<PaintCorner> corners;
};

/// \returns all triangles that `view` may show, in painting order. Of coplanar triangles the lower id is on top. A copy
/// (a triangle with the same vertices as one of lower id) lies directly below that triangle, and costs no more than its
/// own polygon. Triangles seen edge-on, excluded by View::culling or outside the view are left out. Near and far planes
/// cut triangles; the picture's sides do not. Triangles with holes (alpha mode MASK) are whole. The result is the same
/// to the bit for any number of threads. O(n log n), and one test per pair that overlaps on the screen and in depth.
/// 200 bytes a triangle, 110 of them the result. \throws Error as validate(view) does; limit_exceeded beyond the limits
/// of PainterOptions, or if n triangles need more than 2^28 + 8,192 n tests.
[[nodiscard]] PaintOrder painter(const Surfaces& surfaces, const View& view, const PainterOptions& options = {},
                                 const Execution& execution = {});

/// \returns the visible parts of an order, for drawings. Polygons that later occluders hide together are left out. A
/// partly hidden polygon becomes convex pieces of its visible part, at its place in the order; a large one is also cut
/// along a grid. Polygons are cut at the picture's sides. Parts thinner than 1/1024 pixel are left out. Cuts that would
/// leave a part of 1/1024 to 1/16 pixel are not made. Hidden parts that are kept are painted over, as in the order.
/// Near-linear, as painter(), except for long parallel strips, which share many cells of the grid.
/// \throws Error limit_exceeded if n polygons need more than 2^28 + 8,192 n tests.
[[nodiscard]] VisibleParts visible_parts(const PaintOrder& order, const Occluders& occluders = Occluders::all(),
                                         const Execution& execution = {});

/// Paints an order: every polygon over those before it. A polygon is painted at the samples that its primitive covers
/// in the z-buffer and that lie on its side of all cuts. Wrong orders give wrong pictures. Holes are left open.
/// O(polygons + samples that each covers), on one thread.
/// \throws Error bad_argument for an order of other surfaces.
[[nodiscard]] Visible paint(const Surfaces& surfaces, const PaintOrder& order);

}  // namespace frontmost
