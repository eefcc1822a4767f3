// SPDX-License-Identifier: Apache-2.0
// Polygons that no other polygon overlaps on the screen, told by the few sides that have no neighbour.
#pragma once

#include <vector>

#include "base/parallel.h"
#include "painter/seen/adjacency.h"

namespace frontmost::painter_detail {

/// By slot: 1 where surely no other polygon overlaps the one in it. Polygons with `gone[slot]` do not count; an empty
/// `gone` stands for none. Finds nothing in scenes whose polygons share few sides.
[[nodiscard]] std::vector<std::uint8_t> find_unoverlapped(const ScreenPolygons& screen, const Adjacency& adjacency,
                                                          const std::vector<std::uint8_t>& gone,
                                                          const Execution& execution);

}  // namespace frontmost::painter_detail
