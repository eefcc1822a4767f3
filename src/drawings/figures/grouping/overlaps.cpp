// SPDX-License-Identifier: Apache-2.0
// Two convex polygons overlap unless a side of one has all of the other on its outer side. Polygons that overlap by
// less than 1/512 pixel, as neighbours do by the rounding of cuts, count as apart.
#include "figures/grouping/overlaps.h"

#include <algorithm>

namespace frontmost::shading {
namespace {

using painter_detail::PolygonExtent;

/// Least overlap in pixels; polygons cut at each other's sides overlap by rounding.
constexpr double kThin = 1.0 / 512;

using PolygonCorners = std::span<const glm::dvec2>;

/// Whether a side of `a` has all of `b` outside. Both are counter-clockwise as seen; y is down.
bool has_side_between(PolygonCorners a, PolygonCorners b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const glm::dvec2 from = a[i], way = a[i + 1 == a.size() ? 0 : i + 1] - from;
    const double length = glm::length(way);
    if (!(length > kThin)) continue;
    const auto is_outside = [&](const glm::dvec2& corner) {
      const glm::dvec2 p = corner - from;
      return way.x * p.y - way.y * p.x > -kThin * length;
    };
    if (std::all_of(b.begin(), b.end(), is_outside)) return true;
  }
  return false;
}

std::vector<PolygonExtent> extents_of(const ColoredOrder& order) {
  std::vector<PolygonExtent> extents;
  extents.reserve(order.polygons.size());
  for (const PaintPolygon& polygon : order.polygons) {
    PolygonExtent extent{glm::vec2(std::numeric_limits<float>::infinity()),
                         glm::vec2(-std::numeric_limits<float>::infinity()), 0, 0};
    for (const glm::dvec2& corner : order.corners_of(polygon)) {
      extent.low = glm::min(extent.low, glm::vec2(corner));
      extent.high = glm::max(extent.high, glm::vec2(corner));
    }
    extents.push_back(extent);
  }
  return extents;
}

}  // namespace

Overlaps::Overlaps(const ColoredOrder& order) : order_(order), extents_(extents_of(order)), grid_(extents_) {}

bool Overlaps::overlap(std::size_t i, std::size_t k) const {
  const PolygonExtent &a = extents_[i], &b = extents_[k];
  if (a.low.x >= b.high.x || b.low.x >= a.high.x || a.low.y >= b.high.y || b.low.y >= a.high.y) return false;
  const PolygonCorners own = order_.corners_of(order_.polygons[i]), other = order_.corners_of(order_.polygons[k]);
  return !has_side_between(own, other) && !has_side_between(other, own);
}

}  // namespace frontmost::shading
