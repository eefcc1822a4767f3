// SPDX-License-Identifier: Apache-2.0
#include "abuffer/pictures.h"

#include <cmath>

namespace frontmost::bench {

const ResolvedPicture& Pictures::draw(int grid, const Execution& execution) {
  light();
  return draw_unlit(grid, execution);
}

const ResolvedPicture& Pictures::draw_unlit(int grid, const Execution& execution) {
  return resolver_.draw(stage_.surfaces, stage_.view, colors_, {grid, 1.0f}, execution);
}

void Pictures::light() {
  constexpr float kOpacity = 0.4f;
  const View& view = stage_.view;
  const glm::vec3 light = glm::normalize(glm::vec3(-view.forward() + 0.5 * view.up() - 0.3 * view.right()));
  colors_.resize(stage_.surfaces.primitive_count());
  std::size_t id = 0;
  for (const Instance& instance : stage_.scene.instances) {
    // Copies are shifted, not turned.
    const Mesh& mesh = stage_.scene.meshes[instance.mesh];
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::vec3& corner = mesh.positions[t.x];
      const glm::vec3 normal = glm::cross(mesh.positions[t.y] - corner, mesh.positions[t.z] - corner);
      const float length = glm::length(normal);
      const float cosine = length > 0 ? std::abs(glm::dot(normal, light)) / length : 0.0f;
      colors_[id++] = glm::vec4(glm::vec3(0.15f + 0.85f * cosine), kOpacity);
    }
  }
}

Stage make_sheets(int count, int width, int height) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  for (int i = 0; i < count; ++i) {
    const float z = -float(i) / float(count);
    const auto n = std::uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {{-9, -9, z}, {9, -9, z}, {9, 9, z}, {-9, 9, z}});
    mesh.triangles.insert(mesh.triangles.end(), {{n, n + 1, n + 2}, {n, n + 2, n + 3}});
  }
  scene.instances.push_back({"sheets", 0, glm::dmat4(1.0)});
  View view;
  view.width = width;
  view.height = height;
  view.world_from_eye = look_at({0, 0, 1}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_projection(1, double(width) / height, {0.5, 3});
  return Stage(std::move(scene), view);
}

}  // namespace frontmost::bench
