// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "frontmost/scene.h"

namespace frontmost {

/// Validates everything but the vertex numbers of triangles, which Surfaces checks itself.
void validate_besides_vertices(const Scene& scene);

/// The prefix of the place in errors about a scene: the scene's name, if it has one.
[[nodiscard]] std::string place_in(const Scene& scene);

}  // namespace frontmost
