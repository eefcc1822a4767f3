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

/// Appends the edges and circles of a mesh to another mesh. `taken(edge)` returns an edge by vertices of `to`, or
/// nothing if the edge is left out. A circle keeps those of its edges that are taken.
template <class Taken>
void append_edges(const Mesh& from, const glm::dmat4& to_from_from, const Taken& taken, Mesh& to) {
  std::vector<std::uint32_t> places;  // of each sharp edge, or of the next one that is taken
  for (const glm::uvec2& edge : from.sharp_edges) {
    places.push_back(std::uint32_t(to.sharp_edges.size()));
    if (const std::optional<glm::uvec2> own = taken(edge)) to.sharp_edges.push_back(*own);
  }
  places.push_back(std::uint32_t(to.sharp_edges.size()));
  for (const glm::uvec2& edge : from.smooth_edges)
    if (const std::optional<glm::uvec2> own = taken(edge)) to.smooth_edges.push_back(*own);
  for (const EdgeCircle& circle : from.edge_circles) {
    std::optional<EdgeCircle> own = transformed(circle, to_from_from);
    if (!own) continue;
    own->first = places[circle.first];
    own->count = places[circle.first + circle.count] - own->first;
    if (own->count > 0) to.edge_circles.push_back(*own);
  }
}

}  // namespace frontmost
