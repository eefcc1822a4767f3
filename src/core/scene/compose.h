// SPDX-License-Identifier: Apache-2.0
// Functions that compose scenes from paint, places and cameras, and the scenes of builtin() that are composed this way.
// All are bit-identical on every machine, as shapes.h says. Matrices are computed here because glm's use the C
// library's sine and cosine, whose last bits differ from one system to the next.
//
//   paint() --add()--> a material's number --add(mesh)--> a mesh's number --place()--> a visible instance
#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "base/srgb.h"
#include "frontmost/scene.h"
#include "scene/turn.h"

namespace frontmost {

/// Linear light from a colour in designers' notation (0xRRGGBB, sRGB).
[[nodiscard]] inline glm::vec4 color(std::uint32_t srgb, double alpha = 1) {
  const auto byte = [&](int shift) { return linear_of_srgb8(std::uint8_t(srgb >> shift & 255)); };
  return {byte(16), byte(8), byte(0), float(alpha)};
}

/// A plain material: base colour in sRGB as 0xRRGGBB.
[[nodiscard]] inline Material paint(std::string name, std::uint32_t srgb, float roughness = 0.6f, float metallic = 0) {
  Material material;
  material.name = std::move(name);
  material.base_color = color(srgb);
  material.roughness = roughness;
  material.metallic = metallic;
  return material;
}

/// Appends a material. \returns its number.
inline std::uint32_t add(Scene& scene, Material material) {
  scene.materials.push_back(std::move(material));
  return std::uint32_t(scene.materials.size() - 1);
}

/// Appends a mesh whose triangles all get `material`. \returns its number.
inline std::uint32_t add(Scene& scene, std::string name, Mesh mesh, std::uint32_t material) {
  mesh.name = std::move(name);
  mesh.material_ids = {material};
  scene.meshes.push_back(std::move(mesh));
  return std::uint32_t(scene.meshes.size() - 1);
}

inline void place(Scene& scene, std::string name, std::uint32_t mesh,
                  const glm::dmat4& world_from_mesh = glm::dmat4(1.0)) {
  scene.instances.push_back({std::move(name), mesh, world_from_mesh});
}

[[nodiscard]] inline glm::dmat4 moved(const glm::dvec3& by) {
  glm::dmat4 matrix(1.0);
  matrix[3] = glm::dvec4(by, 1);
  return matrix;
}

[[nodiscard]] inline glm::dmat4 scaled(double by) {
  glm::dmat4 matrix(by);
  matrix[3][3] = 1;
  return matrix;
}

/// A turn about the y axis, counter-clockwise seen from above, by part / whole of a full turn.
[[nodiscard]] inline glm::dmat4 turned(int part, int whole) {
  const glm::dvec2 t = turn(part, whole);
  glm::dmat4 matrix(1.0);
  matrix[0] = {t.x, 0, 0 - t.y, 0};
  matrix[2] = {t.y, 0, t.x, 0};
  return matrix;
}

/// A turn about the x axis, counter-clockwise seen from +x.
[[nodiscard]] inline glm::dmat4 tilted(int part, int whole) {
  const glm::dvec2 t = turn(part, whole);
  glm::dmat4 matrix(1.0);
  matrix[1] = {0, t.x, t.y, 0};
  matrix[2] = {0, 0 - t.y, t.x, 0};
  return matrix;
}

/// A camera at `eye` that looks at `target` with y up. `vertical` is the full field of view in degrees.
[[nodiscard]] inline Camera camera_at(std::string name, const glm::dvec3& eye, const glm::dvec3& target,
                                      double vertical) {
  const glm::dvec3 back = unit(eye - target), right = unit(glm::cross(glm::dvec3(0, 1, 0), back));
  Camera camera;
  camera.name = std::move(name);
  camera.world_from_eye = {glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0),
                           glm::dvec4(eye, 1)};
  camera.vertical = vertical * 0.017453292519943295769;
  return camera;
}

[[nodiscard]] Scene make_teapot();
[[nodiscard]] Scene make_cubes();
[[nodiscard]] Scene make_cycle();
[[nodiscard]] Scene make_city();
[[nodiscard]] Scene make_spheres();
[[nodiscard]] Scene make_gallery();

}  // namespace frontmost
