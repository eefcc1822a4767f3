// SPDX-License-Identifier: Apache-2.0
// A sheet is a pair of an edge's sides that belong to one surface, where triangles are there more than once.
//
// Assemblies are exported part by part, and parts that touch have the same triangles where they do. An edge there has
// three or four sides, and yet every part is smooth: no line is to be drawn. The sides of one surface are found by how
// often each side occurs and by its object.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "frontmost/scene.h"

namespace frontmost::lines_detail {

/// A triangle at an edge; the edge's lower vertex is known from the context.
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

/// The questions that find_sheets() asks about the mesh.
struct SheetQuestions {
  std::function<SurfaceOf(std::uint32_t triangle)> surface_of;
  /// Whether two sides with different opposite vertices lie on each other: in one plane, on one side of the edge.
  std::function<bool(const Side&, const Side&)> overlap;
};

/// The sheets of an edge with more than two opposite vertices. Where objects share triangles, as a housing and its
/// cover do, each object is paired by itself. An object's two sides are a sheet. A side that occurs as often as all of
/// the object's others together forms a sheet with each of them. Sides that no object pairs are paired together in the
/// same way. `sides` are all sides of one edge, copies included, sorted by opposite vertex; their winding does not
/// matter.
/// \returns none where surfaces meet: a side has no partner or too many, or sheets neither share sides nor overlap.
/// O(sides log sides), and the square of the number of sheets without common sides.
[[nodiscard]] std::optional<std::vector<SidesOfSheet>> find_sheets(std::span<const Side> sides,
                                                                   const SheetQuestions& questions);

}  // namespace frontmost::lines_detail
