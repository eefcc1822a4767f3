// SPDX-License-Identifier: Apache-2.0
// What occluders hide, told before anything is in order.
#pragma once

#include "base/parallel.h"
#include "frontmost/painter.h"
#include "painter/pieces.h"

namespace frontmost::painter_detail {

/// What is left of a list of pieces, in its order.
struct Unhidden {
  std::vector<std::uint32_t> unoverlapped;  ///< no other one is over or under any part of them
  std::vector<std::uint32_t> others;
};

/// Leaves out most that occluders hide together. Precondition: pieces of different triangles.
[[nodiscard]] Unhidden without_hidden(const Pieces& pieces, const std::vector<std::uint32_t>& members, const View& view,
                                      const Occluders& occluders, const Execution& execution);

}  // namespace frontmost::painter_detail
