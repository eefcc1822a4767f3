// SPDX-License-Identifier: Apache-2.0
// Checking a scene in parts.
#pragma once

#include "frontmost/scene.h"

namespace frontmost {

/// validate(), but for the vertices that triangles name: for whoever looks at all of those anyway.
void validate_besides_vertices(const Scene& scene);

}  // namespace frontmost
