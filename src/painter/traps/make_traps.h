// SPDX-License-Identifier: Apache-2.0
// The one place where traps are made.
#pragma once

#include "painter/seen/screen_polygons.h"
#include "painter/traps/trap.h"

namespace frontmost::painter_detail {

/// The traps of polygons in the order of painting. A polygon reaches under what is painted later and lies beside it, by
/// `width` pixels or less, as far as that, or other polygons of its group, hide the trap, and around its corners
/// likewise. So what is painted first in a pixel covers all of it. Traps end a pixel below what is open, or at two
/// fifths of the way to it where that is less, so that outlines hardly grow bold. Cost as for visible_parts().
[[nodiscard]] TrapList make_traps(std::span<const ScreenPolygon> polygons, const View& view, double width,
                                  const Execution& execution);

}  // namespace frontmost::painter_detail
