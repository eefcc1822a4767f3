// SPDX-License-Identifier: Apache-2.0
// How bright the points of a triangle are, but for what stands in the light. Brightness is the cosine of the angle
// between the normal and the direction to the light, with normals that go smoothly across edges that are no creases: so
// hatching follows a curved surface and not its triangles.
#pragma once

#include <array>
#include <vector>

#include "frontmost/scene.h"
#include "lines/hiding/occluder.h"
#include "lines/mesh/corner_table.h"

namespace frontmost::lines_detail {

/// A normal from point to point of a segment, from t = 0 to 1; of any length between.
struct NormalAlong {
  glm::dvec3 from, to;

  /// The cosine of the angle to a unit vector.
  [[nodiscard]] double cosine_at(double t, const glm::dvec3& to_light) const;
};

/// Where that cosine is less than `limit`, in order: at most three intervals.
void find_dark(const NormalAlong& normal, const glm::dvec3& to_light, double limit, std::vector<Interval>& dark);

/// Normals at the corners of triangles, across edges that are no creases.
class CornerNormals {
 public:
  CornerNormals(const SeenMesh& seen, const Surfaces& surfaces, double crease_angle, const Execution& execution);

  /// Of unit length, at the corners of a triangle, on the side from which it is counter-clockwise. O(triangles at its
  /// vertices); where there are very many, the triangle's own.
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
