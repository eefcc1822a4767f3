// SPDX-License-Identifier: Apache-2.0
// What a view shows of rounds, and where: for centre lines, dimensions and sections.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "frontmost/lines.h"

namespace frontmost {

/// How much of each round a drawing shows, in pixels: of what is seen, and with `with_hidden` of what is not.
[[nodiscard]] std::vector<double> drawn_lengths(const Rounds& rounds, const Drawing& drawing, bool with_hidden);

/// Where a point of world space is in a parallel view, in pixels.
[[nodiscard]] glm::dvec2 on_screen(const View& view, const glm::dvec3& point);

}  // namespace frontmost
