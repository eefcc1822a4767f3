// SPDX-License-Identifier: Apache-2.0
// The part of a scene that casts shadows: glass does not.
#pragma once

#include "frontmost/scene.h"

namespace frontmost::shading {

/// Whether any material of the scene is see-through.
[[nodiscard]] bool has_see_through(const Scene& scene);

/// The scene without see-through triangles. Copies the meshes that contain other triangles, and the textures that cut
/// holes; materials keep their numbers. O(triangles).
[[nodiscard]] Scene opaque_part(const Scene& scene);

}  // namespace frontmost::shading
