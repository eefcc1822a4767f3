// SPDX-License-Identifier: Apache-2.0
// The tree is made from the top: a range of items is halved at the median of the boxes' middles, along the axis on
// which these are spread most, until two are left. All halves have the same size, so no walk is deeper than 32 levels
// and its stack has a fixed size. Items at equal places are parted by their numbers, so that the tree is the same
// everywhere.
#include "raycast/curved/box_tree.h"

#include <algorithm>
#include <numeric>

namespace frontmost::raycast_detail {

DoubleBoxTree::DoubleBoxTree(std::span<const DoubleBox> boxes) : items_(boxes.size()) {
  if (boxes.empty()) return;
  std::iota(items_.begin(), items_.end(), 0u);
  nodes_.emplace_back();
  std::vector<Range> pending{{0, 0, std::uint32_t(boxes.size())}};
  while (!pending.empty()) {
    const Range range = pending.back();
    pending.pop_back();
    split(range, boxes, pending);
  }
}

/// At the median of the middles along the longest side of the middles' box. Patches are few and about equally large:
/// the surface area heuristic would have little to gain.
void DoubleBoxTree::split(const Range& range, std::span<const DoubleBox> boxes, std::vector<Range>& pending) {
  const auto middle_of = [&](std::uint32_t item) { return boxes[item].low * 0.5 + boxes[item].high * 0.5; };
  DoubleBox box, middles;
  for (std::uint32_t i = range.begin; i < range.end; ++i) {
    box.include(boxes[items_[i]]);
    middles.include(middle_of(items_[i]));
  }
  nodes_[range.node].box = box;
  if (range.end - range.begin <= kLeafItems) {
    nodes_[range.node].first = range.begin;
    nodes_[range.node].count = range.end - range.begin;
    return;
  }
  const glm::dvec3 sides = middles.high - middles.low;
  const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
  const std::uint32_t half = range.begin + (range.end - range.begin) / 2;
  std::nth_element(items_.begin() + range.begin, items_.begin() + half, items_.begin() + range.end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double at_a = middle_of(a)[axis], at_b = middle_of(b)[axis];
                     return at_a != at_b ? at_a < at_b : a < b;
                   });
  const auto first = std::uint32_t(nodes_.size());
  nodes_[range.node].first = first;
  nodes_.resize(nodes_.size() + 2);
  pending.push_back({first, range.begin, half});
  pending.push_back({first + 1, half, range.end});
}

}  // namespace frontmost::raycast_detail
