// SPDX-License-Identifier: Apache-2.0
// A spatial search for the corners of a polygon that block an ear.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace frontmost {

/// A tree of boxes over all corners of a polygon, some of which are marked. Siblings hold the same number of corners,
/// so the depth is logarithmic. The tree keeps its arrays from polygon to polygon.
class CornerTree {
 public:
  /// Builds the tree, without marks. Borrows the points and, for each corner, the numbers of its neighbours on the
  /// outline, which may change. O(n log n).
  void build(std::span<const glm::vec2> points, std::span<const std::uint32_t> previous,
             std::span<const std::uint32_t> next);
  /// O(log n).
  void mark(std::uint32_t corner, bool is_marked);

  /// Whether a marked corner blocks the ear a, b, c with its tip at b. A corner blocks if one of its edges leads into
  /// the ear. If `by_touching`, two more corners block: one on an edge of the ear, and one at b whose edges follow
  /// those of the ear, as it may belong to a bridge that turns there. Adds to `work` the number of boxes and corners
  /// tested.
  [[nodiscard]] bool blocks(const std::array<glm::vec2, 3>& ear, bool by_touching, std::uint64_t& work) const;

 private:
  static constexpr std::uint32_t leaf_size = 8;
  /// Node i has the children 2i + 1 and 2i + 2.
  struct Node {
    glm::vec2 low, high;       ///< bounds of all its corners
    std::uint32_t begin, end;  ///< range in order_
    std::uint32_t marked;      ///< number of marked corners
    [[nodiscard]] bool is_leaf() const { return end - begin <= leaf_size; }
  };
  void build(std::uint32_t node);

  std::span<const glm::vec2> points_;
  std::span<const std::uint32_t> previous_, next_;  ///< by corner
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> leaf_of_;  ///< by corner
  std::vector<std::uint8_t> is_marked_;
};

}  // namespace frontmost
