// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "frontmost/scene.h"

namespace frontmost {

/// As validate(), but for the vertices that triangles name: for Surfaces, which look at all of those anyway.
void validate_besides_vertices(const Scene& scene);

}  // namespace frontmost
