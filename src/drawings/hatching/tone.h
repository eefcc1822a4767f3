// SPDX-License-Identifier: Apache-2.0
// The brightness of a triangle's points, without shadows: the cosine of the angle between the normal and the direction
// to the light. Normals are smooth across edges that are no creases, so hatching follows a curved surface, not its
// triangles.
#pragma once

#include <array>
#include <vector>

#include "frontmost/scene.h"
#include "lines/hiding/occluder.h"
#include "lines/mesh/corner_table.h"

namespace frontmost::lines_detail {

/// A normal that is linear along a segment, from t = 0 to 1; not of unit length in between.
struct NormalAlong {
  glm::dvec3 from, to;

  /// The cosine of the angle to a unit vector.
  [[nodiscard]] double cosine_at(double t, const glm::dvec3& to_light) const;
};

/// The intervals in which that cosine is less than `limit`, in order: at most three.
void find_dark(const NormalAlong& normal, const glm::dvec3& to_light, double limit, std::vector<Interval>& dark);

/// Vertex normals of triangles, smooth across edges that are no creases.
class CornerNormals {
 public:
  CornerNormals(const SeenMesh& seen, const Surfaces& surfaces, double crease_angle, const Execution& execution);

  /// The unit normals at the vertices of a triangle, on the side from which it is counter-clockwise. Vertices with very
  /// many triangles have the triangle's own normal. O(triangles at its vertices).
  [[nodiscard]] std::array<glm::dvec3, 3> of(std::uint32_t triangle) const;

 private:
  [[nodiscard]] glm::dvec3 at(std::uint32_t triangle, int corner, const glm::dvec3& own) const;
  [[nodiscard]] glm::dvec3 unit_normal(std::uint32_t triangle) const;

  const WeldedMesh& mesh_;
  Buffer<glm::dvec3> normals_;
  const Surfaces& surfaces_;
  const double cosine_;
  const CornerTable corners_;
};

}  // namespace frontmost::lines_detail
