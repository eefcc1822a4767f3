// SPDX-License-Identifier: Apache-2.0
// Triangles of a mesh of patches, without gaps between patches of different fineness.
#pragma once

#include "frontmost/scene.h"
#include "view/tessellate/level.h"

namespace frontmost {

/// Whether there is anything to cut.
[[nodiscard]] bool is_finite(const BezierPatch& patch);

/// Steps along the four edges of a patch, each at least those of its grid: u = 0, u = 1 (both along v), v = 0, v = 1.
using EdgeLevels = std::array<int, 4>;

/// Each edge is as fine as the finest patch that has it.
/// Those of patches that are not finite are anything.
[[nodiscard]] std::vector<EdgeLevels> edge_levels(std::span<const BezierPatch> patches,
                                                  std::span<const PatchLevel> levels);

/// Appends the triangles of one patch as those of face `face`, with normals and texture coordinates.
void append_grid(const BezierPatch& patch, const PatchLevel& level, const EdgeLevels& edges, std::uint32_t face,
                 Mesh& mesh);

}  // namespace frontmost
