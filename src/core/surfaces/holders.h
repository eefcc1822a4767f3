// SPDX-License-Identifier: Apache-2.0
// Which clusters or leaves hold triangles of an instance, and so change when it moves.
//
//   instance    0          1       2
//   first_      0          2       3        beginning of the instance's list
//   holders_    4  5       5       0 1 9    numbers, each once, in order
#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "surfaces/spatial_order.h"

namespace frontmost {

class Holders {
 public:
  /// ids_of(holder) gives the ids of the holder's triangles; numbers beyond the last id belong to no triangle.
  /// O(triangles).
  template <class IdsOf>
  Holders(const std::vector<PrimitiveId>& first_primitives, std::size_t count, const IdsOf& ids_of)
      : first_(first_primitives.size() + 1, 0) {
    const InstanceFinder instances(first_primitives);
    std::vector<std::uint32_t> last(first_primitives.size(), no_index);
    const auto visit_all = [&](const auto& visit) {
      std::fill(last.begin(), last.end(), no_index);
      for (std::uint32_t holder = 0; holder < count; ++holder)
        for (const PrimitiveId id : ids_of(holder)) {
          if (id >= first_primitives.back()) continue;
          const std::uint32_t instance = instances.find(id);
          if (std::exchange(last[instance], holder) != holder) visit(instance, holder);
        }
    };
    visit_all([&](std::uint32_t instance, std::uint32_t) { ++first_[instance + 2]; });
    for (std::size_t i = 2; i < first_.size(); ++i) first_[i] += first_[i - 1];
    holders_.resize(first_.back());
    // Filling moves each beginning to its end, which is where the next one begins.
    visit_all([&](std::uint32_t instance, std::uint32_t holder) { holders_[first_[instance + 1]++] = holder; });
  }

  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t instance) const {
    return std::span(holders_).subspan(first_[instance], first_[instance + 1] - first_[instance]);
  }
  [[nodiscard]] std::size_t byte_count() const { return (first_.size() + holders_.size()) * sizeof(std::uint32_t); }

 private:
  std::vector<std::uint32_t> first_, holders_;
};

}  // namespace frontmost
