// SPDX-License-Identifier: Apache-2.0
// Pieces as polygons of an order.
#pragma once

#include "frontmost/painter.h"
#include "painter/pieces.h"
#include "painter/poll.h"

namespace frontmost::painter_detail {

/// Appends pieces in the order in which they are listed.
void emit(const Pieces& pieces, const std::vector<std::uint32_t>& members, PaintOrder& order, Poll& poll);

}  // namespace frontmost::painter_detail
