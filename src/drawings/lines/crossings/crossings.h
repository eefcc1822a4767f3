// SPDX-License-Identifier: Apache-2.0
// Where triangles pass through each other.
//
//           /|             The segment that two triangles share ends where an edge of one of them passes through
//      ____/_|___          the other (o). An end is known by the edge that it is on, so that the next triangle of
//     /   o--o  /          the same surface, which has that edge too, begins its segment at the same place to the
//    /_______ _/           bit: segments join to lines without any tolerance.
#pragma once

#include <array>
#include <vector>

#include "lines/mesh/feature_edges.h"

namespace frontmost::lines_detail {

/// Where an edge meets the plane of a triangle.
struct CrossingEnd {
  glm::dvec3 place{0};                ///< rounded
  std::array<std::uint32_t, 2> on{};  ///< the edge's vertices; twice the same where one lies in the plane
};

/// The segment that two triangles have in common.
struct Crossing {
  CrossingEnd from, to;
  std::uint32_t left, right;  ///< the triangles
};

/// The segments of all pairs of triangles each of which has a corner strictly on either side of the other's plane, by
/// exact signs, and those of add_contacts(). Ends are computed from the edge and the plane that they are on, so that
/// the next segment along a surface begins where one ends, to the bit. Triangles that are there twice give each segment
/// once. In the order of their ends. O(triangles log triangles + pairs whose boxes touch).
/// \throws Error limit_exceeded for more than 2^20 segments and 16 for each triangle, or more than 2^27 pairs and 32
/// for each triangle.
[[nodiscard]] std::vector<Crossing> find_crossings(const WeldedMesh& mesh, const Features& features,
                                                   const Execution& execution);

// Where surfaces pass through each other exactly along an edge.

/// An edge, the lower vertex first, that lies in the plane of a triangle of which it is no edge.
struct EdgeContact {
  std::uint32_t from, to, triangle;
};

/// Appends the segments of those edges that the triangle reaches and whose own two triangles lie on different sides of
/// it; and where two edges lie along each other, of those whose triangles follow each other in turn around them. Edges
/// that are drawn give none, so that every line is there once. Ends are exact where they are vertices.
/// O(triangles + contacts log contacts), or nothing without contacts.
void add_contacts(const WeldedMesh& mesh, const Features& features, std::vector<EdgeContact> contacts,
                  std::vector<Crossing>& crossings);

}  // namespace frontmost::lines_detail
