// SPDX-License-Identifier: Apache-2.0
// The painter's algorithm: polygons in an order in which painting one over the other is right everywhere.
#pragma once

#include <functional>
#include <vector>

#include "frontmost/surfaces.h"
#include "frontmost/view.h"
#include "frontmost/visible.h"

namespace frontmost {

/// How polygons are put into order.
enum class PaintMethod : std::uint8_t {
  depth_sort,  ///< by depth, with exchanges and cuts: right everywhere, and cuts only what cannot be ordered whole
  bsp,         ///< by a binary tree of planes: right everywhere, and cuts much more
  farthest,    ///< by their farthest points alone: wrong where that does not decide
  centroid,    ///< by their centroids alone: likewise, elsewhere
};

struct PainterOptions {
  PaintMethod method = PaintMethod::depth_sort;
  /// More polygons, whole ones and pieces, are an error.
  std::size_t most_polygons = std::size_t(1) << 27;
  /// More cuts are one, too: where all of n triangles pass through each other there may be n * n and more. About 400
  /// bytes each.
  std::size_t most_cuts = std::size_t(1) << 20;
  /// Set: of what triangles hide together of which this is true, most is left out before the rest is put into order.
  /// Inside of a machine that is most of the time. What then overlaps nothing is not asked about at all, and painted
  /// first. For visible_parts() with the same function, which leaves out what it takes for hidden here, too; for
  /// several threads at once. Then some 300 bytes a triangle more.
  std::function<bool(PrimitiveId)> hides{};
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

struct PaintOrder {
  View view;
  std::vector<PaintPolygon> polygons;  ///< the first is painted first
  std::vector<PaintCorner> corners;
  PaintSteps steps;
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
/// threads. \throws Error as validate(view) does, and limit_exceeded for more than
/// PainterOptions allow.
[[nodiscard]] PaintOrder painter(const Surfaces& surfaces, const View& view, const PainterOptions& options = {},
                                 const Execution& execution = {});

/// What is seen of an order, for drawings: without polygons that those after them hide together, and with what is left
/// of those that are hidden in part, as convex pieces in the same place of the order; also cut at the sides of the
/// picture. `hides(id)` says of which triangles nothing shows through, for several threads at once; empty: all hide.
/// Parts thinner than 1/1024 pixel are left out, and those between that and 1/16 are not cut off; large polygons are
/// cut along a grid where they are hidden in part. Near-linear, as painter(): every polygon is held against those after
/// it that overlap it, but for those of meshes that overlap nothing, which are found together. In a cell of the grid
/// these are the 4,096 foremost at most, and once 48 parts are left of a polygon there, only those go that one of them
/// hides whole: what is left too much is painted over as before. Long parallel strips share cells with many others: 30
/// thousand take 9 s.
[[nodiscard]] PaintOrder visible_parts(const PaintOrder& order, const std::function<bool(PrimitiveId)>& hides = {},
                                       const Execution& execution = {});

/// The same order with hems: a polygon reaches under what is painted later and lies beside it, by `width` pixels or
/// less, as far as that, or other parts of the same primitive, hide the hem, and around its corners likewise. So
/// viewers that blend the rims of polygons show nothing of the background between neighbours and where several meet:
/// what is painted first in a pixel covers all of it. Hems end a pixel below what is open, or at two fifths of the way
/// to it where that is less, so that outlines hardly grow bold. For drawings: with a hem an outline is not convex, and
/// paint() does not know it. Cost and `hides` as for visible_parts(). \throws Error bad_argument for a width of 0 or
/// less, or over 100.
[[nodiscard]] PaintOrder with_hems(const PaintOrder& order, double width,
                                   const std::function<bool(PrimitiveId)>& hides = {}, const Execution& execution = {});

/// Paints an order: every polygon over those before it, at the samples that its primitive covers in the z-buffer and
/// that lie on the polygon's side of all cuts. Wrong orders give wrong pictures. Holes are left open.
/// O(polygons + samples that each covers), on one thread.
/// \throws Error bad_argument for an order that is not of these surfaces.
[[nodiscard]] Visible paint(const Surfaces& surfaces, const PaintOrder& order);

}  // namespace frontmost
