// SPDX-License-Identifier: Apache-2.0
// Lists of parts of the work, one after the other.
#pragma once

#include <vector>

namespace frontmost::lines_detail {

template <class T>
[[nodiscard]] std::vector<T> joined(const std::vector<std::vector<T>>& lists) {
  std::size_t size = 0;
  for (const std::vector<T>& list : lists) size += list.size();
  std::vector<T> all;
  all.reserve(size);
  for (const std::vector<T>& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

}  // namespace frontmost::lines_detail
