// SPDX-License-Identifier: Apache-2.0
// All threads fill one table with open addressing. A slot holds the lowest vertex of its place: whichever thread comes
// first, the lowest vertex stays, by compare and exchange. So the result does not depend on threads.
#include "geometry/places.h"

#include <atomic>
#include <bit>
#include <cstring>
#include <vector>

#include "base/parallel.h"

namespace frontmost {
namespace {

constexpr std::size_t kAtOnce = 8192;

class PlaceTable {
 public:
  explicit PlaceTable(std::span<const glm::vec3> positions)
      : positions_(positions), slots_(std::bit_ceil(2 * positions.size() + 2)) {}

  /// \returns the slot of the vertex's place. For many threads.
  std::uint32_t enter(std::uint32_t vertex) {
    const glm::vec3& p = positions_[vertex];
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = hash_of(p) & mask;; i = (i + 1) & mask) {
      std::uint32_t held = slots_[i].load(std::memory_order_relaxed);
      if (held == 0 && slots_[i].compare_exchange_strong(held, vertex + 1, std::memory_order_relaxed))
        return std::uint32_t(i);
      if (positions_[held - 1] != p) continue;
      while (vertex + 1 < held && !slots_[i].compare_exchange_weak(held, vertex + 1, std::memory_order_relaxed)) {
      }
      return std::uint32_t(i);
    }
  }
  [[nodiscard]] std::uint32_t lowest_in(std::uint32_t slot) const {
    return slots_[slot].load(std::memory_order_relaxed) - 1;
  }

 private:
  static std::size_t hash_of(const glm::vec3& position) {
    const glm::vec3 p = position + 0.0f;  // -0 becomes +0
    std::uint64_t h = 0;
    for (int axis = 0; axis < 3; ++axis) {
      std::uint32_t bits;
      std::memcpy(&bits, &p[axis], sizeof bits);
      h = (h ^ bits) * 0x9E3779B97F4A7C15u;
      h ^= h >> 29;
    }
    return std::size_t(h);
  }

  std::span<const glm::vec3> positions_;
  std::vector<std::atomic<std::uint32_t>> slots_;  ///< 0: free; otherwise a vertex + 1
};

}  // namespace

Buffer<std::uint32_t> first_at_place(std::span<const glm::vec3> positions, const Execution& execution) {
  PlaceTable table(positions);
  Buffer<std::uint32_t> first(positions.size());
  parallel_for(execution, positions.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      if (is_finite(positions[v])) first[v] = table.enter(std::uint32_t(v));
  });
  parallel_for(execution, positions.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      first[v] = is_finite(positions[v]) ? table.lowest_in(first[v]) : std::uint32_t(v);
  });
  return first;
}

}  // namespace frontmost
