// SPDX-License-Identifier: Apache-2.0
// A point lies in a triangle if it lies to the left of its three edges, by exact signs. A box may hold such a point if,
// for each edge, its corner farthest to the left of the edge lies to the left. Together with the number of marked
// corners in each node, this test leaves few boxes to open, even in polygons of a million corners.
//
// An outline that touches itself has several corners at one place. The directions of their edges decide which of them
// block an ear: the outline does not cross itself, so every edge that enters the ear ends in it or on its edges.
#include "io/models/polygons/corner_tree.h"

#include <algorithm>
#include <numeric>

#include "base/orientation.h"

namespace frontmost {
namespace {

/// An ear a, b, c with its tip at b, counter-clockwise.
struct BlockableEar {
  const std::array<glm::vec2, 3>& corners;

  /// The sides of ab, bc and ca on which a point lies; +1 is the inner side.
  [[nodiscard]] std::array<int, 3> sides(const glm::vec2& p) const {
    const auto& [a, b, c] = corners;
    return {orientation(a, b, p), orientation(b, c, p), orientation(c, a, p)};
  }
  /// False only if the ear holds no point of the box, not even on its edges.
  [[nodiscard]] bool may_hold(const glm::vec2& low, const glm::vec2& high) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::vec2 &from = corners[k], &to = corners[(k + 1) % 3];
      if (orientation(from, to, {to.y > from.y ? low.x : high.x, to.x > from.x ? high.y : low.y}) < 0) return false;
    }
    return true;
  }
  /// Whether the corner p of an outline blocks the ear; `before` and `after` are its neighbours.
  [[nodiscard]] bool is_blocked(const glm::vec2& p, const glm::vec2& before, const glm::vec2& after,
                                bool by_touching) const {
    const std::array<int, 3> at = sides(p);
    if (at[0] < 0 || at[1] < 0 || at[2] < 0) return false;
    const std::array<int, 3> from = sides(before), to = sides(after);
    // A corner on an edge of the ear enters only if its edge leads to the inner side.
    const auto enters = [&](const std::array<int, 3>& end) {
      return (at[0] > 0 || end[0] > 0) && (at[1] > 0 || end[1] > 0) && (at[2] > 0 || end[2] > 0);
    };
    if (enters(from) || enters(to)) return true;
    if (!by_touching || p == corners[0] || p == corners[2]) return false;
    return p != corners[1] || (from[0] >= 0 && from[1] >= 0 && to[0] >= 0 && to[1] >= 0);
  }
};

}  // namespace

void CornerTree::build(std::span<const glm::vec2> points, std::span<const std::uint32_t> previous,
                       std::span<const std::uint32_t> next) {
  points_ = points;
  previous_ = previous;
  next_ = next;
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
  // The halves avoid overflow: extents of huge polygons would not be finite.
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

bool CornerTree::blocks(const std::array<glm::vec2, 3>& ear, bool by_touching, std::uint64_t& work) const {
  const auto& [a, b, c] = ear;
  const glm::vec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
  const auto is_apart = [&](const glm::vec2& l, const glm::vec2& h) {
    return h.x < low.x || l.x > high.x || h.y < low.y || l.y > high.y;
  };
  const BlockableEar blockable{ear};
  std::array<std::uint32_t, 64> stack{};  // deeper than a tree of 2^32 corners
  for (std::size_t depth = 1; depth > 0;) {
    const std::uint32_t number = stack[--depth];
    const Node& node = nodes_[number];
    ++work;
    if (node.marked == 0 || is_apart(node.low, node.high) || !blockable.may_hold(node.low, node.high)) continue;
    if (!node.is_leaf()) {
      stack[depth++] = 2 * number + 1;
      stack[depth++] = 2 * number + 2;
      continue;
    }
    work += node.end - node.begin;
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const std::uint32_t corner = order_[i];
      const glm::vec2& p = points_[corner];
      if (!is_marked_[corner] || is_apart(p, p)) continue;
      if (blockable.is_blocked(p, points_[previous_[corner]], points_[next_[corner]], by_touching)) return true;
    }
  }
  return false;
}

}  // namespace frontmost
