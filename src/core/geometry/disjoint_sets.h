// SPDX-License-Identifier: Apache-2.0
// Sets of numbers that are joined, from several threads at once. The least number of a set stands for it, so the order
// in which sets are joined makes no difference.
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>
#include <vector>

namespace frontmost {

class DisjointSets {
 public:
  /// Numbers from 0 to count - 1, each in a set of its own.
  explicit DisjointSets(std::size_t count) : parents_(count) {
    for (std::size_t i = 0; i < count; ++i) parents_[i].store(std::uint32_t(i), std::memory_order_relaxed);
  }

  void join(std::uint32_t a, std::uint32_t b) {
    for (;;) {
      a = least_of(a), b = least_of(b);
      if (a == b) return;
      if (a > b) std::swap(a, b);
      std::uint32_t expected = b;  // another thread may have joined it meanwhile
      if (parents_[b].compare_exchange_weak(expected, a, std::memory_order_relaxed)) return;
    }
  }
  /// The least number of the set of `i`. Paths are halved on the way.
  [[nodiscard]] std::uint32_t least_of(std::uint32_t i) {
    for (;;) {
      std::uint32_t parent = parents_[i].load(std::memory_order_relaxed);
      if (parent == i) return i;
      const std::uint32_t above = parents_[parent].load(std::memory_order_relaxed);
      // Another thread may have stored a lesser number; then nothing is written.
      parents_[i].compare_exchange_weak(parent, above, std::memory_order_relaxed);
      i = above;
    }
  }
  [[nodiscard]] bool is_least(std::uint32_t i) const { return parents_[i].load(std::memory_order_relaxed) == i; }

 private:
  std::vector<std::atomic<std::uint32_t>> parents_;
};

}  // namespace frontmost
