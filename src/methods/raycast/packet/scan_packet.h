// SPDX-License-Identifier: Apache-2.0
// Rays of a scan that walk the tree together: neighbours on the camera's grid, which start at one eye.
//
//    grid    +--------+--------+--        A packet is a block of the grid, and what its rays look through is a narrow
//            | 64     | 64     |          pyramid. Boxes and triangles beside the pyramid are left out for all rays at
//            | rays   | rays   |          once. Rays that spread too widely for that are asked for one by one; the
//            +--------+--------+--        answers are the same to the bit.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "raycast/index/ray_tree.h"
#include "raycast/query/query_rule.h"

namespace frontmost::raycast_detail {

inline constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

inline constexpr std::size_t kScanRays = 64;

/// Rays and, when they are cast, what each meets. Rays without a finite direction meet nothing.
struct ScanPacket {
  glm::vec3 origin{0};
  std::size_t count = 0;  ///< how many of the rays are used
  alignas(64) float direction[3][kScanRays];
  alignas(64) PrimitiveId primitive[kScanRays];
  alignas(64) float range[kScanRays];  ///< +inf where nothing is met

  [[nodiscard]] Query query_of(std::size_t ray) const {
    return {origin, origin, {direction[0][ray], direction[1][ray], direction[2][ray]}, false};
  }
};

/// A triangle that some rays of a packet may meet.
struct NotedTriangle {
  std::array<glm::vec3, 3> corners;
  PrimitiveId id;
  std::uint64_t rays;  ///< a bit for each that may
};

/// Buffers of one thread.
struct ScanScratch {
  /// More than twice as many as there are rays, of which each keeps one.
  static constexpr std::size_t kMostNotes = 256;

  /// A child, and the least place along the packet's axis that its box reaches.
  struct Waiting {
    float place;
    std::uint32_t child;
  };

  explicit ScanScratch(const RayTree& tree) : stack(tree.stack_size() + kRayLanes) {}

  std::vector<Waiting> stack;
  std::array<NotedTriangle, kMostNotes> notes;
};

/// The distance to where the ray meets something; +inf where it does not.
[[nodiscard]] inline float range_of(const RayHit& hit, const glm::vec3& direction) {
  return hit ? float(hit.t * glm::length(glm::dvec3(direction))) : kFloatInfinity;
}

/// The nearest surface along every ray: what walk_batch() answers, and the distance to it.
void cast_scan(const RayTree& tree, ScanPacket& packet, ScanScratch& scratch, Isa isa);

}  // namespace frontmost::raycast_detail
