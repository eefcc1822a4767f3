// SPDX-License-Identifier: Apache-2.0
#include "occlusion/occluder_mesh.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>
#include <span>

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
  std::uint32_t number;  ///< in the mesh
  glm::uvec3 corners;
  std::uint32_t part;
  bool hides;
  bool is_flat;  ///< two corners lie at one place, so that it is not seen
  bool is_double_sided;
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
    seen.push_back({t, corners, 0, !has_holes && !is_flat && !is_see_through(scene, mesh.material_of(t)), is_flat,
                    placed.sides->is_double(placed.first_primitives[instance] + t)});
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

/// Halves triangles by their middles along the longest side of these, until clusters are small enough.
class ClusterCutter {
 public:
  ClusterCutter(const std::vector<glm::vec3>& positions, std::vector<WeldedTriangle>& triangles)
      : triangles_(triangles) {
    for (const WeldedTriangle& t : triangles)
      middles_.push_back(positions[t.corners.x] / 3.0f + positions[t.corners.y] / 3.0f + positions[t.corners.z] / 3.0f);
  }
  /// Numbers the clusters. \returns how many there are.
  std::uint32_t cut() {
    std::vector<std::uint32_t> all(triangles_.size());
    std::iota(all.begin(), all.end(), 0u);
    if (!all.empty()) halve(all);
    return count_;
  }

 private:
  void halve(std::span<std::uint32_t> some) {
    if (some.size() <= most_in_cluster) {
      for (const std::uint32_t t : some) triangles_[t].part = count_;
      ++count_;
      return;
    }
    Box box;
    for (const std::uint32_t t : some) box.include(middles_[t]);
    const glm::vec3 size = box.high - box.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto middle = some.begin() + std::ptrdiff_t(some.size() / 2);
    std::nth_element(some.begin(), middle, some.end(), [&](std::uint32_t a, std::uint32_t b) {
      return middles_[a][axis] != middles_[b][axis] ? middles_[a][axis] < middles_[b][axis] : a < b;
    });
    halve({some.begin(), middle});
    halve({middle, some.end()});
  }

  std::vector<WeldedTriangle>& triangles_;
  std::vector<glm::vec3> middles_;
  std::uint32_t count_ = 0;
};

/// By part, the triangles that hide and have a vertex with it in common, and are not of it. Each once, in order.
std::vector<std::vector<std::uint32_t>> touching(std::size_t vertex_count, const std::vector<WeldedTriangle>& triangles,
                                                 std::size_t part_count) {
  // Parts of each vertex: few have more than one.
  std::vector<std::vector<std::uint32_t>> parts_of(vertex_count);
  for (const WeldedTriangle& t : triangles)
    for (int k = 0; k < 3; ++k) {
      std::vector<std::uint32_t>& parts = parts_of[t.corners[k]];
      if (std::find(parts.begin(), parts.end(), t.part) == parts.end()) parts.push_back(t.part);
    }
  std::vector<std::vector<std::uint32_t>> touching(part_count);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (!triangles[t].hides) continue;
    for (int k = 0; k < 3; ++k)
      for (const std::uint32_t part : parts_of[triangles[t].corners[k]])
        if (part != triangles[t].part && (touching[part].empty() || touching[part].back() != t))
          touching[part].push_back(t);
  }
  return touching;
}

/// Writes positions and triangles, part by part.
class PartWriter {
 public:
  PartWriter(const std::vector<glm::vec3>& positions, const std::vector<WeldedTriangle>& seen, OccluderMesh& out)
      : positions_(positions), seen_(seen), out_(out), number_(positions.size(), no_index) {}

  void write(const std::vector<std::vector<std::uint32_t>>& touching) {
    std::vector<std::uint32_t> order(seen_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return seen_[a].part < seen_[b].part; });
    auto next = order.begin();
    for (std::uint32_t p = 0; p < out_.parts.size(); ++p) {
      OccluderPart& part = out_.parts[p];
      part.first_triangle = std::uint32_t(out_.triangles.size());
      part.first_vertex = std::uint32_t(out_.positions.size());
      for (; next != order.end() && seen_[*next].part == p; ++next) {
        part.own.push_back(seen_[*next].number);
        part.is_whole = part.is_whole && (seen_[*next].hides || seen_[*next].is_flat);
        add(*next, part);
      }
      if (!touching.empty())
        for (const std::uint32_t t : touching[p]) add(t, part);
    }
  }

 private:
  void add(std::uint32_t triangle, OccluderPart& part) {
    (seen_[triangle].is_double_sided ? part.has_double_sided : part.has_one_sided) = true;
    glm::uvec3 corners;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = seen_[triangle].corners[k];
      part.bounds.include(positions_[vertex]);
      if (!seen_[triangle].hides) continue;
      std::uint32_t& number = number_[vertex];
      if (number == no_index || number < part.first_vertex) {  // not yet, or in another part
        number = std::uint32_t(out_.positions.size());
        out_.positions.push_back(positions_[vertex]);
        ++part.vertex_count;
      }
      corners[k] = number;
    }
    if (!seen_[triangle].hides) return;
    ++part.triangle_count;
    out_.triangles.push_back(corners);
  }

  const std::vector<glm::vec3>& positions_;
  const std::vector<WeldedTriangle>& seen_;
  OccluderMesh& out_;
  std::vector<std::uint32_t> number_;  ///< by vertex, the last that it was written as
};

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

OccluderMesh occluder_mesh(const PlacedScene& placed, std::uint32_t instance, ObjectUnit unit) {
  const Scene& scene = *placed.scene;
  const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
  std::vector<WeldedTriangle> seen = seen_triangles(placed, instance);
  std::uint32_t parts = 1;
  if (unit == ObjectUnit::parts) parts = tell_parts_apart(mesh.positions.size(), seen);
  if (unit == ObjectUnit::clusters) parts = ClusterCutter(mesh.positions, seen).cut();
  OccluderMesh out;
  out.parts.resize(std::max(parts, 1u));
  std::vector<std::vector<std::uint32_t>> touching_parts;
  if (unit == ObjectUnit::clusters) touching_parts = touching(mesh.positions.size(), seen, out.parts.size());
  PartWriter(mesh.positions, seen, out).write(touching_parts);
  out.neighbours = neighbours_of(out.triangles);
  for (OccluderPart& part : out.parts)
    for (std::uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t)
      for (int side = 0; side < 3; ++side) part.is_closed = part.is_closed && out.neighbours[t][side] != no_index;
  return out;
}

}  // namespace frontmost::occlusion_detail
