// SPDX-License-Identifier: Apache-2.0
// The length of strokes without arcs.
#pragma once

#include "frontmost/lines.h"

namespace frontmost::test {

/// Pixels.
inline double total_length(const Strokes& all) {
  double length = 0;
  for (const Stroke& stroke : all.strokes)
    for (std::uint32_t i = 0; i + (stroke.is_closed ? 0 : 1) < stroke.count; ++i)
      length += glm::distance(all.points[stroke.first + i], all.points[stroke.first + (i + 1) % stroke.count]);
  return length;
}

}  // namespace frontmost::test
