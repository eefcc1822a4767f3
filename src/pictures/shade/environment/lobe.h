// SPDX-License-Identifier: Apache-2.0
// What a rough surface mirrors, seen from straight ahead, as a few dozen directions around its normal.
//
// The wider the part of the lobe that a direction stands for, the coarser the map in which it is looked up, so that
// none of the light between directions is lost. (J. Krivanek, M. Colbert. Real-Time Shading with Filtered Importance
// Sampling. Eurographics Symposium on Rendering 2008.)
#pragma once

#include <span>
#include <vector>

#include "frontmost/base.h"
#include "shade/environment/octahedral_map.h"

namespace frontmost::shading {

struct LobeDirection {
  glm::vec3 towards{0};  ///< unit; z along the normal
  float weight = 0;      ///< all together 1
  int map = 0;           ///< number of the map
};

/// Up to `count`, of the GGX lobe of this roughness (above 0) weighted by the cosine; to be looked up in these maps, of
/// which each is half as wide as the one before.
[[nodiscard]] std::vector<LobeDirection> lobe_directions(double roughness, int count,
                                                         std::span<const OctahedralMap> maps);

/// Fills row y of `out` with the light of `maps` weighted by the lobe about the direction of each texel.
void blur_row(std::span<const OctahedralMap> maps, std::span<const LobeDirection> lobe, int y, OctahedralMap& out,
              Isa isa);

}  // namespace frontmost::shading
