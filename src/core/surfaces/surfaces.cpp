// SPDX-License-Identifier: Apache-2.0
// Surfaces: a scene that was checked and numbered, and its clusters, which may not exist yet.
//
// Most data of a method is made here once and only read afterwards. Clusters are the exception: a single picture is
// drawn sooner without them. So the first method that needs clusters makes them, under a lock, behind a const
// interface.
#include <algorithm>

#include "base/parallel.h"
#include "frontmost/scene.h"
#include "scene/validate.h"
#include "surfaces/cluster_set.h"

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
  // All checks are here: behind this point no method checks an index or a transform again.
  validate_besides_vertices(scene);
  check_transforms(scene);
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
  if (&scene != placed.scene) throw Error(ErrorCode::bad_argument, "move", "the surfaces are of another scene");
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

}  // namespace frontmost
