// SPDX-License-Identifier: Apache-2.0
// The edges that a mesh states (Mesh::sharp_edges), taken into other meshes.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "frontmost/scene.h"

namespace frontmost {

/// Returns the circle after a transform, or nothing if the transform does not scale all lengths alike.
[[nodiscard]] inline std::optional<EdgeCircle> transformed(EdgeCircle circle, const glm::dmat4& transform) {
  const glm::dmat3 m(transform);
  const double square = glm::dot(m[0], m[0]), slack = 1e-6 * square, scale = std::sqrt(square);
  const auto is_near = [&](double a, double b) { return std::abs(a - b) <= slack; };
  const bool is_similar = square > 0 && is_near(glm::dot(m[1], m[1]), square) &&
                          is_near(glm::dot(m[2], m[2]), square) && is_near(glm::dot(m[0], m[1]), 0) &&
                          is_near(glm::dot(m[1], m[2]), 0) && is_near(glm::dot(m[2], m[0]), 0);
  if (!is_similar) return std::nullopt;
  circle.centre = glm::dvec3(transform * glm::dvec4(circle.centre, 1));
  circle.axis = m * circle.axis / scale;
  circle.radius *= scale;
  return circle;
}

/// Appends the edges and circles of a mesh to another mesh. `edge_in_to(edge)` returns an edge by vertices of `to`, or
/// nothing if the edge is left out. A circle keeps those of its edges that are taken.
template <class EdgeInTo>
void append_edges(const Mesh& from, const glm::dmat4& to_from_from, const EdgeInTo& edge_in_to, Mesh& to) {
  // The new number of each sharp edge; of an edge that is left out, that of the next one that is taken.
  std::vector<std::uint32_t> new_numbers;
  for (const glm::uvec2& edge : from.sharp_edges) {
    new_numbers.push_back(std::uint32_t(to.sharp_edges.size()));
    if (const std::optional<glm::uvec2> own = edge_in_to(edge)) to.sharp_edges.push_back(*own);
  }
  new_numbers.push_back(std::uint32_t(to.sharp_edges.size()));
  for (const glm::uvec2& edge : from.smooth_edges)
    if (const std::optional<glm::uvec2> own = edge_in_to(edge)) to.smooth_edges.push_back(*own);
  for (const EdgeCircle& circle : from.edge_circles) {
    std::optional<EdgeCircle> own = transformed(circle, to_from_from);
    if (!own) continue;
    own->first = new_numbers[circle.first];
    own->count = new_numbers[circle.first + circle.count] - own->first;
    if (own->count > 0) to.edge_circles.push_back(*own);
  }
}

/// Drawings judge no angles of a mesh that states smooth sides of its triangles. `to`, which is what is left of `from`,
/// states a side that is not sharp as smooth if it would be judged now. Takes n log n for n triangles if no
/// smooth side is left.
void keep_covered(const Mesh& from, Mesh& to);

}  // namespace frontmost
