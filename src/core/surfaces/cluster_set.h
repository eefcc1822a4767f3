// SPDX-License-Identifier: Apache-2.0
// Clusters of triangles as structure of arrays: the form in which methods read geometry that they look at often.
//
//   clusters    | 0           | 1           | ...
//   x, y, z     | v v v ... v | v v ...     |        at most 64 vertices each, in world space
//   i0, i1, i2  | t t t t ... | t t t ...   |        at most 124 triangles each: numbers of its vertices, a byte each
//   id          | t t t t ... | t t t ...   |        which triangle of the scene it is
//   boxes       | box         | box         |        what is outside of the picture is left out as a whole
//
// Everything is padded to 16, so that kernels read whole vectors and have no loop for the rest.
#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include "frontmost/scene.h"
#include "surfaces/cones.h"
#include "surfaces/holders.h"
#include "surfaces/placed_scene.h"

namespace frontmost {

/// Up to 64 vertices and 124 triangles that are neighbours in space. Its vertices start at `first_vertex` of
/// ClusterSet::x, y, z; its corner numbers (0 to 63, relative) and primitive ids at `first_triangle` of i0, i1, i2, id.
/// Both are padded to whole vectors of 16: padding vertices repeat the last one, padding triangles are degenerate.
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
  std::size_t first_cutout = 0;  ///< clusters from here on hold what may have holes, those before nothing of it
  std::shared_ptr<const Cutouts> cutouts;  ///< null where nothing may
  BoxArrays boxes;                         ///< of the clusters; empty where no triangle has finite corners
  Buffer<float> x, y, z;                   ///< world space
  Buffer<std::uint8_t> i0, i1, i2;
  Buffer<PrimitiveId> id;
  LazyCones cones;
  std::optional<Holders> holders;  ///< once an instance has moved

  /// Follows an instance to where it is in the scene. O(triangles) the first time; later what its own clusters take.
  /// \returns false, and is to be made anew, where corners have become finite, or are so no more.
  [[nodiscard]] bool follow(const PlacedScene& placed, const InstanceMove& move, Isa isa);

 private:
  [[nodiscard]] bool move_triangles(const PlacedScene& placed, const InstanceMove& move, std::size_t cluster);
  void fit(std::size_t cluster);
};

/// The clusters of surfaces, made now where they are not there.
[[nodiscard]] const ClusterSet& cluster_set(const Surfaces& surfaces, const Execution& execution = {});
/// Null where they have not been made yet.
[[nodiscard]] const ClusterSet* made_cluster_set(const Surfaces& surfaces);
/// Null where a single picture is drawn sooner without.
[[nodiscard]] const ClusterSet* cluster_set_for_picture(const Surfaces& surfaces, const Execution& execution);

/// Cuts all triangles into clusters, every one into one. Triangles with a non-finite world-space corner become
/// degenerate (three times the same corner number), so that no method sees them.
[[nodiscard]] ClusterSet build_clusters(const PlacedScene& placed, const Execution& execution);

/// The clusters of a scene, made when they have been asked for often enough to pay. May be asked by several threads at
/// once.
class LazyClusters {
 public:
  /// A picture without clusters takes a third to a half of the time that it takes to make them and one with them. So
  /// the first two calls give null, unless the clusters are there.
  [[nodiscard]] const ClusterSet* get(const PlacedScene& placed, const Execution& execution) const;
  /// At the first call, too.
  [[nodiscard]] const ClusterSet& get_now(const PlacedScene& placed, const Execution& execution) const;
  /// Null where they have not been made.
  [[nodiscard]] const ClusterSet* made() const { return made_.load(); }
  /// Clusters that are there follow an instance to where it is in the scene, or go. Not while another call runs.
  void follow(const PlacedScene& placed, const InstanceMove& move, Isa isa);
  /// Until then they have none, so that what may have holes need not be copied for their sake.
  void leave_cutouts() {
    if (set_) set_->cutouts.reset();
  }

 private:
  static constexpr int kCallsWithout = 2;

  mutable std::atomic<int> calls_{0};
  mutable std::mutex mutex_;
  mutable std::unique_ptr<ClusterSet> set_;
  mutable std::atomic<const ClusterSet*> made_{nullptr};
};

}  // namespace frontmost
