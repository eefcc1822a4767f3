// SPDX-License-Identifier: Apache-2.0
// Pieces as polygons of an order.
#pragma once

#include "frontmost/painter.h"
#include "painter/limits.h"
#include "painter/pieces.h"

namespace frontmost::painter_detail {

[[nodiscard]] std::uint32_t corner_count(const Pieces& pieces, std::uint32_t piece);
/// Sets as many corners of an order as there are.
void emit(const Pieces& pieces, std::uint32_t piece, PaintCorner* corners);

/// Appends pieces in the order in which they are listed.
void emit(const Pieces& pieces, const std::vector<std::uint32_t>& members, PaintOrder& order, Poll& poll);

}  // namespace frontmost::painter_detail
