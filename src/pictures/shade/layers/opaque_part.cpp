// SPDX-License-Identifier: Apache-2.0
#include "shade/layers/opaque_part.h"

#include <algorithm>

namespace frontmost::shading {
namespace {

bool is_see_through(const Scene& scene, std::uint32_t material) {
  return material < scene.materials.size() && scene.materials[material].is_see_through();
}

/// Keeps the elements whose triangle is kept.
template <class T>
std::vector<T> kept(const std::vector<T>& values, const std::vector<std::uint32_t>& triangles) {
  std::vector<T> result;
  result.reserve(triangles.size());
  for (const std::uint32_t t : triangles) result.push_back(values[t]);
  return result;
}

template <class T>
Attribute<T> kept(const Attribute<T>& attribute, const std::vector<std::uint32_t>& triangles) {
  if (attribute.triangles.empty()) return attribute;
  return {attribute.values, kept(attribute.triangles, triangles)};
}

Mesh opaque_part(const Scene& scene, const Mesh& mesh) {
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    if (!is_see_through(scene, mesh.material_of(t))) triangles.push_back(t);
  Mesh part;
  if (triangles.empty()) return part;
  part.positions = mesh.positions;
  part.triangles = kept(mesh.triangles, triangles);
  part.normals = kept(mesh.normals, triangles);
  part.texcoords = kept(mesh.texcoords, triangles);
  for (const Attribute<glm::vec2>& set : mesh.further_texcoords) part.further_texcoords.push_back(kept(set, triangles));
  part.colors = kept(mesh.colors, triangles);
  part.material_ids = mesh.material_ids.size() > 1 ? kept(mesh.material_ids, triangles) : mesh.material_ids;
  return part;
}

}  // namespace

bool has_see_through(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& m) { return m.is_see_through(); });
}

Scene opaque_part(const Scene& scene) {
  Scene part;
  part.name = scene.name;
  for (const Mesh& mesh : scene.meshes) part.meshes.push_back(opaque_part(scene, mesh));
  part.instances = scene.instances;
  part.materials = scene.materials;
  part.textures.resize(scene.textures.size());  // the numbers must exist; most pixels are not copied
  for (const Material& m : scene.materials) {
    const std::uint32_t texture = m.base_color_texture.texture;
    if (m.alpha == Material::Alpha::mask && m.base_color_texture.is_set())
      part.textures[texture] = scene.textures[texture];
  }
  part.up = scene.up;
  return part;
}

}  // namespace frontmost::shading
