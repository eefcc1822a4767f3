// SPDX-License-Identifier: Apache-2.0
// Faces of CAD files have vertices of their own, so sides are compared by their places.
#include "scene/edges.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace frontmost {
namespace {

using VertexPlace = std::array<float, 3>;

struct SideAtPlace {
  std::array<VertexPlace, 2> ends;  ///< the lesser one first
  glm::uvec2 edge;
};

bool is_before(const SideAtPlace& a, const SideAtPlace& b) { return a.ends < b.ends; }

/// Appends a side, unless it has no length or an end that is not finite.
void add_side(const Mesh& mesh, const glm::uvec2& edge, std::vector<SideAtPlace>& sides) {
  const glm::vec3 from = mesh.positions[edge.x] + 0.0f, to = mesh.positions[edge.y] + 0.0f;  // -0 is 0
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(from[axis]) || !std::isfinite(to[axis])) return;
  const VertexPlace a{from.x, from.y, from.z}, b{to.x, to.y, to.z};
  if (a != b) sides.push_back({{std::min(a, b), std::max(a, b)}, edge});
}

std::vector<SideAtPlace> sorted_edges(const Mesh& mesh, const std::vector<glm::uvec2>& edges) {
  std::vector<SideAtPlace> sides;
  for (const glm::uvec2& edge : edges) add_side(mesh, edge, sides);
  std::sort(sides.begin(), sides.end(), is_before);
  return sides;
}

/// Calls `take` with each side of the triangles that has a length. \returns whether `take` returned true, which ends
/// it.
template <class Take>
bool any_side(const Mesh& mesh, const Take& take) {
  std::vector<SideAtPlace> side;
  for (const glm::uvec3& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      side.clear();
      add_side(mesh, {t[k], t[(k + 1) % 3]}, side);
      if (!side.empty() && take(side[0])) return true;
    }
  return false;
}

/// Whether a smooth edge is a side of triangles.
bool is_covered(const Mesh& mesh) {
  if (mesh.smooth_edges.empty()) return false;
  const std::vector<SideAtPlace> smooth = sorted_edges(mesh, mesh.smooth_edges);
  return any_side(
      mesh, [&](const SideAtPlace& side) { return std::binary_search(smooth.begin(), smooth.end(), side, is_before); });
}

}  // namespace

void keep_covered(const Mesh& from, Mesh& to) {
  if (is_covered(to) || !is_covered(from)) return;
  const std::vector<SideAtPlace> sharp = sorted_edges(to, to.sharp_edges);
  std::vector<SideAtPlace> sides;
  any_side(to, [&](const SideAtPlace& side) {
    if (!std::binary_search(sharp.begin(), sharp.end(), side, is_before)) sides.push_back(side);
    return false;
  });
  std::sort(sides.begin(), sides.end(), is_before);
  // A side of one triangle alone has no angle.
  const auto pair = std::adjacent_find(sides.begin(), sides.end(),
                                       [](const SideAtPlace& a, const SideAtPlace& b) { return a.ends == b.ends; });
  if (pair != sides.end()) to.smooth_edges.push_back(pair->edge);
}

}  // namespace frontmost
