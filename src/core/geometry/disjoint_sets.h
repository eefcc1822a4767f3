// SPDX-License-Identifier: Apache-2.0
// Sets of numbers that several threads may join at once (union-find). The least number of a set is its leader, so the
// order of joining makes no difference.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace frontmost {

/// With `Before` = std::greater<>, the greatest number of a set is its leader.
template <class Before = std::less<>>
class DisjointSets {
 public:
  /// Numbers from 0 to count - 1, each in a set of its own.
  explicit DisjointSets(std::size_t count) : parents_(count) {
    for (std::size_t i = 0; i < count; ++i) parents_[i].store(std::uint32_t(i), std::memory_order_relaxed);
  }

  /// Joins the sets of two numbers. \returns whether they were in different sets.
  bool join(std::uint32_t a, std::uint32_t b) {
    for (;;) {
      a = leader_of(a), b = leader_of(b);
      if (a == b) return false;
      if (Before()(b, a)) std::swap(a, b);
      std::uint32_t expected = b;  // another thread may have joined b to a third set meanwhile
      if (parents_[b].compare_exchange_weak(expected, a, std::memory_order_relaxed)) return true;
    }
  }
  /// The leader of the set of `i`. The call halves the path to it.
  [[nodiscard]] std::uint32_t leader_of(std::uint32_t i) {
    for (;;) {
      std::uint32_t parent = parents_[i].load(std::memory_order_relaxed);
      if (parent == i) return i;
      const std::uint32_t above = parents_[parent].load(std::memory_order_relaxed);
      if (above == parent) return parent;
      // If another thread has written this parent meanwhile, nothing is written.
      parents_[i].compare_exchange_weak(parent, above, std::memory_order_relaxed);
      i = above;
    }
  }
  [[nodiscard]] bool is_leader(std::uint32_t i) const { return parents_[i].load(std::memory_order_relaxed) == i; }

 private:
  std::vector<std::atomic<std::uint32_t>> parents_;
};

}  // namespace frontmost
