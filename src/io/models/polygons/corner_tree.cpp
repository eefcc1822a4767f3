// SPDX-License-Identifier: Apache-2.0
// A point lies in a triangle if it lies to the left of its three sides, by exact signs. A box may hold such a point if
// its corner farthest to the left of each side does. Together with the counts of marked corners in every node, that
// leaves few boxes to be opened, also in polygons of a million corners.
#include "io/models/polygons/corner_tree.h"

#include <algorithm>
#include <numeric>

#include "base/orientation.h"

namespace frontmost {
namespace {

/// What holds for a point within the triangle a, b, c: it lies to the left of all edges, or at least (0) on them.
struct Within {
  const std::array<glm::vec2, 3>& triangle;
  int least;

  [[nodiscard]] bool holds(const glm::vec2& p) const {
    const auto& [a, b, c] = triangle;
    return orientation(a, b, p) >= least && orientation(b, c, p) >= least && orientation(c, a, p) >= least;
  }
  /// False only if it holds for no point of the box: the corner farthest to the left of some edge is not left enough.
  [[nodiscard]] bool may_hold(const glm::vec2& low, const glm::vec2& high) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::vec2 &from = triangle[k], &to = triangle[(k + 1) % 3];
      if (orientation(from, to, {to.y > from.y ? low.x : high.x, to.x > from.x ? high.y : low.y}) < least) return false;
    }
    return true;
  }
};

}  // namespace

void CornerTree::build(std::span<const glm::vec2> points) {
  points_ = points;
  const auto count = std::uint32_t(points.size());
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0u);
  leaf_of_.resize(count);
  is_marked_.assign(count, 0);
  std::size_t leaves = 1;
  while (leaves * leaf_size < count) leaves *= 2;
  nodes_.resize(2 * leaves - 1);
  nodes_[0] = {{}, {}, 0, count, 0};
  build(0);
}

void CornerTree::build(std::uint32_t number) {
  Node& node = nodes_[number];
  node.low = node.high = points_[order_[node.begin]];
  for (std::uint32_t i = node.begin; i < node.end; ++i) {
    node.low = glm::min(node.low, points_[order_[i]]);
    node.high = glm::max(node.high, points_[order_[i]]);
  }
  if (node.is_leaf()) {
    for (std::uint32_t i = node.begin; i < node.end; ++i) leaf_of_[order_[i]] = number;
    return;
  }
  // Halves: the extents of huge polygons would not be finite.
  const int axis = 0.5f * node.high.x - 0.5f * node.low.x >= 0.5f * node.high.y - 0.5f * node.low.y ? 0 : 1;
  const std::uint32_t middle = node.begin + (node.end - node.begin) / 2;
  std::nth_element(order_.begin() + node.begin, order_.begin() + middle, order_.begin() + node.end,
                   [&](std::uint32_t a, std::uint32_t b) { return points_[a][axis] < points_[b][axis]; });
  nodes_[2 * number + 1] = {{}, {}, node.begin, middle, 0};
  nodes_[2 * number + 2] = {{}, {}, middle, node.end, 0};
  build(2 * number + 1);
  build(2 * number + 2);
}

void CornerTree::mark(std::uint32_t corner, bool is_marked) {
  if (bool(is_marked_[corner]) == is_marked) return;
  is_marked_[corner] = is_marked;
  for (std::uint32_t node = leaf_of_[corner];; node = (node - 1) / 2) {
    nodes_[node].marked += is_marked ? 1u : ~0u;
    if (node == 0) return;
  }
}

bool CornerTree::any_within(const std::array<glm::vec2, 3>& triangle, bool by_touching, std::uint64_t& work) const {
  const auto& [a, b, c] = triangle;
  const glm::vec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
  const auto is_apart = [&](const glm::vec2& l, const glm::vec2& h) {
    return h.x < low.x || l.x > high.x || h.y < low.y || l.y > high.y;
  };
  const Within within{triangle, by_touching ? 0 : 1};
  std::array<std::uint32_t, 64> stack{};  // deeper than the tree of 2^32 corners
  for (std::size_t depth = 1; depth > 0;) {
    const std::uint32_t number = stack[--depth];
    const Node& node = nodes_[number];
    ++work;
    if (node.marked == 0 || is_apart(node.low, node.high) || !within.may_hold(node.low, node.high)) continue;
    if (!node.is_leaf()) {
      stack[depth++] = 2 * number + 1;
      stack[depth++] = 2 * number + 2;
      continue;
    }
    work += node.end - node.begin;
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const glm::vec2& p = points_[order_[i]];
      if (!is_marked_[order_[i]] || is_apart(p, p) || p == a || p == b || p == c) continue;
      if (within.holds(p)) return true;
    }
  }
  return false;
}

}  // namespace frontmost
