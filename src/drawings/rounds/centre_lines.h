// SPDX-License-Identifier: Apache-2.0
// The visible extent of rounds in a view, for centre lines, dimensions and sections.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "frontmost/lines.h"

namespace frontmost {

/// The drawn length of each round in pixels: visible lines, and hidden ones if `with_hidden`.
[[nodiscard]] std::vector<double> drawn_lengths(const Rounds& rounds, const Drawing& drawing, bool with_hidden);

/// The place of a world point in a parallel view, in pixels.
[[nodiscard]] glm::dvec2 on_screen(const View& view, const glm::dvec3& point);

}  // namespace frontmost
