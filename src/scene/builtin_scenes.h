// SPDX-License-Identifier: Apache-2.0
// The scenes behind builtin(), one function each.
#pragma once

#include "frontmost/scene.h"

namespace frontmost {

[[nodiscard]] Scene make_teapot();
[[nodiscard]] Scene make_cubes();
[[nodiscard]] Scene make_cycle();
[[nodiscard]] Scene make_city();
[[nodiscard]] Scene make_spheres();
[[nodiscard]] Scene make_gallery();

}  // namespace frontmost
