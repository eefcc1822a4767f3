// SPDX-License-Identifier: Apache-2.0
// The points of a stream that decide bounds and framing, found in the triangles that count: those whose corners are all
// finite.
//
// A frame of the whole model needs its points, and a stream has forgotten them. But only points at the rim can touch a
// side of the picture, and there are few; so the finder keeps those alone, and its scene() stands for the model:
//
//        . * .                * kept: it is the farthest one towards a side of the frustum or of the bounds
//      *  . .  *              . forgotten: others lie farther out on every side
//        . * .
#pragma once

#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "surfaces/cluster_set.h"
#include "view/camera/extremes.h"

namespace frontmost::streaming {

/// Calls visit(corner, corner, corner) for the finite triangles from `begin` to `end`.
template <class Visit>
void for_finite_triangles(const Mesh& mesh, std::size_t begin, std::size_t end, const Visit& visit) {
  for (std::size_t t = begin; t < end; ++t) {
    const glm::uvec3& corners = mesh.triangles[t];
    const glm::vec3 &a = mesh.positions[corners.x], &b = mesh.positions[corners.y], &c = mesh.positions[corners.z];
    if (is_finite(a) && is_finite(b) && is_finite(c)) visit(a, b, c);
  }
}

[[nodiscard]] inline Box finite_bounds(const Mesh& mesh, std::size_t begin, std::size_t end) {
  Box box;
  for_finite_triangles(mesh, begin, end, [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    box.include(Box{glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c)});
  });
  return box;
}

class OutlineFinder {
 public:
  OutlineFinder(const View& direction, double margin);

  /// Triangles with corners that are not finite count for nothing.
  void include(const Mesh& mesh);
  void include(const OutlineFinder& other) { include(other.points()); }
  void include(std::span<const glm::vec3> points);
  /// Those that count: no more than a few hundred.
  [[nodiscard]] std::vector<glm::vec3> points() const;
  [[nodiscard]] const Box& bounds() const { return bounds_; }
  /// The points as triangles without area: surfaces of it have the bounds of all, and frame() frames them alike.
  [[nodiscard]] Scene scene() const;

 private:
  /// False when no point within the box would be kept.
  [[nodiscard]] bool may_change_by(const Box& box) const;
  void include_run(const Mesh& mesh, std::size_t begin, std::size_t end);
  void include_corners(const Mesh& mesh, std::size_t begin, std::size_t end);
  void include(const glm::vec3& point);

  Extremes extremes_;
  Box bounds_;
  glm::vec3 ends_[6] = {};  ///< a point at each side of the bounds
};

}  // namespace frontmost::streaming
