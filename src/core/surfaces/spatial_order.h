// SPDX-License-Identifier: Apache-2.0
// The order in which triangles are put into clusters: neighbours in the order are neighbours in space.
//
//   centroid --CellMap--> cell of a grid --hilbert_place()--> a number on Hilbert's curve --radix_sort()--> the order
//
//     +--+  +--+
//     |  |  |  |
//     +  +--+  +      The curve goes through all cells of the grid, and completes each block before it leaves the
//     |        |      block. So cells that are near on the curve are near in space.
//     +--+  +--+
//        |  |
//     +--+  +--+
#pragma once

#include <vector>

#include "surfaces/placed_scene.h"

namespace frontmost {

/// Finds the instance of a primitive in constant time: a starting point every 64 ids, then a short search.
class InstanceFinder {
 public:
  /// `first_primitives` has the first id of each instance, then the number of all ids; borrowed.
  explicit InstanceFinder(const std::vector<PrimitiveId>& first_primitives);
  [[nodiscard]] std::uint32_t find(PrimitiveId id) const {
    std::uint32_t instance = start_[id / kStride];
    while (first_primitives_[instance + 1] <= id) ++instance;
    return instance;
  }

 private:
  static constexpr std::uint32_t kStride = 64;
  const std::vector<PrimitiveId>& first_primitives_;
  std::vector<std::uint32_t> start_;
};

/// Up to four triangles of an instance with consecutive ids that lie together and are ordered as one. Files mostly list
/// neighbours one after the other, so there are a third as many runs to sort as triangles.
struct TriangleRun {
  static constexpr std::uint32_t max_count = 4;

  PrimitiveId first;
  std::uint32_t count;

  /// Packs the run into 64 bits: count - 1 in 2 bits, the place on the curve in 30 bits, and `first` in 32 bits.
  [[nodiscard]] std::uint64_t packed(std::uint32_t place) const {
    return std::uint64_t(count - 1) << 62 | std::uint64_t(place) << 32 | first;
  }
  static TriangleRun unpacked(std::uint64_t bits) { return {PrimitiveId(bits), std::uint32_t(bits >> 62) + 1}; }
};

struct SpatialOrder {
  Buffer<std::uint64_t> runs;            ///< packed TriangleRuns; every primitive is in one
  std::vector<std::uint8_t> all_finite;  ///< by instance: not 0 if all vertices are finite in mesh space
};

/// All runs, ordered along Hilbert's curve by the cell that contains the centroid of their first triangle; within a
/// cell by id. Cells hold some tens of triangles of an ordinary surface. O(triangles), 5 to 16 bytes a triangle while
/// it runs.
[[nodiscard]] SpatialOrder spatial_order(const PlacedScene& placed, const Execution& execution);

}  // namespace frontmost
