// SPDX-License-Identifier: Apache-2.0
// All threads fill one table with open addressing. A slot holds the lowest vertex of its place: whichever thread comes
// first, the lowest vertex stays, by compare and exchange. So the result does not depend on threads. A file may hold
// positions that were chosen to collide; if a search passes thousands of slots, the positions are sorted instead.
#include "geometry/places.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <numeric>
#include <tuple>
#include <vector>

#include "base/parallel.h"

namespace frontmost {
namespace {

constexpr std::size_t kAtOnce = 8192;
/// The most slots that a search examines. Keys without a pattern rarely need a hundred.
constexpr std::size_t kMostProbes = 4096;

class PlaceTable {
 public:
  explicit PlaceTable(std::span<const glm::vec3> positions)
      : positions_(positions), slots_(std::bit_ceil(2 * positions.size() + 2)) {}

  /// \returns the slot of the vertex's place; no_index if the search takes too long. Many threads may call it at once.
  std::uint32_t enter(std::uint32_t vertex) {
    const glm::vec3& p = positions_[vertex];
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = hash_of(p) & mask;
    for (std::size_t probes = 0; probes < kMostProbes; ++probes, i = (i + 1) & mask) {
      std::uint32_t held = slots_[i].load(std::memory_order_relaxed);
      if (held == 0 && slots_[i].compare_exchange_strong(held, vertex + 1, std::memory_order_relaxed))
        return std::uint32_t(i);
      if (positions_[held - 1] != p) continue;
      while (vertex + 1 < held && !slots_[i].compare_exchange_weak(held, vertex + 1, std::memory_order_relaxed)) {
      }
      return std::uint32_t(i);
    }
    return no_index;
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

Buffer<std::uint32_t> detail::first_at_place_by_sorting(std::span<const glm::vec3> positions) {
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto finite_end =
      std::partition(order.begin(), order.end(), [&](std::uint32_t v) { return is_finite(positions[v]); });
  const auto key_of = [&](std::uint32_t v) {
    return std::tuple(positions[v].x + 0.0f, positions[v].y + 0.0f, positions[v].z + 0.0f, v);
  };
  std::sort(order.begin(), finite_end, [&](std::uint32_t a, std::uint32_t b) { return key_of(a) < key_of(b); });
  Buffer<std::uint32_t> first(positions.size());
  for (auto v = order.begin(); v != order.end(); ++v) {
    const bool is_new = v >= finite_end || v == order.begin() || positions[*v] != positions[v[-1]];
    first[*v] = is_new ? *v : first[v[-1]];
  }
  return first;
}

Buffer<std::uint32_t> first_at_place(std::span<const glm::vec3> positions, const Execution& execution) {
  if (positions.size() >= std::size_t(1) << 31)
    throw Error(ErrorCode::limit_exceeded, "mesh", "more than 2147483647 vertices to weld");
  PlaceTable table(positions);
  Buffer<std::uint32_t> first(positions.size());
  std::atomic<bool> is_crowded{false};
  parallel_for(execution, positions.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end && !is_crowded; ++v) {
      if (!is_finite(positions[v])) continue;
      first[v] = table.enter(std::uint32_t(v));
      if (first[v] == no_index) is_crowded = true;
    }
  });
  if (is_crowded) return detail::first_at_place_by_sorting(positions);
  parallel_for(execution, positions.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      first[v] = is_finite(positions[v]) ? table.lowest_in(first[v]) : std::uint32_t(v);
  });
  return first;
}

}  // namespace frontmost
