// SPDX-License-Identifier: Apache-2.0
// Lists that many threads make in parts, joined in the order of the parts and sorted.
#pragma once

#include <algorithm>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"

namespace frontmost::lines_detail {

/// The lists one after the other, as one list.
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

/// Sorts like std::sort, but can be cancelled. Precondition: values that compare equal are identical. Parts are sorted
/// on their own, and neighbouring parts are merged until one part is left: O(n log n) on one thread, O(n) on many.
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
