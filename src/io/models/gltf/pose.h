// SPDX-License-Identifier: Apache-2.0
// Moves vertices by morph targets and joints.
#pragma once

#include "io/models/gltf/meshes.h"

namespace frontmost::gltf {

/// A run of vertices of a mesh that come from one vertex set.
struct VertexRun {
  const VertexSet* vertices = nullptr;
  ElementRange range;     ///< of the accessors' elements; empty: no triangle uses them
  std::size_t first = 0;  ///< where they are in the mesh
  std::string place;      ///< of the first primitive that uses them
};

/// Adds weighted displacements to positions, normals, texture coordinates and colours.
void apply_targets(const Data& data, const VertexRun& block, std::span<const double> weights, Mesh& mesh);
/// Moves positions and normals by joints, which the block's vertices have.
/// \throws Error file_malformed for a joint that the skin does not have.
void apply_skin(const Data& data, const VertexRun& block, std::span<const glm::dmat4> joints, const ModelSource& source,
                Mesh& mesh);

}  // namespace frontmost::gltf
