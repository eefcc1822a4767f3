// SPDX-License-Identifier: Apache-2.0
// A painted order compared with the z-buffer.
#pragma once

#include <gtest/gtest.h>

#include "frontmost/painter.h"
#include "frontmost/precision.h"
#include "frontmost/zbuffer.h"

namespace frontmost::test {

/// An order, and how many samples differ from the z-buffer, with a reason and without.
struct Painted {
  PaintOrder order;
  std::uint64_t explained = 0, unexplained = 0;
};

inline Painted painted(const Surfaces& surfaces, const View& view, PaintMethod method = PaintMethod::depth_sort) {
  Painted result{painter(surfaces, view, {.method = method}), 0, 0};
  const Agreement found = check_agreement(surfaces, zbuffer(surfaces, view), paint(surfaces, result.order));
  result.unexplained = found.count(Difference::unexplained);
  result.explained = found.differing() - result.unexplained;
  return result;
}

/// Ids of the polygons of a PaintOrder or of VisibleParts.
template <class Order>
std::vector<PrimitiveId> ids_of(const Order& order) {
  std::vector<PrimitiveId> ids;
  for (const PaintPolygon& polygon : order.polygons) ids.push_back(polygon.id);
  return ids;
}

/// A view from (0, 0, 10) down to the origin, parallel or not, with planes at 1 and 100.
inline View view_from_above(bool is_parallel, int size = 64) {
  View view;
  view.width = view.height = size;
  view.world_from_eye = look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
  view.projection = is_parallel ? make_orthographic(-2, 2, -2, 2, {1, 100}) : make_projection(0.4, 1.0, {1, 100});
  return view;
}

}  // namespace frontmost::test
