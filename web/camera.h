// SPDX-License-Identifier: Apache-2.0
// The page's camera: an eye, what it looks at, an angle, as the program's flags have them, so that a picture of the
// page can be made again by a command.
#pragma once

#include <frontmost/view.h>

#include "web/json.h"

namespace frontmost::web {

/// {"width", "height", "eye", "target", "up", "angle" (degrees from bottom to top), "orthographic", "near", "far"} ->
/// the view that `frontmost render` makes of the flags of these names, to the bit. In parallel projection the angle is
/// that of a perspective camera that sees as much at the target. Without "near" and "far" they enclose `bounds`.
/// \throws Error bad_argument or singular_camera as look_at() and validate() do.
[[nodiscard]] View view_of(const PlainJson& camera, const Box& bounds);

/// Points origin + t * direction.
struct SightLine {
  glm::dvec3 origin{0}, direction{0};
};
/// Through the centre of a pixel. In perspective t is the planar distance.
[[nodiscard]] SightLine sight_through(const View& view, int x, int y);

/// The camera of a view in every convention: pose matrices, intrinsics, projection matrices.
[[nodiscard]] PlainJson conventions_json(const View& view, const glm::dvec3& origin);

/// The other way round, for a view that frame() has made. `centre`: its target is as far away as this.
[[nodiscard]] PlainJson camera_json(const View& view, const glm::dvec3& centre);

}  // namespace frontmost::web
