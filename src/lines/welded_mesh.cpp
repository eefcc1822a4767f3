// SPDX-License-Identifier: Apache-2.0
#include "lines/welded_mesh.h"

#include <bit>
#include <cstring>

#include "surfaces/cluster_set.h"

namespace frontmost::lines_detail {
namespace {

/// Numbers places in the order in which they come, by open addressing.
class PlaceTable {
 public:
  PlaceTable(std::size_t most, std::vector<glm::dvec3>& positions)
      : slots_(std::bit_ceil(2 * most + 2), no_index), positions_(positions) {}

  std::uint32_t number_of(const glm::vec3& place) {
    const glm::vec3 p = place + 0.0f;  // -0 is 0
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = hash(p) & mask;; i = (i + 1) & mask) {
      if (slots_[i] == no_index) {
        slots_[i] = std::uint32_t(positions_.size());
        positions_.emplace_back(p);
        return slots_[i];
      }
      if (positions_[slots_[i]] == glm::dvec3(p)) return slots_[i];
    }
  }

 private:
  static std::size_t hash(const glm::vec3& p) {
    std::uint64_t h = 0;
    for (int axis = 0; axis < 3; ++axis) {
      std::uint32_t bits;
      std::memcpy(&bits, &p[axis], sizeof bits);
      h = (h ^ bits) * 0x9E3779B97F4A7C15u;
      h ^= h >> 29;
    }
    return std::size_t(h);
  }

  std::vector<std::uint32_t> slots_;
  std::vector<glm::dvec3>& positions_;
};

}  // namespace

WeldedMesh weld(const Surfaces& surfaces) {
  const Scene& scene = surfaces.scene();
  std::size_t vertices = 0;
  for (const Instance& instance : scene.instances) vertices += scene.meshes[instance.mesh].positions.size();
  WeldedMesh welded;
  welded.triangles.reserve(surfaces.primitive_count());
  welded.ids.reserve(surfaces.primitive_count());
  PlaceTable places(vertices, welded.positions);
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
    const ToWorld to_world(scene.instances[i].world_from_mesh);
    numbers.assign(mesh.positions.size(), no_index);
    for (std::size_t v = 0; v < numbers.size(); ++v) {
      const glm::vec3 place = to_world(mesh.positions[v]);
      if (is_finite(place)) numbers[v] = places.number_of(place);
    }
    const bool is_mirrored = surfaces.is_mirrored(i);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      glm::uvec3 corners;
      for (int k = 0; k < 3; ++k) corners[k] = numbers[mesh.triangles[t][is_mirrored && k > 0 ? 3 - k : k]];
      if (corners.x == no_index || corners.y == no_index || corners.z == no_index) continue;
      if (corners.x == corners.y || corners.y == corners.z || corners.z == corners.x) continue;
      welded.triangles.push_back(corners);
      welded.ids.push_back(surfaces.first_primitive(i) + t);
    }
  }
  return welded;
}

}  // namespace frontmost::lines_detail
