// SPDX-License-Identifier: Apache-2.0
// Figures come from callers, too.
#pragma once

#include "shade/figure/colored_order.h"

namespace frontmost::shading {

/// \throws Error bad_argument where parts of a ColoredOrder do not match, or polygons have corners that are not there.
void check_figure(const ColoredOrder& colored);

}  // namespace frontmost::shading
