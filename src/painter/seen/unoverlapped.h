// SPDX-License-Identifier: Apache-2.0
// Polygons that nothing lies over or under, told by the few sides where surfaces end.
#pragma once

#include <vector>

#include "base/parallel.h"
#include "painter/seen/adjacency.h"

namespace frontmost::painter_detail {

/// By slot: 1 where surely no other polygon overlaps any part of it on the screen, those with `gone[slot]` apart, which
/// are not there; `gone` empty: all are. Of scenes with few neighbours none is found.
[[nodiscard]] std::vector<std::uint8_t> find_unoverlapped(const ScreenPolygons& screen, const Adjacency& adjacency,
                                                          const std::vector<std::uint8_t>& gone,
                                                          const Execution& execution);

}  // namespace frontmost::painter_detail
