// SPDX-License-Identifier: Apache-2.0
// A set of numbers to which many threads may add at once. The result does not depend on their order.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace frontmost::shading {

class BitSet {
 public:
  BitSet() = default;
  explicit BitSet(std::size_t size) : words_((size + 63) / 64) {}

  void add(std::size_t i) {
    const std::uint64_t bit = std::uint64_t(1) << (i % 64);
    std::atomic<std::uint64_t>& word = words_[i / 64];
    // Most numbers are added many times; reading first keeps the cache line shared.
    if (!(word.load(std::memory_order_relaxed) & bit)) word.fetch_or(bit, std::memory_order_relaxed);
  }
  [[nodiscard]] bool contains(std::size_t i) const {
    return (words_[i / 64].load(std::memory_order_relaxed) >> (i % 64)) & 1;
  }
  /// Whether the set contains all of `other`, which has the same size. Not while threads add to either.
  [[nodiscard]] bool holds(const BitSet& other) const {
    std::uint64_t missing = 0;
    for (std::size_t w = 0; w < words_.size(); ++w)
      missing |= other.words_[w].load(std::memory_order_relaxed) & ~words_[w].load(std::memory_order_relaxed);
    return missing == 0;
  }
  /// Calls visit(i), in ascending order, for every number in this set that `known`, of the same size, lacks. Not while
  /// threads add to either.
  template <class Visit>
  void visit_new(const BitSet& known, const Visit& visit) const {
    for (std::size_t w = 0; w < words_.size(); ++w) {
      const std::uint64_t old = known.words_[w].load(std::memory_order_relaxed);
      for (std::uint64_t left = words_[w].load(std::memory_order_relaxed) & ~old; left != 0; left &= left - 1)
        visit(64 * w + std::size_t(std::countr_zero(left)));
    }
  }
  /// Adds all numbers of `other`, which has the same size.
  void add_all(const BitSet& other) {
    for (std::size_t w = 0; w < words_.size(); ++w)
      words_[w].fetch_or(other.words_[w].load(std::memory_order_relaxed), std::memory_order_relaxed);
  }
  /// Empties the set, for numbers below `size`. Allocates nothing if the size is unchanged.
  void clear(std::size_t size) {
    if (words_.size() != (size + 63) / 64) words_ = std::vector<std::atomic<std::uint64_t>>((size + 63) / 64);
    for (std::atomic<std::uint64_t>& word : words_) word.store(0, std::memory_order_relaxed);
  }

 private:
  std::vector<std::atomic<std::uint64_t>> words_;
};

}  // namespace frontmost::shading
