// SPDX-License-Identifier: Apache-2.0
// The triangles beyond the sides of a mesh's triangles. Vertices at one place are one, whatever their numbers.
#pragma once

#include <vector>

#include "frontmost/scene.h"
#include "geometry/edge_neighbours.h"

namespace frontmost::faces_detail {

/// \throws Error limit_exceeded for more than EdgeNeighbours::most_triangles.
[[nodiscard]] EdgeNeighbours mesh_sides(const Mesh& mesh, const Execution& execution);

/// By mesh. Precondition of asking one: its mesh has an instance.
[[nodiscard]] std::vector<EdgeNeighbours> sides_of_meshes(const Scene& scene, const Execution& execution);

}  // namespace frontmost::faces_detail
