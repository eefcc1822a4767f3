// SPDX-License-Identifier: Apache-2.0
// Finds the triangles of a stream that touch given ones. Smooth normals are computed from them.
//
// The normal at a vertex is a mean over all triangles that have a vertex at the same position. Triangles that are not
// seen are gone after the first pass. So a second pass asks of every triangle whether it touches a visible one:
//
//   vertex --hash--> a bit of the filter:  0, the usual case: no
//                                          1: look into the table of positions
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "frontmost/scene.h"

namespace frontmost::streaming {

/// A set of positions, exact to the bit except for the sign of zero. Normals are not smoothed at a position shared by
/// very many triangles, so further triangles at such a position are not reported.
class TouchedPositions {
 public:
  /// `corner_count` is the greatest number of positions that will be added.
  explicit TouchedPositions(std::size_t corner_count);

  void add(const glm::vec3& position);
  /// True if a vertex of the triangle is in the set. Safe to call from several threads.
  [[nodiscard]] bool touches(const Mesh& mesh, std::uint32_t triangle);

 private:
  using Bits = std::array<std::uint32_t, 3>;
  struct Slot {
    Bits bits{};
    std::atomic<std::uint32_t> count{0};  ///< 0: free; otherwise one more than the triangles found there
  };
  [[nodiscard]] std::size_t slot_of(const Bits& bits) const;

  std::vector<std::uint64_t> filter_;  ///< one bit per hash; most vertices need no further look-up
  std::vector<Slot> slots_;
};

}  // namespace frontmost::streaming
