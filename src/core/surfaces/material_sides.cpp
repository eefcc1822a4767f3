// SPDX-License-Identifier: Apache-2.0
#include "surfaces/material_sides.h"

#include <algorithm>

namespace frontmost {
namespace {

/// The sides of the materials of one mesh's triangles, or of several meshes.
struct SidesFound {
  bool is_any_double = false, is_any_single = false;

  [[nodiscard]] bool are_mixed() const { return is_any_double && is_any_single; }
};

SidesFound sides_of(const Scene& scene, const Mesh& mesh) {
  SidesFound found;
  const auto add = [&](std::uint32_t material) {
    (is_double_sided(scene, material) ? found.is_any_double : found.is_any_single) = true;
  };
  if (mesh.triangles.empty()) return found;
  if (mesh.material_ids.size() <= 1) add(mesh.material_of(0));
  for (std::size_t i = 0; mesh.material_ids.size() > 1 && i < mesh.material_ids.size() && !found.are_mixed(); ++i)
    add(mesh.material_ids[i]);
  return found;
}

}  // namespace

bool is_double_sided(const Scene& scene, std::uint32_t material) {
  return material < scene.materials.size() && scene.materials[material].double_sided;
}

std::shared_ptr<const MaterialSides> MaterialSides::of(const Scene& scene,
                                                       const std::vector<PrimitiveId>& first_primitives) {
  const auto sides = std::make_shared<MaterialSides>();
  const auto is_double = [](const Material& material) { return material.double_sided; };
  if (std::none_of(scene.materials.begin(), scene.materials.end(), is_double)) return sides;
  std::vector<SidesFound> of_meshes;
  of_meshes.reserve(scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) of_meshes.push_back(sides_of(scene, mesh));
  SidesFound all;
  for (const Instance& instance : scene.instances) {
    all.is_any_double |= of_meshes[instance.mesh].is_any_double;
    all.is_any_single |= of_meshes[instance.mesh].is_any_single;
  }
  sides->are_all_double = all.is_any_double && !all.is_any_single;
  if (!all.are_mixed()) return sides;
  sides->bits.assign(std::size_t(first_primitives.back()) / 32 + 1, 0);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
    const SidesFound& found = of_meshes[scene.instances[i].mesh];
    PrimitiveId id = first_primitives[i];
    for (std::uint32_t t = 0; found.is_any_double && t < mesh.triangles.size(); ++t, ++id)
      if (!found.is_any_single || is_double_sided(scene, mesh.material_of(t)))
        sides->bits[id / 32] |= std::uint32_t(1) << (id % 32);
  }
  return sides;
}

}  // namespace frontmost
