// SPDX-License-Identifier: Apache-2.0
// Lists that many threads make, put together and sorted. Whoever makes a list by parts joins them in the order of the
// parts, so that results do not depend on which thread made which part; sorting in parts has the same result as sorting
// at once, but can be stopped between two parts and uses all threads.
#pragma once

#include <algorithm>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"

namespace frontmost::lines_detail {

/// One list after the other, as one list.
template <class T>
[[nodiscard]] std::vector<T> joined(const std::vector<std::vector<T>>& lists,
                                    const Execution& execution = {.threads = 1}) {
  std::size_t size = 0;
  for (const std::vector<T>& list : lists) size += list.size();
  std::vector<T> all;
  reserve_large(all, size, execution);
  for (const std::vector<T>& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

/// Sorts as std::sort does by an order without equals, or of which equals are the same, and can be stopped. Parts are
/// sorted by themselves, and neighbours merged until one is left: O(n log n) on one thread, n on many.
template <class T, class Less>
void sort_in_parts(std::vector<T>& values, const Less& less, const Execution& execution) {
  constexpr std::size_t part = 1 << 15;
  const auto at = [&](std::size_t i) { return values.begin() + std::ptrdiff_t(std::min(i, values.size())); };
  parallel_for(execution, values.size(), part,
               [&](std::size_t begin, std::size_t end) { std::sort(at(begin), at(end), less); });
  for (std::size_t sorted = part; sorted < values.size(); sorted *= 2)
    parallel_for(execution, values.size(), 2 * sorted, [&](std::size_t begin, std::size_t end) {
      std::inplace_merge(at(begin), at(std::min(begin + sorted, end)), at(end), less);
    });
}

}  // namespace frontmost::lines_detail
