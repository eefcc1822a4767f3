// SPDX-License-Identifier: Apache-2.0
// The pixels whose sample a triangle covers, one after another: for what looks at every fragment by itself.
#pragma once

#include "zbuffer/triangle_records.h"

namespace frontmost::zbuffer_detail {

/// Calls visit(x, y) for the pixels of `rect` whose sample, `offset` from the pixel's corner, is covered.
template <class Visit>
void visit_covered(const TriangleRecord& r, const PixelRect& rect, const glm::ivec2& offset, const Visit& visit) {
  // Exact: coordinates within the guard band have 22 bits, their differences 23, a product and a sum of such 47.
  std::int64_t row[3], step_x[3], step_y[3];
  for (int k = 0; k < 3; ++k) {
    const int n = k == 2 ? 0 : k + 1;
    const std::int64_t dx = r.x[n] - r.x[k], dy = r.y[n] - r.y[k];
    const bool is_top_left = dy < 0 || (dy == 0 && dx > 0);
    row[k] = dx * (rect.y0 * kSubPixels + offset.y - r.y[k]) - dy * (rect.x0 * kSubPixels + offset.x - r.x[k]) -
             (is_top_left ? 0 : 1);
    step_x[k] = -dy * kSubPixels;
    step_y[k] = dx * kSubPixels;
  }
  for (int y = rect.y0; y <= rect.y1; ++y) {
    std::int64_t e[3] = {row[0], row[1], row[2]};
    for (int x = rect.x0; x <= rect.x1; ++x) {
      if ((e[0] | e[1] | e[2]) >= 0) visit(x, y);
      for (int k = 0; k < 3; ++k) e[k] += step_x[k];
    }
    for (int k = 0; k < 3; ++k) row[k] += step_y[k];
  }
}

}  // namespace frontmost::zbuffer_detail
