// SPDX-License-Identifier: Apache-2.0
// Traps of a figure's polygons.
#pragma once

#include "painter/traps/trap.h"
#include "shade/figure/colored_order.h"

namespace frontmost::shading {

/// By polygon. Opaque polygons have traps under those after them, translucent ones under others of their sheet. Others
/// of the same shape hide a trap wherever they lie, and so do parts of the same primitive that have its colour.
[[nodiscard]] painter_detail::TrapList figure_traps(const ColoredOrder& colored, double width,
                                                    const Occluders& occluders, const Execution& execution);

}  // namespace frontmost::shading
