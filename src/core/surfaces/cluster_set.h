// SPDX-License-Identifier: Apache-2.0
// Clusters of triangles as structure of arrays, the form in which methods read geometry repeatedly.
//
//   clusters    | 0           | 1           | ...
//   x, y, z     | v v v ... v | v v ...     |        at most 64 vertices each, in world space
//   i0, i1, i2  | t t t t ... | t t t ...   |        at most 124 triangles each: numbers of its vertices, a byte each
//   id          | t t t t ... | t t t ...   |        number of the triangle in the scene
//   boxes       | box         | box         |        clusters outside of the picture are left out as a whole
//
// Everything is padded to 16, so that kernels read whole vectors and need no loop for the rest.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <vector>

#include "frontmost/scene.h"
#include "surfaces/cones.h"
#include "surfaces/groups_by_instance.h"
#include "surfaces/placed_scene.h"

namespace frontmost {

/// Up to 64 vertices and 124 triangles that are neighbours in space. The vertices start at `first_vertex` of
/// ClusterSet::x, y, z; vertex numbers of triangles (0 to 63, relative) and primitive ids start at `first_triangle` of
/// i0, i1, i2, id. Both are padded to whole vectors of 16: padding vertices repeat the last one, padding triangles are
/// degenerate.
struct Cluster {
  static constexpr int max_vertices = 64;
  static constexpr int max_triangles = 124;
  static constexpr int lanes = 16;

  std::uint64_t first_vertex = 0;
  std::uint64_t first_triangle = 0;
  std::uint16_t vertex_count = 0;
  std::uint16_t triangle_count = 0;
};

/// World-space boxes, one array a side, padded to whole vectors of 16 with empty boxes.
struct BoxArrays {
  Buffer<float> low_x, low_y, low_z, high_x, high_y, high_z;

  BoxArrays() = default;
  explicit BoxArrays(std::size_t count);
  void set(std::size_t i, const Box& box);
  [[nodiscard]] Box get(std::size_t i) const {
    return {{low_x[i], low_y[i], low_z[i]}, {high_x[i], high_y[i], high_z[i]}};
  }
};

struct InstanceMove {
  std::uint32_t instance;
  bool was_mirrored;
};

struct ClusterSet {
  std::vector<Cluster> clusters;
  std::size_t first_cutout = 0;            ///< clusters from here on may have holes, clusters before have none
  std::shared_ptr<const Cutouts> cutouts;  ///< null if no triangle may have holes
  BoxArrays boxes;                         ///< boxes of the clusters; empty for a cluster without triangles with finite
                                           ///< vertices
  Buffer<float> x, y, z;                   ///< world space
  Buffer<std::uint8_t> i0, i1, i2;
  Buffer<PrimitiveId> id;
  LazyCones cones;
  std::optional<Buckets<std::uint32_t>> of_instances;  ///< groups_by_instance(), made once an instance has moved

  /// Moves an instance to its place in the scene. O(triangles) the first time, later O(size of the instance's
  /// clusters). \returns false if the set must be made anew, because vertices became finite or ceased to be.
  [[nodiscard]] bool follow(const PlacedScene& placed, const InstanceMove& move, Isa isa);

 private:
  [[nodiscard]] bool move_triangles(const PlacedScene& placed, const InstanceMove& move, std::size_t cluster);
  void fit(std::size_t cluster);
};

/// The clusters of surfaces; makes them if there are none.
[[nodiscard]] const ClusterSet& cluster_set(const Surfaces& surfaces, const Execution& execution = {});
/// The clusters of surfaces, or null if they have not been made yet.
[[nodiscard]] const ClusterSet* made_cluster_set(const Surfaces& surfaces);

/// Divides all triangles into clusters. Triangles with a non-finite world-space vertex become degenerate (three equal
/// vertex numbers), so no method sees them.
[[nodiscard]] ClusterSet build_clusters(const PlacedScene& placed, const Execution& execution);

/// The clusters of a scene, made when a caller first needs them. May be used by several threads at once.
class LazyClusters {
 public:
  /// The clusters, made at the first call.
  [[nodiscard]] const ClusterSet& get(const PlacedScene& placed, const Execution& execution) const;
  /// The clusters, or null if they have not been made.
  [[nodiscard]] const ClusterSet* made() const { return made_.load(); }
  /// Moves an instance of existing clusters to its place in the scene, or drops the clusters. Not while another call
  /// runs.
  void follow(const PlacedScene& placed, const InstanceMove& move, Isa isa);
  /// Drops the clusters' reference to cutouts, so that cutouts need not be copied before they move.
  void leave_cutouts() {
    if (set_) set_->cutouts.reset();
  }

 private:
  mutable std::mutex mutex_;
  mutable std::unique_ptr<ClusterSet> set_;
  mutable std::atomic<const ClusterSet*> made_{nullptr};
};

}  // namespace frontmost
