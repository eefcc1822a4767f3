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
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "frontmost/scene.h"
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

/// World-space boxes, with one array for each side of the boxes, padded to whole vectors of 16 with empty boxes.
struct BoxArrays {
  Buffer<float> low_x, low_y, low_z, high_x, high_y, high_z;

  BoxArrays() = default;
  explicit BoxArrays(std::size_t count);
  void set(std::size_t i, const Box& box);
  [[nodiscard]] Box get(std::size_t i) const {
    return {{low_x[i], low_y[i], low_z[i]}, {high_x[i], high_y[i], high_z[i]}};
  }
};

struct ClusterSet;

/// The cones of normals of all clusters: they tell which clusters have no triangle that faces the eye. (L. A. Shirman,
/// S. S. Abi-Ezzi. The Cone of Normals Technique for Fast Processing of Curved Patches. 1993.)
///
///         \  axis  /
///          \  ^   /
///           \ | /          All normals of the cluster lie in the cone.
///            \|/
///       ------+------ surface
///
/// All triangles face away from the eye if, from every place of the cluster's box, even the direction of the cone that
/// is turned most towards the eye points away from the eye.
///
/// By cluster: a cone that holds the outward normals of all triangles with distinct vertices. Triangles of mirrored
/// instances count with the reversed winding that the cluster stores. Every normal is within kConeRounding, in radians,
/// of the stored cone. Padded to whole vectors of 16.
struct ConeArrays {
  Buffer<float> x, y, z;   ///< axis, of length 1
  Buffer<float> cosine;    ///< cosine of half the opening angle, greater than 0
  Buffer<float> altitude;  ///< the least altitude of all these triangles; 0 if there is no usable cone
};

/// A bound of rounding errors, in radians. The normal of a triangle that is 2^12 times as long as it is high errs by
/// 2^-9; a flatter triangle leaves its cluster without a cone. The cosine of a cone whose normals all agree errs by
/// 2^-22, and so the angle by 2^-10.5.
inline constexpr float kConeRounding = 3.0f / 1024.0f;

/// Makes the cones of a set. O(triangles), in parallel: 3 ms a million triangles on one thread, a tenth of the time
/// that making the clusters takes.
[[nodiscard]] ConeArrays make_cones(const ClusterSet& set, const Execution& execution);

/// The cones of a set, made when a caller first needs them.
class LazyCones {
 public:
  /// The cones, made at the first call. May be called by several threads at once.
  [[nodiscard]] const ConeArrays& get(const ClusterSet& set, const Execution& execution) const;
  /// The cones, or null if they have not been made.
  [[nodiscard]] const ConeArrays* made() const { return made_->cones.load(); }
  /// Identifies the set among all sets that ever existed.
  [[nodiscard]] std::weak_ptr<const void> identity() const { return made_; }
  [[nodiscard]] std::size_t byte_count() const;
  /// Updates existing cones of some clusters after their triangles moved. Not while another call runs.
  void follow(const ClusterSet& set, std::span<const std::uint32_t> clusters, Isa isa);

 private:
  struct Made {
    std::atomic<ConeArrays*> cones{nullptr};
    Made() = default;
    Made(const Made&) = delete;
    Made& operator=(const Made&) = delete;
    ~Made() { delete cones.load(); }
  };
  std::shared_ptr<Made> made_ = std::make_shared<Made>();
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
