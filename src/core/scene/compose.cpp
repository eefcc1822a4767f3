// SPDX-License-Identifier: Apache-2.0
// Matrices of movements, turns and sizes, computed here because glm's use the C library's sine and cosine, whose last
// bits differ from one system to the next.
#include "scene/compose.h"

#include <cmath>
#include <utility>

#include "base/srgb.h"
#include "scene/turn.h"

namespace frontmost {

Material paint(std::string name, std::uint32_t srgb, float roughness, float metallic) {
  Material material;
  material.name = std::move(name);
  material.base_color = color(srgb);
  material.roughness = roughness;
  material.metallic = metallic;
  return material;
}

std::uint32_t add(Scene& scene, Material material) {
  scene.materials.push_back(std::move(material));
  return std::uint32_t(scene.materials.size() - 1);
}

std::uint32_t add(Scene& scene, std::string name, Mesh mesh, std::uint32_t material) {
  mesh.name = std::move(name);
  mesh.material_ids = {material};
  scene.meshes.push_back(std::move(mesh));
  return std::uint32_t(scene.meshes.size() - 1);
}

void place(Scene& scene, std::string name, std::uint32_t mesh, const glm::dmat4& world_from_mesh) {
  scene.instances.push_back({std::move(name), mesh, world_from_mesh});
}

glm::dmat4 moved(const glm::dvec3& by) {
  glm::dmat4 matrix(1.0);
  matrix[3] = glm::dvec4(by, 1);
  return matrix;
}

glm::dmat4 scaled(double by) {
  glm::dmat4 matrix(by);
  matrix[3][3] = 1;
  return matrix;
}

glm::dmat4 turned(int part, int whole) {
  const glm::dvec2 t = turn(part, whole);
  glm::dmat4 matrix(1.0);
  matrix[0] = {t.x, 0, 0 - t.y, 0};
  matrix[2] = {t.y, 0, t.x, 0};
  return matrix;
}

glm::dmat4 tilted(int part, int whole) {
  const glm::dvec2 t = turn(part, whole);
  glm::dmat4 matrix(1.0);
  matrix[1] = {0, t.x, t.y, 0};
  matrix[2] = {0, 0 - t.y, t.x, 0};
  return matrix;
}

Camera camera_at(std::string name, const glm::dvec3& eye, const glm::dvec3& target, double vertical) {
  const glm::dvec3 back = unit(eye - target), right = unit(glm::cross(glm::dvec3(0, 1, 0), back));
  Camera camera;
  camera.name = std::move(name);
  camera.world_from_eye = {glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0),
                           glm::dvec4(eye, 1)};
  camera.vertical = vertical * 0.017453292519943295769;
  return camera;
}

glm::vec4 color(std::uint32_t srgb, double alpha) {
  const auto byte = [&](int shift) { return linear_of_srgb8(std::uint8_t(srgb >> shift & 255)); };
  return {byte(16), byte(8), byte(0), float(alpha)};
}

}  // namespace frontmost
