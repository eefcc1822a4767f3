// SPDX-License-Identifier: Apache-2.0
// The painter's algorithm: polygons in an order in which painting one over the other is right everywhere.
//
//   Surfaces, View --painter()--> PaintOrder --paint()----------> Visible, for comparison with other methods
//                                     |
//                                     +-------visible_parts()---> VisibleParts, for drawings; see draw_figure()
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "frontmost/scene.h"
#include "frontmost/view.h"

namespace frontmost {

/// How polygons are put into order.
enum class PaintMethod : std::uint8_t {
  depth_sort,  ///< by depth, with exchanges and cuts: right everywhere, and cuts only what cannot be ordered whole
  bsp,         ///< by a binary tree of planes: right everywhere, and cuts much more
  farthest,    ///< by their farthest points alone: wrong where that does not decide
  centroid,    ///< by their centroids alone: likewise, elsewhere
};

/// Which triangles hide what lies behind them: nothing is seen through these.
class Occluders {
 public:
  [[nodiscard]] static Occluders none() { return Occluders({}, false); }
  [[nodiscard]] static Occluders all() { return Occluders({}, true); }
  /// Those of which `is_occluder` is true. Several threads ask at once.
  [[nodiscard]] static Occluders where(std::function<bool(PrimitiveId)> is_occluder) {
    return Occluders(std::move(is_occluder), false);
  }
  /// False where surely no triangle is one.
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
  /// More polygons, whole ones and pieces, are an error.
  std::size_t most_polygons = std::size_t(1) << 27;
  /// More cuts are one, too: where all of n triangles pass through each other there may be n * n and more. About 400
  /// bytes each.
  std::size_t most_cuts = std::size_t(1) << 20;
  /// Most triangles that these hide together are left out before the rest is put into order. That saves most of the
  /// time inside of a machine, and takes some 300 bytes a triangle more. Triangles that overlap no other one on the
  /// screen come first, and take no part in the sorting. For visible_parts() with the same occluders, which leaves out
  /// what is hidden here, too.
  Occluders occluders = Occluders::none();
};

/// A corner of a polygon, and the side from it to the next one.
struct PaintCorner {
  glm::dvec3 at{0};     ///< x and y in pixels of the view (x right, y down), z the planar distance
  bool is_cut = false;  ///< the side is no edge of the primitive: it was cut here
};

/// A primitive, or a convex piece of one: `corner_count` of PaintOrder::corners from `first_corner` on,
/// counter-clockwise as they are seen.
struct PaintPolygon {
  PrimitiveId id = no_primitive;
  std::uint32_t corner_count = 0;
  std::size_t first_corner = 0;
};

/// What it took. Pairs are counted as often as they are asked about, by the test that decided.
struct PaintSteps {
  std::uint64_t depths_apart = 0;       ///< one ends in depth before the other begins
  std::uint64_t boxes_apart = 0;        ///< boxes around them do not overlap on the screen
  std::uint64_t behind = 0;             ///< the first lies wholly behind the plane of the second
  std::uint64_t before = 0;             ///< the second lies wholly before the plane of the first
  std::uint64_t projections_apart = 0;  ///< they do not overlap on the screen
  std::uint64_t compared = 0;           ///< decided where they overlap
  std::uint64_t exchanges = 0;          ///< pairs of all these in which the second had to be painted first
  std::uint64_t cycles = 0;             ///< groups without an order among them
  std::uint64_t largest_cycle = 0;      ///< polygons
  std::uint64_t cuts = 0;               ///< polygons that were cut in two
};

/// Polygons in an order of painting: where two overlap, the later one is before the other. paint() paints it.
struct PaintOrder {
  View view;
  std::vector<PaintPolygon> polygons;  ///< the first is painted first
  std::vector<PaintCorner> corners;
  PaintSteps steps;
};

/// What is seen of an order: convex polygons within the picture, in the same order. No two overlap where both hide what
/// is behind them, but for what visible_parts() leaves too much.
struct VisibleParts {
  View view;
  std::vector<PaintPolygon> polygons;
  std::vector<PaintCorner> corners;
};

/// All triangles that `view` may show, in the order of painting.
///
/// Depth sort: by farthest depth, then for every two that may cover each other the tests of Newell, Newell and Sancha
/// in their order, until one decides; what has to be painted before goes first, and only where that leads in a circle
/// are polygons cut, along the plane of one of them. Planes are compared by the signs of determinants of the vertices'
/// floats, without tolerance. Triangles in one plane are painted as the z-buffer decides: the lower id on top; those
/// with the same corners as one of a lower id directly below it, at no more cost than their polygons. (M. Newell, R.
/// Newell, T. Sancha. A Solution to the Hidden Surface Problem. 1972; R. Tarjan. Depth-First Search and Linear Graph
/// Algorithms. 1972; H. Fuchs, Z. Kedem, B. Naylor. On Visible Surface Generation by A Priori Tree Structures. 1980.)
///
/// What is seen from its edge, is left out by View::culling, or lies outside of the view is not there; the near and the
/// far plane cut what they meet, the sides of the picture do not. Triangles with holes (alpha mode MASK) are whole.
/// Near-linear in scenes of bounded depth complexity: n log n to sort, then one test for every two triangles that
/// overlap on the screen and in depth. They are found by a grid when they are asked for, and not stored: about 200
/// bytes a triangle, 110 of them the result, whatever overlaps. The result is the same to the bit for any number of
/// threads. \throws Error as validate(view) does, and limit_exceeded for more than PainterOptions allow, or 2^28 tests
/// and 8,192 for each polygon.
[[nodiscard]] PaintOrder painter(const Surfaces& surfaces, const View& view, const PainterOptions& options = {},
                                 const Execution& execution = {});

/// What is seen of an order, for drawings. Polygons that later occluders hide together are left out. Of a polygon that
/// is hidden in part, what is left stays in its place of the order, as convex pieces. Polygons are cut at the sides of
/// the picture, too.
///
/// Parts thinner than 1/1024 pixel are left out, and those between that and 1/16 are not cut off. Large polygons are
/// cut along a grid where they are hidden in part. Near-linear, as painter(): every polygon is held against the later
/// ones that overlap it, but for those of meshes that overlap nothing, which are found together. A polygon is held
/// against the 4,096 foremost in each cell of a grid at most, and where 48 parts of it are left in one, a part goes
/// only if one occluder hides it whole. What is left too much is painted over, as in the order itself. Long parallel
/// strips share cells with many others. \throws Error limit_exceeded as painter() does for tests.
[[nodiscard]] VisibleParts visible_parts(const PaintOrder& order, const Occluders& occluders = Occluders::all(),
                                         const Execution& execution = {});

/// Paints an order: every polygon over those before it, at the samples that its primitive covers in the z-buffer and
/// that lie on the polygon's side of all cuts. Wrong orders give wrong pictures. Holes are left open.
/// O(polygons + samples that each covers), on one thread.
/// \throws Error bad_argument for an order that is not of these surfaces.
[[nodiscard]] Visible paint(const Surfaces& surfaces, const PaintOrder& order);

}  // namespace frontmost
