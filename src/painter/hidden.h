// SPDX-License-Identifier: Apache-2.0
// What others hide, told before anything is in order.
#pragma once

#include <functional>

#include "base/parallel.h"
#include "painter/pieces.h"

namespace frontmost::painter_detail {

/// `members` in their order, without some that others of them hide together. Those hide of which `hides` is true.
/// Precondition: pieces of different triangles.
[[nodiscard]] std::vector<std::uint32_t> without_hidden(const Pieces& pieces, const std::vector<std::uint32_t>& members,
                                                        const View& view, const std::function<bool(PrimitiveId)>& hides,
                                                        const Execution& execution);

}  // namespace frontmost::painter_detail
