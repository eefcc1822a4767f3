// SPDX-License-Identifier: Apache-2.0
// The triangles beyond the edges of each triangle.
//
//      c-------d         Edge b-c belongs to two triangles, a b c and d c b: each is the neighbour of the other there.
//     / \     /          They are wound alike, because they run along the edge in opposite directions. Edge a-b belongs
//    /   \   /           to one triangle, which has no neighbour there. Where three and more triangles share an edge,
//   a-----b              none of them has a neighbour.
#pragma once

#include <span>
#include <vector>

#include "frontmost/base.h"

namespace frontmost {

/// Side k of a triangle leads from its vertex k to the next.
class EdgeNeighbours {
 public:
  /// 3 * triangle + side and a flag share 32 bits.
  static constexpr std::size_t most_triangles = std::size_t(1) << 29;

  EdgeNeighbours() = default;
  /// `triangles` are welded: vertices at one place have one number, below vertex_count. A triangle that has a vertex
  /// twice neither has neighbours nor is a neighbour. O(triangles * log triangles at a vertex), in parallel.
  /// \throws Error limit_exceeded for more than most_triangles.
  EdgeNeighbours(std::span<const glm::uvec3> triangles, std::size_t vertex_count, const Execution& execution);

  /// The only other triangle that has this side; no_index if there is none, or several.
  [[nodiscard]] std::uint32_t beyond(std::size_t triangle, std::size_t side) const {
    const std::uint32_t found = beyond_[3 * triangle + side];
    return found == no_index ? no_index : found >> 1;
  }
  /// Whether the triangle beyond the side is wound alike, which means that it runs along the side in the other
  /// direction. Precondition: beyond() is not no_index.
  [[nodiscard]] bool is_wound_alike(std::size_t triangle, std::size_t side) const {
    return (beyond_[3 * triangle + side] & 1) != 0;
  }
  /// beyond() if the triangle there is wound alike, otherwise no_index.
  [[nodiscard]] std::uint32_t across(std::size_t triangle, std::size_t side) const {
    const std::uint32_t found = beyond_[3 * triangle + side];
    return found != no_index && (found & 1) != 0 ? found >> 1 : no_index;
  }

 private:
  Buffer<std::uint32_t> beyond_;  ///< by triangle and side: neighbour * 2 + whether it is wound alike
};

}  // namespace frontmost
