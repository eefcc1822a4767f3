// SPDX-License-Identifier: Apache-2.0
// The triangles that a view may show, as pieces.
#pragma once

#include "base/parallel.h"
#include "frontmost/surfaces.h"
#include "painter/pieces.h"

namespace frontmost::painter_detail {

/// Appends them in the order of their ids, between the near and the far plane. \returns their numbers.
[[nodiscard]] std::vector<std::uint32_t> gather(const Surfaces& surfaces, const View& view, Pieces& pieces,
                                                const Execution& execution);

}  // namespace frontmost::painter_detail
