// SPDX-License-Identifier: Apache-2.0
// The cameras and lights of a model that a scene file places.
#pragma once

#include "frontmost/scene.h"

namespace frontmost {

/// A camera of the model, placed as the model is. Cameras are rigid: it looks the way that the transform turns its
/// viewing direction, and lengths (planes, the height of a parallel projection) grow as those along that direction do.
[[nodiscard]] Camera carried(Camera camera, const glm::dmat4& scene_from_model);
/// A light likewise. What it lights, grown with it, is as bright as before.
[[nodiscard]] Light carried(Light light, const glm::dmat4& scene_from_model);

}  // namespace frontmost
