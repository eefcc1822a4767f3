// SPDX-License-Identifier: Apache-2.0
// The views of lights: what is visible in one of them is lit, the rest in shadow.
//
//   key light   along its direction, at what is seen; it moves with the camera
//   sun         the same, but its window lies on a grid that stays where it is, and is larger than it must be: while
//   the
//               camera moves a little it is the same window
//   spot        from the lamp, along its cone: it is the same for every camera
#pragma once

#include <optional>

#include "frontmost/scene.h"
#include "shade/seen_points.h"

namespace frontmost::shading {

/// The view of the key light: along -to_light at what `visible` shows, with room for whatever else lies within `bounds`
/// and may stand between. None where nothing is visible, or there is nothing to throw a shadow.
[[nodiscard]] std::optional<View> view_of_light(const SeenPoints& visible, const Box& bounds,
                                                const glm::dvec3& to_light, const Execution& execution);

/// The same of a sun of the file.
[[nodiscard]] std::optional<View> view_of_sun(const SeenPoints& visible, const Box& bounds, const Light& sun,
                                              const Execution& execution);

/// The view of a spot of the file, for pictures as large as this one. It reaches 75 degrees from the axis at most: what
/// is lit beyond lies in no shadow. None where there is nothing to throw one.
[[nodiscard]] std::optional<View> view_of_spot(const View& picture, const Box& bounds, const Light& spot);

}  // namespace frontmost::shading
