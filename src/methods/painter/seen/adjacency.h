// SPDX-License-Identifier: Apache-2.0
// Which polygons share a side, as those of a mesh do, and which polygons no other one overlaps on the screen, found
// from the few sides without a neighbour.
//
//           ____ ____          The side that both squares share runs down in one and up in the other. The neighbour
//          |    ^    |         lies across it, and a walk over the screen continues there. Sides at the rim have no
//          |   | |   |         neighbour and are called open. Only at an open side may something begin or end, so
//          |____v____|         only there may the number of polygons over a point of the screen change.
#pragma once

#include <vector>

#include "base/parallel.h"
#include "painter/limits.h"
#include "painter/seen/screen_polygons.h"

namespace frontmost::painter_detail {

/// The adjacency of polygons on the screen. Two polygons are adjacent if both have the same side, to the bit, in
/// opposite directions. Both are convex and counter-clockwise, so they touch there and do not overlap.
class Adjacency {
 public:
  explicit Adjacency(const ScreenPolygons& screen);

  /// The slot of the polygon across a side, or no_index. The side is given by its first corner in
  /// ScreenPolygons::corners().
  [[nodiscard]] std::uint32_t across(std::size_t corner) const { return across_[corner]; }

 private:
  std::vector<std::uint32_t> across_;
};

/// By slot: 1 if surely no other polygon overlaps the one in it. Polygons with `gone[slot]` do not count; an empty
/// `gone` means that none is gone. Finds nothing in scenes whose polygons share few sides.
[[nodiscard]] std::vector<std::uint8_t> find_unoverlapped(const ScreenPolygons& screen, const Adjacency& adjacency,
                                                          const std::vector<std::uint8_t>& gone, PaintEffort& effort);

}  // namespace frontmost::painter_detail
