// SPDX-License-Identifier: Apache-2.0
// The gaps of depth buffers against distance, as an SVG drawing.
#pragma once

#include <frontmost/precision.h>

#include <glm/glm.hpp>
#include <optional>
#include <string>

namespace frontmost::cli {

/// `chosen` stands out from the formats in use; none: all are drawn alike. `wanted`: a gap and a distance to mark.
[[nodiscard]] std::string precision_plot(const ClipDistances& clip, bool orthographic,
                                         const std::optional<DepthSetup>& chosen,
                                         const std::optional<glm::dvec2>& wanted);

}  // namespace frontmost::cli
