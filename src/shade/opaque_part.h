// SPDX-License-Identifier: Apache-2.0
// What throws shadows: glass does not, and of leaves only the outline of the card they are drawn on is known.
#pragma once

#include "frontmost/scene.h"

namespace frontmost::shading {

/// Whether any material of the scene is masked or blended.
[[nodiscard]] bool has_see_through(const Scene& scene);

/// The scene without masked and blended triangles. Copies the meshes that hold others, but no textures; materials keep
/// their numbers. O(triangles).
[[nodiscard]] Scene opaque_part(const Scene& scene);

}  // namespace frontmost::shading
