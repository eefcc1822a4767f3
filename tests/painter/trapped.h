// SPDX-License-Identifier: Apache-2.0
// Polygons with their traps.
#pragma once

#include "frontmost/painter.h"
#include "painter/traps/traps.h"

namespace frontmost::test {

using PolygonCorners = std::vector<glm::dvec2>;

/// The outlines of a PaintOrder or of VisibleParts.
template <class Order>
std::vector<PolygonCorners> outlines_of(const Order& order) {
  std::vector<PolygonCorners> outlines;
  for (const PaintPolygon& polygon : order.polygons) {
    PolygonCorners& outline = outlines.emplace_back();
    for (std::uint32_t i = 0; i < polygon.corner_count; ++i)
      outline.push_back(glm::dvec2(order.corners[polygon.first_corner + i].at));
  }
  return outlines;
}

/// The outlines, widened by traps. Polygons with one id look the same; `occluders` is asked by id.
template <class Order>
std::vector<PolygonCorners> trapped(const Order& order, double width, const Occluders& occluders = Occluders::all(),
                                    const Execution& execution = {}) {
  using namespace painter_detail;
  const std::vector<PolygonCorners> outlines = outlines_of(order);
  std::vector<ScreenPolygon> polygons;
  for (std::size_t i = 0; i < outlines.size(); ++i)
    polygons.push_back({outlines[i], order.polygons[i].id, occluders.contain(order.polygons[i].id)});
  const TrapList traps = make_traps(polygons, order.view, width, execution);
  std::vector<PolygonCorners> all(outlines.size());
  std::vector<TrappedCorner> corners;
  for (std::size_t i = 0; i < all.size(); ++i) {
    traps.set_corners(i, outlines[i], corners);
    write_outline(traps, corners, all[i]);
  }
  return all;
}

}  // namespace frontmost::test
