// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "state/frame.h"

namespace frontmost::gl_detail {

/// glRasterPos: the place is transformed, lit and clipped as a vertex with the current values.
void set_raster_position(DrawInput& input, const glm::vec4& object, Isa isa);
/// glWindowPos: a place in the window, with the current values.
void set_window_position(DrawInput& input, const glm::vec3& window);

}  // namespace frontmost::gl_detail
