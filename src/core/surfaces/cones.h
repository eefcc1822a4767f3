// SPDX-License-Identifier: Apache-2.0
// Which way the triangles of each cluster face, at most: what tells that none of them faces the eye.
// (L. A. Shirman, S. S. Abi-Ezzi. The Cone of Normals Technique for Fast Processing of Curved Patches. 1993.)
//
//         \  axis  /
//          \  ^   /
//           \ | /          All normals of the cluster lie in the cone.
//            \|/
//       ------+------ surface
//
// Where even the direction in the cone that is turned most towards the eye faces away from it, from every place of the
// cluster's box, all of its triangles face away.
#pragma once

#include <atomic>
#include <memory>
#include <span>

#include "frontmost/base.h"

namespace frontmost {

struct ClusterSet;

/// By cluster: a cone that holds the outward normals of all triangles with distinct corners, the winding of mirrored
/// instances turned as in the cluster. Every normal is within kConeRounding, in radians, of what is stored. Padded to
/// whole vectors of 16.
struct ConeArrays {
  Buffer<float> x, y, z;   ///< axis, of length 1
  Buffer<float> cosine;    ///< of half the opening angle, greater than 0
  Buffer<float> altitude;  ///< the least of those triangles' least altitudes; 0 where there is no cone to be used
};

/// Of a triangle that is 2^12 times as long as it is high the normal errs by 2^-9 (flatter ones leave the cluster
/// without a cone); the cosine of a closed cone errs by 2^-22, the angle thus by 2^-10.5.
inline constexpr float kConeRounding = 3.0f / 1024.0f;

/// O(triangles), in parallel: 3 ms a million triangles on one thread, a tenth of the time for clusters.
[[nodiscard]] ConeArrays make_cones(const ClusterSet& set, const Execution& execution);

/// The cones of a set, made when they have been asked for often enough to pay.
class LazyCones {
 public:
  /// What cones save of a frame is between a half and a fortieth of what it costs to make them: a set that is drawn
  /// once does better without. So the first few calls give null. May be called by several threads at once.
  [[nodiscard]] const ConeArrays* get(const ClusterSet& set, const Execution& execution) const;
  /// At the first call, too.
  [[nodiscard]] const ConeArrays& get_now(const ClusterSet& set, const Execution& execution) const;
  [[nodiscard]] std::size_t byte_count() const;
  /// Cones that are there follow the triangles of some clusters. Not while another call runs.
  void follow(const ClusterSet& set, std::span<const std::uint32_t> clusters, Isa isa);

 private:
  static constexpr int kCallsWithout = 8;

  struct State {
    std::atomic<int> calls{0};
    std::atomic<ConeArrays*> made{nullptr};
    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() { delete made.load(); }
  };
  std::unique_ptr<State> state_ = std::make_unique<State>();
};

}  // namespace frontmost
