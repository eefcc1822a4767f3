// SPDX-License-Identifier: Apache-2.0
// Polygons of an order one by one.
#pragma once

#include <span>

#include "frontmost/painter.h"

namespace frontmost::shading {

[[nodiscard]] inline std::span<const PaintCorner> corners_of(const PaintOrder& order, std::size_t i) {
  return {order.corners.data() + order.polygons[i].first_corner, order.polygons[i].corner_count};
}

/// Adds one of them to another order.
inline void append(const PaintOrder& order, std::size_t i, PaintOrder& into) {
  PaintPolygon added = order.polygons[i];
  const std::span<const PaintCorner> corners = corners_of(order, i);
  added.first_corner = into.corners.size();
  into.polygons.push_back(added);
  into.corners.insert(into.corners.end(), corners.begin(), corners.end());
}

}  // namespace frontmost::shading
