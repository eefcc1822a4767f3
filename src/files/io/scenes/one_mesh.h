// SPDX-License-Identifier: Apache-2.0
// The objects of a model as one mesh, so that what a scene file places is one object, whatever it is made of.
#pragma once

#include "frontmost/scene.h"

namespace frontmost {

/// All objects of a model, in their order, in its own space: about its origin, rounded to floats. What some of the
/// meshes have (normals, colours, texture coordinates) all have then, with what counts as missing in the others.
/// Preconditions: the model is valid and has no curved meshes. O(triangles).
[[nodiscard]] Mesh one_mesh(const Scene& model);

}  // namespace frontmost
