// SPDX-License-Identifier: Apache-2.0
// Sorting on many threads, and so that it can be stopped.
#pragma once

#include <algorithm>
#include <vector>

#include "base/parallel.h"

namespace frontmost::lines_detail {

/// As std::sort for an order without equals, or of which equals are the same.
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
