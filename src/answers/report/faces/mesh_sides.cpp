// SPDX-License-Identifier: Apache-2.0
// Vertices at one place are found by open addressing, and sides are brought together by their lower vertex. Both are
// quick where keys are spread and vertices have few triangles, as in nearly every mesh; where a vertex has many, its
// sides are sorted.
#include "report/faces/mesh_sides.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/parallel.h"

namespace frontmost::faces_detail {
namespace {

std::uint64_t hash_of_place(const glm::vec3& p) {
  std::uint32_t bits[3];
  std::memcpy(bits, &p, sizeof bits);
  std::uint64_t h = (bits[0] * 0x9E3779B97F4A7C15u) ^ (bits[1] * 0xC2B2AE3D27D4EB4Fu) ^ (bits[2] * 0x165667B19E3779F9u);
  h ^= h >> 32;
  return h * 0xD6E8FEB86659FD93u >> 20;
}

/// By vertex, the first one at its place.
std::vector<std::uint32_t> first_at_places(const std::vector<glm::vec3>& positions) {
  std::vector<std::uint32_t> first(positions.size());
  std::vector<std::uint32_t> slots(std::bit_ceil(2 * positions.size() + 2), no_index);
  const std::size_t mask = slots.size() - 1;
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    const glm::vec3 p = positions[v] + 0.0f;  // -0 is 0
    first[v] = v;
    if (!is_finite(p)) continue;  // NaN is at no place
    std::size_t i = hash_of_place(p) & mask;
    while (slots[i] != no_index && positions[slots[i]] != p) i = (i + 1) & mask;
    if (slots[i] == no_index) slots[i] = v;
    first[v] = slots[i];
  }
  return first;
}

/// So few sides at a vertex need not be sorted.
constexpr std::size_t kFewSides = 8;

/// A side among those with the same lower vertex.
struct SideEntry {
  std::uint32_t upper;   ///< the other vertex
  std::uint32_t number;  ///< 3 * triangle + side, and in the highest bit whether it leads downwards

  static constexpr std::uint32_t downwards = 1u << 31;
  [[nodiscard]] std::uint32_t side() const { return number & ~downwards; }
};

void join(const SideEntry& a, const SideEntry& b, std::vector<std::uint32_t>& beyond) {
  const std::uint32_t alike = (a.number ^ b.number) >> 31;
  beyond[a.side()] = b.side() / 3 << 1 | alike;
  beyond[b.side()] = a.side() / 3 << 1 | alike;
}

/// The same as join_pairs(), by asking all pairs.
void join_few(std::span<const SideEntry> sides, std::vector<std::uint32_t>& beyond) {
  for (std::size_t i = 0; i < sides.size(); ++i) {
    std::size_t found = 0, partner = i;
    for (std::size_t k = 0; k < sides.size(); ++k) {
      if (k == i || sides[k].upper != sides[i].upper) continue;
      ++found;
      partner = k;
    }
    if (found == 1 && partner > i) join(sides[i], sides[partner], beyond);
  }
}

/// Joins the sides of one lower vertex that exactly two triangles have.
void join_pairs(std::span<SideEntry> sides, std::vector<std::uint32_t>& beyond) {
  if (sides.size() <= kFewSides) return join_few(sides, beyond);
  std::sort(sides.begin(), sides.end(), [](const SideEntry& a, const SideEntry& b) {
    return a.upper != b.upper ? a.upper < b.upper : a.side() < b.side();
  });
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    for (end = i + 1; end < sides.size() && sides[end].upper == sides[i].upper;) ++end;
    if (end - i == 2) join(sides[i], sides[i + 1], beyond);
  }
}

}  // namespace

MeshSides::MeshSides(const Mesh& mesh) : beyond_(3 * mesh.triangles.size(), no_index) {
  if (mesh.triangles.size() > most_triangles)
    throw Error(ErrorCode::limit_exceeded, "mesh " + mesh.name, "more than 536870912 triangles to join");
  const std::vector<std::uint32_t> place = first_at_places(mesh.positions);
  const auto visit_sides = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const glm::uvec3& c = mesh.triangles[t];
      const std::uint32_t v[4] = {place[c.x], place[c.y], place[c.z], place[c.x]};
      if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
      for (std::uint32_t k = 0; k < 3; ++k)
        visit(std::min(v[k], v[k + 1]), std::max(v[k], v[k + 1]),
              3 * t + k + (v[k] < v[k + 1] ? 0 : SideEntry::downwards));
    }
  };
  std::vector<std::uint32_t> ends(mesh.positions.size() + 1, 0);  // starts, until the sides are where they belong
  visit_sides([&](std::uint32_t lower, std::uint32_t, std::uint32_t) { ++ends[lower + 1]; });
  for (std::size_t v = 1; v < ends.size(); ++v) ends[v] += ends[v - 1];
  std::vector<SideEntry> sides(ends.back());
  visit_sides([&](std::uint32_t lower, std::uint32_t upper, std::uint32_t number) {
    sides[ends[lower]++] = {upper, number};
  });
  for (std::size_t v = 0, begin = 0; v < mesh.positions.size(); begin = ends[v++])
    join_pairs(std::span(sides).subspan(begin, ends[v] - begin), beyond_);
}

std::vector<MeshSides> sides_of_meshes(const Scene& scene, const Execution& execution) {
  std::vector<bool> is_placed(scene.meshes.size(), false);
  for (const Instance& instance : scene.instances) is_placed[instance.mesh] = true;
  const Mesh none;
  std::vector<MeshSides> sides(scene.meshes.size(), MeshSides(none));
  parallel_for(execution, scene.meshes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t m = begin; m < end; ++m)
      if (is_placed[m]) sides[m] = MeshSides(scene.meshes[m]);
  });
  return sides;
}

}  // namespace frontmost::faces_detail
