// SPDX-License-Identifier: Apache-2.0
// Updates surfaces after one instance moved: only data that depends on the instance is computed again.
//
//   boxes, bounds    of its ranges of triangles
//   holes            places of its triangles
//   clusters         places of its vertices, which it shares with no other instance; boxes and cones of these clusters

#include <algorithm>
#include <utility>

#include "surfaces/cluster_set.h"
#include "surfaces/placed_scene.h"
#include "surfaces/vertex_table.h"

namespace frontmost {
namespace {

constexpr std::size_t kBoxesAround = 16;  ///< instances or boxes in a box of PlacedScene::levels

/// Whether the triangle's three vertices coincide.
bool is_a_point(const Mesh& mesh, const glm::uvec3& c) {
  const glm::vec3 &p = mesh.positions[c.x], &q = mesh.positions[c.y], &r = mesh.positions[c.z];
  return has_same_bits(p, q) && has_same_bits(q, r);
}

}  // namespace

bool PlacedScene::has_cutouts(std::uint32_t instance) const {
  if (!cutouts) return false;
  for (PrimitiveId id = first_primitives[instance]; id < first_primitives[instance + 1]; ++id)
    if (cutouts->has(id)) return true;
  return false;
}

void PlacedScene::follow(std::uint32_t instance, Isa isa) {
  const glm::dmat4& world_from_mesh = scene->instances[instance].world_from_mesh;
  mirrored[instance] = mirrors(world_from_mesh);
  instance_bounds[instance] = Box();
  const auto first = std::lower_bound(ranges.begin(), ranges.end(), instance,
                                      [](const MeshRange& range, std::uint32_t i) { return range.instance < i; });
  WorldScratch scratch;
  for (auto range = first; range != ranges.end() && range->instance == instance; ++range) {
    Box* const own = &boxes[range->first_box];
    std::fill_n(own, range->box_count(), Box());
    find_boxes(world_triangles(*this, *range, isa, scratch), isa, own);
    for (std::uint32_t k = 0; k < range->box_count(); ++k) instance_bounds[instance].include(own[k]);
  }
  follow_bounds(instance);
  if (!has_cutouts(instance)) return;
  // An index keeps its cutouts until it follows, so shared cutouts are copied.
  if (cutouts.use_count() > 1) cutouts = std::make_shared<Cutouts>(*cutouts);
  cutouts->move(scene->meshes[scene->instances[instance].mesh], world_from_mesh, first_primitives[instance]);
}

void PlacedScene::find_bounds() {
  levels.clear();
  for (std::size_t count = instance_bounds.size(); count > 1;) {
    count = (count + kBoxesAround - 1) / kBoxesAround;
    levels.emplace_back(count);
  }
  for (std::size_t first = 0; first < instance_bounds.size(); first += kBoxesAround)
    follow_bounds(std::uint32_t(first));
}

void PlacedScene::follow_bounds(std::uint32_t instance) {
  const std::vector<Box>* below = &instance_bounds;
  std::size_t at = instance;
  for (std::vector<Box>& level : levels) {
    at /= kBoxesAround;
    const std::size_t begin = at * kBoxesAround, end = std::min(begin + kBoxesAround, below->size());
    level[at] = Box();
    for (std::size_t i = begin; i < end; ++i) level[at].include((*below)[i]);
    below = &level;
  }
  bounds = below->front();
}

bool ClusterSet::move_triangles(const PlacedScene& placed, const InstanceMove& move, std::size_t cluster) {
  const Instance& it = placed.scene->instances[move.instance];
  const Mesh& mesh = placed.scene->meshes[it.mesh];
  const ToWorld to_world(it.world_from_mesh);
  const PrimitiveId first = placed.first_primitives[move.instance];
  const bool turns = (placed.mirrored[move.instance] != 0) != move.was_mirrored;
  const std::size_t begin = clusters[cluster].first_triangle, end = begin + clusters[cluster].triangle_count;
  const std::uint64_t vertices = clusters[cluster].first_vertex;
  for (std::size_t t = begin; t < end; ++t) {
    if (id[t] - first >= mesh.triangles.size()) continue;  // wraps around for lower ids
    const glm::uvec3& c = mesh.triangles[id[t] - first];
    const glm::vec3 world[3] = {to_world(mesh.positions[c.x]), to_world(mesh.positions[c.y]),
                                to_world(mesh.positions[c.z])};
    const bool finite = is_finite(world[0]) && is_finite(world[1]) && is_finite(world[2]);
    const bool is_set_aside = i0[t] == i1[t] && i1[t] == i2[t];
    if (!finite && is_set_aside) continue;
    if (!finite || (is_set_aside && !is_a_point(mesh, c))) return false;
    std::uint8_t numbers[3] = {i0[t], i1[t], i2[t]};
    if (move.was_mirrored) std::swap(numbers[1], numbers[2]);
    for (int k = 0; k < 3; ++k) {
      const std::size_t v = vertices + numbers[k];
      x[v] = world[k].x, y[v] = world[k].y, z[v] = world[k].z;
    }
    if (turns) std::swap(i1[t], i2[t]);
  }
  return true;
}

void ClusterSet::fit(std::size_t cluster) {
  const Cluster& c = clusters[cluster];
  if (c.vertex_count == 0) return;
  Box box;
  const std::size_t last = c.first_vertex + c.vertex_count - 1;
  for (std::size_t v = c.first_vertex; v <= last; ++v) box.include({x[v], y[v], z[v]});
  for (std::size_t v = last + 1; v < c.first_vertex + padded_to_lanes(c.vertex_count); ++v)
    x[v] = x[last], y[v] = y[last], z[v] = z[last];
  boxes.set(cluster, box);
}

bool ClusterSet::follow(const PlacedScene& placed, const InstanceMove& move, Isa isa) {
  cutouts = placed.cutouts;
  if (!of_instances)
    of_instances = groups_by_instance(placed.first_primitives, clusters.size(), [&](std::uint32_t c) {
      return std::span(id.data() + clusters[c].first_triangle, clusters[c].triangle_count);
    });
  const std::span<const std::uint32_t> moved = (*of_instances)[move.instance];
  for (const std::uint32_t cluster : moved) {
    if (!move_triangles(placed, move, cluster)) return false;
    fit(cluster);
  }
  cones.follow(*this, moved, isa);
  return true;
}

void LazyClusters::follow(const PlacedScene& placed, const InstanceMove& move, Isa isa) {
  if (!set_ || set_->follow(placed, move, isa)) return;
  made_ = nullptr;
  set_.reset();
}

}  // namespace frontmost
