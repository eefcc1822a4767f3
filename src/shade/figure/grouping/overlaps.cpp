// SPDX-License-Identifier: Apache-2.0
#include "shade/figure/grouping/overlaps.h"

#include <algorithm>

namespace frontmost::shading {
namespace {

using painter_detail::Extent;

/// Pixels by which polygons must overlap to cover each other: those that were cut at each other's sides do so by a
/// rounding.
constexpr double kThin = 1.0 / 512;

using Corners = std::span<const PaintCorner>;

/// Whether a side of `a` has all of `b` on its outside. Both are counter-clockwise as they are seen, y is down.
bool has_side_between(Corners a, Corners b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const glm::dvec2 from(a[i].at), way = glm::dvec2(a[i + 1 == a.size() ? 0 : i + 1].at) - from;
    const double length = glm::length(way);
    if (!(length > kThin)) continue;
    const auto is_outside = [&](const PaintCorner& corner) {
      const glm::dvec2 p = glm::dvec2(corner.at) - from;
      return way.x * p.y - way.y * p.x > -kThin * length;
    };
    if (std::all_of(b.begin(), b.end(), is_outside)) return true;
  }
  return false;
}

std::vector<Extent> extents_of(const PaintOrder& order) {
  std::vector<Extent> extents;
  extents.reserve(order.polygons.size());
  for (std::size_t i = 0; i < order.polygons.size(); ++i) {
    Extent extent{glm::vec2(std::numeric_limits<float>::infinity()), glm::vec2(-std::numeric_limits<float>::infinity()),
                  0, 0};
    for (const PaintCorner& corner : corners_of(order, i)) {
      extent.low = glm::min(extent.low, glm::vec2(corner.at));
      extent.high = glm::max(extent.high, glm::vec2(corner.at));
    }
    extents.push_back(extent);
  }
  return extents;
}

}  // namespace

Overlaps::Overlaps(const PaintOrder& order) : order_(order), extents_(extents_of(order)), grid_(extents_) {}

bool Overlaps::overlap(std::size_t i, std::size_t k) const {
  const Extent &a = extents_[i], &b = extents_[k];
  if (a.low.x >= b.high.x || b.low.x >= a.high.x || a.low.y >= b.high.y || b.low.y >= a.high.y) return false;
  const Corners own = corners_of(order_, i), other = corners_of(order_, k);
  return !has_side_between(own, other) && !has_side_between(other, own);
}

}  // namespace frontmost::shading
