// SPDX-License-Identifier: Apache-2.0
// The page's camera: eye, target and angle as in the program's flags, so that a command can reproduce a picture of the
// page.
#pragma once

#include <frontmost/view.h>

#include "web/json.h"

namespace frontmost::web {

/// Makes a view of {"width", "height", "eye", "target", "up", "angle" (degrees from bottom to top), "orthographic",
/// "near", "far"}. The view equals, to the bit, the view that `frontmost render` makes of the flags of these names. In
/// parallel projection, the angle is that of a perspective camera that sees as much at the target. Default planes
/// enclose `bounds`. \throws Error bad_argument or singular_camera as look_at() and validate() do.
[[nodiscard]] View view_of(const PlainJson& camera, const Box& bounds);

/// Points origin + t * direction.
struct SightLine {
  glm::dvec3 origin{0}, direction{0};
};
/// The line through the centre of a pixel. In perspective, t is the planar distance.
[[nodiscard]] SightLine sight_through(const View& view, int x, int y);

/// The camera of a view in every convention: pose matrices, intrinsics, projection matrices.
[[nodiscard]] PlainJson conventions_json(const View& view, const glm::dvec3& origin);

/// The page's camera for a view that frame() has made. Its target is as far away as `centre`.
[[nodiscard]] PlainJson camera_json(const View& view, const glm::dvec3& centre);

}  // namespace frontmost::web
