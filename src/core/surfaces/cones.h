// SPDX-License-Identifier: Apache-2.0
// The directions that the triangles of each cluster may face: they tell if none of them faces the eye.
// (L. A. Shirman, S. S. Abi-Ezzi. The Cone of Normals Technique for Fast Processing of Curved Patches. 1993.)
//
//         \  axis  /
//          \  ^   /
//           \ | /          All normals of the cluster lie in the cone.
//            \|/
//       ------+------ surface
//
// All triangles face away from the eye if even the cone's direction that is turned most towards it faces away, from
// every place of the cluster's box.
#pragma once

#include <atomic>
#include <memory>
#include <span>

#include "frontmost/base.h"

namespace frontmost {

struct ClusterSet;

/// By cluster: a cone that holds the outward normals of all triangles with distinct vertices; mirrored instances have
/// the cluster's reversed winding. Every normal is within kConeRounding, in radians, of the stored cone. Padded to
/// whole vectors of 16.
struct ConeArrays {
  Buffer<float> x, y, z;   ///< axis, of length 1
  Buffer<float> cosine;    ///< cosine of half the opening angle, greater than 0
  Buffer<float> altitude;  ///< the least altitude of all these triangles; 0 if there is no usable cone
};

/// The normal of a triangle that is 2^12 times as long as it is high errs by 2^-9; a flatter triangle leaves its
/// cluster without a cone. The cosine of a closed cone errs by 2^-22, and so the angle by 2^-10.5.
inline constexpr float kConeRounding = 3.0f / 1024.0f;

/// Makes the cones of a set. O(triangles), in parallel: 3 ms a million triangles on one thread, a tenth of the time for
/// clusters.
[[nodiscard]] ConeArrays make_cones(const ClusterSet& set, const Execution& execution);

/// The cones of a set, made when a caller first needs them.
class LazyCones {
 public:
  /// The cones, made at the first call. May be called by several threads at once.
  [[nodiscard]] const ConeArrays& get(const ClusterSet& set, const Execution& execution) const;
  /// The cones, or null if they have not been made.
  [[nodiscard]] const ConeArrays* made() const { return made_->cones.load(); }
  /// Tells the set from every other one that ever lived.
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

}  // namespace frontmost
