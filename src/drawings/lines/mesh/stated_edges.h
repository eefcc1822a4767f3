// SPDX-License-Identifier: Apache-2.0
// The edges that meshes state (Mesh::sharp_edges), on the vertices of a welded mesh.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "frontmost/scene.h"
#include "geometry/buckets.h"

namespace frontmost::lines_detail {

/// A circle in world space, with the edges that follow it: pairs of vertices.
struct StatedCircle {
  glm::dvec3 centre, axis;
  double radius;
  std::vector<glm::uvec2> edges;
};

class StatedEdges {
 public:
  StatedEdges() = default;
  /// `vertices` holds the welded vertex, or no_index, of each vertex over all instances; `triangles` the welded
  /// vertices of each primitive, x being no_index if it is left out; `places` the places of the welded vertices.
  StatedEdges(const Scene& scene, const Buffer<std::uint32_t>& vertices, const Buffer<glm::uvec3>& triangles,
              std::span<const glm::vec3> places, const Execution& execution);

  /// Adds sharp edges, pairs of vertices, beside those that meshes state.
  void add(std::span<const glm::uvec2> sharp, const Execution& execution);

  /// Whether no mesh states an edge that is a side of its triangles.
  [[nodiscard]] bool empty() const { return is_covered_.empty(); }
  /// Whether the instance has no other creases than its sharp edges: its mesh states where it is smooth.
  [[nodiscard]] bool cover(std::uint32_t instance) const { return !empty() && is_covered_[instance]; }
  /// Whether a sharp edge is stated between two vertices.
  [[nodiscard]] bool are_sharp(std::uint32_t a, std::uint32_t b) const {
    if (empty()) return false;
    const std::span<const std::uint32_t> ends = higher_ends_[std::min(a, b)];
    return std::binary_search(ends.begin(), ends.end(), std::max(a, b));
  }
  /// Whether the vertex is the lower one of a sharp edge.
  [[nodiscard]] bool is_lower_end(std::size_t vertex) const { return !empty() && !higher_ends_[vertex].empty(); }
  [[nodiscard]] const std::vector<StatedCircle>& circles() const { return circles_; }

 private:
  template <class List>
  void set(std::size_t vertices, std::size_t sources, const List& list, const Execution& execution);

  std::vector<bool> is_covered_;        ///< by instance; empty if no mesh states edges
  Buckets<std::uint32_t> higher_ends_;  ///< by vertex: the other ends of its sharp edges, if higher; ascending
  std::vector<StatedCircle> circles_;
};

}  // namespace frontmost::lines_detail
