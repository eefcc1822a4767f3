// SPDX-License-Identifier: Apache-2.0
// Lists of parts of the work, one after the other.
#pragma once

#include <vector>

#include "base/large_pages.h"

namespace frontmost::lines_detail {

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

}  // namespace frontmost::lines_detail
