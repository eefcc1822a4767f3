// SPDX-License-Identifier: Apache-2.0
// Polygons that lie side by side, as those of a mesh do.
#pragma once

#include "painter/seen/screen_polygons.h"

namespace frontmost::painter_detail {

/// Which polygon lies across a side of another: one that has the same side, to the bit, in the other direction. Both
/// are convex and counter-clockwise, so they touch there and do not overlap.
class Adjacency {
 public:
  explicit Adjacency(const ScreenPolygons& screen);

  /// The slot of the polygon across a side, which is known by its first one of ScreenPolygons::corners(); no_index:
  /// none.
  [[nodiscard]] std::uint32_t across(std::size_t corner) const { return across_[corner]; }

 private:
  std::vector<std::uint32_t> across_;
};

}  // namespace frontmost::painter_detail
