// SPDX-License-Identifier: Apache-2.0
// Pieces parted by the plane of one of them.
//
// H. Fuchs, Z. Kedem, B. Naylor. On Visible Surface Generation by A Priori Tree Structures. 1980.
#pragma once

#include "frontmost/painter.h"
#include "painter/limits.h"
#include "painter/pieces.h"

namespace frontmost::painter_detail {

/// What is behind, in and before a plane, as the eye sees it: to be painted in this order, `within` as it stands.
struct Partition {
  std::vector<std::uint32_t> behind, within, before;
};

/// By the plane of one of `members`, which cuts as few of the others as those that were tried. Neither side is as many
/// as the members were. Of what is cut, one half takes its number and the other a new one.
[[nodiscard]] Partition part(Pieces& pieces, const std::vector<std::uint32_t>& members, PaintSteps& steps, Poll& poll);

}  // namespace frontmost::painter_detail
