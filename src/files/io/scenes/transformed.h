// SPDX-License-Identifier: Apache-2.0
// Places the cameras and lights of a model that a scene file places.
#pragma once

#include "frontmost/scene.h"

namespace frontmost {

/// A camera of the model in the scene. The camera stays rigid: it looks along its transformed viewing direction.
/// Lengths (planes, the height of a parallel projection) are scaled by the transform's factor along that direction.
[[nodiscard]] Camera transformed(Camera camera, const glm::dmat4& scene_from_model);
/// A light of the model in the scene. An object that is scaled with the light is as bright as before.
[[nodiscard]] Light transformed(Light light, const glm::dmat4& scene_from_model);

}  // namespace frontmost
