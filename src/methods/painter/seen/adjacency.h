// SPDX-License-Identifier: Apache-2.0
// Which polygons share a side, as those of a mesh do; and which no other one overlaps on the screen, told by the few
// sides that have no neighbour.
//
//           ____ ____          The side that both squares have runs down in one and up in the other: across it lies
//          |    ^    |         the neighbour, and a walk over the screen goes on there. Sides at the rim have no
//          |   | |   |         neighbour, they are open: only at an open side may something begin or end, so only
//          |____v____|         there may the number of polygons over a point of the screen change.
#pragma once

#include <vector>

#include "base/parallel.h"
#include "painter/seen/screen_polygons.h"

namespace frontmost::painter_detail {

/// The adjacency of polygons on the screen. Two are adjacent where both have the same side, to the bit, in opposite
/// directions. Both are convex and counter-clockwise, so they touch there and do not overlap.
class Adjacency {
 public:
  explicit Adjacency(const ScreenPolygons& screen);

  /// The slot of the polygon across a side, which is known by its first one of ScreenPolygons::corners(); no_index:
  /// none.
  [[nodiscard]] std::uint32_t across(std::size_t corner) const { return across_[corner]; }

 private:
  std::vector<std::uint32_t> across_;
};

/// By slot: 1 where surely no other polygon overlaps the one in it. Polygons with `gone[slot]` do not count; an empty
/// `gone` stands for none. Finds nothing in scenes whose polygons share few sides.
[[nodiscard]] std::vector<std::uint8_t> find_unoverlapped(const ScreenPolygons& screen, const Adjacency& adjacency,
                                                          const std::vector<std::uint8_t>& gone, PaintEffort& effort);

}  // namespace frontmost::painter_detail
