// SPDX-License-Identifier: Apache-2.0
// A set of numbers that many threads may add to at once. What it holds at the end does not depend on their order.
#pragma once

#include <atomic>
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
    // Most numbers come many times: looking first keeps the cache line shared.
    if (!(word.load(std::memory_order_relaxed) & bit)) word.fetch_or(bit, std::memory_order_relaxed);
  }
  [[nodiscard]] bool contains(std::size_t i) const {
    return (words_[i / 64].load(std::memory_order_relaxed) >> (i % 64)) & 1;
  }

 private:
  std::vector<std::atomic<std::uint64_t>> words_;
};

}  // namespace frontmost::shading
