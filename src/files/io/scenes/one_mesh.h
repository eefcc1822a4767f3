// SPDX-License-Identifier: Apache-2.0
// Joins the objects of a model into one mesh, so that a scene file places any model as a single object.
#pragma once

#include "frontmost/scene.h"

namespace frontmost {

/// All objects of a model as one mesh, in their order, in the model's space: relative to its origin, rounded to floats.
/// If some meshes have normals, colours or texture coordinates, the others get the values that count as missing.
/// Preconditions: the model is valid and has no curved meshes. O(triangles).
[[nodiscard]] Mesh one_mesh(const Scene& model);

}  // namespace frontmost
