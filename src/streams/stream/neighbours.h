// SPDX-License-Identifier: Apache-2.0
// Finds the triangles of a stream that touch visible triangles, because smooth normals are computed from them.
//
// The normal at a vertex is a mean over all triangles that have a vertex at the same position. Triangles that are not
// seen are gone after the first pass. So a second pass asks of every triangle whether it touches a visible one:
//
//   vertex --hash--> a bit of the filter:  0, the usual case: no
//                                          1: look into the table of positions
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <mutex>

#include "stream/kept_triangles.h"

namespace frontmost::streaming {

/// A set of positions, exact to the bit except for the sign of zero: a table with open addressing. Normals are not
/// smoothed at a position shared by very many triangles, so further triangles at such a position are not reported.
class TouchedPositions {
 public:
  /// `corner_count` is the greatest number of positions that will be added.
  explicit TouchedPositions(std::size_t corner_count)
      : filter_(power_of_two(16 * corner_count) / 64), slots_(power_of_two(2 * corner_count)) {}

  void add(const glm::vec3& position) {
    const Bits bits = bits_of(position);
    Slot& slot = slots_[slot_of(bits)];
    slot.bits = bits;
    slot.count.store(1, std::memory_order_relaxed);
    const std::uint64_t bit = filter_bit(bits);
    filter_[bit / 64] |= std::uint64_t(1) << (bit % 64);
  }

  /// True if a vertex of the triangle is in the set. Several threads may ask at once, after all positions were added.
  [[nodiscard]] bool touches(const Mesh& mesh, std::uint32_t triangle) {
    bool touches = false;
    for (int k = 0; k < 3; ++k) {
      const Bits bits = bits_of(mesh.positions[mesh.triangles[triangle][k]]);
      const std::uint64_t bit = filter_bit(bits);
      if (!((filter_[bit / 64] >> (bit % 64)) & 1)) continue;
      Slot& slot = slots_[slot_of(bits)];
      if (slot.count.load(std::memory_order_relaxed) == 0) continue;
      touches |= slot.count.fetch_add(1, std::memory_order_relaxed) <= most_at_one_place;
    }
    return touches;
  }

 private:
  /// More than the number of vertices that smooth normals examine at one position (shade/geometry/smooth_normals.cpp:
  /// 256), so that smooth normals, too, recognise such a position as having too many.
  static constexpr std::uint32_t most_at_one_place = 1000;

  using Bits = std::array<std::uint32_t, 3>;
  struct Slot {
    Bits bits{};
    std::atomic<std::uint32_t> count{0};  ///< 0: free; otherwise one more than the triangles found there
  };

  static std::size_t power_of_two(std::size_t least) { return std::bit_ceil(std::max<std::size_t>(least, 64)); }
  static Bits bits_of(const glm::vec3& position) {
    const glm::vec3 p = position + 0.0f;  // turns -0 into 0
    Bits bits;
    std::memcpy(bits.data(), &p, sizeof bits);
    return bits;
  }
  static std::uint64_t hash_of(const Bits& bits) {
    std::uint64_t h = bits[0] * 0x9E3779B97F4A7C15u;
    h = (h ^ bits[1]) * 0xC2B2AE3D27D4EB4Fu;
    h = (h ^ (h >> 29) ^ bits[2]) * 0x9E3779B97F4A7C15u;
    return h ^ (h >> 32);
  }
  [[nodiscard]] std::uint64_t filter_bit(const Bits& bits) const { return hash_of(bits) & (filter_.size() * 64 - 1); }
  [[nodiscard]] std::size_t slot_of(const Bits& bits) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = std::size_t(hash_of(bits)) & mask;
    while (slots_[slot].count.load(std::memory_order_relaxed) != 0 && slots_[slot].bits != bits)
      slot = (slot + 1) & mask;
    return slot;
  }

  std::vector<std::uint64_t> filter_;  ///< one bit per hash; most vertices need no further look-up
  std::vector<Slot> slots_;
};

/// Finds the visible triangles, and those that touch large visible triangles.
class NeighbourFinder {
 public:
  /// Triangles of `seen` are copied anew, so that they and their neighbours are in the order of the stream.
  NeighbourFinder(KeptPieces seen, const std::vector<glm::vec3>& corners)
      : seen_(std::move(seen)), touched_(corners.size()) {
    for (const glm::vec3& position : corners) touched_.add(position);
    for (auto& [number, piece] : seen_) piece.mesh = {};
  }

  void find(const Mesh& mesh, const PiecePlace& place) {
    Kept found{place, {}, {}};
    const auto piece = seen_.find(place.number);
    const std::vector<std::uint32_t> none, &seen = piece == seen_.end() ? none : piece->second.triangles;
    std::size_t next = 0;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const bool is_seen = next < seen.size() && seen[next] == t;
      next += is_seen;
      const bool touches = touched_.touches(mesh, t);
      if (!is_seen && !touches) continue;
      found.triangles.push_back(t);
      append_triangle(mesh, t, found.mesh);
    }
    if (found.triangles.empty()) return;
    const std::lock_guard lock(mutex_);
    all_.emplace(place.number, std::move(found));
  }
  [[nodiscard]] KeptPieces take() { return std::move(all_); }

 private:
  KeptPieces seen_, all_;
  TouchedPositions touched_;
  std::mutex mutex_;
};

}  // namespace frontmost::streaming
