// SPDX-License-Identifier: Apache-2.0
// The specular lobe of a rough surface at normal incidence, as a few dozen directions around its normal.
//
// A direction that stands for a wider part of the lobe is looked up in a coarser map, so that no light between
// directions is lost. (J. Krivanek, M. Colbert. Real-Time Shading with Filtered Importance Sampling. Eurographics
// Symposium on Rendering 2008.)
#pragma once

#include <span>
#include <vector>

#include "frontmost/base.h"
#include "shade/environment/octahedral_map.h"

namespace frontmost::shading {

struct LobeDirection {
  glm::vec3 towards{0};  ///< unit; z along the normal
  float weight = 0;      ///< all weights sum to 1
  int map = 0;           ///< index of the map for the look-up
};

/// Up to `count` directions of the GGX lobe of this roughness (above 0), weighted by the cosine, for look-ups in these
/// maps. Each map is half as wide as the one before.
[[nodiscard]] std::vector<LobeDirection> lobe_directions(double roughness, int count,
                                                         std::span<const OctahedralMap> maps);

/// Fills row y of `out`: each texel gets the light of `maps`, weighted by the lobe around the texel's direction.
void blur_row(std::span<const OctahedralMap> maps, std::span<const LobeDirection> lobe, int y, OctahedralMap& out,
              Isa isa);

}  // namespace frontmost::shading
