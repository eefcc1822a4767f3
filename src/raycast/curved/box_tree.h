// SPDX-License-Identifier: Apache-2.0
// A small hierarchy of boxes in doubles, for the few primitives that are curved. Triangles have a wider one of their
// own (ray_tree.h).
//
// A single ray is a packet of one: both walks are one function, which takes the nearer child first and leaves out what
// begins behind everything that was met.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "raycast/curved/double_ray.h"

namespace frontmost::raycast_detail {

struct DoubleBox {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};

  void include(const glm::dvec3& p) { low = glm::min(low, p), high = glm::max(high, p); }
  void include(const DoubleBox& b) { low = glm::min(low, b.low), high = glm::max(high, b.high); }
  [[nodiscard]] double largest_side() const {
    const glm::dvec3 d = high - low;
    return std::max(d.x, std::max(d.y, d.z));
  }
};

/// Which of several rays pass through a box, as bits, and where the first of them enters it.
struct BoxEntry {
  std::uint32_t lanes = 0;
  double at = 0;
};

class DoubleBoxTree {
 public:
  DoubleBoxTree() = default;
  /// Items are the numbers of the boxes. O(n log n).
  explicit DoubleBoxTree(std::span<const DoubleBox> boxes);

  /// Calls visit(item) for the items whose boxes the ray passes through, roughly nearest first; visit may lessen
  /// ray.to.
  template <class Visit>
  void walk(DoubleRay& ray, const Visit& visit) const;

  /// The same for several rays, as bits: enter(box, lanes) gives the BoxEntry of a box, is_past(entry) says whether all
  /// of its rays have been shortened to less by now. Calls visit(item, lanes).
  template <class Enter, class IsPast, class Visit>
  void walk_together(std::uint32_t lanes, const Enter& enter, const IsPast& is_past, const Visit& visit) const;

  [[nodiscard]] std::size_t byte_count() const {
    return nodes_.size() * sizeof(Node) + items_.size() * sizeof(std::uint32_t);
  }

  static constexpr double kRoundings = 1 + 0x1p-50;  ///< a box ends a little farther than it is told to

 private:
  static constexpr std::size_t kLeafItems = 2;
  static constexpr std::size_t kDeepest = 64;  ///< halving 2^32 items takes 32 levels

  /// A leaf holds items [first, first + count); an inner node, with count 0, has children first and first + 1.
  struct Node {
    DoubleBox box;
    std::uint32_t first = 0, count = 0;
  };
  struct Range {
    std::uint32_t node, begin, end;
  };

  void split(const Range& range, std::span<const DoubleBox> boxes, std::vector<Range>& pending);
  /// Where the ray enters the box; infinity where it passes by. Wider than exact by a few roundings, never narrower.
  static double entry(const DoubleBox& box, const DoubleRay& ray, const glm::dvec3& inverse);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
};

inline double DoubleBoxTree::entry(const DoubleBox& box, const DoubleRay& ray, const glm::dvec3& inverse) {
  double enters = ray.from, leaves = ray.to;
  for (int k = 0; k < 3; ++k) {
    double a = (box.low[k] - ray.origin[k]) * inverse[k], b = (box.high[k] - ray.origin[k]) * inverse[k];
    if (a > b) std::swap(a, b);
    // 0 * infinity, along a side: NaN, which bounds nothing.
    if (a > enters) enters = a;
    if (b * kRoundings < leaves) leaves = b * kRoundings;
  }
  return enters <= leaves ? enters : std::numeric_limits<double>::infinity();
}

template <class Visit>
void DoubleBoxTree::walk(DoubleRay& ray, const Visit& visit) const {
  const glm::dvec3 inverse = 1.0 / ray.direction;
  const auto enter = [&](const DoubleBox& box, std::uint32_t) {
    const double at = entry(box, ray, inverse);
    return BoxEntry{at <= ray.to && at < std::numeric_limits<double>::infinity(), at};
  };
  const auto is_past = [&](const BoxEntry& entry) { return entry.at > ray.to; };
  walk_together(1, enter, is_past, [&](std::uint32_t item, std::uint32_t) { visit(item); });
}

template <class Enter, class IsPast, class Visit>
void DoubleBoxTree::walk_together(std::uint32_t lanes, const Enter& enter, const IsPast& is_past,
                                  const Visit& visit) const {
  if (nodes_.empty()) return;
  struct WaitingNode {
    std::uint32_t node;
    BoxEntry entry;
  };
  std::array<WaitingNode, kDeepest> stack;
  std::size_t size = 0;
  const auto push = [&](std::uint32_t node, std::uint32_t of) {
    const BoxEntry entry = enter(nodes_[node].box, of);
    if (entry.lanes != 0) stack[size++] = {node, entry};
  };
  push(0, lanes);
  while (size > 0) {
    const WaitingNode next = stack[--size];
    if (is_past(next.entry)) continue;
    const Node& node = nodes_[next.node];
    for (std::uint32_t i = 0; i < node.count; ++i) visit(items_[node.first + i], next.entry.lanes);
    if (node.count > 0) continue;
    const std::size_t before = size;
    push(node.first, next.entry.lanes);
    push(node.first + 1, next.entry.lanes);
    if (size == before + 2 && stack[before].entry.at < stack[before + 1].entry.at)
      std::swap(stack[before], stack[before + 1]);
  }
}

}  // namespace frontmost::raycast_detail
