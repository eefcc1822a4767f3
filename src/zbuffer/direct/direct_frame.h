// SPDX-License-Identifier: Apache-2.0
// One picture of a scene, straight from its own arrays.
#pragma once

#include "frontmost/scene.h"
#include "frontmost/visible.h"

namespace frontmost::zbuffer_detail {

/// What zbuffer(Surfaces(scene), view) gives, to the bit. Precondition: the view is valid, and the scene but for the
/// vertices that triangles name. \throws Error as validate(scene) does where it is not.
/// O(triangles + covered samples). Memory beside the result: some ten MiB, 100 bytes a large or clipped triangle of
/// half a million in a row, and the holes of MASK materials.
[[nodiscard]] Visible draw_directly(const Scene& scene, const View& view, const Execution& execution);

}  // namespace frontmost::zbuffer_detail
