// SPDX-License-Identifier: Apache-2.0
// A scene with some triangles of another one. Every object gets its own mesh, which holds only the kept triangles.
#include <utility>

#include "frontmost/report.h"
#include "scene/edges.h"

namespace frontmost {
namespace {

/// Kept triangles, with new numbers for their corners.
struct KeptCorners {
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint32_t> values;  ///< old number of each new number, ascending
};

KeptCorners kept_corners(std::size_t value_count, const std::vector<glm::uvec3>& corners,
                         std::span<const std::uint32_t> triangles) {
  std::vector<std::uint32_t> numbers(value_count, no_index);
  for (const std::uint32_t triangle : triangles)
    for (int k = 0; k < 3; ++k) numbers[corners[triangle][k]] = 0;
  KeptCorners kept;
  for (std::uint32_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] == no_index) continue;
    numbers[i] = std::uint32_t(kept.values.size());
    kept.values.push_back(i);
  }
  kept.triangles.reserve(triangles.size());
  for (const std::uint32_t triangle : triangles) {
    const glm::uvec3& c = corners[triangle];
    kept.triangles.emplace_back(numbers[c.x], numbers[c.y], numbers[c.z]);
  }
  return kept;
}

template <class T>
std::vector<T> kept_values(const std::vector<T>& all, const KeptCorners& kept) {
  std::vector<T> values;
  values.reserve(kept.values.size());
  for (const std::uint32_t i : kept.values) values.push_back(all[i]);
  return values;
}

template <class T>
Attribute<T> kept_attribute(const Attribute<T>& all, const KeptCorners& positions,
                            std::span<const std::uint32_t> triangles) {
  if (all.empty()) return {};
  if (all.triangles.empty()) return {kept_values(all.values, positions), {}};
  KeptCorners kept = kept_corners(all.values.size(), all.triangles, triangles);
  return {kept_values(all.values, kept), std::move(kept.triangles)};
}

Mesh kept_mesh(const Mesh& mesh, std::span<const std::uint32_t> triangles) {
  KeptCorners positions = kept_corners(mesh.positions.size(), mesh.triangles, triangles);
  Mesh kept;
  kept.name = mesh.name;
  kept.positions = kept_values(mesh.positions, positions);
  kept.normals = kept_attribute(mesh.normals, positions, triangles);
  kept.texcoords = kept_attribute(mesh.texcoords, positions, triangles);
  for (const Attribute<glm::vec2>& set : mesh.further_texcoords)
    kept.further_texcoords.push_back(kept_attribute(set, positions, triangles));
  kept.colors = kept_attribute(mesh.colors, positions, triangles);
  kept.material_ids = mesh.material_ids;
  if (mesh.material_ids.size() > 1) {
    kept.material_ids.clear();
    for (const std::uint32_t triangle : triangles) kept.material_ids.push_back(mesh.material_ids[triangle]);
  }
  for (const std::uint32_t triangle : triangles) kept.face_ids.push_back(mesh.face_of(triangle));
  kept.triangles = std::move(positions.triangles);
  std::vector<std::uint32_t> numbers(mesh.positions.size(), no_index);
  for (std::uint32_t i = 0; i < positions.values.size(); ++i) numbers[positions.values[i]] = i;
  const auto kept_edge = [&](const glm::uvec2& edge) -> std::optional<glm::uvec2> {
    const glm::uvec2 own(numbers[edge.x], numbers[edge.y]);
    return own.x == no_index || own.y == no_index ? std::nullopt : std::optional(own);
  };
  append_edges(mesh, glm::dmat4(1), kept_edge, kept);
  keep_covered(mesh, kept);
  return kept;
}

}  // namespace

Scene keep_faces(const Scene& scene, std::span<const PrimitiveId> ids) {
  Scene kept;
  kept.name = scene.name;
  kept.categories = scene.categories;
  kept.materials = scene.materials;
  kept.textures = scene.textures;
  kept.cameras = scene.cameras;
  kept.lights = scene.lights;
  kept.up = scene.up;
  kept.origin = scene.origin;
  kept.source = scene.source;
  std::uint64_t first = 0;
  auto id = ids.begin();
  std::vector<std::uint32_t> triangles;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    triangles.clear();
    for (; id != ids.end() && *id < first + mesh.triangles.size(); ++id) {
      if (id != ids.begin() && *id <= *(id - 1)) throw Error(ErrorCode::bad_argument, "ids", "must ascend");
      triangles.push_back(std::uint32_t(*id - first));
    }
    first += mesh.triangles.size();
    if (triangles.empty()) continue;
    kept.instances.push_back(instance);
    kept.instances.back().mesh = std::uint32_t(kept.meshes.size());
    kept.meshes.push_back(kept_mesh(mesh, triangles));
  }
  if (id != ids.end())
    throw Error(ErrorCode::bad_argument, "ids", std::to_string(*id) + " is beyond the scene's last triangle");
  return kept;
}

}  // namespace frontmost
