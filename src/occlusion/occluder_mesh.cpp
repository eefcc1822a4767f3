// SPDX-License-Identifier: Apache-2.0
#include "occlusion/occluder_mesh.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

namespace frontmost::occlusion_detail {
namespace {

std::uint64_t mixed(std::uint64_t h) {
  h *= 0x9E3779B97F4A7C15u;
  return h ^ h >> 29;
}

/// Numbers things that are equal alike, by open addressing.
class FirstAlike {
 public:
  explicit FirstAlike(std::size_t count) : slots_(std::bit_ceil(2 * count + 2), no_index) {}

  /// The first number entered that is_same(number), or `number` itself.
  template <class IsSame>
  std::uint32_t enter(std::uint64_t hash, std::uint32_t number, const IsSame& is_same) {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = hash & mask;; i = (i + 1) & mask) {
      if (slots_[i] == no_index) return slots_[i] = number;
      if (is_same(slots_[i])) return slots_[i];
    }
  }

 private:
  std::vector<std::uint32_t> slots_;
};

std::uint64_t hash_of(const glm::vec3& p) {
  std::uint32_t bits[3];
  std::memcpy(bits, &p, sizeof bits);
  return mixed(mixed(mixed(bits[0]) ^ bits[1]) ^ bits[2]);
}

/// By vertex, the first that lies at the same place.
std::vector<std::uint32_t> first_at_place(const std::vector<glm::vec3>& positions) {
  std::vector<std::uint32_t> first(positions.size());
  FirstAlike places(positions.size());
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    const glm::vec3 p = positions[v] + 0.0f;  // -0 is 0
    first[v] = places.enter(hash_of(p), v, [&](std::uint32_t other) { return positions[other] == p; });
  }
  return first;
}

/// What has holes is told by Cutouts.
bool is_see_through(const Scene& scene, std::uint32_t material) {
  return material < scene.materials.size() && scene.materials[material].is_see_through();
}

/// By vertex, the lowest that hangs together with it.
class HangingTogether {
 public:
  explicit HangingTogether(std::size_t count) : above_(count) { std::iota(above_.begin(), above_.end(), 0u); }

  std::uint32_t lowest(std::uint32_t v) {
    while (above_[v] != v) v = above_[v] = above_[above_[v]];
    return v;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = lowest(a);
    b = lowest(b);
    above_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> above_;
};

/// A triangle that is seen, by its vertices' first ones.
struct WeldedTriangle {
  glm::uvec3 corners;
  std::uint32_t part;
  bool hides;
  bool is_flat;  ///< two corners lie at one place, so that it is not seen
};

std::vector<WeldedTriangle> seen_triangles(const PlacedScene& placed, std::uint32_t instance) {
  const Scene& scene = *placed.scene;
  const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
  const std::vector<std::uint32_t> first = first_at_place(mesh.positions);
  std::vector<WeldedTriangle> seen;
  seen.reserve(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::uvec3& c = mesh.triangles[t];
    if (!is_finite(mesh.positions[c.x]) || !is_finite(mesh.positions[c.y]) || !is_finite(mesh.positions[c.z])) continue;
    const glm::uvec3 corners(first[c.x], first[c.y], first[c.z]);
    const bool has_holes = placed.cutouts && placed.cutouts->has(placed.first_primitives[instance] + t);
    const bool is_flat = corners.x == corners.y || corners.y == corners.z || corners.z == corners.x;
    seen.push_back({corners, 0, !has_holes && !is_flat && !is_see_through(scene, mesh.material_of(t)), is_flat});
  }
  return seen;
}

/// Numbers the parts in the order of their first triangles. \returns how many there are.
std::uint32_t tell_parts_apart(std::size_t vertex_count, std::vector<WeldedTriangle>& triangles) {
  HangingTogether together(vertex_count);
  for (const WeldedTriangle& t : triangles) {
    together.join(t.corners.x, t.corners.y);
    together.join(t.corners.y, t.corners.z);
  }
  std::vector<std::uint32_t> part(vertex_count, no_index);
  std::uint32_t count = 0;
  for (WeldedTriangle& t : triangles) {
    std::uint32_t& own = part[together.lowest(t.corners.x)];
    if (own == no_index) own = count++;
    t.part = own;
  }
  return count;
}

/// Writes positions and triangles, part by part.
void write_parts(const std::vector<glm::vec3>& positions, const std::vector<WeldedTriangle>& seen, OccluderMesh& out) {
  std::vector<std::uint32_t> order(seen.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return seen[a].part < seen[b].part; });
  std::vector<std::uint32_t> number(positions.size(), no_index);
  for (const std::uint32_t t : order) {
    OccluderPart& part = out.parts[seen[t].part];
    glm::uvec3 corners;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = seen[t].corners[k];
      part.bounds.include(positions[vertex]);
      part.is_whole = part.is_whole && (seen[t].hides || seen[t].is_flat);
      if (!seen[t].hides) continue;
      if (number[vertex] == no_index) {
        number[vertex] = std::uint32_t(out.positions.size());
        out.positions.push_back(positions[vertex]);
        if (part.vertex_count++ == 0) part.first_vertex = number[vertex];
      }
      corners[k] = number[vertex];
    }
    if (!seen[t].hides) continue;
    if (part.triangle_count++ == 0) part.first_triangle = std::uint32_t(out.triangles.size());
    out.triangles.push_back(corners);
  }
}

/// Joins triangles at the edges that exactly two have, once in each direction.
std::vector<glm::uvec3> neighbours_of(const std::vector<glm::uvec3>& triangles) {
  std::vector<glm::uvec3> neighbours(triangles.size(), glm::uvec3(no_index));
  std::vector<std::uint8_t> uses(3 * triangles.size(), 0);  // of an edge, by the first triangle side that has it
  const auto start = [&](std::uint32_t side) { return triangles[side / 3][int(side % 3)]; };
  const auto end = [&](std::uint32_t side) { return triangles[side / 3][int((side + 1) % 3 == 0 ? 0 : side % 3 + 1)]; };
  const auto beyond = [&](std::uint32_t side) -> std::uint32_t& { return neighbours[side / 3][int(side % 3)]; };
  FirstAlike edges(uses.size());
  std::vector<std::uint32_t> second(uses.size(), no_index);
  for (std::uint32_t side = 0; side < uses.size(); ++side) {
    const std::uint32_t a = start(side), b = end(side);
    const std::uint64_t key = std::uint64_t(std::min(a, b)) << 32 | std::max(a, b);
    const std::uint32_t first = edges.enter(mixed(mixed(key)), side, [&](std::uint32_t other) {
      return (start(other) == a && end(other) == b) || (start(other) == b && end(other) == a);
    });
    const std::uint8_t use = uses[first] = std::uint8_t(std::min(uses[first] + 1, 3));
    if (use == 2) {
      second[first] = side;
      if (start(first) != b) continue;
      beyond(first) = side / 3;
      beyond(side) = first / 3;
    } else if (use == 3) {
      beyond(first) = beyond(second[first]) = no_index;
    }
  }
  return neighbours;
}

}  // namespace

OccluderMesh occluder_mesh(const PlacedScene& placed, std::uint32_t instance, bool tells_parts_apart) {
  const Scene& scene = *placed.scene;
  const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
  std::vector<WeldedTriangle> seen = seen_triangles(placed, instance);
  const std::uint32_t parts = tells_parts_apart ? tell_parts_apart(mesh.positions.size(), seen) : 1;
  OccluderMesh out;
  out.parts.resize(std::max(parts, 1u));
  write_parts(mesh.positions, seen, out);
  out.neighbours = neighbours_of(out.triangles);
  for (OccluderPart& part : out.parts)
    for (std::uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t)
      for (int side = 0; side < 3; ++side) part.is_closed = part.is_closed && out.neighbours[t][side] != no_index;
  return out;
}

}  // namespace frontmost::occlusion_detail
