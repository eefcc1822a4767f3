// SPDX-License-Identifier: Apache-2.0
// A mesh with the neighbours of its triangles, the smoothness between them, and chains of its sharp edges.
//
// An edge is smooth if its two triangles turn by at most one step of a circle of eighteen sides. Connected smooth
// triangles form one surface, in which cylinders and other rounds are found. Sharp edges are its rims, among which
// circles are found.
#pragma once

#include <vector>

#include "geometry/edge_neighbours.h"
#include "lines/mesh/seen_mesh.h"

namespace frontmost::lines_detail {

/// 20.01 degrees: a larger turn between two neighbours is an edge, and between two sides of a polygon a corner. The
/// same limit as for arcs of strokes.
inline constexpr double kWidestStep = 0.34924038;
inline constexpr double kWidestCosine = 0.93963;

struct SmoothMesh {
  WeldedMesh mesh;
  Buffer<glm::dvec3> normals;  ///< of unit length; zero where rounding leaves no direction
  EdgeNeighbours neighbours;
  double noise = 0;  ///< by how much corners may be off their places: what six digits leave open

  [[nodiscard]] glm::dvec3 corner(std::uint32_t triangle, int k) const {
    return mesh.positions[mesh.triangles[triangle][k]];
  }
  /// The only other triangle at a side, if it is wound alike; otherwise no_index.
  [[nodiscard]] std::uint32_t across(std::uint32_t triangle, int side) const {
    return neighbours.across(triangle, std::size_t(side));
  }
  [[nodiscard]] bool is_smooth(std::uint32_t triangle, int side) const {
    const std::uint32_t other = across(triangle, side);
    return other != no_index && glm::dot(normals[triangle], normals[other]) >= kWidestCosine;
  }
};

/// O(triangles log triangles at a vertex). \throws Error limit_exceeded as EdgeNeighbours does.
[[nodiscard]] SmoothMesh smooth_mesh(const Surfaces& surfaces, const Execution& execution);

/// An edge and its triangles; `right` may be no_index.
struct SharpEdge {
  std::uint32_t from, to, left, right;
};

struct SharpChain {
  std::vector<std::uint32_t> vertices;  ///< a closed chain has its first vertex once
  std::vector<std::uint32_t> edges;     ///< edge i goes from vertex i to the next
  bool is_closed = false;
};

struct SharpChains {
  std::vector<SharpEdge> edges;
  std::vector<SharpChain> chains;
};

inline constexpr std::size_t kFewestSides = 4;  ///< the fewest of an arc

/// Each edge is in one chain, except edges of chains that are shorter than an arc. Where several edges meet, the
/// straightest pairs continue each other, unless the cosine of the turn is below `least_cosine`. O(edges log edges at a
/// vertex).
[[nodiscard]] SharpChains sharp_chains(const SmoothMesh& mesh, const Execution& execution,
                                       double least_cosine = kWidestCosine);

}  // namespace frontmost::lines_detail
