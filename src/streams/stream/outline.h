// SPDX-License-Identifier: Apache-2.0
// Finds the points of a stream that decide bounds and framing. Only triangles with three finite vertices count.
//
// Framing needs the points of the whole model, which a stream does not keep. But only points at the rim can touch a
// side of the picture, and there are few of them. The finder keeps only these, and its scene() stands for the model:
//
//        . * .                * kept: the farthest point towards a side of the frustum or of the bounds
//      *  . .  *              . dropped: other points lie farther out on every side
//        . * .
#pragma once

#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "surfaces/cluster_set.h"
#include "view/camera/extremes.h"

namespace frontmost::streaming {

/// Calls visit(a, b, c) with the vertices of each finite triangle from `begin` to `end`.
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

  /// Triangles with non-finite vertices are ignored.
  void include(const Mesh& mesh);
  void include(const OutlineFinder& other) { include(other.points()); }
  void include(std::span<const glm::vec3> points);
  /// The points kept: no more than a few hundred.
  [[nodiscard]] std::vector<glm::vec3> points() const;
  [[nodiscard]] const Box& bounds() const { return bounds_; }
  /// The points as triangles without area. Surfaces of this scene have the model's bounds, and frame() frames them
  /// alike.
  [[nodiscard]] Scene scene() const;

 private:
  /// False if no point within the box would be kept.
  [[nodiscard]] bool may_change_by(const Box& box) const;
  void include_run(const Mesh& mesh, std::size_t begin, std::size_t end);
  void include_corners(const Mesh& mesh, std::size_t begin, std::size_t end);
  void include(const glm::vec3& point);

  Extremes extremes_;
  Box bounds_;
  glm::vec3 ends_[6] = {};  ///< a point on each side of the bounds
};

}  // namespace frontmost::streaming
