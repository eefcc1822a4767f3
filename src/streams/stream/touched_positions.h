// SPDX-License-Identifier: Apache-2.0
// Which triangles of a stream touch some others: what smooth normals are made of.
//
// The normal at a corner is a mean over all triangles that have a corner in the same place. Those that are not seen are
// gone when the first pass ends, so a second one goes through the stream again and asks of every triangle whether it
// touches one that is seen:
//
//   corner --hash--> a bit of the filter:  0, the usual answer: no
//                                          1: look into the table of positions
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "frontmost/scene.h"

namespace frontmost::streaming {

/// A set of positions, exact to the bit but for the sign of zero. Beyond a number of triangles at one position normals
/// are no longer smoothed there, so no more of them need to be told.
class TouchedPositions {
 public:
  /// Of the corners of `corner_count` triangles at most, times three.
  explicit TouchedPositions(std::size_t corner_count);

  void add(const glm::vec3& position);
  /// Whether a corner of the triangle is one of them. Safe to call from several threads.
  [[nodiscard]] bool touches(const Mesh& mesh, std::uint32_t triangle);

 private:
  using Bits = std::array<std::uint32_t, 3>;
  struct Slot {
    Bits bits{};
    std::atomic<std::uint32_t> count{0};  ///< 0: free; else one more than triangles seen there
  };
  [[nodiscard]] std::size_t slot_of(const Bits& bits) const;

  std::vector<std::uint64_t> filter_;  ///< a bit for every hash: most corners go no further
  std::vector<Slot> slots_;
};

}  // namespace frontmost::streaming
