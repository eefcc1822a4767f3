// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "frontmost/scene.h"

namespace frontmost {

/// Validates all but the vertices that triangles name, which Surfaces checks itself.
void validate_besides_vertices(const Scene& scene);

/// What stands before the place in errors about a scene: its name, if it has one.
[[nodiscard]] std::string place_in(const Scene& scene);

}  // namespace frontmost
