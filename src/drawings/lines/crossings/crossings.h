// SPDX-License-Identifier: Apache-2.0
// Segments along which triangles pass through each other.
//
//           /|             The segment that two triangles share ends where an edge of one of them passes through
//      ____/_|___          the other (o). An end is identified by the edge that it is on. The next triangle of the
//     /   o--o  /          same surface has that edge too and begins its segment at the same place, to the bit. So
//    /_______ _/           segments join to lines without any tolerance.
#pragma once

#include <array>
#include <vector>

#include "lines/mesh/feature_edges.h"

namespace frontmost::lines_detail {

/// The point in which an edge meets the plane of a triangle.
struct CrossingEnd {
  glm::dvec3 place{0};                ///< rounded
  std::array<std::uint32_t, 2> on{};  ///< the edge's vertices; the same vertex twice where it lies in the plane
};

/// The segment that two triangles have in common.
struct Crossing {
  CrossingEnd from, to;
  std::uint32_t left, right;  ///< the triangles
};

/// The segments of all pairs of triangles that each have a corner strictly on either side of the other's plane, by
/// exact signs, and those of add_contacts(). Copies of a triangle give each segment once. Sorted by the segments' ends.
/// O(triangles log triangles + pairs whose boxes touch).
/// \throws Error limit_exceeded beyond 2^20 segments and 16 a triangle, or 2^27 pairs and 32 a triangle.
[[nodiscard]] std::vector<Crossing> find_crossings(const WeldedMesh& mesh, const Features& features,
                                                   const Execution& execution);

/// An edge, the lower vertex first, that lies in the plane of a triangle whose edge it is not.
struct EdgeContact {
  std::uint32_t from, to, triangle;
  friend auto operator<=>(const EdgeContact&, const EdgeContact&) = default;
};

/// Appends the segments of contacts whose edge reaches the triangle and has its own two triangles on different sides of
/// it. Where two edges lie along each other, a segment is appended if their triangles alternate around them. Edges that
/// are drawn give no segment, so that every line is there once. Ends at vertices are exact. O(triangles + contacts log
/// contacts), or nothing without contacts.
void add_contacts(const WeldedMesh& mesh, const Features& features, std::vector<EdgeContact> contacts,
                  std::vector<Crossing>& crossings);

}  // namespace frontmost::lines_detail
