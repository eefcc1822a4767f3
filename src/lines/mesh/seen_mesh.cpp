// SPDX-License-Identifier: Apache-2.0
// Which way a triangle faces is on which side of its plane the eye is: that takes its normal, which creases need, too.
#include "lines/mesh/seen_mesh.h"

#include "base/parallel.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kTrianglesPerPart = 4096;

/// The side of a triangle's plane on which the eye is, exactly.
int side_of_eye(const WeldedMesh& mesh, std::size_t triangle, const Sight& sight) {
  const glm::uvec3& t = mesh.triangles[triangle];
  const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
  return sign_of_determinant({b, a}, {c, a},
                             sight.is_parallel() ? Leg{glm::dvec3(0), sight.forward()} : Leg{sight.eye(), a});
}

}  // namespace

SeenMesh see(const WeldedMesh& mesh, const Sight& sight, const Execution& execution) {
  const std::size_t count = mesh.triangles.size();
  SeenMesh seen{mesh, Buffer<std::int8_t>(count), Buffer<SeenTriangle>(count)};
  const SeeKernel see_triangles = see_kernel(execution.isa);
  parallel_for(execution, count, kTrianglesPerPart, [&](std::size_t begin, std::size_t end) {
    see_triangles(mesh, sight, begin, end, seen.triangles.data());
    for (std::size_t i = begin; i < end; ++i) {
      SeenTriangle& triangle = seen.triangles[i];
      if (triangle.is_open())
        triangle.bits ^= SeenTriangle::kOpen ^ std::uint32_t(side_of_eye(mesh, i, sight) + 1)
                                                   << SeenTriangle::kFacingShift;
      seen.facing[i] = std::int8_t(triangle.facing());
    }
  });
  return seen;
}

}  // namespace frontmost::lines_detail
