// SPDX-License-Identifier: Apache-2.0
#include "report/faces/mesh_sides.h"

#include "base/parallel.h"
#include "geometry/places.h"

namespace frontmost::faces_detail {
namespace {

constexpr std::size_t kTrianglesAtOnce = 8192;

}  // namespace

EdgeNeighbours mesh_sides(const Mesh& mesh, const Execution& execution) {
  const Buffer<std::uint32_t> first = first_at_place(mesh.positions, execution);
  std::vector<glm::uvec3> triangles(mesh.triangles.size());
  parallel_for(execution, triangles.size(), kTrianglesAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const glm::uvec3& c = mesh.triangles[t];
      triangles[t] = {first[c.x], first[c.y], first[c.z]};
    }
  });
  return {triangles, mesh.positions.size(), execution};
}

std::vector<EdgeNeighbours> sides_of_meshes(const Scene& scene, const Execution& execution) {
  std::vector<bool> is_placed(scene.meshes.size(), false);
  for (const Instance& instance : scene.instances) is_placed[instance.mesh] = true;
  std::vector<EdgeNeighbours> sides(scene.meshes.size());
  parallel_for(execution, scene.meshes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t m = begin; m < end; ++m)
      if (is_placed[m]) sides[m] = mesh_sides(scene.meshes[m], execution);
  });
  return sides;
}

}  // namespace frontmost::faces_detail
