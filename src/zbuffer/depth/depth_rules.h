// SPDX-License-Identifier: Apache-2.0
// What a DepthState means for one view and one format, worked out once a draw call.
#pragma once

#include <array>

#include "frontmost/depth_buffer.h"
#include "view/screen_transform.h"

namespace frontmost::zbuffer_detail {

/// Window depth of a key: limited(at_zero + slope * key) + offset, in double, limited to [0, 1].
struct DepthMap {
  double at_zero, slope;
  double low, high;  ///< the depth range, in order

  [[nodiscard]] double of(float key) const {
    const double depth = at_zero + slope * double(key);
    return depth < low ? low : depth > high ? high : depth;
  }
};

struct DepthRules {
  DepthMap map;
  DepthFormat format;
  bool passes_less, passes_equal, passes_greater;
  bool mask;
  PolygonOffset offset;

  [[nodiscard]] bool has_offset() const { return offset.factor != 0 || offset.units != 0; }
  /// Of a triangle with key gradient (gx, gy) per 1/256 pixel; `key_low` and `key_high` of its whole visible part.
  [[nodiscard]] double offset_of(double gx, double gy, float key_low, float key_high) const;
};

/// \throws Error bad_argument naming what is out of range.
[[nodiscard]] DepthRules rules_for(const DepthState& state, DepthFormat format, const ScreenTransform& transform);

}  // namespace frontmost::zbuffer_detail
