// SPDX-License-Identifier: Apache-2.0
// What throws shadows: glass does not.
#pragma once

#include "frontmost/scene.h"

namespace frontmost::shading {

/// Whether light comes through any material of the scene.
[[nodiscard]] bool has_see_through(const Scene& scene);

/// The scene without triangles that light comes through. Copies the meshes that hold others, and of the textures those
/// that cut holes; materials keep their numbers. O(triangles).
[[nodiscard]] Scene opaque_part(const Scene& scene);

}  // namespace frontmost::shading
