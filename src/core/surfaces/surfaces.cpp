// SPDX-License-Identifier: Apache-2.0
// Surfaces: a scene that was checked and numbered, and its clusters, which may not exist yet.
//
// Most data of a method is made here once and only read afterwards. Clusters are the exception: a single picture is
// drawn sooner without them. So the first method that needs clusters makes them, under a lock, behind a const
// interface. After one instance moved, only the data that depend on this instance are computed again:
//
//   boxes, bounds    of its ranges of triangles
//   holes            places of its triangles
//   clusters         places of its vertices, which it shares with no other instance; boxes and cones of these clusters
#include <algorithm>
#include <utility>

#include "base/parallel.h"
#include "frontmost/scene.h"
#include "scene/validate.h"
#include "surfaces/cluster_set.h"
#include "surfaces/placed_scene.h"
#include "surfaces/vertex_table.h"

namespace frontmost {
namespace {

std::size_t byte_count(const ClusterSet& set) {
  return sizeof set + set.clusters.size() * (sizeof(Cluster) + sizeof(Box)) + 3 * set.x.size() * sizeof(float) +
         (3 + sizeof(PrimitiveId)) * set.id.size() + set.cones.byte_count() +
         (set.of_instances ? set.of_instances->byte_count() : 0);
}

}  // namespace

struct Surfaces::State {
  PlacedScene placed;
  LazyClusters clusters;
};

Surfaces::Surfaces(const Scene& scene, const Execution& execution) {
  const IeeeScope ieee;
  // All checks are here: after this point no method checks an index or a transform again.
  validate_besides_vertices(scene);
  for (std::size_t i = 0; i < scene.instances.size(); ++i)
    check_transform(scene, i, scene.instances[i].world_from_mesh);
  auto state = std::make_unique<State>();
  state->placed = place_scene(scene, execution);
  state_ = std::move(state);
}

void Surfaces::move(Scene& scene, std::uint32_t instance, const glm::dmat4& world_from_mesh,
                    const Execution& execution) {
  const Placement placement{instance, world_from_mesh};
  move(scene, std::span(&placement, 1), execution);
}

void Surfaces::move(Scene& scene, std::span<const Placement> placements, const Execution& execution) {
  PlacedScene& placed = state_->placed;
  if (&scene != placed.scene) throw Error(ErrorCode::bad_argument, "move", "the surfaces were made for another scene");
  for (const auto& [instance, world_from_mesh] : placements) {
    if (instance >= scene.instances.size())
      throw Error(ErrorCode::bad_argument, "move", "there is no instance " + std::to_string(instance));
    check_transform(scene, instance, world_from_mesh);
  }
  const IeeeScope ieee;
  for (const auto& [instance, world_from_mesh] : placements) {
    const InstanceMove move{instance, placed.mirrored[instance] != 0};
    scene.instances[instance].world_from_mesh = world_from_mesh;
    state_->clusters.leave_cutouts();
    placed.follow(instance, execution.isa);
    state_->clusters.follow(placed, move, execution.isa);
    placed.moves.add(instance, scene.instances.size());
  }
}

Surfaces::~Surfaces() = default;
Surfaces::Surfaces(Surfaces&&) noexcept = default;
Surfaces& Surfaces::operator=(Surfaces&&) noexcept = default;

const PlacedScene& placed_scene(const Surfaces& surfaces) { return surfaces.state_->placed; }

void Surfaces::make_clusters(const Execution& execution) const { (void)cluster_set(*this, execution); }

const ClusterSet& cluster_set(const Surfaces& surfaces, const Execution& execution) {
  return surfaces.state_->clusters.get(surfaces.state_->placed, execution);
}

const ClusterSet* made_cluster_set(const Surfaces& surfaces) { return surfaces.state_->clusters.made(); }

const Scene& Surfaces::scene() const { return *state_->placed.scene; }

std::uint32_t Surfaces::primitive_count() const { return state_->placed.first_primitives.back(); }

PrimitiveSource Surfaces::source(PrimitiveId id) const {
  const std::vector<PrimitiveId>& first = state_->placed.first_primitives;
  const auto next = std::upper_bound(first.begin(), first.end(), id);
  const auto instance = static_cast<std::uint32_t>(next - first.begin() - 1);
  return {instance, scene().instances[instance].mesh, id - first[instance]};
}

PrimitiveId Surfaces::first_primitive(std::uint32_t instance) const {
  return state_->placed.first_primitives[instance];
}

const Box& Surfaces::bounds() const { return state_->placed.bounds; }

const Box& Surfaces::bounds(std::uint32_t instance) const { return state_->placed.instance_bounds[instance]; }

std::array<glm::vec3, 3> Surfaces::corners(PrimitiveId id) const {
  const PrimitiveSource from = source(id);
  const Mesh& mesh = scene().meshes[from.mesh];
  const ToWorld world(scene().instances[from.instance].world_from_mesh);
  const glm::uvec3& corners = mesh.triangles[from.triangle];
  return {world(mesh.positions[corners.x]), world(mesh.positions[corners.y]), world(mesh.positions[corners.z])};
}

bool Surfaces::is_mirrored(std::uint32_t instance) const { return state_->placed.mirrored[instance] != 0; }

std::size_t Surfaces::byte_count() const {
  const PlacedScene& p = state_->placed;
  const ClusterSet* const made = state_->clusters.made();
  return sizeof(State) + p.first_primitives.size() * sizeof(PrimitiveId) + p.mirrored.size() +
         p.ranges.size() * sizeof(MeshRange) + (p.boxes.size() + p.instance_bounds.size()) * sizeof(Box) +
         (p.cutouts ? p.cutouts->byte_count() : 0) + p.sides->bits.size() * sizeof(std::uint32_t) +
         (made ? frontmost::byte_count(*made) : 0);
}

const ClusterSet& LazyClusters::get(const PlacedScene& placed, const Execution& execution) const {
  if (const ClusterSet* const made = made_.load()) return *made;
  const std::lock_guard lock(mutex_);
  if (!set_) {
    const IeeeScope ieee;
    set_ = std::make_unique<ClusterSet>(build_clusters(placed, execution));
    made_ = set_.get();
  }
  return *set_;
}

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
