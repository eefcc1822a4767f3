// SPDX-License-Identifier: Apache-2.0
// Which way a triangle faces is on which side of its plane the eye is: that takes its normal, which creases need, too.
#include "lines/seen_mesh.h"

#include "base/parallel.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kTrianglesPerPart = 4096;

/// The side of the plane through a, b and c with normal n on which the eye is.
int facing(const BoundedNormal& n, const glm::dvec3 (&at)[3], const Sight& sight) {
  const Leg to_eye = sight.is_parallel() ? Leg{glm::dvec3(0), sight.forward()} : Leg{sight.eye(), at[0]};
  const int sign = certain_sign(bounded_dot(n.value, n.error, to_eye.to - to_eye.from));
  return sign != 2 ? sign : sign_of_determinant({at[1], at[0]}, {at[2], at[0]}, to_eye);
}

}  // namespace

SeenMesh see(const WeldedMesh& mesh, const Sight& sight, const Execution& execution) {
  const std::size_t count = mesh.triangles.size();
  SeenMesh seen{mesh, Buffer<std::int8_t>(count), Buffer<glm::dvec3>(count)};
  parallel_for(execution, count, kTrianglesPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const glm::uvec3& t = mesh.triangles[i];
      const glm::dvec3 at[3] = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
      const BoundedNormal normal(at[1] - at[0], at[2] - at[0]);
      seen.facing[i] = std::int8_t(facing(normal, at, sight));
      seen.normals[i] = normal.value;
    }
  });
  return seen;
}

}  // namespace frontmost::lines_detail
