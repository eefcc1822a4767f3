// SPDX-License-Identifier: Apache-2.0
// The views of lights: surfaces visible in such a view are lit, others are in shadow.
//
//   key light   along its direction, at the visible points; it moves with the camera
//   sun         the same, but its window is larger and on a fixed grid: it stays while the camera moves a little
//   spot        from the lamp along its cone; the same for every camera
#pragma once

#include <optional>

#include "frontmost/scene.h"
#include "shade/seen_points.h"

namespace frontmost::shading {

/// The view of the key light: along -to_light at the points of `visible`, with room for everything within `bounds` that
/// may stand between. None if nothing is visible, or nothing can cast a shadow.
[[nodiscard]] std::optional<View> view_of_light(const SeenPoints& visible, const Box& bounds,
                                                const glm::dvec3& to_light, const Execution& execution);

/// The view of a sun of the file, likewise.
[[nodiscard]] std::optional<View> view_of_sun(const SeenPoints& visible, const Box& bounds, const Light& sun,
                                              const Execution& execution);

/// The view of a spot of the file, for pictures of this size. It reaches at most 75 degrees from the axis; points
/// beyond have no shadow. None if nothing can cast a shadow.
[[nodiscard]] std::optional<View> view_of_spot(const View& picture, const Box& bounds, const Light& spot);

}  // namespace frontmost::shading
