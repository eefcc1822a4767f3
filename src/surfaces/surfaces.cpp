// SPDX-License-Identifier: Apache-2.0
#include "frontmost/surfaces.h"

#include <algorithm>
#include <cmath>

#include "base/float_environment.h"
#include "surfaces/cluster_set.h"

namespace frontmost {
void check_transforms(const Scene& scene) {
  for (std::size_t i = 0; i < scene.instances.size(); ++i)
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row)
        if (!std::isfinite(scene.instances[i].world_from_mesh[column][row]))
          throw Error(ErrorCode::bad_argument, scene.name + ": instance " + std::to_string(i) + " (" +
                                                   scene.instances[i].name + "): its transform is not finite");
}

Surfaces::Surfaces(const Scene& scene, const Execution& execution) {
  const IeeeScope ieee;
  // The door: behind it no method looks at an index or a transform again.
  validate(scene);
  check_transforms(scene);
  clusters_ = std::make_unique<const ClusterSet>(build_clusters(scene, execution));
}

Surfaces::~Surfaces() = default;
Surfaces::Surfaces(Surfaces&&) noexcept = default;
Surfaces& Surfaces::operator=(Surfaces&&) noexcept = default;

const Scene& Surfaces::scene() const { return *clusters_->scene; }

std::uint32_t Surfaces::primitive_count() const { return clusters_->first_primitives.back(); }

PrimitiveSource Surfaces::source(PrimitiveId id) const {
  const std::vector<PrimitiveId>& first = clusters_->first_primitives;
  const auto next = std::upper_bound(first.begin(), first.end(), id);
  const auto instance = static_cast<std::uint32_t>(next - first.begin() - 1);
  return {instance, scene().instances[instance].mesh, id - first[instance]};
}

PrimitiveId Surfaces::first_primitive(std::uint32_t instance) const { return clusters_->first_primitives[instance]; }

const Box& Surfaces::bounds() const { return clusters_->bounds; }

const Box& Surfaces::bounds(std::uint32_t instance) const { return clusters_->instance_bounds[instance]; }

std::array<glm::vec3, 3> Surfaces::corners(PrimitiveId id) const {
  const PrimitiveSource from = source(id);
  const Mesh& mesh = scene().meshes[from.mesh];
  const ToWorld world(scene().instances[from.instance].world_from_mesh);
  const glm::uvec3& corners = mesh.triangles[from.triangle];
  return {world(mesh.positions[corners.x]), world(mesh.positions[corners.y]), world(mesh.positions[corners.z])};
}

bool Surfaces::is_mirrored(std::uint32_t instance) const { return clusters_->mirrored[instance] != 0; }

std::size_t Surfaces::byte_count() const {
  const ClusterSet& set = *clusters_;
  return sizeof set + set.first_primitives.size() * sizeof(PrimitiveId) + set.instance_bounds.size() * sizeof(Box) +
         set.clusters.size() * (sizeof(Cluster) + sizeof(Box)) + 3 * set.x.size() * sizeof(float) +
         (3 + sizeof(PrimitiveId)) * set.id.size() + set.cones.byte_count() +
         (set.cutouts ? set.cutouts->byte_count() : 0);
}

}  // namespace frontmost
