// SPDX-License-Identifier: Apache-2.0
// Sheets: which of the sides of an edge belong together where triangles are there more than once.
//
// Assemblies are exported part by part, and parts that touch have the same triangles at the place where they do. An
// edge there has three or four sides, and yet every part is smooth: no line is to be drawn. Which two sides are one
// surface is told from how often each is there and whose it is.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "frontmost/scene.h"

namespace frontmost::lines_detail {

/// A triangle at an edge, which is known by its lower vertex.
struct Side {
  std::uint32_t upper;  ///< the edge's other vertex
  std::uint32_t triangle;
  std::uint32_t opposite;  ///< the vertex that is not on the edge
  bool is_forward;         ///< the triangle runs from the lower vertex to the upper

  [[nodiscard]] auto key() const { return std::make_tuple(upper, opposite, triangle); }
};

/// Two sides between which a surface goes on.
using SidesOfSheet = std::pair<Side, Side>;

/// Which object and material a triangle belongs to.
struct SurfaceOf {
  std::uint32_t instance, material;
  friend bool operator==(const SurfaceOf&, const SurfaceOf&) = default;
};

/// What find_sheets() asks of the mesh.
struct SheetQuestions {
  std::function<SurfaceOf(std::uint32_t triangle)> surface_of;
  /// Whether two sides with different opposite vertices lie on each other: in one plane, on one side of the edge.
  std::function<bool(const Side&, const Side&)> overlap;
};

/// The sheets of an edge with more than two opposite vertices. Where objects have triangles in common, as a housing and
/// the cover on it, each of them goes on by itself: an object's two sides are a sheet, and so is a side that is there
/// as often as all of the object's others together with each of these. What objects leave alone is paired in the same
/// way. `sides` are those of one edge, with every double, sorted by opposite vertex; their winding does not matter.
/// \returns none where a side stays without a partner or has too many, and where sheets neither have sides in common
/// nor lie on each other: there surfaces meet. O(sides log sides), and the square of the sheets that have none in
/// common.
[[nodiscard]] std::optional<std::vector<SidesOfSheet>> find_sheets(std::span<const Side> sides,
                                                                   const SheetQuestions& questions);

}  // namespace frontmost::lines_detail
