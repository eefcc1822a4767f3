// SPDX-License-Identifier: Apache-2.0
// The groups of triangles (clusters, or leaves of a tree) that change when an instance moves.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "geometry/buckets.h"
#include "surfaces/spatial_order.h"

namespace frontmost {

/// Lists for each instance the groups that hold triangles of the instance: each group's number once, in order.
/// ids_of(group) returns the ids of a group's triangles; ids beyond the last one belong to no triangle. O(triangles),
/// on one thread.
template <class IdsOf>
[[nodiscard]] Buckets<std::uint32_t> groups_by_instance(const std::vector<PrimitiveId>& first_primitives,
                                                        std::size_t group_count, const IdsOf& ids_of) {
  const InstanceFinder instances(first_primitives);
  std::vector<std::uint32_t> of_group;
  const auto list = [&](std::size_t group, const auto& add) {
    of_group.clear();
    for (const PrimitiveId id : ids_of(std::uint32_t(group)))
      if (id < first_primitives.back()) of_group.push_back(instances.find(id));
    std::sort(of_group.begin(), of_group.end());
    of_group.erase(std::unique(of_group.begin(), of_group.end()), of_group.end());
    for (const std::uint32_t instance : of_group) add(instance, std::uint32_t(group));
  };
  return Buckets<std::uint32_t>(first_primitives.size() - 1, group_count, list, {.threads = 1});
}

}  // namespace frontmost
