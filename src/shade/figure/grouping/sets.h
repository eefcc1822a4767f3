// SPDX-License-Identifier: Apache-2.0
// Numbers that are put together into sets.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace frontmost::shading {

/// Each set is known by its greatest number.
class Sets {
 public:
  explicit Sets(std::size_t count) : above_(count) { std::iota(above_.begin(), above_.end(), 0u); }
  std::uint32_t find(std::uint32_t i) {
    while (above_[i] != i) i = above_[i] = above_[above_[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    above_[std::min(a, b)] = std::max(a, b);
  }

 private:
  std::vector<std::uint32_t> above_;
};

}  // namespace frontmost::shading
