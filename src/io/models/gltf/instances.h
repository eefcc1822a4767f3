// SPDX-License-Identifier: Apache-2.0
// What the nodes of a glTF file place in the world: meshes, posed or not, and cameras.
#pragma once

#include "io/models/gltf/meshes.h"
#include "io/models/gltf/nodes.h"

namespace frontmost::gltf {

/// Fills scene.meshes and scene.instances. Meshes keep the file's numbers; a mesh that is posed in several ways is
/// there several times, the others at the end. Meshes that no shown node uses are read, but not placed.
void place_meshes(const JsonValue& root, const Data& data, const std::vector<MeshPlan>& plans, const NodeTree& tree,
                  Scene& scene);

/// Fills scene.cameras, one for each shown node that has one.
void place_cameras(const JsonValue& root, const NodeTree& tree, Scene& scene);

}  // namespace frontmost::gltf
