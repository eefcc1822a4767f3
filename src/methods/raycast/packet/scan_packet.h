// SPDX-License-Identifier: Apache-2.0
// Rays of a scan that walk the tree together: neighbours on the camera's grid that start at one eye.
//
//    grid    +--------+--------+--        A packet is a block of the grid, and its rays look through a narrow pyramid.
//            | 64     | 64     |          Boxes and triangles beside the pyramid are left out for all rays at once.
//            | rays   | rays   |          Rays that spread too widely are cast one by one; the answers are the same to
//            +--------+--------+--        the bit.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "raycast/index/ray_tree.h"
#include "raycast/query/query_rule.h"

namespace frontmost::raycast_detail {

inline constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

inline constexpr std::size_t kScanRays = 64;

/// Rays and, once they are cast, their hits. Rays without a finite direction meet nothing.
struct ScanPacket {
  glm::vec3 origin{0};
  std::size_t count = 0;  ///< rays in use
  alignas(64) float direction[3][kScanRays];
  alignas(64) PrimitiveId primitive[kScanRays];
  alignas(64) float range[kScanRays];  ///< +inf if nothing is met

  [[nodiscard]] Query query_of(std::size_t ray) const {
    return {origin, origin, {direction[0][ray], direction[1][ray], direction[2][ray]}, false};
  }
};

/// A triangle that some rays of a packet may meet.
struct NotedTriangle {
  std::array<glm::vec3, 3> corners;
  PrimitiveId id;
  std::uint64_t rays;  ///< a bit for each ray that may meet it
};

/// Buffers of one thread.
struct ScanScratch {
  /// Far more than the number of rays, because PacketHits::Forget() keeps up to one note for each ray.
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

/// Returns the distance from the ray's origin to the hit, or +inf without a hit.
[[nodiscard]] inline float range_of(const RayHit& hit, const glm::vec3& direction) {
  return hit ? float(hit.t * glm::length(glm::dvec3(direction))) : kFloatInfinity;
}

/// Casts the rays of a packet: stores the id of the nearest surface along every ray, as walk_batch() finds it, and the
/// distance.
void cast_scan(const RayTree& tree, ScanPacket& packet, ScanScratch& scratch, Isa isa);

}  // namespace frontmost::raycast_detail
