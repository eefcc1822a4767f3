// SPDX-License-Identifier: Apache-2.0
// A mesh with its triangles' neighbours, what is smooth between them, and its edges that are not, one after the other.
//
// An edge is smooth where its two triangles turn by no more than one step of a circle of eighteen sides. All smooth
// neighbours together are one surface, from which rounds are told; sharp edges are its rims, among which circles are
// looked for.
#pragma once

#include <vector>

#include "geometry/edge_neighbours.h"
#include "lines/mesh/seen_mesh.h"

namespace frontmost::lines_detail {

/// 20.01 degrees: between two neighbours that turn by more there is an edge, and between two sides of a polygon a
/// corner. As arcs have it.
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

/// O(triangles log triangles at a vertex). \throws Error limit_exceeded for more than EdgeNeighbours::most_triangles.
[[nodiscard]] SmoothMesh smooth_mesh(const Surfaces& surfaces, const Execution& execution);

/// An edge and the triangles at it; `right` may be no_index.
struct SharpEdge {
  std::uint32_t from, to, left, right;
};

struct SharpChain {
  std::vector<std::uint32_t> vertices;  ///< of a closed one the first comes once
  std::vector<std::uint32_t> edges;     ///< the i-th goes from the i-th vertex to the next
  bool is_closed = false;
};

struct SharpChains {
  std::vector<SharpEdge> edges;
  std::vector<SharpChain> chains;
};

inline constexpr std::size_t kFewestSides = 4;  ///< of an arc

/// Each edge is in one chain, but for those of chains that are shorter than an arc. Where several meet, those go on in
/// each other that turn least, and none whose turn has a cosine below `least_cosine`. O(edges log edges at a vertex).
[[nodiscard]] SharpChains sharp_chains(const SmoothMesh& mesh, const Execution& execution,
                                       double least_cosine = kWidestCosine);

}  // namespace frontmost::lines_detail
