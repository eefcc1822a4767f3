// SPDX-License-Identifier: Apache-2.0
// A scene with some triangles of another one. Every object gets its own mesh, which holds only the kept triangles.
#include <algorithm>

#include "frontmost/report.h"

namespace frontmost {
namespace {

/// Selects kept values from a numbered list and renumbers them in their order.
class KeptValues {
 public:
  explicit KeptValues(std::size_t count) : number_(count, no_index) {}

  void keep(const glm::uvec3& corners) {
    for (int k = 0; k < 3; ++k) number_[corners[k]] = 0;
  }
  /// Assigns the new numbers. Call after the last keep().
  void count() {
    std::uint32_t next = 0;
    for (std::uint32_t& number : number_)
      if (number != no_index) number = next++;
    count_ = next;
  }
  [[nodiscard]] glm::uvec3 renumbered(const glm::uvec3& corners) const {
    return {number_[corners.x], number_[corners.y], number_[corners.z]};
  }
  template <class T>
  [[nodiscard]] std::vector<T> of(const std::vector<T>& values) const {
    std::vector<T> kept;
    kept.reserve(count_);
    for (std::size_t i = 0; i < number_.size(); ++i)
      if (number_[i] != no_index) kept.push_back(values[i]);
    return kept;
  }

 private:
  std::vector<std::uint32_t> number_;
  std::size_t count_ = 0;
};

KeptValues kept_values(std::size_t count, const std::vector<glm::uvec3>& corners,
                       std::span<const std::uint32_t> triangles) {
  KeptValues kept(count);
  for (const std::uint32_t triangle : triangles) kept.keep(corners[triangle]);
  kept.count();
  return kept;
}

std::vector<glm::uvec3> kept_corners(const KeptValues& kept, const std::vector<glm::uvec3>& corners,
                                     std::span<const std::uint32_t> triangles) {
  std::vector<glm::uvec3> result;
  result.reserve(triangles.size());
  for (const std::uint32_t triangle : triangles) result.push_back(kept.renumbered(corners[triangle]));
  return result;
}

template <class T>
Attribute<T> kept_attribute(const Attribute<T>& all, const KeptValues& positions,
                            std::span<const std::uint32_t> triangles) {
  if (all.empty()) return {};
  if (all.triangles.empty()) return {positions.of(all.values), {}};
  const KeptValues kept = kept_values(all.values.size(), all.triangles, triangles);
  return {kept.of(all.values), kept_corners(kept, all.triangles, triangles)};
}

Mesh kept_mesh(const Mesh& mesh, std::span<const std::uint32_t> triangles) {
  const KeptValues positions = kept_values(mesh.positions.size(), mesh.triangles, triangles);
  Mesh kept;
  kept.name = mesh.name;
  kept.positions = positions.of(mesh.positions);
  kept.triangles = kept_corners(positions, mesh.triangles, triangles);
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
