// SPDX-License-Identifier: Apache-2.0
// Finds the segments along which triangles pass through each other.
//
//           /|             The segment that two triangles share ends where an edge of one of them passes through
//      ____/_|___          the other (o). An end is identified by the edge that it is on. The next triangle of the
//     /   o--o  /          same surface has that edge too and begins its segment at the same place, to the bit. So
//    /_______ _/           segments join to lines without any tolerance.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "lines/mesh/feature_edges.h"

namespace frontmost::lines_detail {

/// The point in which an edge meets the plane of a triangle.
struct CrossingEnd {
  glm::dvec3 place{0};                ///< rounded
  std::array<std::uint32_t, 2> on{};  ///< the edge's vertices; if one of them lies in the plane, that vertex twice
};

/// The segment that two triangles have in common.
struct Crossing {
  CrossingEnd from, to;
  std::uint32_t left, right;  ///< the triangles
};

/// An edge that lies in the plane of a triangle but is none of that triangle's edges. `from` is the lower vertex.
struct EdgeContact {
  std::uint32_t from, to, triangle;
  friend auto operator<=>(const EdgeContact&, const EdgeContact&) = default;
};

/// The segment of a contact, with the edges on which it lies, the lower vertex first; one edge is given twice.
struct ContactSegment {
  Crossing segment;
  std::array<std::pair<std::uint32_t, std::uint32_t>, 2> edges;
};

/// Intersections and contacts, which are the same in every view.
struct CrossedPairs {
  std::vector<Crossing> crossings;  ///< sorted by the segments' ends, each segment once
  std::vector<ContactSegment> contacts;
};

/// The segments of contacts, and of all pairs of triangles that each have a corner strictly on either side of the
/// other's plane, by exact signs. Copies of a triangle give each segment once. Of `features`, the twins and the spread
/// vertices are used. O(triangles log triangles + pairs whose boxes touch).
/// \throws Error limit_exceeded beyond 2^20 segments and 16 a triangle, or 2^27 pairs and 32 a triangle.
[[nodiscard]] CrossedPairs find_crossed_pairs(const WeldedMesh& mesh, const Features& features,
                                              const Execution& execution);

/// The segments of the pairs, and of those contacts that lie on no feature, so that every line exists once. Sorted by
/// their ends, each once. O(segments + contacts log(features + contacts)).
[[nodiscard]] std::vector<Crossing> find_crossings(const Features& features, const CrossedPairs& pairs,
                                                   const Execution& execution);

/// A segment for each contact whose edge reaches the triangle, if the edge's own two triangles lie on different sides
/// of the triangle's plane. If the edge lies along an edge of the triangle, there is a segment if the triangles of both
/// edges alternate around their common line. Ends at vertices are exact. O(triangles + contacts log contacts), or
/// nothing without contacts.
[[nodiscard]] std::vector<ContactSegment> segments_of(const WeldedMesh& mesh, std::vector<EdgeContact> contacts);

}  // namespace frontmost::lines_detail
