// SPDX-License-Identifier: Apache-2.0
// The order in which triangles are put into clusters: neighbours in space are neighbours in the order.
#pragma once

#include <vector>

#include "frontmost/surfaces.h"

namespace frontmost {

/// Finds the instance of a primitive in constant time: a starting point every 64 ids, then a short walk.
class InstanceFinder {
 public:
  /// `first_primitives` by instance, and the total at the end; borrowed.
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

/// All primitive ids, by the cells of the triangles' centroids along Hilbert's curve; within a cell in id order.
/// Cells hold some tens of triangles of an ordinary surface. O(triangles), 16 bytes a triangle while it runs.
[[nodiscard]] Buffer<PrimitiveId> spatial_order(const Scene& scene, const std::vector<PrimitiveId>& first_primitives,
                                                const Execution& execution);

}  // namespace frontmost
