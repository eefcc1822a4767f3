// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "abuffer/tables.h"

namespace frontmost::bench {

Stage make_lit(std::string_view scene_name, const std::string& models) {
  Stage plain(scene_name, models);
  const View& view = plain.view;
  const glm::vec3 light = glm::normalize(glm::vec3(-view.forward() + 0.5 * view.up() - 0.3 * view.right()));
  Scene lit = std::move(plain.scene);
  // Copies are shifted, not turned.
  for (Mesh& mesh : lit.meshes)
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const glm::uvec3& corners = mesh.triangles[t];
      const glm::vec3& first = mesh.positions[corners.x];
      const glm::vec3 normal = glm::cross(mesh.positions[corners.y] - first, mesh.positions[corners.z] - first);
      const float length = glm::length(normal);
      const float cosine = length > 0 ? std::abs(glm::dot(normal, light)) / length : 0.0f;
      mesh.colors.values.emplace_back(glm::vec3(0.15f + 0.85f * cosine), 1.0f);
      mesh.colors.triangles.emplace_back(t);
    }
  return Stage(std::move(lit), view);
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

Image draw_layers(const Stage& stage, const AbufferOptions& options, const Execution& execution) {
  ShadeOptions flat{.shading = Shading::flat, .background = std::nullopt};
  flat.opacity = options.opacity;
  flat.layers.see_through = SeeThrough::always;
  flat.layers.grid = options.grid;
  return shade(stage.surfaces, zbuffer(stage.surfaces, stage.view, execution), flat, execution);
}

}  // namespace frontmost::bench
