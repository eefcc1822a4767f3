// SPDX-License-Identifier: Apache-2.0
// What others hide, told before anything is in order.
#pragma once

#include <functional>

#include "base/parallel.h"
#include "painter/pieces.h"

namespace frontmost::painter_detail {

/// What is left of a list of pieces, in its order.
struct Unhidden {
  std::vector<std::uint32_t> alone;  ///< no other one is over or under any part of them
  std::vector<std::uint32_t> others;
};

/// Leaves out some that others hide together. Those hide of which `hides` is true. Precondition: pieces of different
/// triangles.
[[nodiscard]] Unhidden without_hidden(const Pieces& pieces, const std::vector<std::uint32_t>& members, const View& view,
                                      const std::function<bool(PrimitiveId)>& hides, const Execution& execution);

}  // namespace frontmost::painter_detail
