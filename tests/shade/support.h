// SPDX-License-Identifier: Apache-2.0
// Small scenes and views for the tests of shading.
#pragma once

#include "frontmost/image.h"
#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "support/random_scene.h"

namespace frontmost::test {

inline Material colored(const glm::vec4& base) {
  Material material;
  material.base_color = base;
  return material;
}

/// A square of side 2 about the origin that faces +z; u to the right, v down.
inline Mesh square() {
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.texcoords.values = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  return mesh;
}

inline Scene scene_of(Mesh mesh, const Material& material) {
  mesh.material_ids = {0};
  Scene scene = scene_of(std::move(mesh));
  scene.materials.push_back(material);
  return scene;
}

/// A see-through square in front of a larger opaque blue one.
inline Scene layered_scene(Material::Alpha alpha, const glm::vec4& front) {
  Material see_through = colored(front);
  see_through.alpha = alpha;
  Scene scene = scene_of(square(), see_through);
  scene.materials.push_back(colored({0, 0, 1, 1}));
  scene.meshes.push_back(square());
  scene.meshes[1].material_ids = {1};
  scene.instances.push_back({"behind", 1, glm::dmat4(1.5)});
  scene.instances[1].world_from_mesh[3] = {0, 0, -1, 1};
  return scene;
}

/// Looks at the origin from (0, 0, 10), in parallel projection; the picture is 4 x 4 units.
inline View front_view(int size = 64, int samples = 1) {
  View view;
  view.width = view.height = size;
  view.samples = samples;
  view.world_from_eye = look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_orthographic(-2, 2, -2, 2, {1, 20});
  return view;
}

inline Texture texture_of(int width, int height, std::vector<glm::u8vec4> pixels) {
  Texture texture;
  texture.width = width;
  texture.height = height;
  texture.pixels = std::move(pixels);
  return texture;
}

/// Allowed difference of colours. A triangle's planes are rounded about its first shaded pixel, so colours differ by
/// less than this if that is another pixel.
inline constexpr float plane_rounding = 2e-5f;

inline glm::vec4 color_at(const Image& image, int x, int y) {
  const auto i = std::size_t(y * image.width + x);
  glm::vec4 color;
  int k = 0;
  for (const char* name : {"R", "G", "B", "A"}) color[k++] = image.find(name)->floats()[i];
  return color;
}

}  // namespace frontmost::test
