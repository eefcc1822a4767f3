// SPDX-License-Identifier: Apache-2.0
// Makes the occluder mesh of an instance: welds vertices, divides the mesh into parts, and finds neighbours.
#include "occlusion/occluder_mesh.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "geometry/disjoint_sets.h"
#include "geometry/edge_neighbours.h"
#include "geometry/places.h"

namespace frontmost::occlusion_detail {
namespace {

/// Returns whether a material is see-through. Holes do not count here, because Cutouts has them.
bool is_see_through(const Scene& scene, std::uint32_t material) {
  return material < scene.materials.size() && scene.materials[material].is_see_through();
}

/// A triangle with finite vertices. Each corner is the first vertex of the mesh at its position.
struct WeldedTriangle {
  std::uint32_t number;  ///< index in the mesh
  glm::uvec3 corners;
  std::uint32_t part;
  bool hides;
  bool is_flat;  ///< two corners coincide, so that it is not seen
  bool is_double_sided;
};

std::vector<WeldedTriangle> seen_triangles(const PlacedScene& placed, std::uint32_t instance,
                                           const Execution& execution) {
  const Scene& scene = *placed.scene;
  const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
  const Buffer<std::uint32_t> first = first_at_place(mesh.positions, execution);
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

/// Numbers the connected parts in the order of their first triangles. \returns the number of parts.
std::uint32_t tell_parts_apart(std::size_t vertex_count, std::vector<WeldedTriangle>& triangles) {
  DisjointSets<> together(vertex_count);
  for (const WeldedTriangle& t : triangles) {
    together.join(t.corners.x, t.corners.y);
    together.join(t.corners.y, t.corners.z);
  }
  std::vector<std::uint32_t> part(vertex_count, no_index);
  std::uint32_t count = 0;
  for (WeldedTriangle& t : triangles) {
    std::uint32_t& own = part[together.leader_of(t.corners.x)];
    if (own == no_index) own = count++;
    t.part = own;
  }
  return count;
}

/// Halves triangles by their centres along the longest axis of the centres' box, until clusters are small enough.
class ClusterCutter {
 public:
  ClusterCutter(const std::vector<glm::vec3>& positions, std::vector<WeldedTriangle>& triangles)
      : triangles_(triangles) {
    for (const WeldedTriangle& t : triangles)
      middles_.push_back(positions[t.corners.x] / 3.0f + positions[t.corners.y] / 3.0f + positions[t.corners.z] / 3.0f);
  }
  /// Numbers the clusters. \returns the number of clusters.
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

/// Returns, by part, the hiding triangles of other parts that share a vertex with the part, each once and in order.
std::vector<std::vector<std::uint32_t>> touching(std::size_t vertex_count, const std::vector<WeldedTriangle>& triangles,
                                                 std::size_t part_count) {
  // The parts that use each vertex: mostly one.
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
      if (number == no_index || number < part.first_vertex) {  // not written yet, or in another part
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
  std::vector<std::uint32_t> number_;  ///< by vertex: its latest index in the output
};

/// Returns, by triangle and side, the triangle across the side, if it is the only one there and has the same winding.
std::vector<glm::uvec3> neighbours_of(const OccluderMesh& mesh, const Execution& execution) {
  const EdgeNeighbours edges(mesh.triangles, mesh.positions.size(), execution);
  std::vector<glm::uvec3> neighbours(mesh.triangles.size());
  for (std::size_t t = 0; t < neighbours.size(); ++t)
    neighbours[t] = {edges.across(t, 0), edges.across(t, 1), edges.across(t, 2)};
  return neighbours;
}

}  // namespace

OccluderMesh occluder_mesh(const PlacedScene& placed, std::uint32_t instance, ObjectUnit unit,
                           const Execution& execution) {
  const Scene& scene = *placed.scene;
  const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
  std::vector<WeldedTriangle> seen = seen_triangles(placed, instance, execution);
  std::uint32_t parts = 1;
  if (unit == ObjectUnit::parts) parts = tell_parts_apart(mesh.positions.size(), seen);
  if (unit == ObjectUnit::clusters) parts = ClusterCutter(mesh.positions, seen).cut();
  OccluderMesh out;
  out.parts.resize(std::max(parts, 1u));
  std::vector<std::vector<std::uint32_t>> touching_parts;
  if (unit == ObjectUnit::clusters) touching_parts = touching(mesh.positions.size(), seen, out.parts.size());
  PartWriter(mesh.positions, seen, out).write(touching_parts);
  out.neighbours = neighbours_of(out, execution);
  for (OccluderPart& part : out.parts)
    for (std::uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t)
      for (int side = 0; side < 3; ++side) part.is_closed = part.is_closed && out.neighbours[t][side] != no_index;
  return out;
}

}  // namespace frontmost::occlusion_detail
