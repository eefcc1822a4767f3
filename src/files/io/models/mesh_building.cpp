// SPDX-License-Identifier: Apache-2.0
// Helpers for readers of polygons. Most files hold only triangles, which take a short way: their corners are not
// copied, nothing is cut, and no list of faces is kept while each polygon so far was one triangle.
#include "io/models/mesh_building.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "base/srgb.h"

namespace frontmost {
namespace {

/// Clamps to [0, 1]. NaN gives 1, so that an undefined colour changes nothing.
float clamped(float value) { return value < 0 ? 0.0f : (value < 1 ? value : 1.0f); }

float linear(float srgb) {
  // Most files hold multiples of 1/255, which a table converts.
  const float bytes = clamped(srgb) * 255.0f;
  const auto nearest = std::uint8_t(bytes + 0.5f);
  if (std::abs(bytes - float(nearest)) < 1e-3f) return linear_of_srgb8(nearest);
  return linear_of_srgb16(std::uint16_t(clamped(srgb) * 65535.0f + 0.5f));
}

}  // namespace

glm::vec4 linear_color(const glm::vec4& srgb) {
  return {linear(srgb.r), linear(srgb.g), linear(srgb.b), clamped(srgb.a)};
}

Mesh& add_object(Scene& scene, const std::string& name, const ModelSource& source, const std::string& place) {
  if (scene.meshes.size() >= max_objects)
    source.fail_limit(place, "more than " + std::to_string(max_objects) + " objects");
  scene.instances.push_back({.name = name, .mesh = std::uint32_t(scene.meshes.size())});
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.name = name;
  return mesh;
}

std::span<const glm::uvec3> PolygonWriter::add(std::span<const std::uint32_t> corners,
                                               std::span<const glm::vec3> positions, Mesh& mesh) {
  static constexpr std::array<glm::uvec3, 1> one_triangle{glm::uvec3(0, 1, 2)};
  const std::size_t before = mesh.triangles.size();
  std::span<const glm::uvec3> triangles;
  if (corners.size() == 3) {
    triangles = one_triangle;
  } else if (corners.size() > 3) {
    polygon_.clear();
    for (const std::uint32_t c : corners) polygon_.push_back(c < positions.size() ? positions[c] : glm::vec3(0));
    triangles = triangulate_(polygon_);
  } else {
    ++skipped_;
  }
  for (const glm::uvec3& t : triangles) mesh.triangles.emplace_back(corners[t.x], corners[t.y], corners[t.z]);
  remember_face(before, mesh);
  ++face_;
  return triangles;
}

void PolygonWriter::remember_face(std::size_t before, Mesh& mesh) const {
  // Face ids equal triangle numbers while each polygon was one triangle, so no list is kept.
  const bool needed = !mesh.face_ids.empty() || face_ != before || mesh.triangles.size() > before + 1;
  if (!needed || mesh.triangles.size() == before) return;
  if (mesh.face_ids.empty()) {
    mesh.face_ids.resize(before);
    std::iota(mesh.face_ids.begin(), mesh.face_ids.end(), 0u);
  }
  mesh.face_ids.resize(mesh.triangles.size(), face_);
}

}  // namespace frontmost
